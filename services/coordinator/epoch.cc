#include "services/coordinator/epoch.h"

#include <algorithm>
#include <chrono>
#include <fstream>

#include "core/results/output_file.h"
#include "core/results/result_error.h"
#include "services/log/log.h"

namespace dispersa {

std::uint64_t NextEpoch() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  const auto now_us = std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
  return static_cast<std::uint64_t>(std::max<std::int64_t>(now_us, 1));
}

std::uint64_t NextEpoch(const std::filesystem::path& data, bool by_itself) {
  std::uint64_t last = 0;
  std::ifstream(data / kEpochFile) >> last;
  const std::uint64_t by_time = std::max(NextEpoch(), last + 1);
  const std::uint64_t epoch = by_itself && last > 0 ? last + 1 : by_time;
  try {
    WriteFile(data / kEpochFile, std::to_string(epoch) + "\n");
  } catch (const ResultError& error) {
    LogError("the number of this start cannot be stored: {}", error.what());
    return by_time;  // the next start must not have this one's number
  }
  return epoch;
}

}  // namespace dispersa
