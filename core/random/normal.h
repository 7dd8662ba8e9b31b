// The standard normal distribution.
#pragma once

namespace dispersa {

/// The x below which a standard normal variable lies with probability p in (0, 1): algorithm AS 241,
/// PPND16 (M. J. Wichura, Applied Statistics 37 (1988) 477-484), relative error about 1e-16.
/// -infinity at p = 0, infinity at p = 1, NaN outside.
double InverseNormal(double p);

}  // namespace dispersa
