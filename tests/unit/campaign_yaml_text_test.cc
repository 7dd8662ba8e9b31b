// Text of files before any key is read: encodings, tabs, tables and base64.
#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/parse_csv.h"
#include "core/campaign_yaml/parse_rasp.h"
#include "core/campaign_yaml/text_problems.h"
#include "core/input/input_error.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_text_test {
namespace {

std::string Texts(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) text += problem.Text() + "\n";
  return text;
}
std::string Utf8(const std::string& text) {
  std::vector<InputProblem> problems;
  const bool is_utf8 = CheckUtf8(text, "f", problems);
  EXPECT_EQ(is_utf8, problems.empty());
  return Texts(problems);
}
std::vector<std::string> Column(const InputNode& table, const char* name) {
  std::vector<std::string> cells;
  if (const InputNode* column = table.Find(name))
    for (const InputNode& cell : column->items) cells.push_back(cell.text);
  return cells;
}

// RFC 3629, chapter 4: the first and last characters of each length, and what lies beside them.
TEST(CheckUtf8, TakesEveryCharacterAndNothingBeside) {
  for (const char* character : {"\x01", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF",
                                "\xEE\x80\x80", "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(Utf8(character), "");
  const std::pair<const char*, const char*> wrong[] = {{"\x80", "80"},
                                                       {"\xC1\xBF", "C1"},
                                                       {"\xC2", "C2"},
                                                       {"\xE0\x9F\xBF", "E0"},
                                                       {"\xED\xA0\x80", "ED"},
                                                       {"\xED\xBF\xBF", "ED"},
                                                       {"\xE1\x80", "E1"},
                                                       {"\xF0\x8F\xBF\xBF", "F0"},
                                                       {"\xF4\x90\x80\x80", "F4"},
                                                       {"\xF5\x80\x80\x80", "F5"}};
  for (const auto& [bytes, first] : wrong)
    EXPECT_EQ(Utf8(bytes),
              std::string("f:1:1: the byte 0x") + first +
                  " is no UTF-8: the file is in another encoding, such as Latin-1, allowed: text in "
                  "UTF-8\n");
}

TEST(CheckUtf8, CountsCharactersOfALine) {
  EXPECT_EQ(
      Utf8("\xC3\xA9\n\xC3\xA9\xE2\x82\xAC\xFF"),
      "f:2:3: the byte 0xFF is no UTF-8: the file is in another encoding, such as Latin-1, allowed: text in "
      "UTF-8\n");
}

TEST(CheckIndentation, RefusesTabsBeforeWhatIsRead) {
  const auto check = [](const std::string& text) {
    std::vector<InputProblem> problems;
    const bool is_sound = CheckIndentation(text, "f", 9, problems);
    EXPECT_EQ(is_sound, problems.empty());
    return Texts(problems);
  };
  EXPECT_EQ(check("a:\n  \tb: 1\n"), "f:2:3: a tab indents the line, allowed: spaces\n");
  EXPECT_EQ(check("a:\n\t# of nothing\n \t\n\t\r\n  b:\t1\n"), "");
}

TEST(ParseCsv, TakesBlanksAndTabsFromCells) {
  std::vector<InputProblem> problems;
  const InputNode table = ParseCsv(" a ,\tb\n 1\t,\t 2 \n", "f", problems);
  EXPECT_EQ(Texts(problems), "");
  EXPECT_EQ(Column(table, "a"), std::vector<std::string>{"1"});
  EXPECT_EQ(Column(table, "b"), std::vector<std::string>{"2"});
}

// As spreadsheets write it. A mark anywhere else is a part of a cell.
TEST(ParseCsv, SkipsAByteOrderMark) {
  std::vector<InputProblem> problems;
  const InputNode table = ParseCsv(
      "\xEF\xBB\xBF"
      "a,b\n1,2\n",
      "f", problems);
  EXPECT_EQ(Texts(problems), "");
  EXPECT_EQ(Column(table, "a"), std::vector<std::string>{"1"});
  EXPECT_EQ(Column(table, "b"), std::vector<std::string>{"2"});
  const InputNode other = ParseCsv(
      "a,\xEF\xBB\xBF"
      "b\n1,2\n",
      "f", problems);
  EXPECT_EQ(Texts(problems), "");
  EXPECT_EQ(other.Find("b"), nullptr);
  EXPECT_EQ(Column(other,
                   "\xEF\xBB\xBF"
                   "b"),
            std::vector<std::string>{"2"});
}

struct CsvForm {
  const char* name;
  const char* text;
  std::vector<std::string> a, b;
  const char* said = "";
};
void PrintTo(const CsvForm& form, std::ostream* out) { *out << form.name; }
class CsvForms : public testing::TestWithParam<CsvForm> {};
TEST_P(CsvForms, AreReadOrRefusedInFull) {
  std::vector<InputProblem> problems;
  const InputNode table = ParseCsv(GetParam().text, "f", problems);
  EXPECT_EQ(Texts(problems), GetParam().said);
  EXPECT_EQ(Column(table, "a"), GetParam().a);
  EXPECT_EQ(Column(table, "b"), GetParam().b);
}
INSTANTIATE_TEST_SUITE_P(
    Each, CsvForms,
    testing::Values(
        CsvForm{"Quotes", "\"a\", \"b\" \n\"1\" ,\" 2\"\n", {"1"}, {" 2"}},
        CsvForm{"SeparatorInQuotes", "a,b\n\"x, y\",\"x \"\"z\"\"\"\n", {"x, y"}, {"x \"z\""}},
        CsvForm{"SemicolonInAQuotedHeader", "a,b,\"c;d\"\n1,2,3\n", {"1"}, {"2"}},
        CsvForm{"EmptyCells", "a,b\n,\"\"\n", {""}, {""}},
        CsvForm{"Semicolons", "a;b\n1.5;2\n", {"1.5"}, {"2"}},
        CsvForm{"DecimalCommas", "a;b\n-0,5;\"1,25e3\"\n7;x, y\n", {"-0.5", "7"}, {"1.25e3", "x, y"}},
        CsvForm{"BothDecimalMarks",
                "a;b\n1;2.5\n1,5;2\n",
                {},
                {},
                "f:3:1: '1,5' has a decimal comma, and other numbers a decimal point, allowed: one decimal "
                "mark in a table\n"},
        CsvForm{"DecimalCommasBetweenCommas",
                "a,b\n0,5,2\n",
                {},
                {},
                "f:2:1: the row has 3 cells, allowed: 2, as the header. Decimal commas need ';' between "
                "cells\n"},
        CsvForm{"ThousandsBetweenCommas", "a,b\n\"1,234\",2\n", {"1,234"}, {"2"}},
        CsvForm{"TooFew", "a,b\n1\n", {}, {}, "f:2:1: the row has 1 cells, allowed: 2, as the header\n"},
        CsvForm{"OpenQuotes",
                "a,b\n1,\"2\n",
                {},
                {},
                "f:2:3: the quotes of this cell do not end with it, allowed: \"text\", with a quote inside "
                "written twice\n"},
        CsvForm{"TextBesideQuotes",
                "a,b\n\"1\"2,3\n",
                {},
                {},
                "f:2:1: the quotes of this cell do not end with it, allowed: \"text\", with a quote inside "
                "written twice\n"}),
    [](const auto& form) { return std::string(form.param.name); });

TEST(ParseRasp, ACommentMayEndALine) {
  std::vector<InputProblem> problems;
  const InputNode curve =
      ParseRasp("M 1200 9000 P 1500 1600 X ; made up\n0.1 100;ignition\n2 0 ; end\n", "f", problems);
  EXPECT_EQ(Texts(problems), "");
  EXPECT_EQ(Column(curve, "thrust_n"), (std::vector<std::string>{"0", "100", "0"}));
}

TEST(ParseRasp, SkipsAByteOrderMark) {
  std::vector<InputProblem> problems;
  ParseRasp("\xEF\xBB\xBFM 1200 9000 P 1500 1600 X\n0.1 100\n2 0\n", "f", problems);
  EXPECT_EQ(Texts(problems), "");
}

// A point without thrust at the beginning is ignition; the next one ends the curve.
TEST(ParseRasp, ACurveMayBeginWithNoThrust) {
  std::vector<InputProblem> problems;
  const InputNode curve = ParseRasp("M 1200 9000 P 1500 1600 X\n0 0\n1 100\n2 0\n", "f", problems);
  EXPECT_EQ(Texts(problems), "");
  EXPECT_EQ(Column(curve, "time_s"), (std::vector<std::string>{"0", "1", "2"}));
  EXPECT_EQ(Column(curve, "thrust_n"), (std::vector<std::string>{"0", "100", "0"}));
}

TEST(Base64, OfABytesTextIsOneTextAlone) {
  for (const std::string bytes : {"", "A", "AB", "ABC", "ABCD"}) EXPECT_EQ(FromBase64(Base64(bytes)), bytes);
  EXPECT_EQ(Base64("A"), "QQ==");
  // The same byte with bits that nobody needs, with white space, without its end.
  for (const char* other : {"QR==", "QQ==\n", " QQ==", "QQ=", "Q", "QQ=A"})
    EXPECT_EQ(FromBase64(other), std::nullopt) << other;
}

}  // namespace
}  // namespace dispersa::campaign_yaml_text_test
