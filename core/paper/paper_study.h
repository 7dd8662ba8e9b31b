// All data of the paper's page: the optimised trajectory, and the flights of the campaigns behind its
// figures.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/control/autopilot_config.h"
#include "core/flight/history.h"
#include "core/margins/flight_margins.h"
#include "core/paper/study_flights.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// A campaign of the page, and its purpose.
struct PaperCampaign {
  std::string name;    ///< of the file without its ending
  std::string figure;  ///< its content, for readers
};

/// In the order of the page. The first is the nominal flight.
const std::vector<PaperCampaign>& PaperCampaigns();

/// Baselines of the comparison: the campaigns that fly other autopilots on the cases of "controllers".
const std::vector<std::string>& PaperBaselines();

/// Inputs that "completions" sweeps.
const std::vector<std::string>& PaperCompletions();

struct PaperOptions {
  /// Size of a Monte Carlo campaign; the designs are repeated, and the bands drawn, in proportion.
  std::uint64_t cases = 200;
  int threads = 1;  ///< the page does not depend on it
  /// Called now and then, one call at a time ("table3", 17, 200).
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress;
};

struct PaperFlights {
  Campaign campaign;
  StudyFlights flights;
};

/// A deliberately bad P_n of the pitch axis: the error message about it, and its flight if it is allowed.
struct BadPn {
  double factor = 0.0;  ///< of the Lyapunov equation's column
  Vector2 p_n = Vector2::Zero();
  std::string refusal;  ///< why an autopilot file with it is refused
  CaseResult flight;    ///< with allow_unproven
};

/// The injection of the nominal flight program, in each model that flies it.
struct PaperInjection {
  double propellant_kg = 0.0;  ///< that the nominal flight's reaction control expels
  Orbit point_mass;            ///< as the optimiser flies it
  Orbit lighter_point_mass;    ///< with that propellant gone before the last stage burns
};

/// A completion of the vehicle away from its value, and the margins of the loop there.
struct CompletionMargins {
  std::string input;  ///< "inertia_factor"
  double factor = 1.0;
  LeastMargins computed;  ///< all axes and instants, gains frozen and adapting
  LeastMargins measured;  ///< all stages; no phase
  bool passed = false;    ///< every gate of both
};

struct PaperStudy {
  std::uint64_t cases = 0;  ///< of the options
  OptimizationResult optimization;
  AutopilotConfig nominal_autopilot;
  CaseResult nominal;
  History nominal_history;
  std::map<std::string, PaperFlights> campaigns;  ///< by name; all but the nominal
  std::vector<BadPn> bad_pn;
  PaperInjection injection;
  std::vector<LeastMargins> pn_margins;  ///< of each case of "pn_sweep": pitch, adapting, computed
  std::vector<CompletionMargins> completion_margins;  ///< as shipped first
  std::vector<ComputedMargins> computed_margins;      ///< of the nominal's autopilot
  std::vector<MeasuredMargins> measured_margins;

  const PaperFlights& at(const std::string& name) const { return campaigns.at(name); }
};

/// Columns of the time histories that flights keep, in this order.
enum PaperColumn { kPitchLaunch, kPitchError, kDeflection, kLyapunovV, kLyapunovSign, kStage, kPaperColumns };

/// Flies everything. `campaigns` are those of PaperCampaigns(), in that order.
PaperStudy RunPaperStudy(const std::vector<Campaign>& campaigns, const PaperOptions& options);

}  // namespace dispersa
