#include "core/flight/digest.h"

#include <xxhash.h>

#include <cstdio>

namespace dispersa {

std::string Digest::Hex() const {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return text;
}

void Digester::Add(const double* values, std::size_t count) {
  values_.insert(values_.end(), values, values + count);
}

Digest Digester::Finish() const {
  const XXH128_hash_t hash = XXH3_128bits(values_.data(), values_.size() * sizeof(double));
  return {hash.high64, hash.low64};
}

}  // namespace dispersa
