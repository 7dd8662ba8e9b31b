#include "core/results/fingerprint.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace dispersa {
namespace {

double AsStored(double value) {
  return std::isfinite(value) ? value + 0.0 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Digest Fingerprint(const CaseResult& result) {
  std::vector<double> words = {std::bit_cast<double>(result.case_index),
                               static_cast<double>(result.outcome),
                               AsStored(result.end_time_s),
                               static_cast<double>(result.end_stage),
                               std::bit_cast<double>(result.digest.high),
                               std::bit_cast<double>(result.digest.low),
                               static_cast<double>(result.reason.size())};
  const std::size_t reason_at = words.size();
  words.resize(reason_at + (result.reason.size() + sizeof(double) - 1) / sizeof(double));
  std::memcpy(words.data() + reason_at, result.reason.data(), result.reason.size());
  words.push_back(static_cast<double>(result.inputs.size()));
  for (const double value : result.inputs) words.push_back(AsStored(value));
  for (const double value : result.metrics) words.push_back(AsStored(value));
  Digester digester;
  digester.Add(words.data(), words.size());
  return digester.Finish();
}

}  // namespace dispersa
