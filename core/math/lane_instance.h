// For sources that are compiled once for each instruction set and number of lanes
// (core/flight/CMakeLists.txt): their value, and the names of their functions.
#pragma once

#include "core/math/lanes.h"

namespace dispersa {

#if DISPERSA_LANES == 1
using LaneValue = double;
#else
using LaneValue = lanes::Pack<DISPERSA_LANES>;
#endif

}  // namespace dispersa

/// DISPERSA_INSTANCE(Fly) is Fly_v3_4 where four lanes are compiled for x86-64-v3.
#define DISPERSA_INSTANCE(name) DISPERSA_INSTANCE_OF(name, DISPERSA_ISA, DISPERSA_LANES)
#define DISPERSA_INSTANCE_OF(name, isa, lanes) DISPERSA_INSTANCE_NAME(name, isa, lanes)
#define DISPERSA_INSTANCE_NAME(name, isa, lanes) name##_##isa##_##lanes
