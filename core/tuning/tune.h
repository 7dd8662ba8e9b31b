// One procedure that tunes any autopilot, whatever its law, with one budget: comparisons of laws are fair
// only between tunings that had the same chances.
//
// Stage after stage, since a stage's gains act only while it burns, a genetic algorithm searches the stage's
// design (stage_design.h): its damping, its learning if the law adapts, and its bandwidth as a fraction of
// the largest one whose margins suffice, since the best designs lie on or near that limit.
// - objective: mean RMS pitch error of the stage over cases of the campaign, drawn with the tuning's own
// seed;
//   tie-breaker within kObjectiveTolerance_deg: the largest peak;
// - subject to: every computed margin of all axes, gains frozen and adapting, at every instant of
//   MarginInstants at or above its gate plus a reserve; every case completed; every ripple of the deflection
//   below kLimitCycleLimit_deg.
// A stage whose schedule has times (autopilot_config.h; pitch's count, with any gains) has a design at each:
// its damping, learning and blend are searched for all, filters follow the first mode's frequency at that
// time, bandwidth is the largest that suffices about it, and where none does the design of that time is
// refined by itself. With `dispersed`, as many draws of the campaign are plants to be held: their margins
// must be above the gates of dispersed flights, those of the nominal plant above theirs, each plus the
// smaller reserve kHeld...; they come from tables (core/margins/loop_table.h), with exact ones at the end. A
// PID may be searched as a linear-quadratic regulator instead (regulator.h): weights take the place of
// damping and learning. Margins come first: a design that misses one is not flown. What augments PD acts in
// every stage; it is searched last, over whole flights, with the measured margins at their gates instead of
// the computed ones, which know it at rest only. The budget is shared by the stages and the augmentation. The
// search does not depend on the gains that the autopilot had before, nor on the number of threads.
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
  int stage = 0;  ///< 0-based; the number of stages: the augmentation
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
  /// Powered pitch error of the tuned autopilot over the tuning's cases; 0 if it is not feasible.
  double median_rms_deg = 0.0;
  double largest_peak_deg = 0.0;
  std::uint64_t evaluations = 0;  ///< designs tried
  std::uint64_t flights = 0;      ///< of cases; those that measure margins are not counted
};

/// Lines that the log of tuning `autopilot` will have.
std::uint64_t TuningGenerations(const Campaign& campaign, const AutopilotConfig& autopilot,
                                const TuningOptions& options);

using TuningObserver = std::function<void(const TuningRecord&)>;

/// Tunes `autopilot` for the vehicle, reference and dispersions of a campaign, whose own autopilot is
/// ignored; cases are drawn by Monte Carlo. `observer`, if given, is called on the calling thread after each
/// generation. Throws InputError if the seed is the campaign's, an option is out of its range, the autopilot
/// does not suit the vehicle or fixes a P_n, which follows from the gains, or a regulator's axis has no
/// integral.
TuningResult Tune(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options,
                  const TuningObserver& observer = nullptr);

}  // namespace dispersa
