// Expressions: a campaign file computes a number from other numbers. README.md in this folder has the
// grammar.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace dispersa {

/// The text is not a valid expression.
class ExpressionError : public std::runtime_error {
 public:
  /// `at`: position of the first wrong character, from 0.
  ExpressionError(const std::string& message, std::string allowed_instead, std::size_t at)
      : std::runtime_error("at character " + std::to_string(at + 1) + ": " + message),
        allowed(std::move(allowed_instead)) {}

  const std::string allowed;
};

/// The value of a name, as its position in the array that Evaluate gets.
struct NamedValue {
  int position = 0;
  bool is_condition = false;  ///< its value is 1 or 0
};
/// Throws UnknownName if the name has no value here.
using LookUp = std::function<NamedValue(const std::string& name)>;
struct UnknownName {
  std::string message;
  std::string allowed;
};

/// One operation of a stack machine. It replaces its operands on top of the stack by its result.
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
  int position = 0;  ///< position of a value, or the exponent of kPower
};

/// The steps of an expression. None: no value.
struct ExpressionSteps {
  const ExpressionStep* steps = nullptr;
  int count = 0;
};

/// Immutable after construction.
class Expression {
 public:
  /// Largest number of values on the stack.
  static constexpr std::size_t kDepth = 32;

  Expression() = default;
  explicit Expression(std::vector<ExpressionStep> steps) : steps_(std::move(steps)) {}

  /// The result. It is not finite if it is undefined. The same bits on every machine.
  double Evaluate(const double* values) const;
  /// They live as long as the expression.
  ExpressionSteps steps() const { return {steps_.data(), static_cast<int>(steps_.size())}; }
  /// Positions of the values that the expression reads, ascending.
  std::vector<int> Positions() const;

 private:
  std::vector<ExpressionStep> steps_;
};

/// Parses an expression of one number. Throws ExpressionError.
Expression ParseExpression(const std::string& text, const LookUp& look_up);

}  // namespace dispersa
