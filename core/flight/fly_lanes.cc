// The engine of one width for one instruction set: compiled once for each (CMakeLists.txt).
#include "core/flight/batch.h"
#include "core/flight/batch_events.h"
#include "core/flight/batch_pass.h"

#if DISPERSA_LANES == 1
using Value = double;
#else
using Value = dispersa::lanes::Pack<DISPERSA_LANES>;
#endif

#define DISPERSA_JOIN(a, b, c) a##b##_##c
#define DISPERSA_NAME(isa, width) DISPERSA_JOIN(Fly_, isa, width)

namespace dispersa {

void DISPERSA_NAME(DISPERSA_ISA, DISPERSA_LANES)(const FlightModel& model, FlightQueue& queue) {
  lanes::Batch<Value>* batch = new lanes::Batch<Value>(model, queue);
  batch->Run();
  delete batch;
}

}  // namespace dispersa
