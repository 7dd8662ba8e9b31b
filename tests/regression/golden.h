// Goldens: today's numbers as text, against unintended change. They say nothing about truth; tests/verification
// does.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace dispersa {

/// Whether `actual` equals the text of `golden`, a file that is under version control. A missing golden is a
/// failure. With DISPERSA_REWRITE_GOLDENS=1 in the environment the file is written instead and the result is a
/// failure too, so that no run with it ever passes for a test.
inline testing::AssertionResult MatchesGolden(const std::string& actual, const std::filesystem::path& golden) {
  const char* rewrite = std::getenv("DISPERSA_REWRITE_GOLDENS");
  if (rewrite != nullptr && std::string(rewrite) == "1") {
    std::ofstream(golden, std::ios::binary) << actual;
    return testing::AssertionFailure() << "rewrote " << golden << "; look at the difference before it is committed";
  }
  std::ifstream file(golden, std::ios::binary);
  if (!file) {
    return testing::AssertionFailure() << "no golden " << golden;
  }
  std::istringstream expected(std::string(std::istreambuf_iterator<char>(file), {}));
  std::istringstream found(actual);
  std::string expected_line;
  std::string found_line;
  for (int line = 1;; ++line) {
    const bool expected_ends = !std::getline(expected, expected_line);
    const bool found_ends = !std::getline(found, found_line);
    if (expected_ends && found_ends) {
      return testing::AssertionSuccess();
    }
    if (expected_ends != found_ends || expected_line != found_line) {
      return testing::AssertionFailure()
             << golden.string() << ":" << line << ": expected " << (expected_ends ? "the end" : expected_line)
             << ", found " << (found_ends ? "the end" : found_line);
    }
  }
}

}  // namespace dispersa
