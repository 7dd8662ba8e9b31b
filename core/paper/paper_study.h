// All data of the paper's page: the campaigns behind its figures as they were flown, the optimised
// trajectory, and the few flights that belong to no campaign.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/comparison.h"
#include "core/margins/flight_margins.h"
#include "core/pages/histories.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// A campaign of the page, and its purpose.
struct PaperCampaign {
  std::string name;        ///< of the file without its ending, and of the result folder
  std::string shows;       ///< for readers
  bool over_time = false;  ///< its report has time histories, which take as long as a hundred flights
};
/// In the order of the page. The first is the nominal flight.
const std::vector<PaperCampaign>& PaperCampaigns();

/// The campaign of the paper's law, and those that fly other autopilots on its cases.
inline constexpr char kPaperLaw[] = "controllers";
const std::vector<std::string>& PaperBaselines();

/// Inputs that "completions" sweeps.
const std::vector<std::string>& PaperCompletions();

/// Of a study with `cases` cases of a Monte Carlo campaign: a design is repeated in proportion.
std::uint64_t PaperCases(const Campaign& campaign, std::uint64_t cases);

/// A result folder of the study.
struct PaperFlights {
  Campaign campaign;             ///< as flown
  std::uint64_t file_cases = 0;  ///< of the campaign's file
  CampaignSummary summary;
  CaseColumns cases;  ///< with all inputs

  std::vector<double> Input(const std::string& name) const;
  std::vector<double> Metric(const std::string& name) const { return MeasuredValues(cases, name); }
};

/// First flights of a campaign, flown again with time histories every 0.1 s.
struct PaperHistories {
  std::vector<SampledFlight> flights;  ///< shape (flights, kPaperColumns, steps)
  FlightHistories drawn;               ///< the nominal flight, and bands over the flights
};
/// Columns of the time histories, in this order.
enum PaperColumn {
  kPitchLaunch,
  kPitchError,
  kDeflection,
  kDynamicPressure,
  kV,
  kVSign,
  kStage,
  kPaperColumns
};

/// A deliberately bad P_n of the pitch axis: the error message about it, and its flight if it is allowed.
struct BadPn {
  Vector2 p_n = Vector2::Zero();
  std::string refusal;  ///< why an autopilot file with it is refused
  CaseResult flight;    ///< with allow_unproven
};

/// A completion of the vehicle away from its value, and the margins of the loop there.
struct CompletionMargins {
  std::string input;  ///< "inertia_factor"; empty: as shipped
  double factor = 1.0;
  LeastMargins computed;  ///< all axes and instants, gains frozen and adapting
  LeastMargins measured;  ///< all stages; no phase
  bool passed = false;    ///< every gate of both
};

struct PaperStudy {
  OptimizationResult optimization;
  std::vector<ComputedMargins> computed_margins;  ///< of the nominal's autopilot
  std::vector<MeasuredMargins> measured_margins;
  std::map<std::string, PaperFlights> campaigns;  ///< by name
  std::map<std::string, Comparison> comparisons;  ///< of each baseline with the paper's law

  // Of FlyBeside().
  std::map<std::string, PaperHistories> histories;  ///< of "table3", "aero20_quiet" and "pn_curves"
  std::vector<BadPn> bad_pn;
  std::vector<LeastMargins> pn_margins;  ///< of each case of "pn_sweep": pitch, adapting, computed
  std::vector<CompletionMargins> completion_margins;  ///< as shipped first

  const PaperFlights& at(const std::string& name) const { return campaigns.at(name); }
  const CaseResult& nominal() const { return histories.at("table3").drawn.nominal; }
};

/// The flights and margins that no campaign has. They do not depend on `threads`. `progress` gets the number
/// of steps done, and of all.
void FlyBeside(PaperStudy& study, int threads,
               const std::function<void(std::uint64_t, std::uint64_t)>& progress);

}  // namespace dispersa
