// The engine for one instruction set, once for each number of lanes: DISPERSA_WIDTHS is WIDTH(1) WIDTH(4) ...
// (CMakeLists.txt).
#include <memory>

#include "core/flight/batch.h"
#include "core/flight/batch_events.h"
#include "core/flight/batch_pass.h"
#include "core/math/lane_instance.h"

namespace dispersa {

#define WIDTH(lane_count)                                                                 \
  void DISPERSA_INSTANCE(Fly, lane_count)(const FlightModel& model, FlightQueue& queue) { \
    using Batch = lanes::Batch<LaneValue<lane_count>>;                                    \
    const std::unique_ptr<Batch> batch(new Batch(model, queue)); /* laws may throw */     \
    batch->Run();                                                                         \
  }
DISPERSA_WIDTHS
#undef WIDTH

}  // namespace dispersa
