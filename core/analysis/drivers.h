// What drives a metric, and what sets failing flights apart, from the inputs as the flights applied them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"

namespace dispersa {

/// One input, or a magnitude along a direction, of one metric over the completed flights. A magnitude, its
/// direction and both together are one family, which is named by what of it explains most.
struct Driver {
  std::string input;  ///< column without prefix; "magnitude * cos angle" columns joined by " along "
  std::string key;    ///< what the campaign file calls it, likewise
  /// Inputs that rank the flights alike or in reverse (one dispersion may feed two): nothing can tell them
  /// apart.
  std::vector<std::string> same_as = {};
  std::string feature;  ///< through which it acts most: "x", "|x|" (about the nominal), "sin x", "cos x"
  /// Share of the metric's variance that the family explains when those that explain more are known, with
  /// its interval of 95 %: the first-order Sobol index where inputs are independent. Together at most 1.
  double index = 0.0;
  double low = 0.0;
  double high = 0.0;
  double partial = 0.0;  ///< partial rank correlation of the feature; undefined of a pair
  /// Other inputs that are drawn with it, so that either may stand for the other.
  std::vector<std::string> correlated_with = {};
};

struct MetricDrivers {
  std::string metric;
  std::vector<Driver> drivers;  ///< by falling index, at most five, none whose interval holds 0
};

/// Of each metric, from the first 50,000 flights that define it; empty for one that fewer than 30 completed
/// flights define, or that does not vary.
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

/// Two inputs that stand in a relation among the failing flights and in none, or in another one, among the
/// others: it is their combination that fails.
struct FailurePair {
  std::string first, second;  ///< columns without prefix
  std::string first_key, second_key;
  std::string first_feature, second_feature;
  double correlation = 0.0;  ///< of ranks among the failing flights
  double p = 1.0;            ///< that it is the others'
  double false_discovery_rate = 1.0;
};

/// What the failing flights of a requirement have in common, against the others of the first 50,000. Where
/// fewer than ten fail, the tenth of the flights nearest to failing, the failing among them.
struct FailureDrivers {
  std::string metric;
  bool nearest = false;  ///< not only those that failed
  std::size_t flights = 0;
  std::vector<FailureDriver> drivers;  ///< up to a false discovery rate of 10 %, by rising p
  std::vector<FailurePair> pairs;      ///< likewise, at most five; none of flights that are only nearest
};

/// In the order of the campaign's requirements; without drivers where there are fewer than 30 flights.
std::vector<FailureDrivers> FindFailureDrivers(const Campaign& campaign, const CaseColumns& cases);

}  // namespace dispersa
