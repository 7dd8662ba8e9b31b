// A dispersion campaign: what is flown, how it is dispersed, what is required of it. Immutable once loaded.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/environment/wind.h"
#include "core/environment/wind_statistics.h"
#include "core/flight/flight_inputs.h"
#include "core/trajectory/reference.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

enum class SamplingMethod { kMonteCarlo, kLatinHypercube, kSobol, kCorners, kOneAtATime, kGrid, kList };

/// What "±" means, always explicit.
enum class Distribution {
  kConstant,  ///< the same value in every case
  kNormal,    ///< nominal + sigma * standard normal, not truncated
  kUniform,   ///< between low and high
  kTwoPoint,  ///< low or high: a factor of a corner or one-at-a-time design, else a fair coin
  kValues,    ///< one of a list: an axis of a grid or list design, else drawn with equal probability
};

/// Of one scalar, in the internal unit of its input (SI, radians, or a factor).
struct ScalarDistribution {
  Distribution kind = Distribution::kConstant;
  double nominal = 0.0;  ///< kNormal: the mean; designs: the value while other parameters move
  double sigma = 0.0;    ///< kNormal
  double low = 0.0;      ///< kUniform, kTwoPoint
  double high = 0.0;     ///< kUniform, kTwoPoint
  std::vector<double> values;  ///< kValues; kConstant: one value
};

/// One draw of a case: `name` keys its random stream and stays when other draws come or go.
struct Dispersion {
  std::string name;            ///< e.g. "thrust/stage1", "wind/azimuth"
  ScalarDistribution distribution;
  std::vector<int> inputs;     ///< columns (FindInput) that take the value; draws of one factor multiply
  bool absolute = false;       ///< take the magnitude of the draw: lateral deviations with a clock angle
};

struct Requirement {
  std::string metric;             ///< without the prefix
  std::optional<double> below;    ///< exactly one of below and above
  std::optional<double> above;
  double probability = 0.0;
  double consumer_risk = 0.0;
};

struct Sampling {
  SamplingMethod method = SamplingMethod::kMonteCarlo;
  std::uint64_t cases = 0;     ///< a design of m runs repeats after m cases with other random draws
  std::uint64_t seed = 0;
};

struct Campaign {
  std::string name;
  Vehicle vehicle;
  AutopilotConfig autopilot;
  Reference reference;
  Sampling sampling;
  std::vector<Dispersion> dispersions;
  std::optional<WindStatistics> wind_statistics;  ///< climatology whose levels the profile draws fill
  std::optional<WindTable> wind_table;            ///< a profile that every flight meets, the nominal too
  std::vector<Requirement> requirements;

  std::string canonical_yaml;  ///< everything inlined; what campaign.yaml holds
  std::string id;              ///< SHA-256 of canonical_yaml, hexadecimal
  std::string flight_id;       ///< SHA-256 of what decides a case
};

}  // namespace dispersa
