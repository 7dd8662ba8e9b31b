// The computed margins of designs along the nominal flight, and the gates plus reserves that they must meet.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/margins/flight_margins.h"
#include "core/tuning/tuned_plant.h"

namespace dispersa {

inline constexpr const char* kGateNames[] = {"gain", "phase", "delay"};

/// Fractions by which gates plus reserves are missed: gain, phase, delay.
void AddViolations(const LeastMargins& m, std::vector<double>& violations);

class NominalMargins {
 public:
  NominalMargins(const TunedPlant& plant, std::vector<MarginInstant> instants)
      : plant_(plant), instants_(std::move(instants)) {}

  LeastMargins LeastOf(const AutopilotConfig& autopilot, int stage, bool adapting) const;
  /// Ends at the first set of margins that fails. Begins with the one that failed last: successive designs
  /// are alike, so a design far from admissible costs next to nothing.
  bool Suffice(const AutopilotConfig& autopilot, int stage, std::size_t* failed_last) const;
  /// The margin that the campaign's autopilot misses, where and by how much. `kind`: 0 gain, 1 phase, 2
  /// delay.
  std::string Missed(std::size_t kind, bool adapting, int stage) const;

 private:
  TunedPlant plant_;
  std::vector<MarginInstant> instants_;
};

}  // namespace dispersa
