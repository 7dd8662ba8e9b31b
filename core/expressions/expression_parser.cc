// Reads both kinds of expression. They differ in one thing: in a flight's expression names stand inside of
// functions over the flight, and these outside of any other.
#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "core/expressions/expression.h"
#include "core/expressions/flight_expression.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

using Step = ExpressionStep::Kind;

constexpr std::size_t kLongest = 1000;
constexpr int kDeepest = 30;

struct NumberFunction {
  const char* name;
  int arguments;
  Step step;
};
constexpr NumberFunction kNumberFunctions[] = {{"abs", 1, Step::kAbs},        {"sqrt", 1, Step::kSqrt},
                                               {"exp", 1, Step::kExp},        {"log", 1, Step::kLog},
                                               {"sin_deg", 1, Step::kSinDeg}, {"cos_deg", 1, Step::kCosDeg},
                                               {"larger", 2, Step::kLarger},  {"smaller", 2, Step::kSmaller}};

struct Comparison {
  const char* sign;
  Step step;
};
// Longer signs before those that begin them.
constexpr Comparison kComparisons[] = {
    {"<=", Step::kAtMost}, {">=", Step::kAtLeast}, {"<", Step::kBelow}, {">", Step::kAbove}};

struct FlightFunction {
  const char* name;
  OverFlight::Kind kind;
};
constexpr FlightFunction kFlightFunctions[] = {{"max", OverFlight::Kind::kMax},
                                               {"min", OverFlight::Kind::kMin},
                                               {"mean", OverFlight::Kind::kMean},
                                               {"rms", OverFlight::Kind::kRms},
                                               {"integral", OverFlight::Kind::kIntegral},
                                               {"first", OverFlight::Kind::kFirst},
                                               {"last", OverFlight::Kind::kLast},
                                               {"time", OverFlight::Kind::kDuration},
                                               {"at", OverFlight::Kind::kAt}};

bool IsWordStart(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsInWord(char c) { return IsWordStart(c) || IsDigit(c); }

class Parser {
 public:
  /// `parts` receives the functions over a flight; null: there are none.
  Parser(const std::string& text, const LookUp& look_up, std::vector<OverFlight>* parts)
      : text_(text), look_up_(look_up), parts_(parts) {}

  Expression Whole() {
    if (text_.size() > kLongest)
      throw ExpressionError("the expression is too long", "up to 1000 characters", kLongest);
    Expression whole = Part(false);
    if (at_ < text_.size()) Expected("an operator or the end");
    return whole;
  }

 private:
  [[noreturn]] void Fail(const std::string& message, const std::string& allowed, std::size_t at) const {
    throw ExpressionError(message, allowed, at);
  }
  [[noreturn]] void Expected(const std::string& what) const {
    Fail(at_ < text_.size() ? "'" + text_.substr(at_, 1) + "' stands where " + what + " is expected"
                            : "the expression ends where " + what + " is expected",
         what, at_);
  }

  // ---- characters ----

  void Skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool Takes(const std::string& sign) {
    if (text_.compare(at_, sign.size(), sign) != 0) return false;
    at_ += sign.size();
    Skip();
    return true;
  }
  std::string NextWord() const {
    std::size_t end = at_;
    if (end < text_.size() && IsWordStart(text_[end]))
      while (end < text_.size() && IsInWord(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  bool TakesWord(const std::string& word) { return NextWord() == word && Takes(word); }
  void Need(const std::string& sign) {
    if (!Takes(sign)) Expected("'" + sign + "'");
  }
  double Number() {
    const std::size_t begin = at_;
    std::size_t end = at_;
    const auto digits = [&] {
      while (end < text_.size() && IsDigit(text_[end])) ++end;
    };
    digits();
    if (end < text_.size() && text_[end] == '.') ++end, digits();
    if (end + 1 < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      const std::size_t sign = text_[end + 1] == '-' || text_[end + 1] == '+' ? 1 : 0;
      if (end + 1 + sign < text_.size() && IsDigit(text_[end + 1 + sign])) end += 1 + sign, digits();
    }
    const std::string number = text_.substr(begin, end - begin);
    const std::optional<double> value = ParseNumber(number);
    if (!value || *value > 1e300) Fail("'" + number + "' is not a number", "a decimal number", begin);
    at_ = end;
    Skip();
    return *value;
  }

  // ---- steps ----

  void Emit(Step kind, int taken, double number = 0.0, int position = 0) {
    steps_.push_back({kind, number, position});
    kept_ += 1 - taken;
    if (kept_ > static_cast<int>(Expression::kDepth)) TooDeep();
  }
  [[noreturn]] void TooDeep() const { Fail("the expression is nested too deeply", "fewer brackets", at_); }

  /// An expression with steps of its own.
  Expression Part(bool is_condition) {
    std::vector<ExpressionStep> outer = std::exchange(steps_, {});
    const int kept = std::exchange(kept_, 0);
    Skip();
    Operand(&Parser::Either, is_condition);
    kept_ = kept;
    return Expression(std::exchange(steps_, std::move(outer)));
  }

  // Each returns whether its value is a condition.
  using Rule = bool (Parser::*)();

  /// A rule whose value must be a condition, or must be a number.
  void Operand(Rule rule, bool is_condition) {
    const std::size_t begin = at_;
    if ((this->*rule)() == is_condition) return;
    if (is_condition)
      Fail("a number stands where a condition is needed", "a comparison, burn or coast", begin);
    Fail("a condition stands where a number is needed", "a number", begin);
  }
  /// After the first value of an operator, which is then known to be one.
  void Second(bool first_is_condition, std::size_t begin, bool needs_condition, Rule rule) {
    if (first_is_condition != needs_condition)
      needs_condition
          ? Fail("a number stands where a condition is needed", "a comparison, burn or coast", begin)
          : Fail("a condition stands where a number is needed", "a number", begin);
    Operand(rule, needs_condition);
  }

  bool Either() {
    if (++nested_ > kDeepest) TooDeep();
    const std::size_t begin = at_;
    bool is_condition = Both();
    while (TakesWord("or")) {
      Second(is_condition, begin, true, &Parser::Both);
      Emit(Step::kOr, 2);
    }
    --nested_;
    return is_condition;
  }
  bool Both() {
    const std::size_t begin = at_;
    const bool is_condition = Condition();
    while (TakesWord("and")) {
      Second(is_condition, begin, true, &Parser::Condition);
      Emit(Step::kAnd, 2);
    }
    return is_condition;
  }
  bool Condition() {
    if (TakesWord("not")) {
      if (++nested_ > kDeepest) TooDeep();
      Operand(&Parser::Condition, true);
      --nested_;
      Emit(Step::kNot, 1);
      return true;
    }
    const std::size_t begin = at_;
    const bool is_condition = Sum();
    for (const Comparison& comparison : kComparisons) {
      if (!Takes(comparison.sign)) continue;
      Second(is_condition, begin, false, &Parser::Sum);
      Emit(comparison.step, 2);
      return true;
    }
    return is_condition;
  }
  bool Sum() {
    const std::size_t begin = at_;
    const bool is_condition = Product();
    for (;;) {
      const Step step = Takes("+") ? Step::kAdd : Takes("-") ? Step::kSubtract : Step::kNumber;
      if (step == Step::kNumber) return is_condition;
      Second(is_condition, begin, false, &Parser::Product);
      Emit(step, 2);
    }
  }
  bool Product() {
    const std::size_t begin = at_;
    const bool is_condition = Signed();
    for (;;) {
      const Step step = Takes("*") ? Step::kMultiply : Takes("/") ? Step::kDivide : Step::kNumber;
      if (step == Step::kNumber) return is_condition;
      Second(is_condition, begin, false, &Parser::Signed);
      Emit(step, 2);
    }
  }
  bool Signed() {
    if (!Takes("-")) return Power();
    if (++nested_ > kDeepest) TooDeep();
    Operand(&Parser::Signed, false);
    --nested_;
    Emit(Step::kNegative, 1);
    return false;
  }
  bool Power() {
    const std::size_t begin = at_;
    const bool is_condition = Value();
    if (!Takes("^")) return is_condition;
    if (is_condition) Fail("a condition stands where a number is needed", "a number", begin);
    const std::size_t exponent = at_;
    if (at_ == text_.size() || !(text_[at_] >= '2' && text_[at_] <= '9') ||
        (at_ + 1 < text_.size() && (IsInWord(text_[at_ + 1]) || text_[at_ + 1] == '.')))
      Fail("the exponent is not a whole number from 2 to 9", "2 to 9; else exp() and log()", exponent);
    Emit(Step::kPower, 1, 0.0, text_[at_] - '0');
    ++at_;
    Skip();
    return false;
  }
  bool Value() {
    if (Takes("(")) {
      const bool is_condition = Either();
      Need(")");
      return is_condition;
    }
    if (at_ < text_.size() && (IsDigit(text_[at_]) || text_[at_] == '.')) {
      Emit(Step::kNumber, 0, Number());
      return false;
    }
    const std::size_t begin = at_;
    const std::string word = NextWord();
    if (word.empty() || word == "and" || word == "or" || word == "while") Expected("a value");
    Takes(word);
    if (Takes("(")) {
      Function(word, begin);
      return false;
    }
    return Name(word, begin);
  }

  bool Name(const std::string& name, std::size_t begin) {
    NamedValue value;
    try {
      value = look_up_(name);
    } catch (const UnknownName& unknown) {
      Fail(unknown.message, unknown.allowed, begin);
    }
    if (parts_ != nullptr && !is_in_part_)
      Fail("'" + name + "' has a value at each tick, and a metric has one value a flight",
           "a function over the flight, such as max(" + name + ")", begin);
    Emit(Step::kValue, 0, 0.0, value.position);
    return value.is_condition;
  }

  void Function(const std::string& name, std::size_t begin) {
    for (const NumberFunction& function : kNumberFunctions) {
      if (name != function.name) continue;
      for (int i = 0; i < function.arguments; ++i) {
        if (i > 0) Need(",");
        Operand(&Parser::Either, false);
      }
      Need(")");
      Emit(function.step, function.arguments);
      return;
    }
    if (parts_ != nullptr)
      for (const FlightFunction& function : kFlightFunctions)
        if (name == function.name) return Over(function, begin);
    std::vector<std::string> names;
    for (const NumberFunction& function : kNumberFunctions) names.emplace_back(function.name);
    if (parts_ != nullptr)
      for (const FlightFunction& function : kFlightFunctions) names.emplace_back(function.name);
    Fail("'" + name + "' is not a function" + DidYouMean(name, names), "one of " + JoinWords(names), begin);
  }

  void Over(const FlightFunction& function, std::size_t begin) {
    if (is_in_part_)
      Fail("'" + std::string(function.name) + "' stands inside of a function over the flight",
           "a value at each tick", begin);
    is_in_part_ = true;
    OverFlight part{function.kind, {}};
    if (function.kind == OverFlight::Kind::kDuration) {
      part.while_true = Part(true);
    } else {
      part.value = Part(false);
      if (function.kind == OverFlight::Kind::kAt) {
        Need(",");
        if (at_ == text_.size() || !IsDigit(text_[at_])) Expected("a time in seconds");
        part.at_s = Number();
      } else if (TakesWord("while")) {
        part.while_true = Part(true);
      }
    }
    is_in_part_ = false;
    Need(")");
    Emit(Step::kValue, 0, 0.0, static_cast<int>(parts_->size()));
    parts_->push_back(std::move(part));
  }

  const std::string& text_;
  const LookUp& look_up_;
  std::vector<OverFlight>* const parts_;
  std::size_t at_ = 0;
  std::vector<ExpressionStep> steps_;
  int kept_ = 0;    ///< values that the steps so far leave
  int nested_ = 0;  ///< brackets and signs around
  bool is_in_part_ = false;
};

}  // namespace

Expression ParseExpression(const std::string& text, const LookUp& look_up) {
  return Parser(text, look_up, nullptr).Whole();
}

FlightExpression ParseFlightExpression(const std::string& text, const LookUp& look_up) {
  FlightExpression expression;
  expression.whole = Parser(text, look_up, &expression.parts).Whole();
  return expression;
}

}  // namespace dispersa
