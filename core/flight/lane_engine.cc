#include "core/flight/lane_engine.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace dispersa {

// Defined by fly_lanes.cc.
void Fly_v3_1(const FlightModel& model, FlightQueue& queue);
void Fly_v3_4(const FlightModel& model, FlightQueue& queue);
void Fly_v3_8(const FlightModel& model, FlightQueue& queue);
void Fly_v4_1(const FlightModel& model, FlightQueue& queue);
void Fly_v4_4(const FlightModel& model, FlightQueue& queue);
void Fly_v4_8(const FlightModel& model, FlightQueue& queue);

namespace {

bool HasV4() {
  // What x86-64-v4 adds to v3.
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}

LaneEngine Choose() {
  const char* isa = std::getenv("DISPERSA_ISA");
  const char* lanes = std::getenv("DISPERSA_LANES");
  const std::vector<LaneEngine> usable = UsableEngines();
  const std::string level = isa ? isa : HasV4() ? "v4" : "v3";
  // One register of the level; more are slower for want of registers.
  const std::string width = lanes ? lanes : level == "v4" ? "8" : "4";
  for (const LaneEngine& engine : usable)
    if (level == engine.isa && width == std::to_string(engine.lanes)) return engine;
  std::string asked;
  if (isa) asked += "DISPERSA_ISA=" + std::string(isa);
  if (lanes) asked += (asked.empty() ? "" : " ") + ("DISPERSA_LANES=" + std::string(lanes));
  throw std::invalid_argument(asked + ": this processor flies with DISPERSA_ISA=" + (HasV4() ? "v3 or v4" : "v3") +
                           " and DISPERSA_LANES=1, 4 or 8");
}

}  // namespace

std::vector<LaneEngine> UsableEngines() {
  std::vector<LaneEngine> engines = {{"v3", 1, &Fly_v3_1}, {"v3", 4, &Fly_v3_4}, {"v3", 8, &Fly_v3_8}};
  if (HasV4()) engines.insert(engines.end(), {{"v4", 1, &Fly_v4_1}, {"v4", 4, &Fly_v4_4}, {"v4", 8, &Fly_v4_8}});
  return engines;
}

const LaneEngine& ChosenEngine() {
  static const LaneEngine engine = Choose();
  return engine;
}

const LaneEngine& OneLaneEngine() {
  static const LaneEngine engine = [] {
    const std::vector<LaneEngine> usable = UsableEngines();
    return *std::find_if(usable.begin(), usable.end(), [](const LaneEngine& e) {
      return e.lanes == 1 && std::string(e.isa) == ChosenEngine().isa;
    });
  }();
  return engine;
}

}  // namespace dispersa
