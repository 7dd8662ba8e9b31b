#include "core/flight/scenario.h"

#include <cmath>
#include <limits>

#include "core/math/table.h"

namespace dispersa {

namespace {

// Published tables are rounded: how far their masses may be from dry mass and propellant.
constexpr double kMassRounding = 1e-6;
constexpr double kMostRows = 1e7;

std::string At(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

// All leading minors are positive (Sylvester).
bool IsPositiveDefinite(const Matrix3& m) {
  return m(0, 0) > 0.0 && m.topLeftCorner<2, 2>().determinant() > 0.0 && m.determinant() > 0.0;
}

// No principal moment exceeds the sum of the two others: the second moments of mass, of which they are sums,
// are not negative. A thin plate has equality, a published one that or a rounding less.
bool IsOfABody(const Matrix3& inertia) {
  constexpr double kRounding = 1e-6;
  const double half_trace = 0.5 * inertia.trace();
  return IsPositiveDefinite((1.0 + kRounding) * half_trace * Matrix3::Identity() - inertia);
}

void CheckMass(const ScenarioMass& mass, std::vector<StructProblem>& problems) {
  const std::string path = "mass_properties.";
  for (std::size_t i = 0; i < mass.propellant_kg.size(); ++i) {
    const double propellant = mass.propellant_kg[i];
    if (i == 0 && propellant != 0.0)
      problems.push_back({At(path + "propellant_kg", i), "does not begin without propellant", "0"});
    if (i > 0 && !(propellant > mass.propellant_kg[i - 1]))
      problems.push_back(
          {At(path + "propellant_kg", i), "is not above the one before", "propellant strictly increasing"});
    const double expected = mass.mass_kg[0] + propellant - mass.propellant_kg[0];
    if (std::fabs(mass.mass_kg[i] - expected) > kMassRounding * expected)
      problems.push_back({At(path + "mass_kg", i), "is not the mass without propellant plus the propellant",
                          std::to_string(expected)});
    if (!IsPositiveDefinite(mass.inertia_kg_m2[i]))
      problems.push_back({At(path + "ixx_kg_m2", i), "the inertia tensor is not positive definite",
                          "positive moments, and products small enough that every principal moment is "
                          "positive"});
    else if (!IsOfABody(mass.inertia_kg_m2[i]))
      problems.push_back({At(path + "ixx_kg_m2", i), "no body has these moments of inertia",
                          "principal moments of which none exceeds the sum of the two others"});
  }
}

void CheckMotor(const ScenarioStage& stage, std::vector<StructProblem>& problems) {
  const ScenarioMass& mass = stage.mass;
  if (mass.propellant_kg.size() < 2) {
    problems.push_back(
        {"motor", "has no propellant to burn", "mass_properties over propellant_kg with two rows or more"});
    return;
  }
  double aftmost = -std::numeric_limits<double>::infinity();
  for (const double cg : mass.cg_station_m) aftmost = cg > aftmost ? cg : aftmost;
  if (!(stage.motor->nozzle_station_m > aftmost))
    problems.push_back(
        {"motor.nozzle_station_m",
         "is not aft of the centre of gravity, which reaches station " + std::to_string(aftmost) + " m",
         "a station aft of the centre of gravity"});
}

}  // namespace

double BurnTime(const ScenarioStage& stage) {
  return stage.mass.propellant_kg.back() / stage.motor->flow_kg_s;
}

double SeparationTime(const ScenarioStage& stage) {
  if (stage.separation_time_s) return *stage.separation_time_s;
  return stage.motor->ignition_time_s + BurnTime(stage);
}

std::vector<StructProblem> Problems(const ScenarioStage& stage) {
  std::vector<StructProblem> problems;
  CheckMass(stage.mass, problems);
  if (stage.motor) CheckMotor(stage, problems);
  return problems;
}

std::vector<StructProblem> Problems(const Scenario& scenario) {
  std::vector<StructProblem> problems;
  double begin_s = 0.0;
  for (std::size_t i = 0; i < scenario.stages.size(); ++i) {
    const ScenarioStage& stage = scenario.stages[i];
    const std::string path = At("stages", i);
    if (stage.motor && stage.motor->ignition_time_s < begin_s)
      problems.push_back({path + ".motor.ignition_time_s", "is before the stage flies on its own",
                          "not below " + std::to_string(begin_s)});
    if (i + 1 == scenario.stages.size()) {
      if (stage.separation_time_s)
        problems.push_back({path + ".separation_time_s", "the last stage separates from nothing",
                            "no separation_time_s in the last stage"});
      break;
    }
    if (!stage.motor && !stage.separation_time_s) {
      problems.push_back(
          {path, "does not say when it separates: it has no motor that burns out", "separation_time_s"});
      break;
    }
    const double end_s = SeparationTime(stage);
    if (!(end_s > begin_s))
      problems.push_back({path + ".separation_time_s", "is not after the separation before it",
                          "above " + std::to_string(begin_s)});
    begin_s = end_s;
    const double next_kg = scenario.stages[i + 1].mass.mass_kg.back();
    if (!(next_kg < stage.mass.mass_kg.front()))
      problems.push_back({At("stages", i + 1) + ".mass_properties.mass_kg",
                          "the stage is not lighter than what it separates from is without propellant",
                          "less than " + std::to_string(stage.mass.mass_kg.front())});
  }
  if (scenario.output_step_s > scenario.duration_s)
    problems.push_back({"output_step_s", "is longer than the flight", "not above duration_s"});
  if (scenario.duration_s > kMostRows * scenario.output_step_s)
    problems.push_back({"output_step_s", "gives more than ten million rows", "a longer step"});
  if (scenario.duration_s > kMostRows * scenario.integration_step_s)
    problems.push_back({"integration_step_s", "gives more than ten million steps", "a longer step"});
  return problems;
}

}  // namespace dispersa
