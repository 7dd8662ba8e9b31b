// Time of an ascent of the optimiser in 1, 4 and 8 lanes, and of a whole optimisation, on one core.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {
namespace {

const OptimizationInput& Input() {
  static const OptimizationInput input =
      LoadOptimization(std::string(DISPERSA_CAMPAIGNS) + "/slv4_500km.yaml");
  return input;
}

// A generation's worth, spread over the coast so that lanes do not end together. Items are ascents.
void Ascents(benchmark::State& state) {
  const AscentModel model = BuildAscentModel(Input().vehicle, Input().tick_s);
  const FlightProgram shipped =
      LoadReference(std::string(DISPERSA_CAMPAIGNS) + "/references/slv4_500km.yaml").program;
  std::vector<FlightProgram> programs(64, shipped);
  for (std::size_t i = 0; i < programs.size(); ++i) programs[i].coast_s -= static_cast<double>(i);
  AscentOptions options;
  options.steps = TrajectoryOptions{}.search_steps;
  for (auto _ : state)
    benchmark::DoNotOptimize(FlyAscents(model, programs, options, static_cast<int>(state.range(0))));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(programs.size()));
}
BENCHMARK(Ascents)->Arg(1)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);

void Optimisation(benchmark::State& state) {
  TrajectoryOptions options;
  options.tick_s = Input().tick_s;
  for (auto _ : state)
    benchmark::DoNotOptimize(OptimizeTrajectory(Input().vehicle, Input().problem, options));
}
BENCHMARK(Optimisation)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dispersa
