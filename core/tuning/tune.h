// One procedure tunes any autopilot under any control law with one budget. Comparisons of laws are fair only
// between tunings with the same budget.
//
// Stages are tuned one after another, since the gains of a stage act only while it burns. A genetic algorithm
// searches the design of the stage (stage_design.h): damping, learning if the law adapts, and bandwidth. The
// bandwidth is a fraction of the largest one with sufficient margins. The best designs are on or near that
// limit.
// - Objective: mean RMS pitch error of the stage over cases of the campaign, with the seed of the tuning.
// - Tie-breaker within kObjectiveTolerance_deg: the largest peak of the pitch error.
// - Constraints: every computed margin of all axes is at or above its gate plus a reserve, with gains frozen
//   and adapting, at every instant of MarginInstants. Every case completes. Every ripple of the deflection is
//   below kLimitCycleLimit_deg.
//
// Designs fly the reference, without closed-loop guidance. Its commanded turns would count as ripple: on the
// gallery's Falcon 9 as 0.3 deg under any gains, where the autopilot alone makes 0.02 deg.
//
// If the schedule of a stage has times, the stage has a design for each (autopilot_config.h; the times of
// pitch count). Damping, learning and weights of the gyros are searched for all of them together. The filters
// follow the frequency of the first mode at each time. The bandwidth is the largest that suffices near the
// time. If none suffices, the design of that time is refined by itself.
//
// With `dispersed`, that number of draws of the campaign are held as plants too. Their margins must be above
// the gates of dispersed flights, those of the nominal plant above its own gates, each plus the smaller
// reserve kHeld.... These margins come from tables (core/margins/loop_table.h), and at the end from exact
// computation.
//
// A PID may be searched as a linear-quadratic regulator instead (regulator.h): its weights then replace
// damping and learning.
//
// Margins come first: a design that misses one is not flown. The augmentation of PD acts in every stage. It
// is searched last, over whole flights, against the gates of measured margins. Computed margins include it
// only at rest. Stages and augmentation share the budget. The result depends neither on the earlier gains of
// the autopilot nor on the number of threads.
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
  int stage = 0;  ///< 0-based; the augmentation has the number of stages
  GenerationRecord generation;
};

struct StageTuning {
  StageDesign design;
  bool feasible = false;      ///< all constraints are met
  double mean_rms_deg = 0.0;  ///< pitch, over the stage
  double peak_deg = 0.0;      ///< pitch, largest in the stage over the cases
  LeastMargins frozen;        ///< of the stage
  LeastMargins adapting;      ///< the same as `frozen` if nothing adapts
  /// The least of (margin - gate with reserve) / gate over the held plants, if plants are held.
  std::optional<double> surplus;
  /// If not feasible: the constraint that is missed by most, where, and by how much.
  std::string missed;
};

struct AugmentationTuning {
  AugmentationDesign design;
  bool feasible = false;
  double mean_rms_deg = 0.0;  ///< of powered flight, pitch
  double peak_deg = 0.0;      ///< largest over the cases, pitch
  std::string missed;         ///< as for a stage
};

struct TuningResult {
  AutopilotConfig autopilot;  ///< tuned
  std::vector<StageTuning> stages;
  std::vector<SkippedInstant> skipped;             ///< of the nominal flight, without margins
  std::optional<AugmentationTuning> augmentation;  ///< if PD is augmented and every stage is feasible
  std::string start_loss;    ///< NominalLoss() of the design that the search starts from: margins end there
  std::string nominal_loss;  ///< NominalLoss() of the tuned autopilot, which is then not feasible
  bool feasible = false;     ///< all stages, and the augmentation
  /// Powered pitch error of the tuned autopilot over the cases of the tuning. 0 if not feasible.
  double median_rms_deg = 0.0;
  double largest_peak_deg = 0.0;
  std::uint64_t evaluations = 0;  ///< designs tried
  std::uint64_t flights = 0;      ///< of cases; flights that measure margins are not counted
};

/// Number of log lines of a tuning of `autopilot`.
std::uint64_t TuningGenerations(const Campaign& campaign, const AutopilotConfig& autopilot,
                                const TuningOptions& options);

using TuningObserver = std::function<void(const TuningRecord&)>;

/// Tunes `autopilot` for a campaign's vehicle, reference and dispersions. The campaign's own autopilot is
/// ignored. Cases are drawn by Monte Carlo. `observer`, if given, is called on the calling thread after each
/// generation.
///
/// Throws InputError if the seed is the campaign's, if an option is out of its range, or if the autopilot
/// does not suit the vehicle. It also throws InputError if the autopilot fixes a P_n, which follows from the
/// gains, or if a regulator's axis has no integral.
TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer = nullptr);

}  // namespace dispersa
