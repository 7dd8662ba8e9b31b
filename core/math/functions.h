// Every transcendental function between a draw and a result goes through this header.
//
// glibc picks other code by processor, so its results differ in the last bit from one machine to the
// next. SLEEF's `finz` functions return the same bits on every processor with FMA, in one lane or in
// eight. Square root, fused multiply-add, rounding and absolute value are exact in IEEE 754 and need
// no such care. A test fails when a core library links a transcendental of libm.
#pragma once

#include <cmath>

namespace dispersa {

/// Sine and cosine of one angle.
struct SinCos {
  double sin;
  double cos;
};

double Sin(double x_rad);
double Cos(double x_rad);
SinCos SineCosine(double x_rad);
double Asin(double x);
double Atan(double x);
double Atan2(double y, double x);
double Exp(double x);
double Log(double x);
double Log10(double x);
double Pow(double x, double y);

inline double Sqrt(double x) { return std::sqrt(x); }
inline double Square(double x) { return x * x; }
/// x limited to [low, high].
inline double Clamp(double x, double low, double high) { return x < low ? low : (x > high ? high : x); }

}  // namespace dispersa
