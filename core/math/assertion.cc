#include "core/math/assertion.h"

#include <cstdio>
#include <string>
#include <string_view>

namespace dispersa {
namespace {

// From the repository's root on: where it was built is of no use elsewhere.
std::string_view InRepository(std::string_view file) {
  for (const std::string_view room : {"core/", "services/"})
    if (const std::size_t at = file.rfind(room); at != std::string_view::npos) return file.substr(at);
  return file;
}

}  // namespace

void FailAssertion(const char* condition, const char* file, int line, const char* names,
                   std::initializer_list<AssertedValue> values) {
  std::string text = "engine fault: ";
  text += std::string(InRepository(file)) + ":" + std::to_string(line) + ": " + condition + " does not hold";
  if (values.size() > 0) text += std::string(", ") + names + ":";
  for (const AssertedValue& each : values) {
    char number[32];
    std::snprintf(number, sizeof number, " %.17g", each.value);
    text += number;
  }
  throw AssertionFailed(text);
}

}  // namespace dispersa
