#include "core/paper/paper_study.h"

#include <algorithm>
#include <set>

#include "core/campaign/case_design.h"
#include "core/cases/campaign_flights.h"
#include "core/control/lyapunov.h"
#include "core/math/assertion.h"

namespace dispersa {
namespace {

constexpr double kHistoryStep_s = 0.1;
/// Time histories that a band is made of: enough for its 5 and 95 % curves.
constexpr std::uint64_t kBandFlights = 100;

std::vector<int> HistoryColumnsKept() {
  std::vector<int> columns(kPaperColumns);
  columns[kPitchLaunch] = FindHistoryColumn("pitch_launch_deg");
  columns[kPitchError] = FindHistoryColumn("pitch_error_deg");
  columns[kDeflection] = FindHistoryColumn("deflection_pitch_deg");
  columns[kLyapunovV] = FindHistoryColumn("lyapunov_v");
  columns[kLyapunovSign] = FindHistoryColumn("lyapunov_v_rate_sign");
  columns[kStage] = FindHistoryColumn("stage");
  return columns;
}

/// Whole repetitions of a design, about `cases` divided by `share` of them; once when everything is planned.
std::uint64_t CasesOf(const Campaign& campaign, std::uint64_t cases) {
  const std::uint64_t size = DesignSize(campaign);
  if (size == 1) return cases;
  // Without random dispersions every repetition is the same flight again.
  if (campaign.sampling.cases <= size) return size;
  constexpr std::uint64_t kCasesPerRepetition = 25;
  return size * std::clamp<std::uint64_t>(cases / kCasesPerRepetition, 1, campaign.sampling.cases / size);
}

BadPn FlyBadPn(Campaign campaign, double factor) {
  BadPn bad;
  AxisConfig& pitch = campaign.autopilot.pitch;
  bad.factor = factor;
  bad.p_n = factor * SolveLyapunov(pitch.gains[0], pitch.adaptation.q).col(1);
  pitch.adaptation.p_n = bad.p_n;
  pitch.adaptation.allow_unproven = false;
  const int stages = static_cast<int>(campaign.vehicle.stages.size());
  for (const StructProblem& problem : Problems(campaign.autopilot, stages)) {
    bad.refusal += problem.path + ": " + problem.message + ", allowed: " + problem.allowed;
  }
  pitch.adaptation.allow_unproven = true;
  const CampaignFlights flights(campaign);
  FlightInputs inputs = flights.Draw(0);
  inputs.pn_error_factor = inputs.pn_rate_factor = 1.0;
  bad.flight = flights.Fly(inputs, 0, nullptr);
  return bad;
}

PaperInjection FlyInjection(const Campaign& nominal, const CaseResult& flown) {
  PaperInjection injection;
  injection.propellant_kg = flown.metrics[MetricColumn("rcs_propellant_kg")];
  AscentModel model = BuildAscentModel(nominal.vehicle, nominal.autopilot.tick_s);
  AscentOptions options;
  options.steps = TrajectoryOptions{}.steps;
  injection.point_mass = FlyAscent(model, nominal.reference.program, options).orbit;
  model.reaction_control_propellant_kg = injection.propellant_kg;
  injection.lighter_point_mass = FlyAscent(model, nominal.reference.program, options).orbit;
  return injection;
}

// P_n moves no trajectory that a linearisation would see: every choice is judged along the nominal flight.
std::vector<LeastMargins> PnMargins(const PaperFlights& sweep) {
  const CampaignFlights flights(sweep.campaign);
  const FlightModel& model = flights.model();
  const std::vector<MarginInstant> instants = MarginInstants(model);
  const std::vector<double>& errors =
      sweep.flights.cases.inputs[static_cast<std::size_t>(FindInput("pn_error_factor"))];
  const std::vector<double>& rates =
      sweep.flights.cases.inputs[static_cast<std::size_t>(FindInput("pn_rate_factor"))];
  std::vector<LeastMargins> all(errors.size());
  for (std::size_t row = 0; row < errors.size(); ++row) {
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

CompletionMargins MarginsOf(const FlightModel& model, const std::string& input, double factor) {
  CompletionMargins all;
  all.input = input;
  all.factor = factor;
  all.passed = true;
  FlightInputs inputs;
  if (!input.empty()) InputValue(inputs, FindInput(input)) = factor;
  for (const ComputedMargins& m : ComputeMargins(model, 5.0, inputs)) {
    for (const LoopMargins* margins : {&m.frozen, &m.adapting}) {
      all.computed.Take(*margins);
      all.passed = all.passed && PassesGates(*margins);
    }
  }
  for (const MeasuredMargins& m : MeasureMargins(model, inputs)) {
    all.measured.gain_db = std::min({all.measured.gain_db, m.gain_up_db, m.gain_down_db});
    all.measured.delay_s = std::min(all.measured.delay_s, m.delay_s);
    all.passed = all.passed && PassesGates(m);
  }
  return all;
}

// As shipped, then each setting of the sweep that moves a completion, in the order of the page.
std::vector<CompletionMargins> MarginsOfCompletions(const PaperFlights& sweep) {
  const CampaignFlights flights(sweep.campaign);
  std::vector<CompletionMargins> all = {MarginsOf(flights.model(), "", 1.0)};
  for (const std::string& input : PaperCompletions()) {
    const std::vector<double>& column =
        sweep.flights.cases.inputs[static_cast<std::size_t>(FindInput(input))];
    for (const double factor : std::set<double>(column.begin(), column.end()))
      if (factor != 1.0) all.push_back(MarginsOf(flights.model(), input, factor));
  }
  return all;
}

}  // namespace

const std::vector<PaperCampaign>& PaperCampaigns() {
  static const std::vector<PaperCampaign> campaigns = {
      {"nominal", "Figs. 6 to 9, the nominal flight"},
      {"table3", "Table 3, the bands of Figs. 6 to 9, the statistics of V"},
      {"pn_curves", "Fig. 5, error over time"},
      {"pn_sweep", "Fig. 5, maps"},
      {"aero20_quiet", "Fig. 10, the 16 corners"},
      {"aero20", "Fig. 10, the 16 corners with Table 3"},
      {"aero20_one_at_a_time_quiet", "Fig. 10, one at a time"},
      {"aero20_one_at_a_time", "Fig. 10, one at a time with Table 3"},
      {"aero20_monte_carlo_quiet", "Fig. 10, Monte Carlo"},
      {"aero20_monte_carlo", "Fig. 10, Monte Carlo with Table 3"},
      {"controllers", "the paper's law on Table 3, cases that no tuning used"},
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

PaperStudy RunPaperStudy(const std::vector<Campaign>& campaigns, const PaperOptions& options) {
  DISPERSA_ASSERT(campaigns.size() == PaperCampaigns().size(), campaigns.size());
  const auto progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (options.progress) options.progress(what, done, total);
  };
  PaperStudy study;
  study.cases = options.cases;

  const Campaign& nominal = campaigns.front();
  TrajectoryOptions trajectory;
  trajectory.tick_s = nominal.autopilot.tick_s;
  trajectory.threads = options.threads;
  const auto generations = static_cast<std::uint64_t>(nominal.reference.problem.generations);
  study.optimization = OptimizeTrajectory(
      nominal.vehicle, nominal.reference.problem, trajectory, [&](const GenerationRecord& record) {
        progress("optimize", static_cast<std::uint64_t>(record.generation), generations);
      });

  study.nominal_autopilot = nominal.autopilot;
  study.nominal_history.step_s = kHistoryStep_s;
  const CampaignFlights nominal_flights(nominal);
  study.nominal = nominal_flights.FlyNominal(&study.nominal_history);
  progress("margins", 0, 1);
  study.computed_margins = ComputeMargins(nominal_flights.model());
  study.measured_margins = MeasureMargins(nominal_flights.model());
  study.injection = FlyInjection(nominal, study.nominal);
  progress("margins", 1, 1);

  for (std::size_t i = 1; i < campaigns.size(); ++i) {
    const std::string& name = PaperCampaigns()[i].name;
    StudyOptions flown;
    flown.cases = CasesOf(campaigns[i], options.cases);
    flown.histories = kBandFlights;
    flown.columns = HistoryColumnsKept();
    flown.step_s = kHistoryStep_s;
    flown.threads = options.threads;
    flown.progress = [&](std::uint64_t done) { progress(name, done, flown.cases); };
    study.campaigns.emplace(name, PaperFlights{campaigns[i], FlyStudy(campaigns[i], flown)});
  }
  progress("margins of sweeps", 0, 1);
  study.pn_margins = PnMargins(study.at("pn_sweep"));
  study.completion_margins = MarginsOfCompletions(study.at("completions"));
  progress("margins of sweeps", 1, 1);
  // A P_n of the wrong sign, which feeds the error back positively, and one too large for the actuators.
  for (const double factor : {-1.0, 100.0})
    study.bad_pn.push_back(FlyBadPn(study.at("pn_curves").campaign, factor));
  return study;
}

}  // namespace dispersa
