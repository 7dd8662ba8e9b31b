// Tables 1 to 3, Figures 2 and 3.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/pages/report_sections.h"
#include "core/pages/trajectory_figures.h"
#include "core/pages/trajectory_page.h"
#include "core/paper/paper_parts.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string Signed(double value) { return fmt::format("{:+.3g}", value); }

PaperPart VehiclePart(const Vehicle& vehicle) {
  HtmlTable table(
      "!Stage|#lift-off mass, t|#propellant, t|#thrust, kN|#flow as printed, kg/s|#flow as flown, kg/s|"
      "#burning time, s|#diameter, m");
  std::vector<double> departures;
  for (const Stage& stage : vehicle.stages) {
    const Motor& motor = stage.motor;
    const double flow_kg_s = stage.propellant_mass_kg / motor.burning_time_s;
    departures.push_back(std::fabs(motor.published_mass_flow_kg_s / flow_kg_s - 1.0));
    table.Row({fmt::format("{}", departures.size()), ReadableText(stage.liftoff_mass_kg * 1e-3),
               ReadableText(stage.propellant_mass_kg * 1e-3), ReadableText(motor.thrust_n * 1e-3),
               ReadableText(motor.published_mass_flow_kg_s), FixedText(flow_kg_s, 2),
               ReadableText(motor.burning_time_s), ReadableText(stage.diameter_m)});
  }
  const auto worst = std::max_element(departures.begin(), departures.end());
  const double most = std::exchange(*worst, 0.0);
  const auto odd = static_cast<std::size_t>(worst - departures.begin());
  const Motor& motor = vehicle.stages[odd].motor;
  return {
      "table1",
      "Table 1: the vehicle",
      "Data of a four-stage launch vehicle. The heading of the third stage is misprinted as a second "
      "“Stage-2”.",
      fmt::format("Flown as printed, but with propellant / burning time as mass flow. It departs from the "
                  "printed flow by {:.1f} % in stage {}, elsewhere by {:.1f} % at most.",
                  100.0 * most, odd + 1, 100.0 * *std::max_element(departures.begin(), departures.end())),
      fmt::format("{} kg/s for {} s would burn {:.0f} kg of the {:.0f} kg in stage {}. A lift-off mass is "
                  "read as that of the stage and all above it, a thrust as that of all four nozzles (4P of "
                  "the equations). <code>campaigns/vehicles/slv4.yaml</code> adds mass distribution, "
                  "aerodynamics, actuators and launch site, each with its reason. See <a "
                  "href=\"#completions\">how much depends on them</a>.",
                  ReadableText(motor.published_mass_flow_kg_s), ReadableText(motor.burning_time_s),
                  motor.published_mass_flow_kg_s * motor.burning_time_s,
                  vehicle.stages[odd].propellant_mass_kg, odd + 1),
      most > 0.05 ? PaperVerdict::kInPart : PaperVerdict::kReproduced,
      "",
      table.Html()};
}

PaperPart OptimizationPart(const OptimizationResult& result) {
  constexpr const char* kPrinted[] = {"500.406", "7612.585",
                                      "0.0000055"};  // the paper's optimum, km, m/s, deg
  HtmlTable table("!Injection|#desired|#paper|#paper’s error|#reached|#error|#with half the step");
  bool closer = true;
  const std::vector<InjectionRow> rows = InjectionRows(result, std::nullopt);
  for (std::size_t i = 0; i < std::min(rows.size(), std::size(kPrinted)); ++i) {
    const InjectionRow& row = rows[i];
    const double paper_error = std::stod(kPrinted[i]) - row.desired;
    closer = closer && std::fabs(row.error) < std::fabs(paper_error);
    table.Row({HtmlText(row.name), ReadableText(row.desired), kPrinted[i], Signed(paper_error),
               FixedText(row.reached, row.decimals), Signed(row.error), Signed(row.halved)});
  }
  return {
      "table2",
      "Table 2: what the optimisation reaches",
      "A genetic algorithm over α<sub>max</sub>, t1, t2 and t3 meets height, velocity and angle of "
      "injection to 0.406 km, 0.015 m/s and 5.5e-6°.",
      !result.reached ? "The target is not reached: " + HtmlText(result.statement) + "."
      : closer        ? "The target is reached closer than in the paper in all three, constraints met."
                      : "The target is reached within the optimiser’s tolerance, constraints met; not "
                        "closer than in the paper in all three.",
      "A continuous burn of this vehicle does not reach 500 km with a horizontal velocity. Nor does it "
      "reach 7612.6 m/s on an Earth at rest. So a coast before stage 4, which the paper does not mention, "
      "and the launch azimuth are variables too. The paper’s four have two effective degrees of freedom "
      "at most.",
      result.reached ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      PaperLink("trajectory.html", "variables, constraints, search, closed loop"),
      table.Html()};
}

PaperPart ProgramPart(const OptimizationResult& result) {
  const FlightProgram& program = result.reference.program;
  std::string mach;
  bool met = true;
  for (const ConstraintMargin& constraint : result.reference.constraints) {
    met = met && (!constraint.enforced || constraint.margin >= 0.0);
    if (constraint.name == "mach_at_t2") mach = fmt::format(", at Mach {:.3f}", constraint.value);
  }
  return {"fig2",
          "Fig. 2: flight program",
          "Vertical flight, a turn with incidence from t1 to t2 with its maximum at t3, then zero incidence. "
          "It is at most 6°, and zero in the transonic range.",
          fmt::format("The maximum is {} at {:.2f} s. The incidence is back at zero at {:.2f} s{}.",
                      Degrees(program.alpha_max_rad * kDegPerRad), program.t3_s, program.t2_s, mach),
          "The incidence is drawn with its sign: nose down. Its ramps are smooth polynomials, so the program "
          "demands no jump of the autopilot.",
          met ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
          PaperLink("trajectory.html", "the program"),
          Figures(FlightProgramFigures(program, result.history))};
}

PaperPart AscentPart(const OptimizationResult& result) {
  AscentSample fastest, hardest;
  for (const AscentSample& sample : result.history) {
    if (sample.qbar_pa > fastest.qbar_pa) fastest = sample;
    if (sample.axial_load_g > hardest.axial_load_g) hardest = sample;
  }
  return {
      "fig3",
      "Fig. 3: reference trajectories",
      "Curves of pitch angle, height, velocity and injection angle of the optimised trajectory.",
      fmt::format("Injection {:.1f} s after lift-off. The dynamic pressure peaks at {:.1f} kPa at {:.1f} s, "
                  "the axial load at {:.2f} g.",
                  result.history.empty() ? 0.0 : result.history.back().time_s, fastest.qbar_pa * 1e-3,
                  fastest.time_s, hardest.axial_load_g),
      "Flown by a point mass in three dimensions over the rotating ellipsoid with J2. Equations (1) to "
      "(7) are its planar limit. (2) as printed has the rate of g where that of ϑ belongs.",
      result.reached ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      PaperLink("trajectory.csv", "the numbers"),
      Figures(ReferenceFigures(result.history))};
}

PaperPart DispersionPart(const CampaignSummary& table3) {
  const auto off = std::count_if(table3.dispersions.begin(), table3.dispersions.end(),
                                 [](const auto& row) { return !row.consistent.value_or(true); });
  return {
      "table3",
      "Table 3: dispersions",
      "Thrust misalignment 0.25°, wind 60.96 m/s maximum, drag coefficient 6.7 %, thrust variation 2 %.",
      fmt::format("The flights applied {} inputs. {}", table3.dispersions.size(),
                  off == 0 ? "They agree with what is declared."
                           : fmt::format("{} of them differ from what is declared.", off)),
      "The paper does not say what its numbers mean. Here misalignment, drag and thrust are three standard "
      "deviations, with a uniform clock angle and independent stages. The wind is a jet stream at 12 km "
      "with its maximum in every flight, from a uniform direction. A thrust variation keeps the total "
      "impulse: the burn is shorter when the thrust is larger.",
      PaperVerdict::kNoClaim,
      PaperLink("table3/report.html#dispersions", "table3"),
      DispersionsTable(table3)};
}

}  // namespace

std::vector<PaperPart> TrajectoryParts(const PaperStudy& study) {
  return {VehiclePart(study.at("table3").campaign.vehicle), OptimizationPart(study.optimization),
          ProgramPart(study.optimization), AscentPart(study.optimization),
          DispersionPart(study.at("table3").summary)};
}

}  // namespace dispersa
