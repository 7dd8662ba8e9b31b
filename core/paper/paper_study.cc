#include "core/paper/paper_study.h"

#include <algorithm>
#include <set>

#include "core/campaign/case_design.h"
#include "core/cases/campaign_flights.h"
#include "core/control/lyapunov.h"

namespace dispersa {
namespace {

constexpr double kStep_s = 0.1;
/// Flights that a band is made of: enough for its 5 and 95 % curves.
constexpr std::uint64_t kBandFlights = 100;

PaperHistories FlyHistories(const PaperFlights& flown, int threads) {
  std::vector<int> columns;
  for (const char* name : {"pitch_launch_deg", "pitch_error_deg", "deflection_pitch_deg", "qbar_pa",
                           "lyapunov_v", "lyapunov_v_rate_sign", "stage"})
    columns.push_back(FindHistoryColumn(name));
  const CampaignFlights flights(flown.campaign);
  PaperHistories histories;
  std::vector<CaseOrder> orders;
  for (std::uint64_t i = 0; i < std::min(flown.campaign.sampling.cases, kBandFlights); ++i)
    orders.push_back({i, kStep_s});
  histories.flights.resize(orders.size());
  flights.FlyCases(orders, threads, [&](std::size_t i, const CaseResult&, const History& history) {
    histories.flights[i] = SampleFlight(history, columns, kStep_s);
  });
  histories.drawn.bands = ComputeBands(histories.flights, columns, kStep_s);
  histories.drawn.nominal_history.step_s = kStep_s;
  histories.drawn.nominal = flights.FlyNominal(&histories.drawn.nominal_history);
  return histories;
}

BadPn FlyBadPn(Campaign campaign, double factor) {
  BadPn bad;
  AxisConfig& pitch = campaign.autopilot.pitch;
  bad.p_n = factor * SolveLyapunov(pitch.gains[0], pitch.adaptation.q).col(1);
  pitch.adaptation.p_n = bad.p_n;
  pitch.adaptation.allow_unproven = false;
  const int stages = static_cast<int>(campaign.vehicle.stages.size());
  for (const StructProblem& problem : Problems(campaign.autopilot, stages))
    bad.refusal += problem.path + ": " + problem.message + ", allowed: " + problem.allowed;
  pitch.adaptation.allow_unproven = true;
  const CampaignFlights flights(campaign);
  FlightInputs inputs = flights.Draw(0);
  inputs.pn_error_factor = inputs.pn_rate_factor = 1.0;
  bad.flight = flights.Fly(inputs, 0, nullptr);
  return bad;
}

// P_n moves no trajectory that a linearisation would see: every choice is judged along the nominal flight.
std::vector<LeastMargins> PnMargins(const PaperFlights& sweep) {
  const CampaignFlights flights(sweep.campaign);
  const FlightModel& model = flights.model();
  const std::vector<MarginInstant> instants = MarginInstants(model);
  const std::vector<double> errors = sweep.Input("pn_error_factor"), rates = sweep.Input("pn_rate_factor");
  std::vector<LeastMargins> all(sweep.cases.rows());
  for (std::size_t row = 0; row < all.size(); ++row) {
    AutopilotModel autopilot = model.autopilot();
    for (StageLaw& stage : autopilot.laws[kPitch].stages) {
      stage.pn_error *= errors[row];
      stage.pn_rate *= rates[row];
    }
    for (const MarginInstant& instant : instants)
      all[row].Take(
          MarginsAt(model.nominal_plant(), model.sensors(), autopilot, instant.sample, kPitch, true));
  }
  return all;
}

CompletionMargins LeastOf(const std::string& input, double factor,
                          const std::vector<ComputedMargins>& computed,
                          const std::vector<MeasuredMargins>& measured) {
  CompletionMargins all{input, factor, {}, {}, true};
  for (const ComputedMargins& m : computed) {
    for (const LoopMargins* margins : {&m.frozen, &m.adapting}) {
      all.computed.Take(*margins);
      all.passed = all.passed && PassesGates(*margins);
    }
  }
  for (const MeasuredMargins& m : measured) {
    all.measured.gain_db = std::min({all.measured.gain_db, m.gain_up_db, m.gain_down_db});
    all.measured.delay_s = std::min(all.measured.delay_s, m.delay_s);
    all.passed = all.passed && PassesGates(m);
  }
  return all;
}

// As shipped, then each setting of the sweep that moves a completion, in the order of the page.
std::vector<CompletionMargins> MarginsOfCompletions(const PaperStudy& study) {
  const PaperFlights& sweep = study.at("completions");
  const CampaignFlights flights(sweep.campaign);
  std::vector<CompletionMargins> all = {LeastOf("", 1.0, study.computed_margins, study.measured_margins)};
  for (const std::string& input : PaperCompletions()) {
    const std::vector<double> column = sweep.Input(input);
    for (const double factor : std::set<double>(column.begin(), column.end())) {
      if (factor == 1.0) continue;
      FlightInputs inputs;
      InputValue(inputs, FindInput(input)) = factor;
      all.push_back(LeastOf(input, factor, ComputeMargins(flights.model(), 5.0, inputs),
                            MeasureMargins(flights.model(), inputs)));
    }
  }
  return all;
}

}  // namespace

std::vector<double> PaperFlights::Input(const std::string& name) const {
  return cases.inputs[static_cast<std::size_t>(FindInput(name))];
}

const std::vector<PaperCampaign>& PaperCampaigns() {
  static const std::vector<PaperCampaign> campaigns = {
      {"nominal", "Figs. 6 to 9, the nominal flight"},
      {"table3", "Table 3, the bands of Figs. 6 to 9, the statistics of V", true},
      {"pn_curves", "Fig. 5, error over time"},
      {"pn_sweep", "Fig. 5, maps"},
      {"aero20_quiet", "Fig. 10, the 16 corners", true},
      {"aero20", "Fig. 10, the 16 corners with Table 3", true},
      {"aero20_one_at_a_time_quiet", "Fig. 10, one at a time", true},
      {"aero20_one_at_a_time", "Fig. 10, one at a time with Table 3"},
      {"aero20_monte_carlo_quiet", "Fig. 10, Monte Carlo", true},
      {"aero20_monte_carlo", "Fig. 10, Monte Carlo with Table 3", true},
      {kPaperLaw, "the paper's law on Table 3, cases that no tuning used"},
      {"controllers_frozen_fuzzy", "the frozen rules on the same cases"},
      {"controllers_pd", "scheduled PD on the same cases"},
      {"controllers_pid", "scheduled PID on the same cases"},
      {"controllers_lqr", "a linear-quadratic regulator with integral on the same cases"},
      {"controllers_pd_aac", "PD with adaptive augmenting control on the same cases"},
      {"controllers_pid_aac", "PID with adaptive augmenting control on the same cases"},
      {"completions", "what we added to the vehicle, swept"},
  };
  return campaigns;
}

const std::vector<std::string>& PaperBaselines() {
  static const std::vector<std::string> names = {"controllers_frozen_fuzzy", "controllers_pd",
                                                 "controllers_pid",          "controllers_lqr",
                                                 "controllers_pd_aac",       "controllers_pid_aac"};
  return names;
}

const std::vector<std::string>& PaperCompletions() {
  static const std::vector<std::string> inputs = {"inertia_factor", "cp_factor", "cg_factor",
                                                  "actuator_bandwidth_factor"};
  return inputs;
}

std::uint64_t PaperCases(const Campaign& campaign, std::uint64_t cases) {
  if (campaign.dispersions.empty()) return 1;
  const std::uint64_t size = DesignSize(campaign);
  if (size == 1) return cases;
  // Without random dispersions every repetition is the same flight again.
  if (campaign.sampling.cases <= size) return size;
  constexpr std::uint64_t kCasesPerRepetition = 25;
  return size * std::clamp<std::uint64_t>(cases / kCasesPerRepetition, 1, campaign.sampling.cases / size);
}

void FlyBeside(PaperStudy& study, int threads,
               const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  constexpr std::uint64_t kSteps = 6;
  std::uint64_t done = 0;
  for (const char* name : {"table3", "aero20_quiet", "pn_curves"}) {
    progress(done++, kSteps);
    study.histories.emplace(name, FlyHistories(study.at(name), threads));
  }
  progress(done++, kSteps);
  // A P_n of the wrong sign, which feeds the error back positively, and one too large for the actuators.
  for (const double factor : {-1.0, 100.0})
    study.bad_pn.push_back(FlyBadPn(study.at("pn_curves").campaign, factor));
  progress(done++, kSteps);
  study.pn_margins = PnMargins(study.at("pn_sweep"));
  progress(done++, kSteps);
  study.completion_margins = MarginsOfCompletions(study);
  progress(kSteps, kSteps);
}

}  // namespace dispersa
