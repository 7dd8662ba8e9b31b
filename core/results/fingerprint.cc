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

// Appends the length of a text and its bytes.
void Append(std::string_view bytes, std::vector<double>& words) {
  words.push_back(static_cast<double>(bytes.size()));
  const std::size_t at = words.size();
  words.resize(at + (bytes.size() + sizeof(double) - 1) / sizeof(double));
  if (!bytes.empty()) std::memcpy(words.data() + at, bytes.data(), bytes.size());
}

Digest DigestOf(const std::vector<double>& words) {
  Digester digester;
  digester.Add(words.data(), words.size());
  return digester.Finish();
}

}  // namespace

Digest Fingerprint(std::string_view bytes) {
  std::vector<double> words;
  Append(bytes, words);
  return DigestOf(words);
}

Digest Fingerprint(const CaseResult& result, bool with_inputs_digest) {
  std::vector<double> words = {std::bit_cast<double>(result.case_index),
                               static_cast<double>(result.outcome),
                               AsStored(result.end_time_s),
                               static_cast<double>(result.end_stage),
                               std::bit_cast<double>(result.digest.high),
                               std::bit_cast<double>(result.digest.low)};
  Append(result.reason, words);
  words.push_back(static_cast<double>(result.inputs.size()));
  for (const double value : result.inputs) words.push_back(AsStored(value));
  for (const double value : result.metrics) words.push_back(AsStored(value));
  if (with_inputs_digest) {
    words.push_back(std::bit_cast<double>(result.inputs_digest.high));
    words.push_back(std::bit_cast<double>(result.inputs_digest.low));
  }
  for (const SeenEvent& event : result.events) {
    Append(event.name, words);
    for (const auto value : SeenEvent::kValues) words.push_back(AsStored(event.*value));
  }
  return DigestOf(words);
}

}  // namespace dispersa
