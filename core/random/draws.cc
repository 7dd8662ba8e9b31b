#include "core/random/draws.h"

#include <Random123/philox.h>

#include "core/math/assertion.h"
#include "core/random/normal.h"

namespace dispersa {
namespace {

std::uint32_t LowWord(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t HighWord(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

}  // namespace

std::uint64_t HashName(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char character : name) {
    hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3;
  }
  return hash;
}

double OpenUnitInterval(std::uint64_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52; }

Stream::Stream(std::uint64_t seed, std::uint64_t index, std::string_view name)
    : seed_(seed), index_(LowWord(index)), name_hash_(HashName(name)) {
  DISPERSA_ASSERT(HighWord(index) == 0, index);
}

std::uint64_t Stream::Bits() {
  if (drawn_ % 2 == 0) {
    DISPERSA_ASSERT(drawn_ < std::uint64_t{1} << 33);
    const r123::Philox4x32::ctr_type counter = {
        {LowWord(drawn_ / 2), index_, LowWord(name_hash_), HighWord(name_hash_)}};
    const r123::Philox4x32::key_type key = {{LowWord(seed_), HighWord(seed_)}};
    const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
    block_ = {words[0] | std::uint64_t{words[1]} << 32, words[2] | std::uint64_t{words[3]} << 32};
  }
  return block_[drawn_++ % 2];
}

double Stream::Uniform() { return OpenUnitInterval(Bits()); }

double Stream::Normal() { return InverseNormal(Uniform()); }

}  // namespace dispersa
