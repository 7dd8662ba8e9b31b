#include "core/campaign_yaml/parse_rasp.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/campaign_yaml/text_problems.h"
#include "core/input/number_text.h"

namespace dispersa {
namespace {

struct Word {
  std::string text;
  int column = 1;  // of its first character
};

std::vector<Word> Words(std::string_view line) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  std::vector<Word> words;
  for (std::size_t at = 0; at < line.size();) {
    if (is_blank(line[at])) {
      ++at;
      continue;
    }
    const std::size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    words.push_back({std::string(line.substr(begin, at - begin)), static_cast<int>(begin) + 1});
  }
  return words;
}

class RaspReader {
 public:
  RaspReader(const std::string& file, std::vector<InputProblem>& problems) : problems_(problems) {
    place_.file = std::make_shared<const std::string>(file);
    times_ = ListAt(place_);
    thrusts_ = ListAt(place_);
  }

  void Take(std::string_view line, int number) {
    place_.line = number;
    place_.column = 1;
    const std::vector<Word> words = Words(line.substr(0, line.find(';')));
    if (words.empty()) return;
    if (ended_ && words.size() == kHeaderWords) {
      Report(words[0], "a second motor, '" + words[0].text + "', follows the first", "one motor in a file");
    } else if (ended_) {
      Report(words[0], "the line comes after the thrust of 0 that ends the motor's curve",
             "one motor in a file, and nothing but comments after it");
    } else if (!has_header_) {
      has_header_ = true;
      TakeHeader(words);
    } else {
      TakePoint(words);
    }
  }

  InputNode Finish(int lines) {
    place_.line = lines < 1 ? 1 : lines;
    place_.column = 1;
    if (!has_header_)
      Report({}, "the file holds no motor", kHeader);
    else if (!ended_ && !failed_)
      Report({}, "the curve does not end", "a last line with a thrust of 0");
    else if (ended_)
      AddIgnition();
    if (failed_) return {};
    place_.line = 1;
    InputNode table = MapAt(place_);
    table.is_table = true;
    SetMember(table, "time_s", std::move(times_));
    SetMember(table, "thrust_n", std::move(thrusts_));
    SetMember(table, "published_propellant_mass_kg", std::move(propellant_kg_));
    SetMember(table, "published_motor_mass_kg", std::move(whole_kg_));
    return table;
  }

 private:
  static constexpr std::size_t kHeaderWords = 7;
  static constexpr double kLatestPart = 0.1;  // of the first point in the whole curve
  static constexpr const char* kHeader =
      "name, diameter in mm, length in mm, delays, propellant in kg, mass in kg, maker, apart by blanks";

  void Report(const Word& at, const std::string& message, const std::string& allowed) {
    failed_ = true;
    problems_.push_back({*place_.file, place_.line, at.column, "", message, allowed});
  }

  // A finite number above 0, or 0 itself.
  std::optional<double> Number(const Word& word, const std::string& what, bool may_be_zero) {
    const std::optional<double> number = ParseNumber(word.text);
    if (number && std::isfinite(*number) && (*number > 0.0 || (may_be_zero && *number == 0.0))) return number;
    Report(word, what + " is '" + word.text + "'", may_be_zero ? "a number not below 0" : "a number above 0");
    return {};
  }

  void TakeHeader(const std::vector<Word>& words) {
    if (words.size() != kHeaderWords)
      return Report(words[0], "the header has " + std::to_string(words.size()) + " fields in place of 7",
                    kHeader);
    Number(words[1], "the diameter", false);
    Number(words[2], "the length", false);
    const std::optional<double> propellant = Number(words[4], "the propellant's mass", false);
    const std::optional<double> whole = Number(words[5], "the motor's mass", false);
    if (propellant && whole && *propellant > *whole)
      Report(words[4],
             "the propellant of " + words[4].text + " kg is more than the motor's " + words[5].text + " kg",
             "a part of the motor's mass");
    propellant_kg_ = At(words[4]);
    whole_kg_ = At(words[5]);
  }

  void TakePoint(const std::vector<Word>& words) {
    if (words.size() != 2)
      return Report(words[0], "the line has " + std::to_string(words.size()) + " fields in place of 2",
                    "a time in s and a thrust in N");
    const std::optional<double> time_s = Number(words[0], "the time", times_.items.empty());
    const std::optional<double> thrust_n = Number(words[1], "the thrust", true);
    if (!time_s || !thrust_n) return;
    if (!times_.items.empty() && !(*time_s > last_s_))
      return Report(words[0], "the time " + words[0].text + " is not later than that before it",
                    "times that increase");
    ended_ = *thrust_n == 0.0 && *time_s > 0.0;
    last_s_ = *time_s;
    Add(words[0], words[1]);
  }

  // The format leaves out the point at 0 s. A clock that did not start at ignition is not meant by that.
  void AddIgnition() {
    const InputNode& first = times_.items.front();
    const double first_s = *ParseNumber(first.text);
    if (first_s > kLatestPart * last_s_) {
      place_.line = first.line;
      return Report({"", first.column},
                    "the first time, " + first.text + " s, is more than a tenth of the curve's " +
                        FormatRounded(last_s_) + " s after ignition",
                    "times since ignition; from 0 s to the first one the thrust rises from 0");
    }
    if (first_s == 0.0) return;
    times_.items.insert(times_.items.begin(), ScalarAt(times_.items.front(), "0"));
    thrusts_.items.insert(thrusts_.items.begin(), ScalarAt(thrusts_.items.front(), "0"));
  }

  InputNode At(const Word& word) {
    place_.column = word.column;
    return ScalarAt(place_, word.text);
  }
  void Add(const Word& time, const Word& thrust) {
    times_.items.push_back(At(time));
    thrusts_.items.push_back(At(thrust));
  }

  std::vector<InputProblem>& problems_;
  InputNode place_, times_, thrusts_, propellant_kg_, whole_kg_;
  double last_s_ = 0.0;
  bool has_header_ = false, ended_ = false, failed_ = false;
};

}  // namespace

InputNode ParseRasp(const std::string& text, const std::string& file, std::vector<InputProblem>& problems) {
  if (!CheckUtf8(text, file, problems)) return {};
  RaspReader reader(file, problems);
  int line_number = 0;
  for (const std::string_view line : LinesOf(WithoutByteOrderMark(text))) reader.Take(line, ++line_number);
  return reader.Finish(line_number);
}

}  // namespace dispersa
