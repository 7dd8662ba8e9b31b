#include "services/cli/seed_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/math/constants.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/refine.h"
#include "services/client/reference_search.h"

namespace dispersa {
namespace {

double Deg(double radians) { return radians / kRadPerDeg; }

// A column of the table: scaled to the unit in its title.
struct Column {
  const char* title;
  const char* json;
  int width;
  int decimals;
  std::function<double(const SeedRow&)> value;
  bool is_error;  ///< summarised by the largest magnitude, others by their range
};

std::vector<Column> Columns(const std::vector<SeedRow>& rows) {
  std::vector<Column> columns = {
      {"dH, m", "altitude_error_m", 9, 4, [](const SeedRow& r) { return r.read_back.altitude_m; }, true},
      {"dV, mm/s", "velocity_error_mm_s", 9, 4,
       [](const SeedRow& r) { return r.read_back.velocity_m_s * 1e3; }, true},
      {"dg, udeg", "flight_path_angle_error_udeg", 9, 4,
       [](const SeedRow& r) { return Deg(r.read_back.flight_path_angle_rad) * 1e6; }, true},
      {"half dH", "halved_altitude_error_m", 9, 4, [](const SeedRow& r) { return r.halved.altitude_m; },
       true},
      {"half dV", "halved_velocity_error_mm_s", 9, 4,
       [](const SeedRow& r) { return r.halved.velocity_m_s * 1e3; }, true},
      {"half dg", "halved_flight_path_angle_error_udeg", 9, 4,
       [](const SeedRow& r) { return Deg(r.halved.flight_path_angle_rad) * 1e6; }, true},
      {"alpha,deg", "alpha_max_deg", 10, 4, [](const SeedRow& r) { return Deg(r.program.alpha_max_rad); },
       false},
      {"t1, s", "t1_s", 8, 3, [](const SeedRow& r) { return r.program.t1_s; }, false},
      {"t3, s", "t3_s", 8, 3, [](const SeedRow& r) { return r.program.t3_s; }, false},
      {"t2, s", "t2_s", 8, 3, [](const SeedRow& r) { return r.program.t2_s; }, false},
      {"coast, s", "coast_s", 10, 4, [](const SeedRow& r) { return r.program.coast_s; }, false},
      {"azimuth,deg", "launch_azimuth_deg", 12, 4,
       [](const SeedRow& r) { return Deg(r.program.launch_azimuth_rad); }, false},
      {"q*alpha", "q_alpha_max_pa_rad", 9, 1, [](const SeedRow& r) { return r.q_alpha_max_pa_rad; }, false}};
  const bool flown =
      std::all_of(rows.begin(), rows.end(), [](const SeedRow& r) { return r.check && r.check->completed(); });
  if (flown) {
    columns.push_back({"6D dH,km", "flown_altitude_error_km", 9, 4,
                       [](const SeedRow& r) { return r.check->errors.altitude_m * 1e-3; }, true});
    columns.push_back({"6D dV,m/s", "flown_velocity_error_m_s", 10, 4,
                       [](const SeedRow& r) { return r.check->errors.velocity_m_s; }, true});
    columns.push_back({"6D dg,deg", "flown_flight_path_angle_error_deg", 10, 5,
                       [](const SeedRow& r) { return Deg(r.check->errors.flight_path_angle_rad); }, true});
  }
  columns.push_back(
      {"ascents", "ascents", 8, 0, [](const SeedRow& r) { return static_cast<double>(r.ascents); }, false});
  columns.push_back({"time, s", "wall_s", 8, 1, [](const SeedRow& r) { return r.wall_s; }, false});
  return columns;
}

// Least, largest and largest magnitude of a column.
struct Spread {
  double low;
  double high;
  double Magnitude() const { return std::fmax(std::fabs(low), std::fabs(high)); }
};
Spread SpreadOf(const std::vector<SeedRow>& rows, const Column& column) {
  Spread spread = {column.value(rows.front()), column.value(rows.front())};
  for (const SeedRow& row : rows) {
    spread.low = std::fmin(spread.low, column.value(row));
    spread.high = std::fmax(spread.high, column.value(row));
  }
  return spread;
}

}  // namespace

std::vector<SeedRow> RunSeedStudy(const OptimizationInput& input, int seeds, const TrajectoryOptions& options,
                                  const std::function<void(const SeedRow&)>& done) {
  std::vector<SeedRow> rows;
  TrajectoryProblem problem = input.problem;
  AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
  AimAt(problem, model.vehicle);
  model.reaction_control_propellant_kg = problem.reaction_control_propellant_kg;
  for (int i = 0; i < seeds; ++i, ++problem.seed) {
    const auto begin = std::chrono::steady_clock::now();
    OptimizationResult result = OptimizeTrajectory(input.vehicle, problem, options);
    SeedRow row;
    row.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    row.seed = problem.seed;
    result.reference.name = input.name;
    result.reference.vehicle_sha256 = input.vehicle_sha256;
    const Reference read = LoadReference({input.name, WriteReference(result.reference)});
    const auto errors = [&](const AscentSteps& steps) {
      return ErrorsOf(read.problem,
                      FlyAscent(model, read.program, AscentOptionsOf(read.problem, steps)).orbit);
    };
    row.read_back = errors(options.steps);
    row.halved = errors(HalvedSteps(options.steps));
    row.check = FlyReference(input, read);
    row.reached =
        result.reached && IsWithin(row.read_back, result.tolerance) && (!row.check || row.check->completed());
    row.program = read.program;
    for (const ConstraintMargin& c : read.constraints)
      if (c.name == "q_alpha_max_pa_rad") row.q_alpha_max_pa_rad = c.value;
    row.ascents = read.evaluations;
    rows.push_back(row);
    done(row);
  }
  return rows;
}

std::string SeedStudyText(const std::vector<SeedRow>& rows) {
  const std::vector<Column> columns = Columns(rows);
  std::string text = fmt::format("{:>6} {:>8}", "seed", "reached");
  for (const Column& column : columns) text += fmt::format("{:>{}}", column.title, column.width + 1);
  text += "\n";
  for (const SeedRow& row : rows) {
    text += fmt::format("{:>6} {:>8}", row.seed, row.reached ? "yes" : "NO");
    for (const Column& column : columns)
      text += fmt::format("{:>{}.{}f}", column.value(row), column.width + 1, column.decimals);
    text += "\n";
  }
  const auto summary = [&](const char* title, bool errors,
                           const std::function<double(const Spread&)>& value) {
    text += fmt::format("{:<15}", title);
    for (const Column& column : columns) {
      text += column.is_error == errors ? fmt::format("{:>{}.{}f}", value(SpreadOf(rows, column)),
                                                      column.width + 1, column.decimals)
                                        : std::string(static_cast<std::size_t>(column.width) + 1, ' ');
    }
    text += "\n";
  };
  summary("worst", true, [](const Spread& range) { return range.Magnitude(); });
  summary("least", false, [](const Spread& range) { return range.low; });
  summary("largest", false, [](const Spread& range) { return range.high; });
  for (const SeedRow& row : rows)
    if (row.check && !row.check->completed())
      text += fmt::format("seed {}: {}\n", row.seed, CheckFlightText(*row.check));
  const auto reached =
      std::count_if(rows.begin(), rows.end(), [](const SeedRow& row) { return row.reached; });
  return text + fmt::format("reached from {} of {} seeds\n", reached, rows.size());
}

nlohmann::ordered_json SeedStudyJson(const std::vector<SeedRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  const std::vector<Column> columns = Columns(rows);
  for (const SeedRow& row : rows) {
    nlohmann::ordered_json object = {{"seed", row.seed}, {"reached", row.reached}};
    for (const Column& column : columns) object[column.json] = column.value(row);
    if (row.check) object["check_flight"] = CheckFlightJson(*row.check);
    list.push_back(std::move(object));
  }
  return {{"schema", "dispersa/optimize-seeds/1"}, {"seeds", std::move(list)}};
}

}  // namespace dispersa
