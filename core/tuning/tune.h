// One procedure tunes any autopilot under any law with one budget. Comparisons of laws are fair only between
// tunings with the same budget.
//
// A stage's gains act only while it burns, so stages are tuned one after another. A genetic algorithm
// searches the stage's design (stage_design.h): damping, learning if the law adapts, and bandwidth. Bandwidth
// is a fraction of the largest one whose margins suffice: the best designs are on or near that limit.
// - Objective: mean RMS pitch error of the stage over cases of the campaign, drawn with the tuning's own
// seed.
//   Tie-breaker within kObjectiveTolerance_deg: the largest peak.
// - Constraints: every computed margin of all axes is at or above its gate plus a reserve, with gains frozen
// and
//   adapting, at every instant of MarginInstants. Every case completes. Every ripple of the deflection is
//   below kLimitCycleLimit_deg.
//
// A stage whose schedule has times has a design at each (autopilot_config.h; pitch's times count). Damping,
// learning and blend are searched for all of them. Filters follow the first mode's frequency at each time.
// Bandwidth is the largest that suffices near the time. If none suffices, the design of that time is refined
// by itself.
//
// With `dispersed`, as many draws of the campaign are plants to be held. Their margins must be above the
// gates of dispersed flights, the nominal plant's above its own gates, each plus the smaller reserve
// kHeld.... They come from tables (core/margins/loop_table.h), and from exact computation at the end.
//
// A PID may be searched as a linear-quadratic regulator instead (regulator.h): weights take the place of
// damping and learning.
//
// Margins come first: a design that misses one is not flown. The augmentation of PD acts in every stage. It
// is searched last, over whole flights, with measured margins at their gates. Computed margins know it at
// rest only. Stages and augmentation share the budget. The search depends neither on the autopilot's earlier
// gains nor on the number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/margins/flight_margins.h"
#include "core/optimization/genetic_algorithm.h"
#include "core/tuning/stage_design.h"
#include "core/tuning/tuning_options.h"

namespace dispersa {

/// One line of the log.
struct TuningRecord {
  int stage = 0;  ///< 0-based, and the number of stages for the augmentation
  GenerationRecord generation;
};

struct StageTuning {
  StageDesign design;
  bool feasible = false;      ///< all constraints are met
  double mean_rms_deg = 0.0;  ///< of the stage, pitch
  double peak_deg = 0.0;      ///< largest of the stage over the cases, pitch
  LeastMargins frozen;        ///< of the stage
  LeastMargins adapting;      ///< as frozen where nothing adapts
  /// The least of (margin - gate with reserve) / gate over the dispersed plants and the nominal one, where
  /// they are held.
  std::optional<double> surplus;
  /// Of a stage that is not feasible: the constraint that is missed by most, where and by how much.
  std::string missed;
};

struct AugmentationTuning {
  AugmentationDesign design;
  bool feasible = false;
  double mean_rms_deg = 0.0;  ///< of powered flight, pitch
  double peak_deg = 0.0;      ///< largest over the cases, pitch
  std::string missed;         ///< as a stage's
};

struct TuningResult {
  AutopilotConfig autopilot;  ///< tuned
  std::vector<StageTuning> stages;
  std::vector<SkippedInstant> skipped;  ///< of the nominal flight, at which no margins were asked for
  std::optional<AugmentationTuning> augmentation;  ///< where PD is augmented and every stage is feasible
  bool feasible = false;                           ///< all of them
  /// Powered pitch error of the tuned autopilot over the tuning's cases; 0 if none is feasible.
  double median_rms_deg = 0.0;
  double largest_peak_deg = 0.0;
  std::uint64_t evaluations = 0;  ///< designs tried
  std::uint64_t flights = 0;      ///< of cases, without flights that measure margins
};

/// Lines that the log of tuning `autopilot` will have.
std::uint64_t TuningGenerations(const Campaign& campaign, const AutopilotConfig& autopilot,
                                const TuningOptions& options);

using TuningObserver = std::function<void(const TuningRecord&)>;

/// Tunes `autopilot` for a campaign's vehicle, reference and dispersions. The campaign's own autopilot is
/// ignored. Cases are drawn by Monte Carlo. `observer`, if given, is called on the calling thread after each
/// generation. Throws InputError in these cases: the seed is the campaign's, an option is out of its range,
/// the autopilot does not suit the vehicle, it fixes a P_n (which follows from the gains), or a regulator's
/// axis has no integral.
TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer = nullptr);

}  // namespace dispersa
