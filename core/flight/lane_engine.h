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

/// The engine with as many lanes as one register holds, 4 or 8, at the highest level of this processor. The
/// environment variables DISPERSA_LANES (1, 4, 8) and DISPERSA_ISA (v3, v4) choose another one. Decided at
/// the first call. Throws std::invalid_argument if the engine asked for does not exist or the processor
/// cannot run it.
const LaneEngine& ChosenEngine();
/// The instance of one lane on the same level; of v3 where the build has none.
const LaneEngine& OneLaneEngine();
/// The narrowest engine of the chosen level (or of v3) with lanes for this number of flights. An empty lane
/// costs as much as a flying one. If DISPERSA_LANES is set, the chosen engine.
const LaneEngine& EngineFor(std::size_t flights);

}  // namespace dispersa
