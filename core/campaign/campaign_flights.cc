#include "core/campaign/campaign_flights.h"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "core/campaign/contained.h"
#include "core/campaign/contained_flights.h"
#include "core/input/input_error.h"
#include "core/control/law_here.h"
#include "core/flight/flight.h"
#include "core/flight/lane_engine.h"
#include "core/math/functions.h"
#include "core/trajectory/ascent.h"

namespace dispersa {

namespace {

AscentResult FlyReference(const Campaign& campaign) {
  AscentOptions options;
  options.record = true;
  return FlyAscent(BuildAscentModel(campaign.vehicle, campaign.autopilot.tick_s), campaign.reference.program,
                   options);
}

bool Jettisons(const Vehicle& vehicle) {
  return std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                     [](const Stage& stage) { return !stage.jettisoned.empty(); });
}

// The reference's own way up, the same for every autopilot: over the ground, until it leaves the air that
// matters or climbs no more.
ClimbPath ClimbOf(const Campaign& campaign) {
  const AscentResult ascent = FlyReference(campaign);
  ClimbPath path;
  path.azimuth_rad = campaign.reference.program.launch_azimuth_rad;
  const double ground_m = campaign.vehicle.site.altitude_m;
  path.altitude_m = {ground_m};
  path.sine_angle = {1.0};
  for (const AscentSample& s : ascent.samples) {
    // The first metres have no direction yet.
    if (s.altitude_m < ground_m + 1.0) continue;
    if (s.altitude_m <= path.altitude_m.back()) break;
    path.altitude_m.push_back(s.altitude_m);
    path.sine_angle.push_back(Sin(s.relative_path_angle_rad));
  }
  if (path.altitude_m.size() < 2) {  // it never left the ground
    path.altitude_m.push_back(ground_m + 1.0);
    path.sine_angle.push_back(1.0);
  }
  return path;
}

bool MeetsTurbulence(const Campaign& campaign) {
  const int exceedance = FindInput("turbulence_exceedance");
  return std::any_of(campaign.dispersions.begin(), campaign.dispersions.end(), [&](const Dispersion& d) {
    return std::find(d.inputs.begin(), d.inputs.end(), exceedance) != d.inputs.end();
  });
}

FlightDefinition DefinitionOf(const Campaign& campaign) {
  FlightDefinition definition;
  definition.vehicle = campaign.vehicle;
  definition.autopilot = campaign.autopilot;
  definition.program = campaign.reference.attitude;
  definition.last_ignition_s = campaign.reference.last_ignition_s;
  definition.kick_start_s = campaign.reference.program.t1_s;
  definition.kick_end_s = campaign.reference.program.t2_s;
  const TrajectoryProblem& problem = campaign.reference.problem;
  definition.earlier_ignition_s = campaign.reference.earlier_ignition_s;
  // What the target leaves open, or counts from elsewhere, is the reference's.
  const Orbit& reached = campaign.reference.orbit;
  definition.target = {problem.target_apogee_m ? reached.altitude_m : problem.target_altitude_m,
                       problem.velocity_is_free ? reached.velocity_m_s - problem.velocity_reserve_m_s
                                                : problem.target_velocity_m_s,
                       problem.target_flight_path_angle_rad,
                       problem.target_inclination_rad.value_or(reached.inclination_rad)};
  definition.guidance = campaign.guidance;
  definition.velocity_reserve_m_s = problem.velocity_reserve_m_s;
  definition.wind_table = campaign.wind_table;
  definition.wind_statistics = campaign.wind_statistics;
  definition.noise_seed = campaign.sampling.seed;
  if (Jettisons(campaign.vehicle) || CutsOffAtVelocity(campaign.vehicle)) {
    const AscentResult ascent = FlyReference(campaign);
    definition.jettison_s = ascent.jettison_s;
    definition.cut_off_s = ascent.cut_off_s;
  }
  if (MeetsTurbulence(campaign))
    definition.turbulence_path = std::make_shared<const TurbulencePath>(ClimbOf(campaign));
  return definition;
}

// What was flown with a law in Python can be read by everybody, and flown by who has the law.
const Campaign& WithItsLaw(const Campaign& campaign) {
  const auto& plugin = campaign.autopilot.plugin;
  if (plugin && IsAbsent(*plugin)) {
    throw InputError(
        "flown with a Python law, '" + plugin->name + "', which is not here: its cases cannot be flown again",
        "in Python, with that law as law=...");
  }
  return campaign;
}

}  // namespace

CampaignFlights::CampaignFlights(const Campaign& campaign)
    : design_(WithItsLaw(campaign)), model_(std::make_unique<FlightModel>(DefinitionOf(campaign))) {
  HistoryColumns();  // made here: a child may be forked while another thread would make them
  MetricNames();
}

CampaignFlights::~CampaignFlights() = default;

CaseResult CampaignFlights::FlyCase(std::uint64_t case_index, History* history) const {
  return Fly(Draw(case_index), case_index, history);
}

CaseResult CampaignFlights::FlyNominal(History* history) const { return Fly(FlightInputs{}, 0, history); }

CaseResult CampaignFlights::Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                                Scheme scheme) const {
  if (NeedsChild()) return FlyContained(*this, inputs, case_index, history, scheme);
  FlightOptions options;
  options.scheme = scheme;
  options.case_index = case_index;
  options.history = history;
  return ResultOf(*model_, case_index, inputs, dispersa::Fly(*model_, inputs, options));
}

namespace {

// The cases of a queue as flights of the engine.
class FlyingCases : public FlightQueue {
 public:
  FlyingCases(const CampaignFlights& flights, CaseQueue& cases) : flights_(flights), cases_(cases) {}

  FlightRecord* Next(bool idle) override {
    const std::optional<std::uint64_t> case_index = cases_.Next(idle);
    if (!case_index) return nullptr;
    FlightOrder order{flights_.Draw(*case_index), {}};
    order.options.case_index = *case_index;
    auto record = std::make_unique<FlightRecord>(flights_.model(), order);
    FlightRecord* const flying = record.get();
    flying_[flying] = std::move(record);
    return flying;
  }
  void Done(FlightRecord* record) override {
    const auto ended = flying_.extract(record);
    cases_.Done(ResultOf(flights_.model(), record->options.case_index, record->inputs, record->Result()));
  }

 private:
  const CampaignFlights& flights_;
  CaseQueue& cases_;
  std::map<FlightRecord*, std::unique_ptr<FlightRecord>> flying_;
};

// A list of cases that threads share.
struct SharedOrders {
  const CampaignFlights& flights;
  const std::vector<CaseOrder>& orders;
  const CaseObserver& done;
  std::mutex mutex = {};
  std::size_t next = 0;
  std::exception_ptr problem = {};

  std::optional<std::size_t> Next() {
    const std::lock_guard lock(mutex);
    if (next == orders.size() || problem) return std::nullopt;
    return next++;
  }
  void Done(std::size_t order, CaseResult result, const History& history) {
    const std::lock_guard lock(mutex);
    if (problem) return;
    try {
      done(order, std::move(result), history);
    } catch (...) {
      problem = std::current_exception();
    }
  }
};

// What one thread flies of them.
class FlyingOrders : public FlightQueue {
 public:
  explicit FlyingOrders(SharedOrders& shared) : shared_(shared) {}

  FlightRecord* Next(bool) override {
    const std::optional<std::size_t> order = shared_.Next();
    if (!order) return nullptr;
    const CaseOrder& wanted = shared_.orders[*order];
    auto flight = std::make_unique<InFlight>();
    flight->order = *order;
    FlightOrder to_fly{shared_.flights.Draw(wanted.case_index), {}};
    to_fly.options.case_index = wanted.case_index;
    if (wanted.history_step_s > 0.0) {
      flight->history.step_s = wanted.history_step_s;
      to_fly.options.history = &flight->history;
    }
    flight->record = std::make_unique<FlightRecord>(shared_.flights.model(), to_fly);
    FlightRecord* const record = flight->record.get();
    flying_[record] = std::move(flight);
    return record;
  }
  void Done(FlightRecord* record) override {
    const auto ended = flying_.extract(record);
    CaseResult result =
        ResultOf(shared_.flights.model(), record->options.case_index, record->inputs, record->Result());
    shared_.Done(ended.mapped()->order, std::move(result), ended.mapped()->history);
  }

 private:
  struct InFlight {
    std::size_t order = 0;
    History history;
    std::unique_ptr<FlightRecord> record;
  };
  SharedOrders& shared_;
  std::map<FlightRecord*, std::unique_ptr<InFlight>> flying_;
};

// The same where every flight has a process of its own.
void FlyOneByOne(SharedOrders& shared) {
  while (const std::optional<std::size_t> order = shared.Next()) {
    const CaseOrder& wanted = shared.orders[*order];
    History history;
    history.step_s = wanted.history_step_s;
    try {
      CaseResult result =
          shared.flights.FlyCase(wanted.case_index, wanted.history_step_s > 0.0 ? &history : nullptr);
      shared.Done(*order, std::move(result), history);
    } catch (...) {
      const std::lock_guard lock(shared.mutex);
      if (!shared.problem) shared.problem = std::current_exception();
    }
  }
}

}  // namespace

bool CampaignFlights::NeedsChild() const {
  const PluginLaw* const plugin = model_->autopilot().plugin.get();
  return plugin != nullptr && !IsContained() && FunctionsHere(plugin->config()) == nullptr;
}

void CampaignFlights::FlyCases(CaseQueue& queue) const {
  if (NeedsChild()) return FlyContained(*this, queue);
  FlyingCases flying(*this, queue);
  ChosenEngine().fly(*model_, flying);
}

void CampaignFlights::FlyCases(const std::vector<CaseOrder>& orders, int threads,
                               const CaseObserver& done) const {
  SharedOrders shared{*this, orders, done};
  const auto fly = [&] {
    if (NeedsChild()) return FlyOneByOne(shared);
    FlyingOrders flying(shared);
    ChosenEngine().fly(*model_, flying);
  };
  {
    std::vector<std::jthread> others;  // joined at the end of this block
    const auto useful = (orders.size() + static_cast<std::size_t>(ChosenEngine().lanes) - 1) /
                        static_cast<std::size_t>(ChosenEngine().lanes);
    for (std::size_t i = 1; i < std::min(useful, static_cast<std::size_t>(std::max(1, threads))); ++i)
      others.emplace_back(fly);
    fly();
  }
  if (shared.problem) std::rethrow_exception(shared.problem);
}

}  // namespace dispersa
