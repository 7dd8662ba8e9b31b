// The standard normal distribution, for modules that use nothing else of Boost.
#pragma once

namespace dispersa {

/// Probability of a value below z.
double NormalProbability(double z);
/// The value z for which NormalProbability(z) is `probability`, in (0, 1).
double NormalQuantile(double probability);

}  // namespace dispersa
