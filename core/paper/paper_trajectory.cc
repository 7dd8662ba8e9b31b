// Tables 1 to 3, Figures 2 and 3.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/analysis/dispersion_summary.h"
#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/trajectory_figures.h"
#include "core/paper/paper_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

// The optimal results that the paper prints in its Table 2.
constexpr double kPaperHeight_km = 500.406;
constexpr double kPaperVelocity_m_s = 7612.585;
constexpr double kPaperAngle_deg = 0.0000055;

std::string Signed(double value) { return fmt::format("{:+.3g}", value); }

std::string ConstraintTable(const Reference& reference) {
  HtmlTable table({{"Constraint"}, {"value", true}, {"limit", true}, {"margin", true}});
  for (const ConstraintMargin& constraint : reference.constraints) {
    table.Row({"<code>" + HtmlText(constraint.name) + "</code>", ReadableText(constraint.value),
               constraint.enforced ? ReadableText(constraint.limit) : "none",
               constraint.enforced ? ReadableText(constraint.margin) : "–"});
  }
  return table.Html("narrow");
}

/// The same program by what flies it, to the flight with attitude, actuators and reaction control.
std::string InjectionTable(const PaperStudy& study) {
  const PaperInjection& injection = study.injection;
  HtmlTable table({{"Injection of the shipped program"},
                   {"point mass", true},
                   {"lighter point mass", true},
                   {"flown nominal", true},
                   {"flown less point mass", true},
                   {"flown less lighter", true}});
  const auto row = [&](const char* name, int decimals, double point_mass, double lighter,
                       const char* metric) {
    const double flown = study.nominal.metrics[MetricColumn(metric)];
    table.Row({name, FixedText(point_mass, decimals), FixedText(lighter, decimals),
               FixedText(flown, decimals), Signed(flown - point_mass), Signed(flown - lighter)});
  };
  const Orbit &heavy = injection.point_mass, &light = injection.lighter_point_mass;
  row("Height, km", 3, heavy.altitude_m * 1e-3, light.altitude_m * 1e-3, "injection_altitude_km");
  row("Velocity, m/s", 3, heavy.velocity_m_s, light.velocity_m_s, "injection_velocity_m_s");
  row("Angle of injection, °", 5, heavy.flight_path_angle_rad * kDegPerRad,
      light.flight_path_angle_rad * kDegPerRad, "injection_flight_path_angle_deg");
  return table.Html() + fmt::format(
                            "<p class=\"soft\">Lighter: by the {:.3f} kg that the flown nominal’s reaction "
                            "control expels in the "
                            "coast, which a point mass has no use for. What then remains is what a point "
                            "mass leaves out: the "
                            "attitude follows the program with an error, nozzles deflect, stages separate "
                            "while they turn.</p>\n",
                            injection.propellant_kg);
}

}  // namespace

std::string PaperVehicleSection(const PaperStudy& study) {
  const Vehicle& vehicle = study.at("table3").campaign.vehicle;
  HtmlTable table({{"Stage"},
                   {"lift-off mass, t", true},
                   {"propellant, t", true},
                   {"thrust, kN", true},
                   {"flow as printed, kg/s", true},
                   {"flow as flown, kg/s", true},
                   {"burning time, s", true},
                   {"diameter, m", true}});
  double worst = 0.0;
  double worst_others = 0.0;
  std::size_t worst_stage = 0;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    const double flow_kg_s = stage.propellant_mass_kg / stage.motor.burning_time_s;
    const double departure = std::fabs(stage.motor.published_mass_flow_kg_s / flow_kg_s - 1.0);
    if (departure > worst) {
      worst_others = worst;
      worst = departure;
      worst_stage = i;
    } else {
      worst_others = std::max(worst_others, departure);
    }
    table.Row({fmt::format("{}", i + 1), ReadableText(stage.liftoff_mass_kg * 1e-3),
               ReadableText(stage.propellant_mass_kg * 1e-3), ReadableText(stage.motor.thrust_n * 1e-3),
               ReadableText(stage.motor.published_mass_flow_kg_s), fmt::format("{:.2f}", flow_kg_s),
               ReadableText(stage.motor.burning_time_s), ReadableText(stage.diameter_m)});
  }
  const Stage& odd = vehicle.stages[worst_stage];
  const double burnt_kg = odd.motor.published_mass_flow_kg_s * odd.motor.burning_time_s;
  return "<h2 id=\"table1\">Table 1: the vehicle</h2>\n" + table.Html() +
         PaperFindings(
             "Data of a four-stage satellite launch vehicle; the heading of the third stage is misprinted as "
             "a second "
             "“Stage-2”.",
             fmt::format("Flown verbatim but for the mass flow, which is propellant / burning time. It "
                         "departs from the "
                         "printed one by {:.1f} % at most in the other stages and by {:.1f} % in stage {}.",
                         100.0 * worst_others, 100.0 * worst, worst_stage + 1),
             fmt::format(
                 "In stage {} the table contradicts itself: {} kg/s for {} s would burn {:.0f} kg of the "
                 "{:.0f} kg "
                 "on board. A stage's lift-off mass is read as that stage and everything above it, and the "
                 "thrust "
                 "as that of all four nozzles (the 4P of the equations). What the table leaves open, mass "
                 "distribution, aerodynamics, actuators and launch site, is completed in "
                 "<code>campaigns/vehicles/slv4.yaml</code> with the reason for each value; see "
                 "<a href=\"#completions\">how much depends on it</a>.",
                 worst_stage + 1, ReadableText(odd.motor.published_mass_flow_kg_s),
                 ReadableText(odd.motor.burning_time_s), burnt_kg, odd.propellant_mass_kg));
}

std::string PaperTrajectorySection(const PaperStudy& study) {
  const OptimizationResult& result = study.optimization;
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const FlightProgram& program = reference.program;
  std::string html = "<h2 id=\"table2\">Table 2: what the optimisation reaches</h2>\n";

  HtmlTable table({{"Injection"},
                   {"desired", true},
                   {"paper", true},
                   {"paper’s error", true},
                   {"ours", true},
                   {"our error", true},
                   {"with half the step", true}});
  const auto row = [&](const char* name, int decimals, double desired, double paper, double ours,
                       double error, double halved) {
    table.Row({name, ReadableText(desired), FixedText(paper, decimals), Signed(paper - desired),
               FixedText(ours, decimals), Signed(error), Signed(halved)});
  };
  const OrbitErrors& halved = result.halved_step_errors;
  row("Height, km", 3, problem.target_altitude_m * 1e-3, kPaperHeight_km, reference.orbit.altitude_m * 1e-3,
      result.errors.altitude_m * 1e-3, halved.altitude_m * 1e-3);
  row("Velocity, m/s", 3, problem.target_velocity_m_s, kPaperVelocity_m_s, reference.orbit.velocity_m_s,
      result.errors.velocity_m_s, halved.velocity_m_s);
  row("Angle of injection, °", 7, problem.target_flight_path_angle_rad * kDegPerRad, kPaperAngle_deg,
      reference.orbit.flight_path_angle_rad * kDegPerRad, result.errors.flight_path_angle_rad * kDegPerRad,
      halved.flight_path_angle_rad * kDegPerRad);
  html += table.Html() + InjectionTable(study);
  html += fmt::format(
      "<p>Variables: α<sub>max</sub> {:.4f}°, t1 {:.3f} s, t3 {:.3f} s, t2 {:.3f} s, coast before stage 4 "
      "{:.2f} s, launch "
      "azimuth {:.3f}°; inclination {:.2f}°. Genetic algorithm with {} individuals, then refinement by least "
      "squares: {} "
      "evaluations, seed {}.</p>\n",
      program.alpha_max_rad * kDegPerRad, program.t1_s, program.t3_s, program.t2_s, program.coast_s,
      program.launch_azimuth_rad * kDegPerRad, reference.orbit.inclination_rad * kDegPerRad,
      problem.population, reference.evaluations, problem.seed);
  html += ConstraintTable(reference);
  const bool better =
      std::fabs(result.errors.altitude_m) < std::fabs(kPaperHeight_km * 1e3 - problem.target_altitude_m) &&
      std::fabs(result.errors.velocity_m_s) < std::fabs(kPaperVelocity_m_s - problem.target_velocity_m_s) &&
      std::fabs(result.errors.flight_path_angle_rad * kDegPerRad) < kPaperAngle_deg;
  html += PaperFindings(
      "A genetic algorithm over α<sub>max</sub>, t1, t2 and t3 meets height, velocity and angle of injection "
      "to 0.406 km, "
      "0.015 m/s and 5.5e-6°.",
      result.reached
          ? (better
                 ? "The target is reached closer than in the paper in all three, constraints met."
                 : "The target is reached within the optimiser’s tolerance, constraints met; not closer than "
                   "in the paper in all three.")
          : "The target is not reached: " + HtmlText(result.statement),
      "A continuous burn of this vehicle does not reach 500 km with a horizontal velocity, nor does it reach "
      "7612.6 m/s on "
      "an Earth at rest. A coast before stage 4, which the paper does not mention, and the launch azimuth "
      "are therefore "
      "variables too; the four of the paper alone have no more than two effective degrees of freedom.");

  html += "<h2 id=\"fig2\">Fig. 2: flight program</h2>\n<div class=\"figures\">\n" +
          FlightProgramFigures(program, result.history) + "</div>\n";
  html += PaperFindings(
      "Vertical flight, a turn with incidence between t1 and t2 with its maximum at t3, then zero incidence; "
      "at most 6°, zero "
      "in the transonic range.",
      [&] {
        const auto mach = std::find_if(reference.constraints.begin(), reference.constraints.end(),
                                       [](const ConstraintMargin& c) { return c.name == "mach_at_t2"; });
        return fmt::format("The maximum is {} at {:.2f} s; the incidence is back at zero at {:.2f} s{}.",
                           Degrees(program.alpha_max_rad * kDegPerRad), program.t3_s, program.t2_s,
                           mach == reference.constraints.end()
                               ? std::string()
                               : fmt::format(", at Mach {:.3f}", mach->value));
      }(),
      "The incidence is drawn with its sign: nose down. Its ramps are smooth polynomials, so that the "
      "program demands no "
      "jump of the autopilot.");

  html += "<h2 id=\"fig3\">Fig. 3: reference trajectories</h2>\n<div class=\"figures\">\n" +
          ReferenceFigures(result.history) + "</div>\n";
  const auto fastest = std::max_element(result.history.begin(), result.history.end(),
                                        [](const auto& a, const auto& b) { return a.qbar_pa < b.qbar_pa; });
  html += PaperFindings(
      "Pitch angle, height, velocity and injection angle of the optimised trajectory.",
      result.history.empty()
          ? std::string("No trajectory.")
          : fmt::format(
                "Injection {:.1f} s after lift-off; the dynamic pressure peaks at {:.1f} kPa at {:.1f} s, "
                "the axial "
                "load at {:.2f} g.",
                result.history.back().time_s, fastest->qbar_pa * 1e-3, fastest->time_s,
                std::max_element(result.history.begin(), result.history.end(),
                                 [](const auto& a, const auto& b) { return a.axial_load_g < b.axial_load_g; })
                    ->axial_load_g),
      "Flown by a point mass in three dimensions over the rotating ellipsoid with J2; equations (1) to (7) "
      "are its planar "
      "limit, and (2) as printed has the rate of g where that of ϑ belongs.");
  return html;
}

std::string PaperDispersionSection(const PaperStudy& study) {
  const PaperFlights& table3 = study.at("table3");
  HtmlTable table({{"Dispersion"},
                   {"Input"},
                   {"As read"},
                   {"drawn, mean", true},
                   {"drawn, std", true},
                   {"drawn, range", true}});
  for (const DispersionSummary& row : SummarizeDispersions(table3.campaign, table3.flights.cases)) {
    table.Row({HtmlText(row.dispersion), "<code>" + HtmlText(row.input) + "</code>", HtmlText(row.declared),
               ReadableText(row.drawn.mean), ReadableText(row.drawn.std),
               ReadableText(row.drawn.min) + " … " + ReadableText(row.drawn.max)});
  }
  return "<h2 id=\"table3\">Table 3: dispersions</h2>\n" + PaperSource(study, {"table3"}) +
         PaperFindings(
             "Thrust misalignment 0.25°, wind 60.96 m/s maximum, drag coefficient 6.7 %, thrust variation 2 "
             "%.",
             "As the flights of this page applied them: <details><summary>the drawn inputs</summary>" +
                 table.Html() + "</details>",
             "The paper does not say what its numbers mean. Here misalignment, drag and thrust are three "
             "standard "
             "deviations, with a uniform clock angle and independent stages; the wind is a jet stream at 12 "
             "km with its "
             "maximum in every flight, from a uniform direction. A thrust variation keeps the total impulse: "
             "the burn is "
             "shorter when the thrust is larger.");
}

}  // namespace dispersa
