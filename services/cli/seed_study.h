// Several optimisations with different seeds: whether each finds the orbit, and whether all find the same
// program.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/trajectory/check_flight.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

struct SeedRow {
  std::uint64_t seed = 0;
  bool reached = false;              ///< as written and read back too, and by the check flight
  OrbitErrors read_back;             ///< of the program as written to text, read again and flown again
  OrbitErrors halved;                ///< the same with half the steps
  std::optional<CheckFlight> check;  ///< closed loop, if the campaign has an autopilot
  FlightProgram program;
  double q_alpha_max_pa_rad = 0.0;
  std::int64_t ascents = 0;
  double wall_s = 0.0;
};

/// Seeds problem.seed, problem.seed + 1, ... `done` is called after each row.
std::vector<SeedRow> RunSeedStudy(const OptimizationInput& input, int seeds, const TrajectoryOptions& options,
                                  const std::function<void(const SeedRow&)>& done);

/// A row for each seed, then the worst, and the smallest and largest of each variable.
std::string SeedStudyText(const std::vector<SeedRow>& rows);
nlohmann::ordered_json SeedStudyJson(const std::vector<SeedRow>& rows);

}  // namespace dispersa
