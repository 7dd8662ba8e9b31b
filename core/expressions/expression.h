// A number that input files compute from other numbers. README.md beside this file has the grammar.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace dispersa {

/// A text that is no expression.
class ExpressionError : public std::runtime_error {
 public:
  /// `at`: of the first character that is wrong, from 0.
  ExpressionError(const std::string& message, std::string allowed_instead, std::size_t at)
      : std::runtime_error("at character " + std::to_string(at + 1) + ": " + message),
        allowed(std::move(allowed_instead)) {}

  const std::string allowed;
};

/// The value that a name stands for: its position among those that Evaluate gets.
struct NamedValue {
  int position = 0;
  bool is_condition = false;  ///< its value is 1 or 0
};
/// Throws UnknownName for a name that stands for nothing here.
using LookUp = std::function<NamedValue(const std::string& name)>;
struct UnknownName {
  std::string message;
  std::string allowed;
};

/// One operation on the last values: those that it takes are replaced by its result.
struct ExpressionStep {
  enum class Kind {
    kNumber,
    kValue,
    kNegative,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kPower,  ///< a whole exponent: repeated multiplication
    kAbs,
    kSqrt,
    kExp,
    kLog,
    kSinDeg,
    kCosDeg,
    kLarger,
    kSmaller,
    kBelow,
    kAtMost,
    kAbove,
    kAtLeast,
    kAnd,
    kOr,
    kNot,
  };
  Kind kind;
  double number = 0.0;
  int position = 0;  ///< of a value, or an exponent
};

/// Immutable once made.
class Expression {
 public:
  /// As many values as are kept at the same time, at most.
  static constexpr std::size_t kDepth = 32;

  Expression() = default;
  explicit Expression(std::vector<ExpressionStep> steps) : steps_(std::move(steps)) {}

  /// Not finite where it is undefined. The same bits on every machine.
  double Evaluate(const double* values) const;
  /// Positions of the values that it reads, ascending.
  std::vector<int> Positions() const;

 private:
  std::vector<ExpressionStep> steps_;
};

/// One number of other numbers. Throws ExpressionError.
Expression ParseExpression(const std::string& text, const LookUp& look_up);

}  // namespace dispersa
