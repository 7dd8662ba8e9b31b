// Inputs that drive a metric, and inputs that distinguish failing flights. Both use the inputs as applied.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// One cause of a metric over the completed flights: an input, or a magnitude along a direction. A magnitude,
/// its direction and their product are one family. The member that explains most gives the family its name.
struct Driver {
  std::string input;  ///< column without prefix; "magnitude * cos angle" columns joined by " along "
  std::string key;    ///< its name in the campaign file, joined in the same way
  /// Inputs that rank the flights in the same or in reverse order, so they cannot be told apart. One
  /// dispersion may feed two inputs.
  std::vector<std::string> same_as = {};
  /// The form with the largest share: "x", "|x|" (about the nominal), "sin x", "cos x"; "which" of an input
  /// that is a number of something, whose order means nothing.
  std::string feature;
  /// Share of the metric's variance that the family explains when the families before it are known. `low` and
  /// `high` are its 95 % interval. For independent inputs it is the first-order Sobol index. All shares sum
  /// to 1 at most.
  double index = 0.0;
  double low = 0.0;
  double high = 0.0;
  double partial = 0.0;  ///< partial rank correlation of the feature; undefined of a pair, and of "which"
  /// Other inputs that are drawn with it, so that either may stand for the other.
  std::vector<std::string> correlated_with = {};
};

struct MetricDrivers {
  std::string metric;
  std::vector<Driver> drivers;  ///< by falling index, at most five, none whose interval holds 0
};

/// The drivers of each metric, from the first 50,000 flights that define it. A metric has none if fewer than
/// 30 completed flights define it, if it does not vary, or if it lies all around a circle.
std::vector<MetricDrivers> FindDrivers(const Campaign& campaign, const std::vector<std::string>& metrics,
                                       const CaseColumns& cases);

struct FailureDriver {
  std::string input;
  std::string key;
  std::string feature;
  bool larger = true;  ///< among the failing flights than among the others
  double p = 1.0;
  double false_discovery_rate = 1.0;  ///< of this and all that rank before it (Benjamini and Hochberg)
};

/// Two inputs whose combination fails: they are correlated among the failing flights, and otherwise not or
/// differently.
struct FailurePair {
  std::string first, second;  ///< columns without prefix
  std::string first_key, second_key;
  std::string first_feature, second_feature;
  double correlation = 0.0;  ///< of ranks among the failing flights
  double p = 1.0;            ///< p-value: the correlation is equal among the other flights
  double false_discovery_rate = 1.0;
};

/// Inputs with an order that distinguish the failing flights of a requirement from the others of the first
/// 50,000. If fewer than ten fail, the tenth of the flights nearest to the limit stands for them, failing
/// ones included.
struct FailureDrivers {
  std::string metric;
  bool nearest = false;  ///< true: flights near the limit stand for failing ones
  std::size_t flights = 0;
  std::vector<FailureDriver> drivers;  ///< up to a false discovery rate of 10 %, by rising p
  std::vector<FailurePair> pairs;      ///< in the same way, at most five; none if `nearest`
};

/// In the order of the campaign's requirements. No drivers with fewer than 30 flights.
std::vector<FailureDrivers> FindFailureDrivers(const Campaign& campaign, const CaseColumns& cases);

}  // namespace dispersa
