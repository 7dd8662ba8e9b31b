// How many stages there may be: vehicles, inputs, metrics and autopilots count by them.
#pragma once

namespace dispersa {

/// The largest number of stages.
inline constexpr int kMaxStages = 6;

}  // namespace dispersa
