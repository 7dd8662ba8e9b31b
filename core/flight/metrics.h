// What is measured of a flight: one table of names, meanings and how each follows from what was accumulated.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/flight/outcome.h"

namespace dispersa {

struct FlightDefinition;
struct FlightSums;

/// Which values of a metric are worse ones.
enum class Worse {
  kLarger,
  kSmaller,
  kFartherFromZero,
  kNeither,  ///< it tells where or when, not how good
};

/// A metric that a flight does not define (a stage that it never reached) is NaN inside and NULL, empty or
/// null outside.
struct Metric {
  std::string name;        ///< with phase and unit: "pitch_error_peak_stage2_deg"
  std::string title;       ///< "Pitch error, peak, stage 2"
  std::string definition;  ///< completes the title; empty where that says all
  Worse worse = Worse::kLarger;
};

/// In the order of their columns.
const std::vector<Metric>& Metrics();
const std::vector<std::string>& MetricNames();
/// Metrics that a vehicle of so many stages has: the first so many of Metrics().
std::size_t MetricCount(std::size_t stages);
/// The first so many of them are part of a flight's digest; the later ones follow from its states, which are
/// too.
std::size_t DigestedMetrics();
/// The column of a metric that exists.
std::size_t MetricColumn(const std::string& name);

/// Those that the vehicle has, in the order of Metrics(), in the units of their names.
std::vector<double> MetricsOf(const FlightSums& sums, const FlightDefinition& definition);

}  // namespace dispersa
