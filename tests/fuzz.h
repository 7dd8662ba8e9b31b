// Shared by the tests that damage their input: the number of damaged inputs, and the random source.
#pragma once

#include "tests/test.h"

namespace dispersa::fuzz {

/// How many damaged inputs a test tries: DISPERSA_FUZZ_INPUTS, which tests/run --long sets. By itself a test
/// tries few: other ones every time.
inline std::uint64_t Inputs() {
  const char* text = std::getenv("DISPERSA_FUZZ_INPUTS");
  return text == nullptr ? 10'000 : std::strtoull(text, nullptr, 10);
}

/// The seed of this process: DISPERSA_FUZZ_SEED, else another one each time.
inline std::uint64_t Seed() {
  static const std::uint64_t seed = [] {
    const char* text = std::getenv("DISPERSA_FUZZ_SEED");
    return text == nullptr ? std::uint64_t{std::random_device{}()} : std::strtoull(text, nullptr, 10);
  }();
  return seed;
}

/// A source of chance. It prints what repeats the test, because a crash would take a failure's message with
/// it.
inline std::mt19937_64 Chance() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::printf("to repeat it: DISPERSA_FUZZ_SEED=%llu DISPERSA_FUZZ_INPUTS=%llu and --gtest_filter=%s.%s\n",
              static_cast<unsigned long long>(Seed()), static_cast<unsigned long long>(Inputs()),
              test->test_suite_name(), test->name());
  std::fflush(stdout);
  return std::mt19937_64(Seed());
}

}  // namespace dispersa::fuzz
