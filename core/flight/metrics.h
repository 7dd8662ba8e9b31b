// The metrics of a flight. metrics.cc declares each metric once, in one row. Names, groups, texts, storage
// and pages follow from this row.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/flight/flight_course.h"
#include "core/flight/outcome.h"
#include "core/math/circle.h"

namespace dispersa {

struct FlightDefinition;
struct FlightSums;
struct Vehicle;

/// Which values of a metric are worse ones.
enum class Worse {
  kLarger,
  kSmaller,
  kFartherFromZero,
  kNeither,  ///< a place or a time, neither good nor bad
};

/// The heading of reports under which a metric stands.
enum class MetricGroup {
  kAttitude,
  kControlEffort,
  kLoads,
  kInjection,
  kFreeFlight,
  kGuidance,
  kControlLaw,
  kIntegration,
  kOwn,  ///< of the campaign (own_metrics.h)
};
inline constexpr const char* kMetricGroupTitles[] = {"Attitude",    "Control effort", "Loads",
                                                     "Injection",   "Free flight",    "Guidance",
                                                     "Control law", "Integration",    "The campaign's own"};
constexpr const char* TitleOf(MetricGroup group) { return kMetricGroupTitles[static_cast<int>(group)]; }

/// What flights must have, besides their law, to have a metric.
enum class MetricNeeds {
  kNothing,
  kControl,       ///< a stage that an autopilot controls
  kFreeStage,     ///< a stage that nothing controls
  kSectionLoads,  ///< HasSectionLoads()
  kLimits,        ///< of the vehicle's structure
  kCutOff,        ///< a burn that a command ends
  kRail,
  kApogee,  ///< they end there, or later
  kImpact,
  kNode,  ///< a target that names it, as the next two
  kArgumentOfPerigee,
  kTrueAnomaly,
};
/// What decides which metrics the flights of a campaign have.
struct FlightKind {
  FlightKind(ControlLaw law) : pitch_law(law) {}

  ControlLaw pitch_law;
  bool is_controlled = true;
  bool has_free_stage = false;
  bool has_section_loads = false;
  bool has_limits = false;
  bool has_cut_off = false;
  bool has_rail = false;
  FlightEnd ends = FlightEnd::kInjection;
  // What the target names.
  bool has_node = false, has_argument_of_perigee = false, has_true_anomaly = false;
};
FlightKind KindOf(const Vehicle& vehicle, const AutopilotConfig& autopilot, const FlightCourse& course);
/// All that flights under a law may have: those of other needs are empty.
FlightKind AnyUnder(ControlLaw law);

/// A metric that a flight does not define (a stage that it never reached) is NaN inside and NULL, empty or
/// null outside.
struct Metric {
  std::string name;        ///< with phase and unit: "pitch_error_peak_stage2_deg"
  std::string title;       ///< "Pitch error, peak, stage 2"
  std::string symbol;      ///< "max |e_θ|"
  std::string unit;        ///< "°" for instance (empty: a pure number)
  std::string definition;  ///< completes the title (empty if the title says all)
  std::string over;        ///< the part of a flight that it is taken over: "the last ignition"
  MetricGroup group = MetricGroup::kAttitude;
  Worse worse = Worse::kLarger;
  bool is_usual = false;     ///< shown in full in every report, with or without a requirement
  bool is_digested = false;  ///< part of a flight's digest
  bool is_part =
      false;  ///< of one stage or of the coast: the metric without this suffix has the same definition
  /// property that a law needs for its flights to have the metric (null: none)
  bool LawInfo::*of_law = nullptr;
  MetricNeeds needs = MetricNeeds::kNothing;
  Circle circle = {};  ///< where it repeats, in its unit
  int since = 1;       ///< the first version of stored rows (kRowVersion) that knows it
};

/// In the order of their columns.
const std::vector<Metric>& Metrics();
const std::vector<std::string>& MetricNames();
/// Number of metrics of a vehicle with this number of stages: they are the first of Metrics(). A flight's
/// value is undefined if its control law does not have the metric.
std::size_t MetricCount(std::size_t stages);
/// Whether flights of a kind have it.
bool HasMetric(const Metric& metric, const FlightKind& kind);
/// Positions in Metrics() of the metrics that flights of a kind have, for a number of stages.
std::vector<std::size_t> MetricsUnder(std::size_t stages, const FlightKind& kind);
/// "a stage that an autopilot controls": what flights of a metric need, besides a law; empty: nothing.
std::string NeedsOf(const Metric& metric);
/// "adaptive_fuzzy or frozen_fuzzy": the laws that have it.
std::string LawsWith(const Metric& metric);
/// The column of a metric that exists.
std::size_t MetricColumn(const std::string& name);

/// The measured results of one flight.
struct MeasuredFlight {
  std::vector<double> metrics;   ///< of the vehicle, in the order of Metrics(), in the units of their names
  std::vector<double> digested;  ///< what of it is part of the digest, whether its law has the metric or not
};
MeasuredFlight Measure(const FlightSums& sums, const FlightDefinition& definition);

}  // namespace dispersa
