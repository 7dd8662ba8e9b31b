// Plausibility of stages, their tanks, nozzles and the bodies that they carry.
#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/plausibility_checks.h"

namespace dispersa::plausibility {
namespace {

// Thrust over chamber pressure, its largest over its smallest while the thrust is above half of its largest.
double PressureSpread(const ThrustCurve& curve) {
  if (curve.pressure_pa.empty()) return kNothing;
  const double half_n = 0.5 * *std::max_element(curve.thrust_n.begin(), curve.thrust_n.end());
  double least = HUGE_VAL, most = 0.0;
  for (std::size_t i = 0; i < curve.time_s.size(); ++i) {
    if (!(curve.thrust_n[i] > half_n)) continue;
    const double ratio = curve.thrust_n[i] / std::fmax(curve.pressure_pa[i], 1.0);
    least = std::fmin(least, ratio);
    most = std::fmax(most, ratio);
  }
  return most / least;
}

// Of a stage with a table, alone and full: by the table, and by its tubes. Without a table NaN.
std::pair<MassProperties, MassProperties> TableAndTubes(const Subject& s) {
  MassProperties none;
  none.cg_station_m = none.axial_inertia_kg_m2 = none.transverse_inertia_kg_m2 = kNothing;
  if (!s.stage().flown_mass.rows) return {none, none};
  Vehicle alone = s.vehicle;
  alone.boosters = {};
  alone.stages = {s.stage()};
  alone.stages[0].jettisoned.clear();
  const double own_kg = DryMass(s.vehicle, static_cast<int>(s.index)) + s.stage().propellant_mass_kg;
  alone.stages[0].liftoff_mass_kg = own_kg;
  const StackMass by_table = BuildStackMasses(alone)[0];
  alone.stages[0].flown_mass = {};
  const StackMass by_tubes = BuildStackMasses(alone)[0];
  return {by_table.At(by_table.propellant_mass_kg), by_tubes.At(by_tubes.propellant_mass_kg)};
}
double TableOverTubes(const Subject& s, double MassProperties::*value) {
  const auto [table, tubes] = TableAndTubes(s);
  return tubes.*value > 0.0 ? table.*value / (tubes.*value) : kNothing;
}

double PartOfProfile(const Subject& s) {
  const double widest_m = WidestDiameter(s.vehicle, s.stage().PropellantTop(), s.stage().PropellantBottom());
  return widest_m > 0.0 ? s.stage().diameter_m / widest_m : kNothing;
}

constexpr Check kStageChecks[] = {
    {"propellant_mass_kg", "implies with thrust and burning time a specific impulse of", "s",
     Usual(180.0, 470.0).Possible(0.0, 1000.0),
     "200 to 410 s of solid and liquid rockets: Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., "
     "table 2-1; "
     "465 s of hydrogen stages in vacuum; combustion never gave more than 550 s, reactors 900 s",
     [](const Subject& s) { return s.stage().is_liquid() ? kNothing : s.figure().specific_impulse_s; }},
    {"motor.liquid.specific_impulse_s", "is", "s", kLiquidImpulse.spans, kLiquidImpulse.source,
     [](const Subject& s) { return s.stage().is_liquid() ? s.figure().specific_impulse_s : kNothing; }},
    {"motor.liquid.residual_mass_kg", "is, as part of the propellant,", "", kResidual.spans, kResidual.source,
     [](const Subject& s) { return s.stage().motor.residual_mass_kg / s.stage().propellant_mass_kg; }},
    {"tanks",
     "take together, as part of the stage's diameter_m from its bottom to the next stage's (of the last: to "
     "their top),",
     "", Usual(0.05, 0.95).Possible(0.0, 1.0),
     "the tanks are inside the stage; of Vega's upper stage they take 0.09",
     [](const Subject& s) {
       if (!s.stage().is_liquid()) return kNothing;
       // Above the last stage's tanks are payload and fairing.
       const double top_m =
           s.is_last() ? s.stage().PropellantTop() : s.vehicle.stages[s.last_burn() + 1].bottom_station_m;
       double volume_m3 = 0.0;
       for (const Tank& tank : s.stage().tanks) volume_m3 += tank.Volume();
       return volume_m3 / (0.25 * kPi * Square(s.stage().diameter_m) * (s.stage().bottom_station_m - top_m));
     }},
    {"motor.thrust_n", "implies a thrust to weight at lift-off of", "", Usual(1.15, 12.0).Possible(1.0, kAny),
     "Saturn V 1.2, solid launchers 1.6 to 2.5, sounding rockets to 12; below 1 it never leaves the pad",
     [](const Subject& s) {
       return s.index == 0 && s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n", "implies, without a gimbal, a thrust to weight at lift-off of", "",
     Usual(3.0, 60.0).Possible(1.0, kAny), "fins hold a vehicle that leaves its rail with 20 m/s or more",
     [](const Subject& s) {
       return s.index == 0 && !s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n", "implies a thrust to weight at ignition of", "", Usual(0.05, 12.0),
     "small liquid upper stages from 0.08, solid ones to 8",
     [](const Subject& s) {
       return s.index > 0 && s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n", "implies towards burnout a load of", "g", Usual(0.05, 20.0),
     "user's manuals of solid launchers state up to 13 g",
     [](const Subject& s) { return s.stage().is_controlled() ? s.figure().burnout_load_g : kNothing; }},
    {"motor.thrust_n", "implies towards burnout, without a gimbal, a load of", "g", Usual(0.5, 100.0),
     "sounding rockets 10 to 60 g",
     [](const Subject& s) { return s.stage().is_controlled() ? kNothing : s.figure().burnout_load_g; }},
    {"liftoff_mass_kg", "implies a dry mass of the stage, as part of its own, of", "", Usual(0.03, 0.35),
     "0.05 of large liquid stages, 0.07 to 0.15 of solid ones, more only of the smallest",
     [](const Subject& s) {
       return s.is_last() || !s.stage().is_controlled() ? kNothing : s.figure().structural_fraction;
     }},
    {"liftoff_mass_kg", "implies a dry mass of the stage without gimbal, as part of its own, of", "",
     Usual(0.03, 0.6), "boosters of sounding rockets have heavy cases and fins: 0.3 to 0.5",
     [](const Subject& s) {
       return s.is_last() || s.stage().is_controlled() ? kNothing : s.figure().structural_fraction;
     }},
    {"liftoff_mass_kg", "implies a dry mass of the last stage with payload, as part of its own, of", "",
     Usual(0.05, 0.95), "0.2 to 0.8 of upper stages with what they carry",
     [](const Subject& s) { return s.is_last() ? s.figure().structural_fraction : kNothing; }},
    {"grain", "implies a propellant density of", "kg/m3", Usual(1500.0, 1950.0),
     "solid propellants: Sutton and Biblarz, table 12-1",
     [](const Subject& s) { return s.stage().is_liquid() ? kNothing : PropellantDensity(s.stage()); }},
    {"grain.outer_diameter_m", "is, as part of the stage's diameter_m,", "",
     Usual(0.5, 1.0).Possible(0.0, 1.0), "the propellant is inside",
     [](const Subject& s) {
       return s.stage().is_liquid() ? kNothing : s.stage().grain.outer_diameter_m / s.stage().diameter_m;
     }},
    {"diameter_m", "is, as part of the profile's largest diameter about this stage's propellant,", "",
     Usual(0.4, 1.02), "1 where the case is the skin, less inside a wider fairing",
     [](const Subject& s) { return s.index == 0 ? kNothing : PartOfProfile(s); }},
    {"diameter_m", "is, as part of the profile's largest diameter about the first stage's propellant,", "",
     Usual(0.7, 1.02), "1 where the case is the skin; no fairing is about a first stage",
     [](const Subject& s) { return s.index == 0 ? PartOfProfile(s) : kNothing; }},
    {"gimbal.pivot_station_m", "is, as part of the stage's bottom_station_m,", "", Usual(0.0, 1.05),
     "the nozzles begin inside the base",
     [](const Subject& s) { return s.stage().gimbal.pivot_station_m / s.stage().bottom_station_m; }},
    {"motor.nozzle_exit_area_m2", "is, as part of the stage's cross-section,", "", Usual(0.02, 1.0),
     "the nozzles end inside the base, or inside the interstage below",
     [](const Subject& s) {
       const double area_m2 = s.stage().motor.nozzle_exit_area_m2;
       return area_m2 > 0.0 ? area_m2 / (0.25 * kPi * Square(s.stage().diameter_m)) : kNothing;
     }},
    {"mass_table.transverse_inertia_kg_m2", "at ignition is that of the stage's tubes times", "",
     Usual(0.3, 3.0),
     "structure, grain and tanks weigh the same; kg mm2 or an inertia about another point are far off",
     [](const Subject& s) { return TableOverTubes(s, &MassProperties::transverse_inertia_kg_m2); }},
    {"mass_table.axial_inertia_kg_m2", "at ignition is that of the stage's tubes times", "", Usual(0.1, 10.0),
     "structure and grain weigh the same; liquids count as none about the axis",
     [](const Subject& s) { return TableOverTubes(s, &MassProperties::axial_inertia_kg_m2); }},
    {"mass_table.cg_station_m", "differs at ignition from that of the stage's tubes by", "m",
     Usual(-2.0, 2.0), "stations count aft from the nose tip of the full vehicle",
     [](const Subject& s) {
       const auto [table, tubes] = TableAndTubes(s);
       return table.cg_station_m - tubes.cg_station_m;
     }},
    {"motor.published_mass_flow_kg_s", "is the flow that propellant and burning time give times", "",
     Usual(0.8, 1.25), "near 1: what a source prints as mean flow",
     [](const Subject& s) {
       const double published_kg_s = s.stage().motor.published_mass_flow_kg_s;
       return published_kg_s > 0.0 ? published_kg_s / s.figure().flow_kg_s : kNothing;
     }},
    {"gimbal.radius_m", "is, as part of half the stage's diameter_m,", "", Usual(0.0, 1.0),
     "the hinges are inside the base",
     [](const Subject& s) {
       if (!s.stage().gimbal.nozzles.empty() || !s.stage().is_controlled()) return kNothing;
       return s.stage().gimbal.radius_m / (0.5 * s.stage().diameter_m);
     }},
    {"gimbal.nozzles", "are, as part of half the stage's diameter_m, off the axis by up to", "",
     Usual(0.0, 1.5), "engines stand in the base, verniers beside it",
     [](const Subject& s) {
       double farthest_m = kNothing;
       for (const Nozzle& nozzle : s.stage().gimbal.nozzles)
         farthest_m = std::fmax(
             farthest_m, std::fmax(nozzle.ring.radius_m, Sqrt(Square(nozzle.y_m) + Square(nozzle.z_m))));
       return farthest_m / (0.5 * s.stage().diameter_m);
     }},
};

constexpr Check kPressureChecks[] = {
    {"thrust_curve.table.chamber_pressure", "is at most", "MPa", Usual(0.2, 30.0).Possible(0.0, 1000.0),
     "solid motors burn at 3 to 15 MPa; a pressure in bar or psi may stand under another unit",
     [](const Subject& s) {
       const std::vector<double>& pressure_pa = s.motor().thrust_curve.pressure_pa;
       return pressure_pa.empty() ? kNothing
                                  : 1e-6 * *std::max_element(pressure_pa.begin(), pressure_pa.end());
     }},
    {"thrust_curve.table.chamber_pressure",
     "makes thrust over pressure change, in the burn's strong part, by a factor of", "", Usual(1.0, 1.4),
     "thrust is the pressure times throat area and thrust coefficient, which change little; a channel may "
     "belong to another test or run late",
     [](const Subject& s) { return PressureSpread(s.motor().thrust_curve); }},
};

constexpr Check kGimbalChecks[] = {
    {"limit_rad", "lets a nozzle turn by", "deg", Usual(1.0, 15.0).Possible(0.0, 89.0),
     "the Space Shuttle's boosters 8 deg, its main engines 10.5 deg",
     [](const Subject& s) { return s.gimbal() != nullptr ? s.gimbal()->limit_rad * kDegPerRad : kNothing; }},
    {"bandwidth_rad_s", "is", "rad/s", Usual(6.0, 250.0).Possible(1.0, 2000.0),
     "actuators of nozzles have 2 to 20 Hz; slower ones hold no launcher that the air turns over",
     [](const Subject& s) { return s.gimbal() != nullptr ? s.gimbal()->bandwidth_rad_s : kNothing; }},
    {"rate_limit_rad_s", "lets a nozzle turn at", "deg/s", Usual(2.0, 120.0).Possible(0.1, 1000.0),
     "the Space Shuttle's main engines 10 deg/s, small electric actuators to 60 deg/s",
     [](const Subject& s) {
       return s.gimbal() != nullptr ? s.gimbal()->rate_limit_rad_s * kDegPerRad : kNothing;
     }},
};

constexpr Check kCutOffChecks[] = {
    {"velocity_m_s", "is, as an inertial speed,", "m/s", Usual(1500.0, 12500.0).Possible(500.0, 17000.0),
     "a site on the equator moves at 465 m/s, a circle at 200 km has 7784 m/s, escape from there 11,008 m/s",
     [](const Subject& s) {
       return s.stage().motor.cut_off == CutOff::kAtVelocity ? s.stage().motor.cut_off_velocity_m_s
                                                             : kNothing;
     }},
};

// Checks of jettisoned masses.
constexpr Check kJettisonChecks[] = {
    {"at.time_s", "comes", "s after lift-off", Usual(90.0, 1000.0),
     "fairings leave 150 to 300 s after lift-off, above 100 km; sooner the payload meets the air",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtTime ? s.jettison().threshold : kNothing;
     }},
    {"at.altitude_m", "comes at", "km", Usual(60.0, 200.0),
     "fairings leave at 100 to 140 km; a flight may never come higher than its orbit",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtAltitude ? s.jettison().threshold / 1e3 : kNothing;
     }},
    {"at.heat_flux_w_m2", "waits for a free-molecular heating of", "W/m2", Usual(10.0, 10000.0),
     "1135 W/m2 of the user's manuals of Ariane 5, Vega and others",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtHeatFlux ? s.jettison().threshold : kNothing;
     }},
};

// Checks of sets of fins.
constexpr Check kFinChecks[] = {
    {"leading_edge_station_m", "begins the root, as part of the stage's bottom_station_m, at", "",
     Usual(0.0, 1.0).Possible(0.0, 1.0), "the fins are on the body",
     [](const Subject& s) { return s.fins().leading_edge_station_m / s.stage().bottom_station_m; }},
    {"root_chord_m", "ends the root, as part of the stage's bottom_station_m, at", "", Usual(0.0, 1.02),
     "the root is on the body; only the tip may stand back by its sweep",
     [](const Subject& s) {
       return (s.fins().leading_edge_station_m + s.fins().root_chord_m) / s.stage().bottom_station_m;
     }},
    {"leading_edge_station_m", "begins the root, behind the bottom_station_m of the stage above, by", "m",
     Usual(0.0, kAny), "the fins leave with their stage",
     [](const Subject& s) {
       return s.is_last()
                  ? kNothing
                  : s.fins().leading_edge_station_m - s.vehicle.stages[s.last_burn() + 1].bottom_station_m;
     }},
};

constexpr Check kTankChecks[] = {
    {"density_kg_m3", "is", "kg/m3", Usual(60.0, 1700.0),
     "liquid hydrogen 71, kerosene 810, oxygen 1141, nitrogen tetroxide 1443 kg/m3",
     [](const Subject& s) { return s.tank().density_kg_m3; }},
    {"propellant_mass_kg", "fills of the tank", "", Usual(0.5, 0.99),
     "a few per cent of a tank are left to the gas that presses the liquid out",
     [](const Subject& s) {
       return s.tank().propellant_mass_kg / (s.tank().density_kg_m3 * s.tank().Volume());
     }},
};
constexpr Check kTankInStageChecks[] = {
    {"diameter_m", "is, as part of the stage's diameter_m,", "", Usual(0.2, 1.0).Possible(0.0, 1.0),
     "the tank is inside the stage",
     [](const Subject& s) { return s.tank().diameter_m / s.stage().diameter_m; }},
};

constexpr Check kNozzleChecks[] = {
    {"inertia_about_hinge_kg_m2", "is the nozzle's mass at its centre of gravity, about the hinge, times", "",
     Usual(1.0, 10.0).Possible(1.0, kAny), "the parallel axis theorem: above 1 by the nozzle's own extent",
     [](const Subject& s) {
       const Gimbal& gimbal = s.stage().gimbal;
       const double point_kg_m2 = gimbal.nozzle_mass_kg * Square(gimbal.nozzle_cg_m);
       return point_kg_m2 > 0.0 ? gimbal.nozzle_inertia_kg_m2 / point_kg_m2 : kNothing;
     }},
};

}  // namespace

std::span<const Check> StageChecks() { return kStageChecks; }
std::span<const Check> PressureChecks() { return kPressureChecks; }
std::span<const Check> GimbalChecks() { return kGimbalChecks; }
std::span<const Check> CutOffChecks() { return kCutOffChecks; }
std::span<const Check> JettisonChecks() { return kJettisonChecks; }
std::span<const Check> FinChecks() { return kFinChecks; }
std::span<const Check> TankChecks() { return kTankChecks; }
std::span<const Check> TankInStageChecks() { return kTankInStageChecks; }
std::span<const Check> NozzleChecks() { return kNozzleChecks; }

}  // namespace dispersa::plausibility
