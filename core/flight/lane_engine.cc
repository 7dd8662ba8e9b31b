#include "core/flight/lane_engine.h"

#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <tuple>

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

// The fastest that the environment allows: of the newest level, with the lanes of one register. More lanes
// lack registers and are slower.
LaneEngine Choose() {
  const char* isa = std::getenv("DISPERSA_ISA");
  const char* lanes = std::getenv("DISPERSA_LANES");
  const auto speed = [](const LaneEngine& engine) {
    const bool is_v4 = std::string_view(engine.isa) == "v4", fills_register = engine.lanes == (is_v4 ? 8 : 4);
    return std::tuple(is_v4, fills_register, engine.lanes);
  };
  const std::vector<LaneEngine> usable = UsableEngines();
  const LaneEngine* best = nullptr;
  std::string allowed;
  for (const LaneEngine& engine : usable) {
    allowed += (allowed.empty() ? "" : ", ") + std::string(engine.isa) + " " + std::to_string(engine.lanes);
    if (isa != nullptr && std::string_view(isa) != engine.isa) continue;
    if (lanes != nullptr && lanes != std::to_string(engine.lanes)) continue;
    if (best == nullptr || speed(*best) < speed(engine)) best = &engine;
  }
  if (best != nullptr) return *best;
  std::string asked;
  if (isa != nullptr) asked += "DISPERSA_ISA=" + std::string(isa);
  if (lanes != nullptr) asked += (asked.empty() ? "" : " ") + ("DISPERSA_LANES=" + std::string(lanes));
  throw std::invalid_argument(asked + ": no engine of this build on this processor, allowed: " + allowed);
}

// Of the chosen level; or of v3, whose bits are the same, where a build leaves that width out.
const LaneEngine& Narrowest(std::size_t flights) {
  static const std::vector<LaneEngine> usable = UsableEngines();
  const LaneEngine* found = &ChosenEngine();
  const std::string_view level = found->isa;
  for (const LaneEngine& engine : usable) {
    const bool is_of_level = level == engine.isa;
    if ((!is_of_level && std::string_view(engine.isa) != "v3") ||
        flights > static_cast<std::size_t>(engine.lanes))
      continue;
    if (engine.lanes < found->lanes || (engine.lanes == found->lanes && is_of_level)) found = &engine;
  }
  return *found;
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

const LaneEngine& OneLaneEngine() { return Narrowest(1); }

const LaneEngine& EngineFor(std::size_t flights) {
  return std::getenv("DISPERSA_LANES") != nullptr ? ChosenEngine() : Narrowest(flights);
}

}  // namespace dispersa
