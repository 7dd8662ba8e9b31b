// 128-bit fingerprint of a flight: equal digests mean equal bits.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dispersa {

struct Digest {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  bool operator==(const Digest&) const = default;
  /// 32 lower-case hexadecimal digits.
  std::string Hex() const;
};

/// Collects doubles in order (XXH3-128 over their bytes).
class Digester {
 public:
  void Add(const double* values, std::size_t count);
  Digest Finish() const;

 private:
  std::vector<double> values_;
};

}  // namespace dispersa
