// The standard normal distribution. Here for modules that need nothing else of Boost's.
#pragma once

namespace dispersa {

/// That it is below z.
double NormalProbability(double z);
/// What it is below with the probability, between 0 and 1.
double NormalQuantile(double probability);

}  // namespace dispersa
