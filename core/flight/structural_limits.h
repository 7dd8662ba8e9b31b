// The load that each limit of the vehicle's structure is compared with: one row a limit. A new limit needs a
// member of StructuralLimits with its key, a load in FlightSums with its metric, and a row in
// structural_limits.cc. For `terminate` it also needs its lanes in Batch::CheckEnds.
#pragma once

#include <span>

#include "core/vehicle/vehicle.h"

namespace dispersa {

struct FlightSums;

struct StructuralLimit {
  const char* metric;  ///< of the load, in the limit's unit
  double StructuralLimits::*limit;
  double FlightSums::*load;  ///< largest so far
};

std::span<const StructuralLimit> AllStructuralLimits();

/// Whether the vehicle gives any.
bool HasLimits(const StructuralLimits& limits);
/// Whether the loads so far exceed a limit that the vehicle gives.
bool ExceedsStructure(const StructuralLimits& limits, const FlightSums& sums);

}  // namespace dispersa
