// Which instance of the engine flies: how many lanes, compiled for which instruction set.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/flight/flight_queue.h"

namespace dispersa {

struct LaneEngine {
  const char* isa;                                            ///< "v3" or "v4": the x86-64 level
  int lanes;                                                  ///< 1, 4 or 8
  void (*fly)(const FlightModel& model, FlightQueue& queue);  ///< until the queue is empty
};

/// All that this processor can run. The bits of a flight are the same in each.
std::vector<LaneEngine> UsableEngines();

/// As many lanes as one register holds, 4 or 8, on the highest level that this processor has; or what
/// DISPERSA_LANES (1, 4, 8) and DISPERSA_ISA (v3, v4) ask for. Decided at the first call. Throws
/// std::invalid_argument when they ask for what there is not.
const LaneEngine& ChosenEngine();
/// The instance of one lane on the same level.
const LaneEngine& OneLaneEngine();
/// The chosen instance; or, unless DISPERSA_LANES asks for it, the narrowest on its level that holds so many
/// flights at once: a lane that stays empty costs as much as one that flies.
const LaneEngine& EngineFor(std::size_t flights);

}  // namespace dispersa
