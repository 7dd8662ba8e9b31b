// Random numbers of the cases, from a counter-based generator.
//
// A draw is a pure function of (seed, case index, input name, draw number). It needs no earlier draw, no
// other input and no other case. So neither the order of the cases nor the set of inputs can change it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace dispersa {

/// 64-bit FNV-1a hash of a name: stable over compilers, machines and versions.
std::uint64_t HashName(std::string_view name);

/// The draws of one parameter in one case, from Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel
/// random numbers: as easy as 1, 2, 3", SC11).
///
/// Key: the seed, low word first. Counter words: 0 the draw number / 2, 1 the index, 2 and 3 the name's
/// hash, low word first. The four words that come out make two 64-bit draws, low word first.
class Stream {
 public:
  /// `index`, the case's, is below 2^32. A stream holds 2^33 draws.
  Stream(std::uint64_t seed, std::uint64_t index, std::string_view name);

  /// 64 uniform bits.
  std::uint64_t Bits();
  /// Uniform in the open interval (0, 1): the centres of 2^52 equal cells. So u and 1 - u are both exact and
  /// equally likely, and the ends cannot occur. Takes one draw.
  double Uniform();
  /// Standard normal: the inverse distribution function of Uniform(). One draw, within ±8.3.
  double Normal();

 private:
  std::uint64_t seed_;
  std::uint32_t index_;
  std::uint64_t name_hash_;
  std::uint64_t drawn_ = 0;
  std::array<std::uint64_t, 2> block_{};
};

/// The centre of the cell of (0, 1), out of 2^52, that the upper 52 bits select.
double OpenUnitInterval(std::uint64_t bits);

}  // namespace dispersa
