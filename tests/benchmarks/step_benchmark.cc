// Lower bound of a flight's time: its steps alone, without autopilot, metrics and events, and the right-hand
// side.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/lane_engine.h"
#include "core/flight/tick_sample.h"
#include "core/math/rotation.h"
#include "tests/benchmarks/step_instances.h"

namespace dispersa {

// Defined by step_instance.cc; CMakeLists.txt lists them as ENGINE(isa, lanes) ....
#define ENGINE(isa, lanes)                                              \
  void Step_##isa##_##lanes(const StepSetting&, long ticks, double* y); \
  void Evaluate_##isa##_##lanes(const StepSetting&, long evaluations, double* dv);
DISPERSA_ENGINES
#undef ENGINE

std::vector<StepInstance> UsableSteps() {
#define ENGINE(isa, lanes) {#isa, lanes, &Step_##isa##_##lanes, &Evaluate_##isa##_##lanes},
  std::vector<StepInstance> steps = {DISPERSA_ENGINES};
#undef ENGINE
  const std::vector<LaneEngine> usable = UsableEngines();
  std::erase_if(steps, [&](const StepInstance& s) {
    return std::none_of(usable.begin(), usable.end(), [&](const LaneEngine& e) {
      return e.lanes == s.lanes && std::string(e.isa) == s.isa;
    });
  });
  return steps;
}

namespace {

const Campaign& Table3() {
  static const Campaign campaign = LoadCampaign(std::string(DISPERSA_CAMPAIGNS) + "/table3.yaml");
  return campaign;
}

// A state of the first stage's burn at high dynamic pressure: every term of the right-hand side acts.
struct Ascent {
  CampaignFlights flights{Table3()};
  LauncherPlant plant = flights.model().PlantFor(flights.Draw(0));
  FlightWeather weather = PrepareWeather(plant.environment.wind, plant.environment.density);
  StepSetting setting{&plant, &weather, true, 45.0, Table3().autopilot.tick_s, {}};

  Ascent() {
    const LaunchFrame frame = BuildLaunchFrame(plant.environment.earth, Table3().vehicle.site,
                                               Table3().reference.program.launch_azimuth_rad);
    RigidBodyState state;
    state.p_EoC_I = frame.p_EoL_I - 11000.0 * frame.R_IL.col(2);
    state.v_IC_I = frame.v_IL_I + frame.R_IL * Vector3(450.0, 0.0, -450.0);
    state.q_IB = frame.q_IL * FromPitchYawRoll({0.75, 0.01, 0.0});
    WriteState(state, setting.y);
  }
};

struct Ticks {
  long burning = 0, other = 0;
};
Ticks TicksOfTheNominalFlight(const FlightModel& model) {
  Ticks ticks;
  FlightOptions options;
  options.observe = [&](const TickSample& s) { ++(s.burning ? ticks.burning : ticks.other); };
  Fly(model, {}, options);
  return ticks;
}

// As many steps as a nominal flight has, with and without thrust. Items are flights.
void BareFlight(benchmark::State& state, const StepInstance& instance) {
  Ascent ascent;
  const Ticks ticks = TicksOfTheNominalFlight(ascent.flights.model());
  double y[kLauncherSize];
  for (auto _ : state) {
    ascent.setting.burning = true;
    instance.step(ascent.setting, ticks.burning, y);
    ascent.setting.burning = false;
    instance.step(ascent.setting, ticks.other, y);
    benchmark::DoNotOptimize(y);
  }
  state.SetItemsProcessed(state.iterations() * instance.lanes);
}

// Items are evaluations of a lane.
void RightHandSide(benchmark::State& state, const StepInstance& instance) {
  constexpr long kEvaluations = 10000;
  const Ascent ascent;
  double dv[3];
  for (auto _ : state) {
    instance.evaluate(ascent.setting, kEvaluations, dv);
    benchmark::DoNotOptimize(dv);
  }
  state.SetItemsProcessed(state.iterations() * kEvaluations * instance.lanes);
}

const bool kRegistered = [] {
  for (const StepInstance& instance : UsableSteps()) {
    const std::string name = "/" + std::string(instance.isa) + "/" + std::to_string(instance.lanes);
    benchmark::RegisterBenchmark(("BareFlight" + name).c_str(), BareFlight, instance)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("RightHandSide" + name).c_str(), RightHandSide, instance)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace dispersa
