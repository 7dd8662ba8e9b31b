// The value type of a flight's models: one double, or a pack of W doubles whose lanes are W flights.
//
// A model is written once over a type T. `double` is one lane, Pack<4> and Pack<8> are as many flights side
// by side. Every operation here is exact or correctly rounded for each lane (IEEE 754), or is one of SLEEF's
// `finz` functions, which return the same bits in any width. So the bits of a lane depend neither on W nor on
// the instruction set, as long as models keep one rule: a branch that depends on any lane must not change the
// others. Use Select. Or guard code that only saves time (`if (Any(mask))`) such that skipping it changes no
// lane.
//
// Code that is compiled once for each instruction set lives in an inline namespace of its own, so that the
// linker never mixes instruction sets. Such sources use no inline function from elsewhere that the compiler
// could emit as a function (tests/static/lane_symbols.py checks this).
#pragma once

#include <immintrin.h>
#include <sleef.h>

#include <cstdint>
#include <utility>

#include "core/math/functions.h"

#if defined(__AVX512F__)
#define DISPERSA_ISA v4
#else
#define DISPERSA_ISA v3
#endif
#define DISPERSA_INLINE inline __attribute__((always_inline))
#define DISPERSA_OUT_OF_LINE __attribute__((noinline))

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

// ---- one lane ------------------------------------------------------------------------------------------

DISPERSA_INLINE double Select(bool mask, double yes, double no) { return mask ? yes : no; }
DISPERSA_INLINE bool SelectMask(bool mask, bool yes, bool no) { return mask ? yes : no; }
DISPERSA_INLINE bool Any(bool mask) { return mask; }
DISPERSA_INLINE bool All(bool mask) { return mask; }
DISPERSA_INLINE double Sqrt(double a) { return __builtin_sqrt(a); }
DISPERSA_INLINE double Abs(double a) { return __builtin_fabs(a); }
/// The smaller value; b if either is NaN.
DISPERSA_INLINE double Min(double a, double b) { return a < b ? a : b; }
/// The larger value; b if either is NaN.
DISPERSA_INLINE double Max(double a, double b) { return a > b ? a : b; }
DISPERSA_INLINE double Cos(double x_rad) { return ::dispersa::Cos(x_rad); }
DISPERSA_INLINE double Sin(double x_rad) { return ::dispersa::Sin(x_rad); }
DISPERSA_INLINE double Atan2(double y, double x) { return ::dispersa::Atan2(y, x); }
DISPERSA_INLINE double Exp(double x) { return ::dispersa::Exp(x); }
DISPERSA_INLINE double Log(double x) { return ::dispersa::Log(x); }

/// The bits of a double as they are.
DISPERSA_INLINE double OfBits(std::uint64_t bits) { return __builtin_bit_cast(double, bits); }
DISPERSA_INLINE std::uint64_t ToBits(double a) { return __builtin_bit_cast(std::uint64_t, a); }
DISPERSA_INLINE double OrBits(double a, double b) { return OfBits(ToBits(a) | ToBits(b)); }
DISPERSA_INLINE double AndBits(double a, double b) { return OfBits(ToBits(a) & ToBits(b)); }

template <int W>
struct Pack;
template <int W>
struct Mask;

// ---- four lanes: one register of AVX2 ------------------------------------------------------------------

template <>
struct Mask<4> {
  __m256d v;

  friend DISPERSA_INLINE Mask operator&(Mask a, Mask b) { return {_mm256_and_pd(a.v, b.v)}; }
  friend DISPERSA_INLINE Mask operator|(Mask a, Mask b) { return {_mm256_or_pd(a.v, b.v)}; }
  friend DISPERSA_INLINE Mask operator!(Mask a) {
    return {_mm256_xor_pd(a.v, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))};
  }
};

template <>
struct Pack<4> {
  __m256d v;

  Pack() = default;
  DISPERSA_INLINE Pack(__m256d value) : v(value) {}
  DISPERSA_INLINE Pack(double value) : v(_mm256_set1_pd(value)) {}

  friend DISPERSA_INLINE Pack operator+(Pack a, Pack b) { return _mm256_add_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator-(Pack a, Pack b) { return _mm256_sub_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator*(Pack a, Pack b) { return _mm256_mul_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator/(Pack a, Pack b) { return _mm256_div_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator-(Pack a) { return -a.v; }
  friend DISPERSA_INLINE Mask<4> operator<(Pack a, Pack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)}; }
  friend DISPERSA_INLINE Mask<4> operator>(Pack a, Pack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)}; }
  friend DISPERSA_INLINE Mask<4> operator<=(Pack a, Pack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)}; }
  friend DISPERSA_INLINE Mask<4> operator>=(Pack a, Pack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_GE_OQ)}; }
};

/// One instruction: GCC 12 takes the intrinsic apart and compares the mask with zero first.
DISPERSA_INLINE __m256d BlendRegisters(__m256d mask, __m256d yes, __m256d no) {
  __m256d blended;
  __asm__("vblendvpd %3, %2, %1, %0" : "=x"(blended) : "x"(no), "xm"(yes), "x"(mask));
  return blended;
}
DISPERSA_INLINE Pack<4> Select(Mask<4> m, Pack<4> yes, Pack<4> no) {
  return BlendRegisters(m.v, yes.v, no.v);
}
DISPERSA_INLINE Mask<4> SelectMask(Mask<4> m, Mask<4> yes, Mask<4> no) {
  return {BlendRegisters(m.v, yes.v, no.v)};
}
DISPERSA_INLINE bool Any(Mask<4> m) { return _mm256_movemask_pd(m.v) != 0; }
DISPERSA_INLINE bool All(Mask<4> m) { return _mm256_movemask_pd(m.v) == 0xf; }
DISPERSA_INLINE Pack<4> Sqrt(Pack<4> a) { return _mm256_sqrt_pd(a.v); }
DISPERSA_INLINE Pack<4> Abs(Pack<4> a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v); }
DISPERSA_INLINE Pack<4> Min(Pack<4> a, Pack<4> b) { return _mm256_min_pd(a.v, b.v); }
DISPERSA_INLINE Pack<4> Max(Pack<4> a, Pack<4> b) { return _mm256_max_pd(a.v, b.v); }
DISPERSA_INLINE Pack<4> OrBits(Pack<4> a, Pack<4> b) { return _mm256_or_pd(a.v, b.v); }
DISPERSA_INLINE Pack<4> AndBits(Pack<4> a, Pack<4> b) { return _mm256_and_pd(a.v, b.v); }
DISPERSA_INLINE Pack<4> Cos(Pack<4> x) { return Sleef_finz_cosd4_u10avx2(x.v); }
DISPERSA_INLINE Pack<4> Sin(Pack<4> x) { return Sleef_finz_sind4_u10avx2(x.v); }
DISPERSA_INLINE Pack<4> Atan2(Pack<4> y, Pack<4> x) { return Sleef_finz_atan2d4_u10avx2(y.v, x.v); }
DISPERSA_INLINE Pack<4> Exp(Pack<4> x) { return Sleef_finz_expd4_u10avx2(x.v); }
DISPERSA_INLINE Pack<4> Log(Pack<4> x) { return Sleef_finz_logd4_u10avx2(x.v); }

// ---- eight lanes: one register of AVX-512, or two of AVX2 ----------------------------------------------

#if defined(__AVX512F__)

template <>
struct Mask<8> {
  __mmask8 v;

  friend DISPERSA_INLINE Mask operator&(Mask a, Mask b) { return {static_cast<__mmask8>(a.v & b.v)}; }
  friend DISPERSA_INLINE Mask operator|(Mask a, Mask b) { return {static_cast<__mmask8>(a.v | b.v)}; }
  friend DISPERSA_INLINE Mask operator!(Mask a) { return {static_cast<__mmask8>(~a.v)}; }
};

template <>
struct Pack<8> {
  __m512d v;

  Pack() = default;
  DISPERSA_INLINE Pack(__m512d value) : v(value) {}
  DISPERSA_INLINE Pack(double value) : v(_mm512_set1_pd(value)) {}
  DISPERSA_INLINE Pack(Pack<4> low, Pack<4> high)
      : v(_mm512_insertf64x4(_mm512_castpd256_pd512(low.v), high.v, 1)) {}

  friend DISPERSA_INLINE Pack operator+(Pack a, Pack b) { return _mm512_add_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator-(Pack a, Pack b) { return _mm512_sub_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator*(Pack a, Pack b) { return _mm512_mul_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator/(Pack a, Pack b) { return _mm512_div_pd(a.v, b.v); }
  friend DISPERSA_INLINE Pack operator-(Pack a) { return -a.v; }
  friend DISPERSA_INLINE Mask<8> operator<(Pack a, Pack b) {
    return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)};
  }
  friend DISPERSA_INLINE Mask<8> operator>(Pack a, Pack b) {
    return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)};
  }
  friend DISPERSA_INLINE Mask<8> operator<=(Pack a, Pack b) {
    return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ)};
  }
  friend DISPERSA_INLINE Mask<8> operator>=(Pack a, Pack b) {
    return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GE_OQ)};
  }
};

DISPERSA_INLINE Pack<8> Select(Mask<8> m, Pack<8> yes, Pack<8> no) {
  return _mm512_mask_blend_pd(m.v, no.v, yes.v);
}
DISPERSA_INLINE Mask<8> SelectMask(Mask<8> m, Mask<8> yes, Mask<8> no) { return (m & yes) | ((!m) & no); }
DISPERSA_INLINE bool Any(Mask<8> m) { return m.v != 0; }
DISPERSA_INLINE bool All(Mask<8> m) { return m.v == 0xff; }
DISPERSA_INLINE Pack<8> Sqrt(Pack<8> a) { return _mm512_sqrt_pd(a.v); }
DISPERSA_INLINE Pack<8> Abs(Pack<8> a) { return _mm512_abs_pd(a.v); }
DISPERSA_INLINE Pack<8> Min(Pack<8> a, Pack<8> b) { return _mm512_min_pd(a.v, b.v); }
DISPERSA_INLINE Pack<8> Max(Pack<8> a, Pack<8> b) { return _mm512_max_pd(a.v, b.v); }
DISPERSA_INLINE Pack<8> OrBits(Pack<8> a, Pack<8> b) {
  return _mm512_castsi512_pd(_mm512_or_si512(_mm512_castpd_si512(a.v), _mm512_castpd_si512(b.v)));
}
DISPERSA_INLINE Pack<8> AndBits(Pack<8> a, Pack<8> b) {
  return _mm512_castsi512_pd(_mm512_and_si512(_mm512_castpd_si512(a.v), _mm512_castpd_si512(b.v)));
}
DISPERSA_INLINE Pack<8> Cos(Pack<8> x) { return Sleef_finz_cosd8_u10avx512f(x.v); }
DISPERSA_INLINE Pack<8> Sin(Pack<8> x) { return Sleef_finz_sind8_u10avx512f(x.v); }
DISPERSA_INLINE Pack<8> Atan2(Pack<8> y, Pack<8> x) { return Sleef_finz_atan2d8_u10avx512f(y.v, x.v); }
DISPERSA_INLINE Pack<8> Exp(Pack<8> x) { return Sleef_finz_expd8_u10avx512f(x.v); }
DISPERSA_INLINE Pack<8> Log(Pack<8> x) { return Sleef_finz_logd8_u10avx512f(x.v); }

#else

template <>
struct Mask<8> {
  Mask<4> low, high;

  friend DISPERSA_INLINE Mask operator&(Mask a, Mask b) { return {a.low & b.low, a.high & b.high}; }
  friend DISPERSA_INLINE Mask operator|(Mask a, Mask b) { return {a.low | b.low, a.high | b.high}; }
  friend DISPERSA_INLINE Mask operator!(Mask a) { return {!a.low, !a.high}; }
};

template <>
struct Pack<8> {
  Pack<4> low, high;

  Pack() = default;
  DISPERSA_INLINE Pack(Pack<4> l, Pack<4> h) : low(l), high(h) {}
  DISPERSA_INLINE Pack(double value) : low(value), high(value) {}

  friend DISPERSA_INLINE Pack operator+(Pack a, Pack b) { return {a.low + b.low, a.high + b.high}; }
  friend DISPERSA_INLINE Pack operator-(Pack a, Pack b) { return {a.low - b.low, a.high - b.high}; }
  friend DISPERSA_INLINE Pack operator*(Pack a, Pack b) { return {a.low * b.low, a.high * b.high}; }
  friend DISPERSA_INLINE Pack operator/(Pack a, Pack b) { return {a.low / b.low, a.high / b.high}; }
  friend DISPERSA_INLINE Pack operator-(Pack a) { return {-a.low, -a.high}; }
  friend DISPERSA_INLINE Mask<8> operator<(Pack a, Pack b) { return {a.low < b.low, a.high < b.high}; }
  friend DISPERSA_INLINE Mask<8> operator>(Pack a, Pack b) { return {a.low > b.low, a.high > b.high}; }
  friend DISPERSA_INLINE Mask<8> operator<=(Pack a, Pack b) { return {a.low <= b.low, a.high <= b.high}; }
  friend DISPERSA_INLINE Mask<8> operator>=(Pack a, Pack b) { return {a.low >= b.low, a.high >= b.high}; }
};

DISPERSA_INLINE Pack<8> Select(Mask<8> m, Pack<8> yes, Pack<8> no) {
  return {Select(m.low, yes.low, no.low), Select(m.high, yes.high, no.high)};
}
DISPERSA_INLINE Mask<8> SelectMask(Mask<8> m, Mask<8> yes, Mask<8> no) {
  return {SelectMask(m.low, yes.low, no.low), SelectMask(m.high, yes.high, no.high)};
}
DISPERSA_INLINE bool Any(Mask<8> m) { return Any(m.low | m.high); }
DISPERSA_INLINE bool All(Mask<8> m) { return All(m.low & m.high); }
DISPERSA_INLINE Pack<8> Sqrt(Pack<8> a) { return {Sqrt(a.low), Sqrt(a.high)}; }
DISPERSA_INLINE Pack<8> Abs(Pack<8> a) { return {Abs(a.low), Abs(a.high)}; }
DISPERSA_INLINE Pack<8> Min(Pack<8> a, Pack<8> b) { return {Min(a.low, b.low), Min(a.high, b.high)}; }
DISPERSA_INLINE Pack<8> Max(Pack<8> a, Pack<8> b) { return {Max(a.low, b.low), Max(a.high, b.high)}; }
DISPERSA_INLINE Pack<8> OrBits(Pack<8> a, Pack<8> b) {
  return {OrBits(a.low, b.low), OrBits(a.high, b.high)};
}
DISPERSA_INLINE Pack<8> AndBits(Pack<8> a, Pack<8> b) {
  return {AndBits(a.low, b.low), AndBits(a.high, b.high)};
}
DISPERSA_INLINE Pack<8> Cos(Pack<8> x) { return {Cos(x.low), Cos(x.high)}; }
DISPERSA_INLINE Pack<8> Sin(Pack<8> x) { return {Sin(x.low), Sin(x.high)}; }
DISPERSA_INLINE Pack<8> Atan2(Pack<8> y, Pack<8> x) { return {Atan2(y.low, x.low), Atan2(y.high, x.high)}; }
DISPERSA_INLINE Pack<8> Exp(Pack<8> x) { return {Exp(x.low), Exp(x.high)}; }
DISPERSA_INLINE Pack<8> Log(Pack<8> x) { return {Log(x.low), Log(x.high)}; }

#endif

// ---- a b + c, rounded once ------------------------------------------------------------------------------
//
// The only place at which the product fuses. Without it (DISPERSA_NO_FMA) nothing that is compiled may hold a
// fused instruction: tests/static/fused.py.

#if defined(DISPERSA_NO_FMA)
template <class T>
DISPERSA_INLINE T Fma(T a, T b, T c) {
  return a * b + c;
}
#else
DISPERSA_INLINE double Fma(double a, double b, double c) { return __builtin_fma(a, b, c); }
DISPERSA_INLINE Pack<4> Fma(Pack<4> a, Pack<4> b, Pack<4> c) { return _mm256_fmadd_pd(a.v, b.v, c.v); }
#if defined(__AVX512F__)
DISPERSA_INLINE Pack<8> Fma(Pack<8> a, Pack<8> b, Pack<8> c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }
#else
DISPERSA_INLINE Pack<8> Fma(Pack<8> a, Pack<8> b, Pack<8> c) {
  return {Fma(a.low, b.low, c.low), Fma(a.high, b.high, c.high)};
}
#endif
#endif

// ---- any number of lanes -------------------------------------------------------------------------------

template <class T>
struct Traits;
template <>
struct Traits<double> {
  static constexpr int kWidth = 1;
  using Mask = bool;
};
template <int W>
struct Traits<Pack<W>> {
  static constexpr int kWidth = W;
  using Mask = lanes::Mask<W>;
};
/// Number of lanes of a value type.
template <class T>
inline constexpr int kWidth = Traits<T>::kWidth;
/// The type that a comparison of two values returns.
template <class T>
using MaskOf = typename Traits<T>::Mask;

typedef double __attribute__((may_alias)) LaneDouble;

/// A mask that selects no lane.
template <class T>
DISPERSA_INLINE MaskOf<T> NoLane() {
  return T(0.0) > T(1.0);
}

/// One lane of a value.
template <class T>
DISPERSA_INLINE LaneDouble& Lane(T& value, int lane) {
  return reinterpret_cast<LaneDouble*>(&value)[lane];
}
template <class T>
DISPERSA_INLINE double Lane(const T& value, int lane) {
  return reinterpret_cast<const LaneDouble*>(&value)[lane];
}

DISPERSA_INLINE void SetLane(bool& mask, int, bool value) { mask = value; }
DISPERSA_INLINE void SetLane(Mask<4>& mask, int lane, bool value) {
  typedef long long __attribute__((may_alias)) LaneBits;
  reinterpret_cast<LaneBits*>(&mask)[lane] = value ? -1 : 0;
}
#if defined(__AVX512F__)
DISPERSA_INLINE void SetLane(Mask<8>& mask, int lane, bool value) {
  mask.v = static_cast<__mmask8>((mask.v & ~(1u << lane)) | (value ? 1u << lane : 0u));
}
#else
DISPERSA_INLINE void SetLane(Mask<8>& mask, int lane, bool value) {
  SetLane(lane < 4 ? mask.low : mask.high, lane & 3, value);
}
#endif

/// Whether a number of any lane is not 0.
template <class T>
DISPERSA_INLINE bool IsAnywhere(const T& value) {
  bool any = false;
  for (int lane = 0; lane < kWidth<T>; ++lane) any |= Lane(value, lane) != 0.0;
  return any;
}

/// Bit i: lane i.
DISPERSA_INLINE unsigned Bits(bool mask) { return mask ? 1u : 0u; }
DISPERSA_INLINE unsigned Bits(Mask<4> mask) { return static_cast<unsigned>(_mm256_movemask_pd(mask.v)); }
#if defined(__AVX512F__)
DISPERSA_INLINE unsigned Bits(Mask<8> mask) { return mask.v; }
#else
DISPERSA_INLINE unsigned Bits(Mask<8> mask) { return Bits(mask.low) | Bits(mask.high) << 4; }
#endif

template <class F, int... I>
DISPERSA_INLINE void EachOf(F& f, std::integer_sequence<int, I...>) {
  (f(I), ...);
}
/// f(0), ..., f(N - 1), written out.
template <int N, class F>
DISPERSA_INLINE void Each(F f) {
  EachOf(f, std::make_integer_sequence<int, N>{});
}

/// The nearest integer; of two nearest the even one. For magnitudes below 2^51.
template <class T>
DISPERSA_INLINE T Nearest(T x) {
  const T to_integer(0x1.8p52);  // added, it leaves the integer; taken away, that alone is left
  return (x + to_integer) - to_integer;
}

template <class T>
DISPERSA_INLINE T Clamp(T x, T low, T high) {
  return Max(Min(x, high), low);
}
template <class T>
DISPERSA_INLINE T Square(T x) {
  return x * x;
}
/// c0 + x (c1 + x (c2 + ...)).
template <class T>
DISPERSA_INLINE T Horner(T, double c0) {
  return T(c0);
}
template <class T, class... Rest>
DISPERSA_INLINE T Horner(T x, double c0, Rest... rest) {
  return Fma(x, Horner(x, rest...), T(c0));
}

// Structs that consist of values alone are read and written value by value through their bytes. A pointer to
// one member may not be used as a pointer to an array of all of them.

template <class T, class S>
inline constexpr unsigned kValues = sizeof(S) / sizeof(T);
/// Value i of a struct, and one lane of it.
template <class T, class S>
DISPERSA_INLINE T ValueAt(const S& s, unsigned i) {
  T value;
  const char* const from = reinterpret_cast<const char*>(&s) + i * sizeof value;
  __builtin_memcpy(static_cast<void*>(&value), from, sizeof value);
  return value;
}
template <class T, class S>
DISPERSA_INLINE void SetValueAt(S& s, unsigned i, T value) {
  char* const to = reinterpret_cast<char*>(&s) + i * sizeof value;
  __builtin_memcpy(to, static_cast<const void*>(&value), sizeof value);
}
template <class T, class S>
DISPERSA_INLINE double LaneAt(const S& s, unsigned i, int lane) {
  return ValueAt<double>(s, i * static_cast<unsigned>(kWidth<T>) + static_cast<unsigned>(lane));
}
template <class T, class S>
DISPERSA_INLINE void SetLaneAt(S& s, unsigned i, int lane, double value) {
  SetValueAt(s, i * static_cast<unsigned>(kWidth<T>) + static_cast<unsigned>(lane), value);
}

/// Replaces the lanes of a struct that a mask selects.
template <class T, class S>
DISPERSA_INLINE void Blend(MaskOf<T> mask, const S& from, S& to) {
  static_assert(sizeof(S) % sizeof(T) == 0);
  for (unsigned i = 0; i < kValues<T, S>; ++i)
    SetValueAt(to, i, Select(mask, ValueAt<T>(from, i), ValueAt<T>(to, i)));
}

/// A lane of a struct of T in one of 64-bit values in the same order.
template <class T, class S, class V>
DISPERSA_INLINE void SetLaneValues(S& to, int lane, const V& from) {
  static_assert(kValues<T, S> == kValues<double, V>);
  for (unsigned i = 0; i < kValues<T, S>; ++i) SetLaneAt<T>(to, i, lane, ValueAt<double>(from, i));
}
template <class T, class S, class V>
DISPERSA_INLINE void ReadLaneValues(const S& from, int lane, V& to) {
  static_assert(kValues<T, S> == kValues<double, V>);
  for (unsigned i = 0; i < kValues<T, S>; ++i) SetValueAt(to, i, LaneAt<T>(from, i, lane));
}

/// A lane of X<T> is an X<double>: any struct that consists of values alone.
template <template <class> class X, class T>
DISPERSA_INLINE void SetLane(X<T>& to, int lane, const X<double>& from) {
  SetLaneValues<T>(to, lane, from);
}
template <template <class> class X, class T>
DISPERSA_INLINE X<double> LaneOf(const X<T>& from, int lane) {
  X<double> to;
  ReadLaneValues<T>(from, lane, to);
  return to;
}

/// Truncates towards zero, lane by lane. Values must fit int.
DISPERSA_INLINE void Truncate(double x, int* out) { out[0] = static_cast<int>(x); }
DISPERSA_INLINE void Truncate(Pack<4> x, int* out) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm256_cvttpd_epi32(x.v));
}
#if defined(__AVX512F__)
DISPERSA_INLINE void Truncate(Pack<8> x, int* out) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm512_cvttpd_epi32(x.v));
}
#else
DISPERSA_INLINE void Truncate(Pack<8> x, int* out) {
  Truncate(x.low, out);
  Truncate(x.high, out + 4);
}
#endif

/// Element i of out, i < 4: row[lane][i] in each lane. Rows stand at multiples of 32 bytes.
DISPERSA_INLINE void LoadFour(const double* const* row, double* out) {
  for (int i = 0; i < 4; ++i) out[i] = row[0][i];
}
DISPERSA_INLINE void LoadFour(const double* const* row, Pack<4>* out) {
  const __m256d r0 = _mm256_load_pd(row[0]), r1 = _mm256_load_pd(row[1]);
  const __m256d r2 = _mm256_load_pd(row[2]), r3 = _mm256_load_pd(row[3]);
  const __m256d low01 = _mm256_unpacklo_pd(r0, r1), high01 = _mm256_unpackhi_pd(r0, r1);
  const __m256d low23 = _mm256_unpacklo_pd(r2, r3), high23 = _mm256_unpackhi_pd(r2, r3);
  out[0] = _mm256_permute2f128_pd(low01, low23, 0x20);
  out[1] = _mm256_permute2f128_pd(high01, high23, 0x20);
  out[2] = _mm256_permute2f128_pd(low01, low23, 0x31);
  out[3] = _mm256_permute2f128_pd(high01, high23, 0x31);
}
DISPERSA_INLINE void LoadFour(const double* const* row, Pack<8>* out) {
  Pack<4> low[4], high[4];
  LoadFour(row, low);
  LoadFour(row + 4, high);
  for (int i = 0; i < 4; ++i) out[i] = Pack<8>(low[i], high[i]);
}
/// The first `4 * groups` elements of each lane's row.
template <class T>
DISPERSA_INLINE void LoadRow(const double* const* row, int groups, T* out) {
  for (int group = 0; group < groups; ++group) {
    const double* at[kWidth<T>];
    for (int lane = 0; lane < kWidth<T>; ++lane) at[lane] = row[lane] + 4 * group;
    LoadFour(at, out + 4 * group);
  }
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
