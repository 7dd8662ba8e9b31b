// Goldens: today's numbers as text, against unintended change. They do not show that a number is true;
// tests/verification does.
//
// Each line of the text is an entry: a name, a space and a value. Lines in brackets begin a section, lines
// with # are comments.
#pragma once

#include "tests/test.h"

namespace dispersa {

/// Values by section and name ("case 1 metric_a"), and these in the order of the text.
struct GoldenEntries {
  std::vector<std::string> names;
  std::map<std::string, std::string> values;

  std::string Of(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? "nothing" : found->second;
  }
};

inline GoldenEntries ReadGolden(const std::string& text) {
  GoldenEntries entries;
  std::istringstream lines(text);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      section = line.substr(1, line.size() - 2) + " ";
      continue;
    }
    const std::size_t end = line.find(' ');
    const std::string name = section + line.substr(0, end);
    entries.names.push_back(name);
    entries.values[name] = end == std::string::npos ? "" : line.substr(end + 1);
  }
  return entries;
}

/// Whether `actual` equals the text of `golden`, a file that is under version control. A difference is named
/// by the file, the section and the entry. A missing golden is a failure. With DISPERSA_REWRITE_GOLDENS=1 in
/// the environment the file is written instead and the result is a failure too, so that no run with it ever
/// passes for a test.
inline testing::AssertionResult MatchesGolden(const std::string& actual,
                                              const std::filesystem::path& golden) {
  const char* rewrite = std::getenv("DISPERSA_REWRITE_GOLDENS");
  if (rewrite != nullptr && std::string(rewrite) == "1") {
    std::ofstream(golden, std::ios::binary) << actual;
    return testing::AssertionFailure()
           << "rewrote " << golden << "; look at the difference before it is committed";
  }
  std::ifstream file(golden, std::ios::binary);
  if (!file) {
    return testing::AssertionFailure() << "no golden " << golden;
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (actual == text) return testing::AssertionSuccess();

  const GoldenEntries expected = ReadGolden(text), found = ReadGolden(actual);
  std::vector<std::string> different;
  for (const std::string& name : expected.names)
    if (found.Of(name) != expected.Of(name)) different.push_back(name);
  for (const std::string& name : found.names)
    if (!expected.values.contains(name)) different.push_back(name);
  const std::string title = "golden " + golden.stem().string();
  if (different.empty())
    return testing::AssertionFailure() << title << ": equal entries, but other lines or another order";
  const std::string& first = different.front();
  return testing::AssertionFailure() << title << " " << first << ": expected " << expected.Of(first)
                                     << ", found " << found.Of(first) << "; " << different.size() - 1
                                     << " more differ";
}

}  // namespace dispersa
