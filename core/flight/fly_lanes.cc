// The engine of one width for one instruction set: compiled once for each (CMakeLists.txt).
#include "core/flight/batch.h"
#include "core/flight/batch_events.h"
#include "core/flight/batch_pass.h"
#include "core/math/lane_instance.h"

namespace dispersa {

void DISPERSA_INSTANCE(Fly)(const FlightModel& model, FlightQueue& queue) {
  lanes::Batch<LaneValue>* batch = new lanes::Batch<LaneValue>(model, queue);
  batch->Run();
  delete batch;
}

}  // namespace dispersa
