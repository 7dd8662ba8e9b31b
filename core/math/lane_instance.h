// For sources that are compiled once for each instruction set and for several numbers of lanes
// (core/flight/CMakeLists.txt): the lanes' value type and the functions' names.
#pragma once

#include "core/math/lanes.h"

namespace dispersa {

template <int W>
struct LaneValueOf {
  using Type = lanes::Pack<W>;
};
template <>
struct LaneValueOf<1> {
  using Type = double;
};
/// For W lanes.
template <int W>
using LaneValue = typename LaneValueOf<W>::Type;

}  // namespace dispersa

/// DISPERSA_INSTANCE(Fly, 4) is Fly_v3_4 where x86-64-v3 is compiled for.
#define DISPERSA_INSTANCE(name, lanes) DISPERSA_INSTANCE_OF(name, DISPERSA_ISA, lanes)
#define DISPERSA_INSTANCE_OF(name, isa, lanes) DISPERSA_INSTANCE_NAME(name, isa, lanes)
#define DISPERSA_INSTANCE_NAME(name, isa, lanes) name##_##isa##_##lanes
