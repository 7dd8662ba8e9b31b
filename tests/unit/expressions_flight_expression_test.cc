// Expressions of campaign files: values against closed forms, the rules about undefined values, and the full
// text of every error.
#include "core/expressions/flight_expression.h"

#include "core/expressions/part_sums.h"
#include "tests/test.h"

namespace dispersa::expressions_flight_expression_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Columns: time_s, x, y, and the condition `on`.
NamedValue Find(const std::string& name) {
  if (name == "time_s") return {0, false};
  if (name == "x") return {1, false};
  if (name == "y") return {2, false};
  if (name == "on") return {3, true};
  throw UnknownName{"'" + name + "' is not a column", "time_s, x, y or on"};
}

using Rows = std::vector<std::vector<double>>;

// Four ticks of 0.5 s: x = 1, -3, 2, 4 and y = 2, 0, undefined, 1; on at the second and the third.
const Rows kRows = {{0.0, 1.0, 2.0, 0.0}, {0.5, -3.0, 0.0, 1.0}, {1.0, 2.0, kNaN, 1.0}, {1.5, 4.0, 1.0, 0.0}};

double Value(const std::string& text, const Rows& rows = kRows) {
  const FlightExpression expression = ParseFlightExpression(text, Find);
  std::vector<PartSum> sums;
  for (const OverFlight& part : expression.parts) {
    lanes::PartSumOf<double> sum{0.0, 0.0};
    for (const std::vector<double>& row : rows)
      lanes::AddTick<double>(SummedPart(part), true, row[0], 0.5, row.data(), sum);
    sums.push_back({sum.value, sum.count});
  }
  return ValueOf(expression, sums.data());
}

// What is wrong, and what is allowed.
std::string ProblemOf(const std::function<void()>& parse) {
  try {
    parse();
  } catch (const ExpressionError& error) {
    return std::string(error.what()) + " | " + error.allowed;
  }
  return "none";
}

std::string Repeated(const std::string& text, int times) {
  std::string all;
  while (times-- > 0) all += text;
  return all;
}

double Scalar(const std::string& text) {
  const double values[] = {0.25, 3.0, -2.0, 1.0};
  return ParseExpression(text, Find).Evaluate(values);
}

TEST(Expressions, OperatorsBindAsInArithmetic) {
  EXPECT_EQ(Scalar("1 + 2 * 3"), 7.0);
  EXPECT_EQ(Scalar("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(Scalar("8 / 4 / 2"), 1.0);
  EXPECT_EQ(Scalar("10 - 3 - 2"), 5.0);
  EXPECT_EQ(Scalar("-x^2"), -9.0);
  EXPECT_EQ(Scalar("2 * y^3"), -16.0);
  EXPECT_EQ(Scalar("--x"), 3.0);
  EXPECT_EQ(Scalar("1.5e1-.5"), 14.5);
  EXPECT_EQ(Scalar("abs(y) + sqrt(x + 1)"), 4.0);
  EXPECT_EQ(Scalar("larger(x, y) - smaller(x, y)"), 5.0);
  EXPECT_NEAR(Scalar("exp(log(x))"), 3.0, 1e-15);
  EXPECT_NEAR(Scalar("sin_deg(30) + cos_deg(60)"), 1.0, 1e-15);
}

TEST(Expressions, UndefinedIsNotLostInLargerAndSmaller) {
  const double values[] = {0.0, kNaN, 1.0, 0.0};
  for (const char* text : {"larger(x, y)", "larger(y, x)", "smaller(x, y)", "smaller(y, x)"})
    EXPECT_TRUE(std::isnan(ParseExpression(text, Find).Evaluate(values))) << text;
}

TEST(Expressions, OverTheTicksOfAFlight) {
  EXPECT_EQ(Value("max(x)"), 4.0);
  EXPECT_EQ(Value("min(x)"), -3.0);
  EXPECT_EQ(Value("max(abs(x) while on)"), 3.0);
  EXPECT_EQ(Value("mean(x)"), 1.0);
  EXPECT_EQ(Value("rms(x)"), std::sqrt((1.0 + 9.0 + 4.0 + 16.0) / 4.0));
  EXPECT_EQ(Value("integral(x)"), 2.0);
  EXPECT_EQ(Value("first(x while on)"), -3.0);
  EXPECT_EQ(Value("last(x while on)"), 2.0);
  EXPECT_EQ(Value("last(x)"), 4.0);
  EXPECT_EQ(Value("time(x > 1)"), 1.0);
  EXPECT_EQ(Value("time(x >= 1)"), 1.5);
  EXPECT_EQ(Value("time(x < 2)"), 1.0);
  EXPECT_EQ(Value("time(x <= 2 and not on)"), 0.5);
  EXPECT_EQ(Value("time(on or x > 3)"), 1.5);
  EXPECT_EQ(Value("first(time_s while x > 1)"), 1.0);
  EXPECT_EQ(Value("max(x) - at(x, 0.5) * 2 + 1"), 11.0);
}

TEST(Expressions, AtIsTheNearestTick) {
  EXPECT_EQ(Value("at(x, 0)"), 1.0);
  EXPECT_EQ(Value("at(x, 0.74)"), -3.0);
  EXPECT_EQ(Value("at(x, 0.75)"), 2.0) << "the later of two";
  EXPECT_EQ(Value("at(x, 1.5)"), 4.0);
  EXPECT_EQ(Value("at(x, 1.7)"), 4.0);
  EXPECT_TRUE(std::isnan(Value("at(x, 1.8)"))) << "the flight has ended";
  EXPECT_TRUE(std::isnan(Value("at(y, 1)"))) << "undefined there";
}

TEST(Expressions, UndefinedTicksDoNotCount) {
  EXPECT_EQ(Value("mean(y)"), 1.0);
  EXPECT_EQ(Value("integral(y)"), 1.5);
  EXPECT_EQ(Value("last(y while on)"), 0.0);
  EXPECT_EQ(Value("max(1 / y)"), 1.0) << "a division by 0";
  EXPECT_EQ(Value("time(y < 5)"), 1.5) << "a comparison with an undefined value does not hold";
  EXPECT_EQ(Value("time(not y < 5)"), 0.5);
  EXPECT_TRUE(std::isnan(Value("max(x while x > 9)")));
  EXPECT_TRUE(std::isnan(Value("mean(x while x > 9) + max(x)")));
  EXPECT_EQ(Value("time(x > 9)"), 0.0);
  EXPECT_TRUE(std::isnan(Value("max(x)", {}))) << "no tick at all";
}

TEST(Expressions, EveryErrorSaysWhereAndWhatIsAllowed) {
  const std::string functions =
      "one of abs, sqrt, exp, log, sin_deg, cos_deg, larger, smaller, max, min, mean, rms, integral, first, "
      "last, time, at";
  const std::vector<std::pair<std::string, std::string>> problems = {
      {"max(z)", "at character 5: 'z' is not a column | time_s, x, y or on"},
      {"x + 1",
       "at character 1: 'x' has a value at each tick, and a metric has one value a flight | a function over "
       "the flight, such as max(x)"},
      {"maxx(x)", "at character 1: 'maxx' is not a function (did you mean 'max'?) | " + functions},
      {"max(min(x))",
       "at character 5: 'min' stands inside of a function over the flight | a value at each tick"},
      {"max(x", "at character 6: the expression ends where ')' is expected | ')'"},
      {"max(x))",
       "at character 7: ')' stands where an operator or the end is expected | an operator or the end"},
      {"", "at character 1: the expression ends where a value is expected | a value"},
      {"max()", "at character 5: ')' stands where a value is expected | a value"},
      {"max(x while x)",
       "at character 13: a number stands where a condition is needed | a comparison, burn or coast"},
      {"max(x > 1)", "at character 5: a condition stands where a number is needed | a number"},
      {"time(on + 1 > 2)", "at character 6: a condition stands where a number is needed | a number"},
      {"time(x and on)",
       "at character 6: a number stands where a condition is needed | a comparison, burn or coast"},
      {"time(1 < x < 3)", "at character 12: '<' stands where ')' is expected | ')'"},
      {"at(x, y)", "at character 7: 'y' stands where a time in seconds is expected | a time in seconds"},
      {"max(x^y)",
       "at character 7: the exponent is not a whole number from 2 to 9 | 2 to 9; else exp() and log()"},
      {"max(x^10)",
       "at character 7: the exponent is not a whole number from 2 to 9 | 2 to 9; else exp() and log()"},
      {"max(x)^22",
       "at character 8: the exponent is not a whole number from 2 to 9 | 2 to 9; else exp() and log()"},
      {"max(larger(x))", "at character 13: ')' stands where ',' is expected | ','"},
      {"max(x) & 1",
       "at character 8: '&' stands where an operator or the end is expected | an operator or the end"},
      {"max(x) + while", "at character 10: 'w' stands where a value is expected | a value"},
      {std::string(1001, ' '), "at character 1001: the expression is too long | up to 1000 characters"},
      {"max(" + std::string(40, '(') + "x" + std::string(40, ')') + ")",
       "at character 34: the expression is nested too deeply | fewer brackets"},
      {Repeated("1 - -2 * (", 20) + "3" + Repeated(")", 20),
       "at character 163: the expression is nested too deeply | fewer brackets"}};
  for (const auto& [text, expected] : problems)
    EXPECT_EQ(ProblemOf([&] { ParseFlightExpression(text, Find); }), expected) << text;
}

TEST(Expressions, AFormulaOfNumbersHasNoFunctionsOverAFlight) {
  EXPECT_EQ(ProblemOf([] { ParseExpression("max(x)", Find); }),
            "at character 1: 'max' is not a function | one of abs, sqrt, exp, log, sin_deg, cos_deg, larger, "
            "smaller");
}

}  // namespace dispersa::expressions_flight_expression_test
