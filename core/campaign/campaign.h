// A dispersion campaign: what is flown, how it is dispersed, what is required of it. Immutable once loaded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/derived_input.h"
#include "core/control/autopilot_config.h"
#include "core/environment/weather_ensemble.h"
#include "core/environment/wind.h"
#include "core/environment/wind_statistics.h"
#include "core/flight/flight_course.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/own_metrics.h"
#include "core/guidance/guidance_config.h"
#include "core/input/fields.h"
#include "core/statistics/verdict_plan.h"
#include "core/trajectory/reference.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

enum class SamplingMethod { kMonteCarlo, kLatinHypercube, kSobol, kCorners, kOneAtATime, kGrid, kList };

/// Cases are independent and identically distributed, so that binomial limits hold.
inline bool IsIndependent(SamplingMethod method) { return method == SamplingMethod::kMonteCarlo; }

/// The meaning of "±", which a file always states.
enum class Distribution {
  kConstant,         ///< the same value in every case
  kNormal,           ///< nominal + sigma * standard normal, not truncated
  kTruncatedNormal,  ///< the same between low and high: never clamped, which would pile cases at the ends
  kLogNormal,        ///< nominal (the median) * exp(sigma * standard normal)
  kRayleigh,         ///< magnitude of two normal components of standard deviation sigma: sigma is its mode
  kUniform,          ///< between low and high
  kTriangular,       ///< between low and high, most likely at nominal
  kTwoPoint,         ///< low or high: a factor of a corner or one-at-a-time design, else a fair coin
  kValues,           ///< one of a list: an axis of a grid or list design, else drawn by weight
  kEmpirical,        ///< like the values of a sample: linear between its order statistics
};

/// Of one scalar, in the internal unit of its input (SI, radians, or a factor).
struct ScalarDistribution {
  Distribution kind = Distribution::kConstant;
  double nominal = 0.0;  ///< see Distribution; in designs the value while other inputs move
  double sigma = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::vector<double>
      values;  ///< for kValues all values, for kConstant one, for kEmpirical in ascending order
  std::vector<double> weights = {};  ///< kValues: above 0, one a value, or none: equal
};

/// One draw of a case: `name` keys its random stream and stays when other draws come or go.
struct Dispersion {
  std::string name;  ///< e.g. "thrust/stage1", "wind/azimuth"
  ScalarDistribution distribution;
  std::vector<int>
      inputs;             ///< columns (FindInput) that take the value (several draws of one factor multiply)
  bool absolute = false;  ///< take the magnitude of the draw: lateral deviations with a clock angle
  /// For a correlated normal: positions in Campaign::dispersions, and weights. The standard normal is the
  /// weighted sum of those of the named dispersions. The weights are a row of the Cholesky factor of the
  /// correlations. Empty: not correlated.
  std::vector<std::pair<std::size_t, double>> mix = {};
  bool replaces = false;  ///< of a list's table: the value stands in place of all other draws of its input
};

struct Requirement {
  std::string metric;           ///< without the prefix
  std::optional<double> below;  ///< exactly one of below, above and within
  std::optional<double> above;
  double probability = 0.0;
  double consumer_risk = 0.0;
  std::optional<std::array<double, 2>> within = {};  ///< between both, strictly
  std::string own_expression = {};                   ///< of a metric of the campaign's own
  VerdictPlan plan = {};
  bool every_case = false;     ///< study only, in place of probability and risk: no point may violate it
  std::string id = {};         ///< the project's number of this requirement; these three change no verdict
  std::string rationale = {};  ///< why it is required
  std::string source = {};     ///< the document that requires it
};

/// How the requirements are judged together, and whether their verdicts end the campaign.
struct Verdicts {
  bool holm =
      false;  ///< all verdicts together keep the largest consumer risk (S. Holm, 1979), else each its own
  bool stop_when_decided =
      false;  ///< end at the look at which every requirement is decided (else all cases are flown)
  std::uint64_t attempts =
      1;  ///< number of campaigns of one design that share each requirement's risk evenly
};

struct Sampling {
  SamplingMethod method = SamplingMethod::kMonteCarlo;
  std::uint64_t cases =
      0;  ///< at most this many (a design of m runs repeats after m cases with other random draws)
  std::uint64_t seed = 0;
  /// Latin hypercube and Sobol: number of independent designs, of cases / replicates points each.
  std::uint64_t replicates = 1;
};

/// A group of normal dispersions that are drawn together.
struct Correlation {
  std::vector<std::string> names;
  std::vector<std::vector<double>>
      matrix;  ///< of correlations, or of covariances in the units of the columns
  bool is_covariance = false;
};

struct Campaign {
  std::string name;
  Vehicle vehicle;
  AutopilotConfig autopilot;
  Reference reference;
  GuidanceConfig guidance;
  FlightCourse course;
  Sampling sampling;
  std::vector<Dispersion> dispersions;
  std::vector<DerivedInput> derived;              ///< set after all draws of a case
  std::optional<WindStatistics> wind_statistics;  ///< climatology of the profile draws
  std::optional<WeatherTable> wind_table;         ///< a profile that every flight meets, the nominal too
  std::vector<DatedWeather> soundings;            ///< or those of which each flight draws one
  std::vector<OwnMetric> own_metrics;
  std::vector<Requirement> requirements;
  Verdicts verdicts;
  std::vector<std::string> assumptions;  ///< assumptions of the verdicts, in the project's words

  std::string vehicle_file;     ///< as the campaign file names it, without folders; no part of any id
  std::string canonical_yaml;   ///< everything inlined: the text of campaign.yaml
  std::string id;               ///< SHA-256 of canonical_yaml, hexadecimal
  std::string flight_id;        ///< SHA-256 of what decides a case
  std::string requirements_id;  ///< SHA-256 of what is required, in any order, and of how it is judged
  std::string design_id;        ///< SHA-256 of what is flown, without seed, number of cases and engine
  std::string own_metrics_id;   ///< SHA-256 of the flight id and the own metrics; empty without any

  /// Id of everything that decides a case's result: the flight and the measured metrics.
  const std::string& result_id() const { return own_metrics_id.empty() ? flight_id : own_metrics_id; }
};

// The keys of a campaign's maps. Relations between several keys are checked where the map is described.

/// Without a list's table, whose columns come after the dispersions.
void Describe(Fields& fields, Sampling& sampling);
/// `plan` is what the verdicts say of all requirements.
void Describe(Fields& fields, Verdicts& verdicts, VerdictPlan& plan, Sampling& sampling);
/// `others` are the names that it may not have. Its expression is not parsed.
void Describe(Fields& fields, OwnMetric& metric, const std::vector<std::string>& others);
/// requirement.plan is the plan of `verdicts` unless the requirement has its own. `metrics` are the names of
/// metrics that it may require.
void Describe(Fields& fields, Requirement& requirement, const std::vector<std::string>& metrics);
/// And gives each of its dispersions its `mix`.
void Describe(Fields& fields, Correlation& correlation, std::vector<Dispersion>& dispersions);
/// A design needs dispersions that it can set. `fields` are the campaign's.
void CheckDesign(Fields& fields, const Sampling& sampling, const std::vector<Dispersion>& dispersions);

}  // namespace dispersa
