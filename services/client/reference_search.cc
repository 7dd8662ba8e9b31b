#include "services/client/reference_search.h"

#include <fmt/format.h>

#include "core/cases/campaign_flights.h"
#include "core/flight/metrics.h"
#include "core/math/constants.h"
#include "core/pages/trajectory_figures.h"
#include "core/pages/trajectory_page.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

fs::path Beside(fs::path file, const char* extension) { return file.replace_extension(extension); }

OptimizationResult Search(const OptimizationInput& input, int threads, Observer& observer) {
  const auto generations = static_cast<std::uint64_t>(input.problem.generations);
  const auto observe = [&](const GenerationRecord& record) {
    if (observer.ShouldStop()) throw Interrupted();
    observer.Show("optimize", static_cast<std::uint64_t>(record.generation), generations,
                  record.best_objective ? fmt::format("best {:.4g}", *record.best_objective)
                                        : std::string("no feasible trajectory yet"));
  };
  return SearchOrInputError([&] {
    return OptimizeTrajectory(input.vehicle, input.problem, SearchOptions(input, threads), observe);
  });
}

}  // namespace

TrajectoryOptions SearchOptions(const OptimizationInput& input, int threads) {
  TrajectoryOptions options;
  options.tick_s = input.tick_s;
  options.threads = threads;
  return options;
}

std::optional<CheckFlight> FlyReference(const OptimizationInput& input, const Reference& reference) {
  const std::optional<Campaign> campaign = CampaignOf(input, reference);
  if (!campaign) return std::nullopt;
  const CaseResult result = CampaignFlights(*campaign).FlyNominal();
  CheckFlight flight{result.outcome, result.end_time_s, result.reason};
  if (!flight.completed()) return flight;
  const auto metric = [&](const char* name) { return result.metrics[MetricColumn(name)]; };
  flight.errors = {metric("injection_altitude_error_km") * 1e3, metric("injection_velocity_error_m_s"),
                   metric("injection_flight_path_angle_error_deg") * kRadPerDeg,
                   metric("inclination_error_deg") * kRadPerDeg};
  return flight;
}

nlohmann::ordered_json CheckFlightJson(const CheckFlight& flight) {
  return {{"outcome", OutcomeName(flight.outcome)},
          {"end_time_s", Number(flight.end_time_s)},
          {"reason", flight.reason}};
}

std::string FoundReference::Statement() const {
  return result.reached && !reached() ? CheckFlightText(*check) : result.statement;
}

FoundReference FindReference(const OptimizationInput& input, int threads, Observer& observer) {
  FoundReference found = {Search(input, threads, observer), {}};
  Reference& reference = found.result.reference;
  reference.name = input.name;
  reference.vehicle_sha256 = input.vehicle_sha256;
  reference.target_missed = found.result.statement;
  if (found.result.reached) found.check = FlyReference(input, reference);
  return found;
}

void RequireWritableReference(const std::string& option, const fs::path& file) {
  for (const fs::path& path : {file, Beside(file, ".csv"), Beside(file, ".html")})
    RequireWritableFile(option, path);
}

void WriteFoundReference(const FoundReference& found, const fs::path& file) {
  WriteFile(file, WriteReference(found.result.reference));
  WriteFile(Beside(file, ".csv"), AscentCsv(found.result.history));
  WriteFile(Beside(file, ".html"), TrajectoryPage(found.result, found.check));
}

nlohmann::ordered_json FoundReferenceJson(const Vehicle& vehicle, const FoundReference& found,
                                          const std::string& file) {
  const OptimizationResult& result = found.result;
  const Reference& reference = result.reference;
  const FlightProgram& program = reference.program;
  auto constraints = nlohmann::ordered_json::array();
  for (const ConstraintMargin& constraint : reference.constraints) {
    constraints.push_back({{"name", constraint.name},
                           {"value", Number(constraint.value)},
                           {"limit", constraint.enforced ? Number(constraint.limit) : nullptr},
                           {"margin", constraint.enforced ? Number(constraint.margin) : nullptr}});
  }
  nlohmann::ordered_json variables;
  for (const ProgramVariable& variable : VariablesOf(vehicle, reference.problem))
    variables[variable.Name() + "_" + variable.unit_name()] = variable.Of(program) / variable.unit();
  return {{"schema", "dispersa/optimize/1"},
          {"reference", file},
          {"reached", found.reached()},
          {"check_flight", found.check ? CheckFlightJson(*found.check) : nlohmann::ordered_json(nullptr)},
          {"orbit",
           {{"altitude_km", Number(reference.orbit.altitude_m * 1e-3)},
            {"velocity_m_s", Number(reference.orbit.velocity_m_s)},
            {"flight_path_angle_deg", Number(reference.orbit.flight_path_angle_rad * kDegPerRad)},
            {"inclination_deg", Number(reference.orbit.inclination_rad * kDegPerRad)},
            {"node_longitude_deg", Number(reference.orbit.node_longitude_rad * kDegPerRad)}}},
          {"lift_off_sidereal_deg", LiftOffSidereal(reference)
                                        ? nlohmann::ordered_json(*LiftOffSidereal(reference) * kDegPerRad)
                                        : nlohmann::ordered_json(nullptr)},
          {"errors",
           {{"altitude_km", Number(result.errors.altitude_m * 1e-3)},
            {"velocity_m_s", Number(result.errors.velocity_m_s)},
            {"flight_path_angle_deg", Number(result.errors.flight_path_angle_rad * kDegPerRad)},
            {"inclination_deg", Number(result.errors.inclination_rad * kDegPerRad)},
            {"argument_of_perigee_deg", Number(result.errors.argument_of_perigee_rad * kDegPerRad)}}},
          {"variables", std::move(variables)},
          {"constraints", std::move(constraints)},
          {"seed", reference.problem.seed},
          {"evaluations", reference.evaluations}};
}

}  // namespace dispersa
