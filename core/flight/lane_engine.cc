#include "core/flight/lane_engine.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace dispersa {

// The engines of this build, as CMakeLists.txt lists them: ENGINE(isa, lanes). fly_lanes.cc defines them.
#define ENGINE(isa, lanes) void Fly_##isa##_##lanes(const FlightModel& model, FlightQueue& queue);
DISPERSA_ENGINES
#undef ENGINE

namespace {

bool HasV4() {
  // Instructions that x86-64-v4 has and v3 has not.
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}

LaneEngine Choose() {
  const char* isa = std::getenv("DISPERSA_ISA");
  const char* lanes = std::getenv("DISPERSA_LANES");
  const std::vector<LaneEngine> usable = UsableEngines();
  const bool any_v4 = std::any_of(usable.begin(), usable.end(),
                                  [](const LaneEngine& engine) { return std::string(engine.isa) == "v4"; });
  const std::string level = isa ? isa : any_v4 ? "v4" : "v3";
  // One register of the level: more lanes lack registers and are slower. A build may lack that width.
  const std::string width = lanes ? lanes : level == "v4" ? "8" : "4";
  const LaneEngine* widest = nullptr;
  for (const LaneEngine& engine : usable) {
    if (level != engine.isa) continue;
    if (width == std::to_string(engine.lanes)) return engine;
    if (widest == nullptr || engine.lanes > widest->lanes) widest = &engine;
  }
  if (widest != nullptr && !lanes) return *widest;
  std::string asked;
  if (isa) asked += "DISPERSA_ISA=" + std::string(isa);
  if (lanes) asked += (asked.empty() ? "" : " ") + ("DISPERSA_LANES=" + std::string(lanes));
  throw std::invalid_argument(asked + ": this processor flies with DISPERSA_ISA=" +
                              (HasV4() ? "v3 or v4" : "v3") + " and DISPERSA_LANES=1, 4 or 8");
}

}  // namespace

std::vector<LaneEngine> UsableEngines() {
#define ENGINE(isa, lanes) {#isa, lanes, &Fly_##isa##_##lanes},
  std::vector<LaneEngine> engines = {DISPERSA_ENGINES};
#undef ENGINE
  if (!HasV4())
    std::erase_if(engines, [](const LaneEngine& engine) { return std::string(engine.isa) == "v4"; });
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

const LaneEngine& EngineFor(std::size_t flights) {
  static const std::vector<LaneEngine> narrower = [] {
    std::vector<LaneEngine> engines =
        std::getenv("DISPERSA_LANES") ? std::vector<LaneEngine>() : UsableEngines();
    std::erase_if(engines, [](const LaneEngine& e) {
      return std::string(e.isa) != ChosenEngine().isa || e.lanes >= ChosenEngine().lanes;
    });
    std::sort(engines.begin(), engines.end(),
              [](const LaneEngine& a, const LaneEngine& b) { return a.lanes < b.lanes; });
    return engines;
  }();
  for (const LaneEngine& engine : narrower)
    if (flights <= static_cast<std::size_t>(engine.lanes)) return engine;
  return ChosenEngine();
}

}  // namespace dispersa
