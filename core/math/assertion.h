// Rules of the program itself, checked in every build. One that does not hold is a defect of the program, not
// of its input: what computes stops, and nothing that it found counts.
#pragma once

#include <initializer_list>
#include <stdexcept>

namespace dispersa {

/// "engine fault: FILE:LINE: CONDITION does not hold", with the values of what the rule names.
class AssertionFailed : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

struct AssertedValue {
  template <typename Number>
  AssertedValue(Number number) : value(static_cast<double>(number)) {}
  double value;
};
[[noreturn]] void FailAssertion(const char* condition, const char* file, int line, const char* names,
                                std::initializer_list<AssertedValue> values);

}  // namespace dispersa

/// DISPERSA_ASSERT(condition, values...): throws AssertionFailed unless the condition holds. Not in code of
/// lanes, which is compiled for several instruction sets.
#define DISPERSA_ASSERT(condition, ...) \
  ((condition) ? void()                 \
               : ::dispersa::FailAssertion(#condition, __FILE__, __LINE__, #__VA_ARGS__, {__VA_ARGS__}))
