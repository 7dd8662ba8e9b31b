#include "services/program/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/input/read_value.h"
#include "services/program/completion_words.h"

namespace dispersa {
namespace {

constexpr char kWholeNumber[] = "whole number";  // the validator's name

bool AllDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// False if `digits` are too many for the type.
template <typename Number>
bool Parse(std::string_view digits, Number* number) {
  return std::from_chars(digits.data(), digits.data() + digits.size(), *number).ec == std::errc();
}

/// Makes `text` a number that CLI11 reads as decimal. Returns the problem with it, or "".
std::string MakeWholeNumber(std::string& text, std::int64_t least, std::uint64_t most) {
  const bool negative = text.starts_with('-');
  const std::string problem = "'" + text + "' is ";
  const std::string allowed =
      ", allowed: a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  if (!AllDigits(std::string_view(text).substr(negative ? 1 : 0)))
    return problem + "not a whole number" + allowed;
  std::int64_t below = 0;
  std::uint64_t above = 0;
  const bool inside =
      negative ? Parse(text, &below) && below >= least
               : Parse(text, &above) && above <= most && (least < 0 || above >= std::uint64_t(least));
  if (!inside) return problem + "out of range" + allowed;
  text = negative ? std::to_string(below) : std::to_string(above);
  return "";
}

/// Not so is nan, which is in every range for CLI11.
bool IsFinite(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped == end && std::isfinite(number);
}

bool HasValidator(CLI::Option& option, const std::string& name) {
  try {
    return option.get_validator(name) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

std::string WantedOf(const std::string& type) {
  if (type.starts_with(kFileType) || type.starts_with(kYamlType)) return "a file";
  if (type.starts_with(kFolderType)) return "a folder";
  return type.starts_with(kMetricType) ? "a metric" : "a text";
}

/// Before the checks that the option has: transform() puts it there.
void CheckFirst(CLI::Option& option, std::function<std::string(std::string&)> problem) {
  option.transform(CLI::Validator(std::move(problem), ""));
}

void CheckValue(CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::vector<std::string> words = ListedValues(option);
  // CLI11 does not say how wide a number is; what has a sign is an int.
  if (type.starts_with("UINT") || type.starts_with("INT")) {
    if (HasValidator(option, kWholeNumber)) return;
    option.transform(type.starts_with("UINT")
                         ? WholeNumber(0, std::numeric_limits<std::uint64_t>::max())
                         : WholeNumber(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
  } else if (!words.empty()) {
    CheckFirst(option, [words](const std::string& text) {
      if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
      return "there is no '" + text + "'" + DidYouMean(text, words) + ", allowed: one of " + JoinWords(words);
    });
  } else if (type.starts_with("FLOAT")) {
    CheckFirst(option, [](const std::string& text) {
      return IsFinite(text) ? "" : "'" + text + "' is not a number, allowed: a number";
    });
  } else {
    CheckFirst(option, [type](const std::string& text) {
      return text.empty() ? "is empty, allowed: " + WantedOf(type) : "";
    });
  }
}

}  // namespace

CLI::Validator WholeNumber(std::int64_t least, std::uint64_t most) {
  // Limits that no user reaches would only lengthen help texts.
  const std::string range = most < kMostCases ? std::to_string(least) + " to " + std::to_string(most) : "";
  return CLI::Validator([least, most](std::string& text) { return MakeWholeNumber(text, least, most); },
                        range, kWholeNumber);
}

std::vector<std::string> ListedValues(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::vector<std::string> values;
  const std::size_t from = type.find('{'), to = type.find('}', from);
  if (from == std::string::npos || to == std::string::npos) return values;
  std::istringstream list(type.substr(from + 1, to - from - 1));
  for (std::string value; std::getline(list, value, ',');)
    values.push_back(value.substr(0, value.find("->")));
  return values;
}

void CheckValues(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_max() > 0) CheckValue(*option);
  for (CLI::App* command : app.get_subcommands(nullptr)) CheckValues(*command);
}

}  // namespace dispersa
