#include "services/coordinator/epoch.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/input/input_error.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"
#include "services/coordinator/sealed_json.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

constexpr int kEpochVersion = 2;  // version 1 was the number alone

std::uint64_t ParseEpoch(const std::string& text) {
  // A version 1 has as many digits as microseconds since 1970 have.
  if (text.size() == 17 && text.find_first_not_of("0123456789") == 16 && text[16] == '\n')
    return std::stoull(text);
  const nlohmann::ordered_json epoch = Unseal(text, kEpochVersion);
  const auto member = epoch.find("epoch");
  if (member == epoch.end() || !member->is_number_unsigned()) throw std::runtime_error("has no number");
  return *member;
}

}  // namespace

std::uint64_t ReadEpoch(const std::filesystem::path& file) {
  std::string text;
  try {
    text = ReadWholeFile(file);
  } catch (const ResultError&) {
    return 0;
  }
  try {
    return ParseEpoch(text);
  } catch (const std::runtime_error& damage) {
    throw InputError(file.string() + ": is damaged: it " + damage.what(),
                     "the file of a backup; or none, which numbers this start by the clock");
  }
}

std::uint64_t NextEpoch() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  const auto now_us = std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
  return static_cast<std::uint64_t>(std::max<std::int64_t>(now_us, 1));
}

std::uint64_t NextEpoch(const std::filesystem::path& data, bool by_itself) {
  const std::uint64_t last = ReadEpoch(data / kEpochFile);
  const std::uint64_t by_time = std::max(NextEpoch(), last + 1);
  const std::uint64_t epoch = by_itself && last > 0 ? last + 1 : by_time;
  try {
    WriteFile(data / kEpochFile, Sealed({{"version", kEpochVersion}, {"epoch", epoch}}));
  } catch (const ResultError& error) {
    LogError("the number of this start cannot be stored: {}", error.what());
    return by_time;  // the next start must not have this one's number
  }
  return epoch;
}

}  // namespace dispersa
