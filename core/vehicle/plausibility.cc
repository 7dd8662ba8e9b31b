#include "core/vehicle/plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/mould_line.h"
#include "core/vehicle/propulsion.h"
#include "core/vehicle/vehicle_figures.h"

namespace dispersa {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Span {
  double low = -kAny;
  double high = kAny;
  bool Holds(double value) const { return value >= low && value <= high; }
};
constexpr Span kAnything{};

/// The subject of a check: the vehicle, and one of its stages, nozzles or gyros, or a tank of its boosters.
struct Subject {
  const Vehicle& vehicle;
  const std::vector<StageFigures>& figures;
  std::size_t index = 0;
  std::size_t part = 0;  ///< tank or jettisoned body of the stage, lighter table (from 1)
  bool is_booster = false;

  const Tank& tank() const { return (is_booster ? vehicle.boosters.tanks : stage().tanks)[part]; }
  const Jettison& jettison() const { return stage().jettisoned[part]; }
  /// Of the stack, or a lighter one's.
  const AeroTable& table() const {
    const AeroTable& whole = vehicle.aerodynamics[index];
    return part == 0 ? whole : whole.lighter[part - 1].table;
  }
  const Stage& stage() const { return vehicle.stages[index]; }
  const StageFigures& figure() const { return figures[index]; }
  std::size_t last_burn() const {
    return static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(index)));
  }
  bool has_coast_control() const {
    return vehicle.stages.size() > 1 && std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                                                    [](const Stage& one) { return one.is_controlled(); });
  }
  bool is_last() const { return last_burn() + 1 == vehicle.stages.size(); }
  double length_m() const { return vehicle.stages[0].bottom_station_m; }
};

struct Check {
  const char* field;    ///< of the value that most probably is wrong
  const char* implies;  ///< "implies a specific impulse of"
  const char* unit;
  Span possible;  ///< beyond: no such thing can exist
  Span usual;     ///< beyond: none is known
  const char* source;
  double (*value)(const Subject&);  ///< NaN: does not apply
};

// The widest diameter of the mould line between two stations.
double WidestDiameter(const Vehicle& vehicle, double top_m, double bottom_m) {
  constexpr int kSamples = 64;  // sections are far longer than a 64th of a grain
  double widest_m = 0.0;
  for (const MouldSection& section : CutMouldLine(vehicle.profile, vehicle.stages[0].bottom_station_m)) {
    for (int k = 0; k <= kSamples; ++k) {
      const double station_m = top_m + (bottom_m - top_m) * k / kSamples;
      if (station_m >= section.start_m && station_m <= section.end_m)
        widest_m = std::max(widest_m, 2.0 * section.Radius(station_m));
    }
  }
  return widest_m;
}

// Of thrust and chamber pressure over the burn, about 0.
double PressureCorrelation(const ThrustCurve& curve) {
  if (curve.pressure_pa.empty()) return kNothing;
  double both = 0.0, thrust = 0.0, pressure = 0.0;
  for (std::size_t i = 0; i + 1 < curve.time_s.size(); ++i) {
    const double step_s = curve.time_s[i + 1] - curve.time_s[i];
    const double p = 0.5 * (curve.pressure_pa[i] + curve.pressure_pa[i + 1]);
    const double f = 0.5 * (curve.thrust_n[i] + curve.thrust_n[i + 1]);
    both += step_s * p * f;
    thrust += step_s * f * f;
    pressure += step_s * p * p;
  }
  return pressure > 0.0 ? both / Sqrt(thrust * pressure) : 0.0;
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

// Of engines of stages and of boosters.
struct Known {
  Span possible, usual;
  const char* source;
};
constexpr Known kLiquidImpulse = {
    {0.0, 1000.0},
    {200.0, 470.0},
    "in vacuum 220 to 240 s of hydrazine alone, 280 to 330 s of storable pairs, 300 to 360 s of oxygen with "
    "kerosene, to 465 s with hydrogen; combustion never gave more than 550 s, reactors 900 s"};
constexpr Known kResidual = {
    kAnything, {0.0, 0.05}, "0.5 to 3 % of a liquid stage's propellant stays in tanks and lines"};

constexpr Check kStageChecks[] = {
    {"propellant_mass_kg",
     "implies with thrust and burning time a specific impulse of",
     "s",
     {0.0, 1000.0},
     {180.0, 470.0},
     "200 to 410 s of solid and liquid rockets: Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., "
     "table 2-1; "
     "465 s of hydrogen stages in vacuum; combustion never gave more than 550 s, reactors 900 s",
     [](const Subject& s) { return s.stage().is_liquid() ? kNothing : s.figure().specific_impulse_s; }},
    {"motor.liquid.specific_impulse_s", "is", "s", kLiquidImpulse.possible, kLiquidImpulse.usual,
     kLiquidImpulse.source,
     [](const Subject& s) { return s.stage().is_liquid() ? s.figure().specific_impulse_s : kNothing; }},
    {"motor.liquid.residual_mass_kg", "is, as part of the propellant,", "", kResidual.possible,
     kResidual.usual, kResidual.source,
     [](const Subject& s) { return s.stage().motor.residual_mass_kg / s.stage().propellant_mass_kg; }},
    {"tanks",
     "take together, as part of the stage's diameter_m from its bottom to the next stage's (of the last: to "
     "their top),",
     "",
     {0.0, 1.0},
     {0.05, 0.95},
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
    {"motor.thrust_n",
     "implies a thrust to weight at lift-off of",
     "",
     {1.0, kAny},
     {1.15, 12.0},
     "Saturn V 1.2, solid launchers 1.6 to 2.5, sounding rockets to 12; below 1 it never leaves the pad",
     [](const Subject& s) {
       return s.index == 0 && s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n",
     "implies, without a gimbal, a thrust to weight at lift-off of",
     "",
     {1.0, kAny},
     {3.0, 60.0},
     "fins hold a vehicle that leaves its rail with 20 m/s or more",
     [](const Subject& s) {
       return s.index == 0 && !s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n",
     "implies a thrust to weight at ignition of",
     "",
     kAnything,
     {0.05, 12.0},
     "small liquid upper stages from 0.08, solid ones to 8",
     [](const Subject& s) {
       return s.index > 0 && s.stage().is_controlled() ? s.figure().thrust_to_weight : kNothing;
     }},
    {"motor.thrust_n",
     "implies towards burnout a load of",
     "g",
     kAnything,
     {0.05, 20.0},
     "user's manuals of solid launchers state up to 13 g",
     [](const Subject& s) { return s.stage().is_controlled() ? s.figure().burnout_load_g : kNothing; }},
    {"motor.thrust_n",
     "implies towards burnout, without a gimbal, a load of",
     "g",
     kAnything,
     {0.5, 100.0},
     "sounding rockets 10 to 60 g",
     [](const Subject& s) { return s.stage().is_controlled() ? kNothing : s.figure().burnout_load_g; }},
    {"liftoff_mass_kg",
     "implies a dry mass of the stage, as part of its own, of",
     "",
     kAnything,
     {0.03, 0.35},
     "0.05 of large liquid stages, 0.07 to 0.15 of solid ones, more only of the smallest",
     [](const Subject& s) {
       return s.is_last() || !s.stage().is_controlled() ? kNothing : s.figure().structural_fraction;
     }},
    {"liftoff_mass_kg",
     "implies a dry mass of the stage without gimbal, as part of its own, of",
     "",
     kAnything,
     {0.03, 0.6},
     "boosters of sounding rockets have heavy cases and fins: 0.3 to 0.5",
     [](const Subject& s) {
       return s.is_last() || s.stage().is_controlled() ? kNothing : s.figure().structural_fraction;
     }},
    {"liftoff_mass_kg",
     "implies a dry mass of the last stage with payload, as part of its own, of",
     "",
     kAnything,
     {0.05, 0.95},
     "0.2 to 0.8 of upper stages with what they carry",
     [](const Subject& s) { return s.is_last() ? s.figure().structural_fraction : kNothing; }},
    {"grain",
     "implies a propellant density of",
     "kg/m3",
     kAnything,
     {1500.0, 1950.0},
     "solid propellants: Sutton and Biblarz, table 12-1",
     [](const Subject& s) { return s.stage().is_liquid() ? kNothing : PropellantDensity(s.stage()); }},
    {"grain.outer_diameter_m",
     "is, as part of the stage's diameter_m,",
     "",
     {0.0, 1.0},
     {0.5, 1.0},
     "the propellant is inside",
     [](const Subject& s) {
       return s.stage().is_liquid() ? kNothing : s.stage().grain.outer_diameter_m / s.stage().diameter_m;
     }},
    {"diameter_m",
     "is, as part of the profile's largest diameter about this stage's propellant,",
     "",
     kAnything,
     {0.4, 1.02},
     "1 where the case is the skin, less inside a wider fairing",
     [](const Subject& s) {
       const double widest_m =
           WidestDiameter(s.vehicle, s.stage().PropellantTop(), s.stage().PropellantBottom());
       return widest_m > 0.0 ? s.stage().diameter_m / widest_m : kNothing;
     }},
    {"motor.nozzle_exit_area_m2",
     "is, as part of the stage's cross-section,",
     "",
     kAnything,
     {0.02, 1.0},
     "the nozzles end inside the base, or inside the interstage below",
     [](const Subject& s) {
       const double area_m2 = s.stage().motor.nozzle_exit_area_m2;
       return area_m2 > 0.0 ? area_m2 / (0.25 * kPi * Square(s.stage().diameter_m)) : kNothing;
     }},
    {"motor.thrust_curve.table.chamber_pressure",
     "is at most",
     "MPa",
     {0.0, 1000.0},
     {0.2, 30.0},
     "solid motors burn at 3 to 15 MPa; a pressure in bar or psi may stand under another unit",
     [](const Subject& s) {
       const std::vector<double>& pressure_pa = s.stage().motor.thrust_curve.pressure_pa;
       return pressure_pa.empty() ? kNothing
                                  : 1e-6 * *std::max_element(pressure_pa.begin(), pressure_pa.end());
     }},
    {"motor.thrust_curve.table.chamber_pressure",
     "goes with the thrust with a correlation of",
     "",
     kAnything,
     {0.9, kAny},
     "thrust is the pressure times throat area and thrust coefficient, which change little; a channel may "
     "belong to another test or run late",
     [](const Subject& s) { return PressureCorrelation(s.stage().motor.thrust_curve); }},
    {"mass_table.transverse_inertia_kg_m2",
     "is, at ignition, that of the stage's tubes times",
     "",
     kAnything,
     {0.3, 3.0},
     "structure, grain and tanks weigh the same; kg mm2 or an inertia about another point are far off",
     [](const Subject& s) { return TableOverTubes(s, &MassProperties::transverse_inertia_kg_m2); }},
    {"mass_table.axial_inertia_kg_m2",
     "is, at ignition, that of the stage's tubes times",
     "",
     kAnything,
     {0.1, 10.0},
     "structure and grain weigh the same; liquids count as none about the axis",
     [](const Subject& s) { return TableOverTubes(s, &MassProperties::axial_inertia_kg_m2); }},
    {"mass_table.cg_station_m",
     "is, at ignition, from that of the stage's tubes away by",
     "m",
     kAnything,
     {-2.0, 2.0},
     "stations count aft from the nose tip of the full vehicle",
     [](const Subject& s) {
       const auto [table, tubes] = TableAndTubes(s);
       return table.cg_station_m - tubes.cg_station_m;
     }},
    {"motor.published_mass_flow_kg_s",
     "is the flow that propellant and burning time give times",
     "",
     kAnything,
     {0.8, 1.25},
     "near 1: what a source prints as mean flow",
     [](const Subject& s) {
       const double published_kg_s = s.stage().motor.published_mass_flow_kg_s;
       return published_kg_s > 0.0 ? published_kg_s / s.figure().flow_kg_s : kNothing;
     }},
    {"gimbal.limit_rad",
     "lets a nozzle turn by",
     "deg",
     {0.0, 89.0},
     {1.0, 15.0},
     "the Space Shuttle's boosters 8 deg, its main engines 10.5 deg",
     [](const Subject& s) {
       return s.stage().is_controlled() ? s.stage().gimbal.limit_rad * kDegPerRad : kNothing;
     }},
    {"gimbal.bandwidth_rad_s",
     "is",
     "rad/s",
     {1.0, 2000.0},
     {6.0, 250.0},
     "actuators of nozzles have 2 to 20 Hz; slower ones hold no launcher that the air turns over",
     [](const Subject& s) {
       return s.stage().is_controlled() ? s.stage().gimbal.bandwidth_rad_s : kNothing;
     }},
    {"gimbal.rate_limit_rad_s",
     "lets a nozzle turn at",
     "deg/s",
     {0.1, 1000.0},
     {2.0, 120.0},
     "the Space Shuttle's main engines 10 deg/s, small electric actuators to 60 deg/s",
     [](const Subject& s) {
       return s.stage().is_controlled() ? s.stage().gimbal.rate_limit_rad_s * kDegPerRad : kNothing;
     }},
    {"motor.liquid.cut_off.velocity_m_s",
     "is, as an inertial speed,",
     "m/s",
     {500.0, 17000.0},
     {1500.0, 12500.0},
     "a site on the equator moves at 465 m/s, a circle at 200 km has 7784 m/s, escape from there 11,008 m/s",
     [](const Subject& s) {
       return s.stage().motor.cut_off == CutOff::kAtVelocity ? s.stage().motor.cut_off_velocity_m_s
                                                             : kNothing;
     }},
    {"gimbal.radius_m",
     "is, as part of half the stage's diameter_m,",
     "",
     kAnything,
     {0.0, 1.0},
     "the hinges are inside the base",
     [](const Subject& s) {
       if (!s.stage().gimbal.nozzles.empty() || !s.stage().is_controlled()) return kNothing;
       return s.stage().gimbal.radius_m / (0.5 * s.stage().diameter_m);
     }},
};

// Checks of jettisoned masses.
constexpr Check kJettisonChecks[] = {
    {"at.time_s",
     "comes",
     "s after lift-off",
     kAnything,
     {60.0, 1000.0},
     "fairings leave 150 to 300 s after lift-off, above 100 km; sooner the payload meets the air",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtTime ? s.jettison().threshold : kNothing;
     }},
    {"at.altitude_m",
     "comes at",
     "km",
     kAnything,
     {60.0, 200.0},
     "fairings leave at 100 to 140 km; a flight may never come higher than its orbit",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtAltitude ? s.jettison().threshold / 1e3 : kNothing;
     }},
    {"at.heat_flux_w_m2",
     "waits for a free-molecular heating of",
     "W/m2",
     kAnything,
     {10.0, 10000.0},
     "1135 W/m2 of the user's manuals of Ariane 5, Vega and others",
     [](const Subject& s) {
       return s.jettison().trigger == JettisonTrigger::kAtHeatFlux ? s.jettison().threshold : kNothing;
     }},
};

// The value of a table, at an incidence that it has, over Mach number: the one farthest from a value.
double Farthest(const AeroTable& table, const std::vector<double>& values, std::size_t incidence,
                double from) {
  double farthest = from;
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const double value = values[m * table.incidence_rad.size() + incidence];
    if (std::fabs(value - from) > std::fabs(farthest - from)) farthest = value;
  }
  return farthest;
}
// The slope of the normal force from 0 to the first incidence of the table, or to 2 degrees if that is
// nearer.
double NormalSlope(const AeroTable& table, bool of_largest) {
  if (table.incidence_rad.size() < 2 || table.incidence_rad[0] != 0.0) return kNothing;
  double found = kNothing;
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const double* row = table.cn.data() + m * table.incidence_rad.size();
    const double slope = (row[1] - row[0]) / table.incidence_rad[1];
    if (std::isnan(found) || (of_largest ? slope > found : slope < found)) found = slope;
  }
  return found;
}

// For incidences up to 10 degrees. Beyond, and tail first, the axial force may pull a body forwards.
double LeastAxial(const AeroTable& table) {
  constexpr double kSmall_rad = 10.0 * kRadPerDeg;
  double least = kAny;
  for (std::size_t i = 0; i < table.incidence_rad.size(); ++i) {
    if (i > 0 && table.incidence_rad[i] > kSmall_rad) break;
    for (std::size_t m = 0; m < table.mach.size(); ++m)
      least = std::min(least, table.ca[m * table.incidence_rad.size() + i]);
  }
  return least;
}

// Of ca with the motor out over that with power, at the smallest incidence.
double PowerOffExcess(const AeroTable& table, bool of_largest) {
  double found = kNothing;
  for (std::size_t m = 0; m < table.mach.size() && !table.ca_power_off.empty(); ++m) {
    const double excess = table.ca_power_off[table.RowOf(m, 0)] - table.ca[table.RowOf(m, 0)];
    if (std::isnan(found) || (of_largest ? excess > found : excess < found)) found = excess;
  }
  return found;
}

double GreatestOfTable(const std::vector<double>& values) {
  return values.empty() ? kNothing : *std::max_element(values.begin(), values.end());
}

// Checks of the aerodynamic table of each stack.
constexpr Check kAeroChecks[] = {
    {"reference_area_m2",
     "is the cross-section of the stack's lowest stage times",
     "",
     kAnything,
     {0.3, 4.0},
     "the usual reference is the cross-section",
     [](const Subject& s) {
       return s.table().reference_area_m2 / (0.25 * kPi * Square(s.stage().diameter_m));
     }},
    {"reference_length_m",
     "is the diameter of the stack's lowest stage times",
     "",
     kAnything,
     {0.5, 2.0},
     "the usual reference is the diameter; with the length dampings are many times as large",
     [](const Subject& s) { return s.table().reference_length_m / s.stage().diameter_m; }},
    {"table.mach",
     "begin at",
     "",
     kAnything,
     {0.0, 0.9},
     "a launcher is at rest before it flies; below the first one its values hold",
     [](const Subject& s) { return s.index == 0 ? s.table().mach.front() : kNothing; }},
    {"table.mach",
     "end at",
     "",
     kAnything,
     {2.0, kAny},
     "a first stage burns out at Mach 4 to 10; above the last one its values hold",
     [](const Subject& s) { return s.index == 0 ? s.table().mach.back() : kNothing; }},
    {"table.incidence_deg",
     "ends at",
     "deg",
     kAnything,
     {5.0, 180.0},
     "dispersed flights meet 5 to 10 deg; a range to 3.14 may be in radians",
     [](const Subject& s) { return s.table().incidence_rad.back() * kDegPerRad; }},
    {"table.ca",
     "is at least",
     "",
     {0.0, kAny},
     {0.02, kAny},
     "the air resists; skin friction alone gives 0.05 to 0.1",
     [](const Subject& s) { return LeastAxial(s.table()); }},
    {"table.ca",
     "is at most, at the smallest incidence,",
     "",
     {0.0, 20.0},
     {0.0, 2.0},
     "0.2 to 1.2 of launchers, about 1.5 of a blunt face",
     [](const Subject& s) { return Farthest(s.table(), s.table().ca, 0, 0.0); }},
    {"table.ca_power_off",
     "exceeds ca, at the smallest incidence, by at least",
     "",
     {-2.0, 2.0},
     {-0.01, 0.5},
     "without a jet the base is sucked at: 0.05 to 0.25 of its share of the cross-section",
     [](const Subject& s) { return PowerOffExcess(s.table(), false); }},
    {"table.ca_power_off",
     "exceeds ca, at the smallest incidence, by at most",
     "",
     {-2.0, 2.0},
     {-0.01, 0.5},
     "without a jet the base is sucked at: 0.05 to 0.25 of its share of the cross-section",
     [](const Subject& s) { return PowerOffExcess(s.table(), true); }},
    {"table.ca_uncertainty",
     "is, as one standard deviation, at most",
     "",
     kAnything,
     {0.0, 0.5},
     "5 to 10 % of wind tunnels; a part may stand under percent",
     [](const Subject& s) { return GreatestOfTable(s.table().uncertainty.ca); }},
    {"table.cn_uncertainty",
     "is, as one standard deviation, at most",
     "",
     kAnything,
     {0.0, 0.5},
     "5 to 10 % of wind tunnels",
     [](const Subject& s) { return GreatestOfTable(s.table().uncertainty.cn); }},
    {"table.xcp_uncertainty_m",
     "is, as one standard deviation and part of the stack's length, at most",
     "",
     kAnything,
     {0.0, 0.1},
     "0.1 to 1 diameter",
     [](const Subject& s) {
       return GreatestOfTable(s.table().uncertainty.xcp_m) / s.stage().bottom_station_m;
     }},
    {"table.cn",
     "is at an incidence of 0",
     "",
     {-0.05, 0.05},
     {-0.001, 0.001},
     "a body of revolution has no normal force there: incidence is the total angle between axis and flow",
     [](const Subject& s) {
       return s.table().incidence_rad[0] == 0.0 ? Farthest(s.table(), s.table().cn, 0, 0.0) : kNothing;
     }},
    {"table.cn",
     "rises from an incidence of 0 by at least",
     "a radian",
     {0.0, kAny},
     {0.5, kAny},
     "2 by slender-body theory",
     [](const Subject& s) { return NormalSlope(s.table(), false); }},
    {"table.cn",
     "rises from an incidence of 0 by at most",
     "a radian",
     {0.0, 500.0},
     {0.0, 40.0},
     "2 to 4 of bodies, to 30 of finned rockets on their cross-section; 57 times as much has radians under "
     "degrees",
     [](const Subject& s) { return NormalSlope(s.table(), true); }},
    {"table.xcp_station_m",
     "lies, as part of the stack's length, at most",
     "",
     {0.0, 2.0},
     {0.0, 1.0},
     "the air presses on the body",
     [](const Subject& s) {
       const std::vector<double>& xcp_m = s.table().xcp_station_m;
       return *std::max_element(xcp_m.begin(), xcp_m.end()) / s.stage().bottom_station_m;
     }},
    {"table.xcp_station_m",
     "lies, as part of the stack's length, at least",
     "",
     {-1.0, 2.0},
     {0.0, 1.0},
     "the air presses on the body",
     [](const Subject& s) {
       const std::vector<double>& xcp_m = s.table().xcp_station_m;
       return *std::min_element(xcp_m.begin(), xcp_m.end()) / s.stage().bottom_station_m;
     }},
    {"table.cmq_per_rad",
     "is at most",
     "",
     {-kAny, 0.0},
     {-kAny, 0.0},
     "the air takes from a turning body; above 0 it drives it",
     [](const Subject& s) {
       const std::vector<double>& cmq = s.table().cmq_per_rad;
       if (cmq.empty()) return kNothing;
       return *std::max_element(cmq.begin(), cmq.end());
     }},
    {"table.cmq_per_rad",
     "is at least",
     "",
     {-1e6, kAny},
     {-10000.0, kAny},
     "slender-body theory gives with the length L and the diameter d about -(L/d)²: -400 of a fineness of 20",
     [](const Subject& s) {
       const std::vector<double>& cmq = s.table().cmq_per_rad;
       if (cmq.empty()) return kNothing;
       return *std::min_element(cmq.begin(), cmq.end());
     }},
    {"table.clp_per_rad",
     "is at most",
     "",
     {-kAny, 0.0},
     {-kAny, 0.0},
     "the air takes from a rolling body; above 0 it drives it",
     [](const Subject& s) {
       const std::vector<double>& clp = s.table().clp_per_rad;
       if (clp.empty()) return kNothing;
       return *std::max_element(clp.begin(), clp.end());
     }},
};

constexpr Check kTankChecks[] = {
    {"density_kg_m3",
     "is",
     "kg/m3",
     kAnything,
     {60.0, 1700.0},
     "liquid hydrogen 71, kerosene 810, oxygen 1141, nitrogen tetroxide 1443 kg/m3",
     [](const Subject& s) { return s.tank().density_kg_m3; }},
    {"propellant_mass_kg",
     "fills of the tank",
     "",
     kAnything,
     {0.5, 0.99},
     "a few per cent of a tank are left to the gas that presses the liquid out",
     [](const Subject& s) {
       return s.tank().propellant_mass_kg / (s.tank().density_kg_m3 * s.tank().Volume());
     }},
};
constexpr Check kTankInStageChecks[] = {
    {"diameter_m",
     "is, as part of the stage's diameter_m,",
     "",
     {0.0, 1.0},
     {0.2, 1.0},
     "the tank is inside the stage",
     [](const Subject& s) { return s.tank().diameter_m / s.stage().diameter_m; }},
};

constexpr Check kNozzleChecks[] = {
    {"inertia_about_hinge_kg_m2",
     "is the nozzle's mass at its centre of gravity, about the hinge, times",
     "",
     {1.0, kAny},
     {1.0, 10.0},
     "the parallel axis theorem: above 1 by the nozzle's own extent",
     [](const Subject& s) {
       const Gimbal& gimbal = s.stage().gimbal;
       const double point_kg_m2 = gimbal.nozzle_mass_kg * Square(gimbal.nozzle_cg_m);
       return point_kg_m2 > 0.0 ? gimbal.nozzle_inertia_kg_m2 / point_kg_m2 : kNothing;
     }},
};

constexpr Check kGyroChecks[] = {
    {"station_m",
     "lies, as part of the vehicle's length,",
     "",
     {0.0, 1.0},
     {0.0, 1.0},
     "inside the body",
     [](const Subject& s) { return s.vehicle.sensors.rate_gyros[s.index].station_m / s.length_m(); }},
};

constexpr Check kVehicleChecks[] = {
    {"site.latitude_rad",
     "is",
     "deg",
     kAnything,
     {-42.0, 64.0},
     "orbital launch sites lie between 39.3 deg south (Mahia) and 62.9 deg north (Plesetsk); latitude and "
     "longitude "
     "may have changed places",
     [](const Subject& s) { return s.vehicle.site.latitude_rad * kDegPerRad; }},
    {"limits.q_max_pa",
     "is",
     "Pa",
     kAnything,
     {5000.0, 300000.0},
     "launchers meet 20,000 to 90,000 Pa",
     [](const Subject& s) { return s.vehicle.limits.q_max_pa > 0.0 ? s.vehicle.limits.q_max_pa : kNothing; }},
    {"limits.q_alpha_pa_rad",
     "is",
     "Pa rad",
     kAnything,
     {200.0, 30000.0},
     "launchers are limited to 2000 to 7000 Pa rad",
     [](const Subject& s) {
       return s.vehicle.limits.q_alpha_pa_rad > 0.0 ? s.vehicle.limits.q_alpha_pa_rad : kNothing;
     }},
    {"limits.axial_load_g",
     "is",
     "g",
     kAnything,
     {2.0, 50.0},
     "user's manuals of solid launchers state up to 13 g",
     [](const Subject& s) {
       return s.vehicle.limits.axial_load_g > 0.0 ? s.vehicle.limits.axial_load_g : kNothing;
     }},
    {"boosters.propellant_mass_kg",
     "implies with thrust and burning time a specific impulse of",
     "s",
     {0.0, 1000.0},
     {180.0, 310.0},
     "200 to 300 s of solid rockets: Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., table 2-1",
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       if (b.count == 0 || b.is_liquid()) return kNothing;
       return BuildBoosterBurn(b, 1.0, 1.0).ExhaustVelocity() / kStandardGravity;
     }},
    {"boosters.motor.liquid.specific_impulse_s", "is", "s", kLiquidImpulse.possible, kLiquidImpulse.usual,
     kLiquidImpulse.source,
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       return b.is_liquid() ? b.motor.specific_impulse_s : kNothing;
     }},
    {"boosters.motor.liquid.residual_mass_kg", "is, as part of the propellant,", "", kResidual.possible,
     kResidual.usual, kResidual.source,
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       return b.is_liquid() ? b.motor.residual_mass_kg / b.propellant_mass_kg : kNothing;
     }},
    {"boosters.grain",
     "implies a propellant density of",
     "kg/m3",
     {0.0, 2100.0},
     {1500.0, 1950.0},
     "solid propellants: Sutton and Biblarz, table 12-1",
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       if (b.count == 0 || b.is_liquid()) return kNothing;
       const BoosterPropellant grains = BuildBoosterPropellant(b);
       return grains.kilograms_per_area_m2 / (b.count * kPi * grains.length_m);
     }},
    {"sensors.inertial_unit.station_m",
     "lies, as part of the vehicle's length,",
     "",
     {0.0, 1.0},
     {0.0, 1.0},
     "inside the body",
     [](const Subject& s) { return s.vehicle.sensors.inertial_unit_station_m / s.length_m(); }},
    {"profile",
     "implies a length, in diameters, of",
     "",
     kAnything,
     {4.0, 30.0},
     "Vega 10, Saturn V 11, Falcon 9 19, Scout 20",
     [](const Subject& s) {
       const double widest_m = WidestDiameter(s.vehicle, 0.0, s.length_m());
       return widest_m > 0.0 ? s.length_m() / widest_m : kNothing;
     }},
    {"stages",
     "imply together an ideal change of velocity, without losses, of",
     "m/s",
     kAnything,
     {500.0, 14000.0},
     "low orbits ask 9 to 10 km/s with losses, sounding rockets 1 to 4 km/s",
     [](const Subject& s) {
       double sum_m_s = 0.0;
       for (const StageFigures& one : s.figures) sum_m_s += one.ideal_delta_v_m_s;
       return sum_m_s;
     }},
    {"reaction_control.specific_impulse_s",
     "is",
     "s",
     {0.0, 1000.0},
     {30.0, 340.0},
     "cold gas 40 to 75 s, hydrazine 220 to 240 s, two propellants to 330 s",
     [](const Subject& s) {
       return s.has_coast_control() ? s.vehicle.reaction_control.specific_impulse_s : kNothing;
     }},
    {"reaction_control.thrust_n",
     "turns the last stage in pitch and yaw by",
     "deg/s2",
     {0.0, 1000.0},
     {0.01, 60.0},
     "a rate of 1 deg/s should take neither minutes nor less than a cycle to stop",
     [](const Subject& s) {
       if (!s.has_coast_control()) return kNothing;
       const StackMass stack = BuildStackMasses(s.vehicle).back();
       const ReactionControl& control = s.vehicle.reaction_control;
       return 2.0 * control.thrust_n * control.pitch_yaw_arm_m /
              stack.At(stack.propellant_mass_kg).transverse_inertia_kg_m2 * kDegPerRad;
     }},
};

std::string Readable(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::fabs(value) >= 1e4 && std::fabs(value) < 1e9 ? "%.0f" : "%.4g",
                value);
  return text;
}

std::string SpanText(const Span& span, const std::string& unit) {
  const std::string end = unit.empty() ? "" : " " + unit;
  if (!(span.high < kAny)) return Readable(span.low) + end + " or more";
  if (!(span.low > -kAny)) return "up to " + Readable(span.high) + end;
  if (span.low == 0.0) return "up to " + Readable(span.high) + end;
  return Readable(span.low) + " to " + Readable(span.high) + end;
}

// A thrust curve or an engine replaces the key of the thrust.
std::string PathOf(const Check& check, const Subject& subject) {
  const std::string field = check.field;
  if (field == "table.xcp_station_m" && subject.table().is_by_moment) return "table.cm";
  if (field != "motor.thrust_n") return field;
  if (subject.stage().is_liquid()) return "motor.liquid.thrust_n";
  return subject.stage().motor.thrust_curve.empty() ? field : "motor.thrust_curve";
}

template <std::size_t N>
void Apply(const Check (&checks)[N], const Subject& subject, const std::string& prefix,
           std::vector<PlausibilityFinding>& findings) {
  for (const Check& check : checks) {
    const double value = check.value(subject);
    if (std::isnan(value)) continue;
    const bool beyond = !check.possible.Holds(value);
    if (!beyond && check.usual.Holds(value)) continue;
    const bool impossible = beyond && !subject.vehicle.made_up;
    const std::string unit = check.unit;
    findings.push_back({prefix + PathOf(check, subject),
                        std::string(check.implies) + " " + Readable(value) +
                            (unit.empty() ? "" : " " + unit) + (impossible ? ", which cannot be" : ""),
                        SpanText(impossible ? check.possible : check.usual, unit) + " (" + check.source + ")",
                        impossible});
  }
}

}  // namespace

std::vector<PlausibilityFinding> Plausibility(const Vehicle& vehicle) {
  const std::vector<StageFigures> figures = FiguresOf(vehicle);
  std::vector<PlausibilityFinding> findings;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    if (vehicle.stages[i].restarts) continue;  // the same body
    const std::string index = "[" + std::to_string(i) + "].";
    Apply(kStageChecks, {vehicle, figures, i}, "stages" + index, findings);
    for (std::size_t k = 0; k < vehicle.stages[i].tanks.size(); ++k) {
      const std::string tank = "stages" + index + "tanks[" + std::to_string(k) + "].";
      Apply(kTankChecks, {vehicle, figures, i, k}, tank, findings);
      Apply(kTankInStageChecks, {vehicle, figures, i, k}, tank, findings);
    }
    for (std::size_t k = 0; k < vehicle.stages[i].jettisoned.size(); ++k)
      Apply(kJettisonChecks, {vehicle, figures, i, k},
            "stages" + index + "jettisoned[" + std::to_string(k) + "].", findings);
    if (vehicle.stages[i].gimbal.nozzle_mass_kg > 0.0)
      Apply(kNozzleChecks, {vehicle, figures, i}, "nozzles" + index, findings);
  }
  for (std::size_t i = 0; i < vehicle.aerodynamics.size(); ++i)
    for (std::size_t k = 0; k <= vehicle.aerodynamics[i].lighter.size(); ++k)
      Apply(kAeroChecks, {vehicle, figures, i, k},
            "aerodynamics.tables[" + std::to_string(i) + "]." +
                (k == 0 ? "" : "lighter[" + std::to_string(k - 1) + "]."),
            findings);
  for (std::size_t i = 0; i < vehicle.sensors.rate_gyros.size(); ++i)
    Apply(kGyroChecks, {vehicle, figures, i}, "sensors.rate_gyros[" + std::to_string(i) + "].", findings);
  for (std::size_t k = 0; k < vehicle.boosters.tanks.size(); ++k)
    Apply(kTankChecks, {vehicle, figures, 0, k, true}, "boosters.tanks[" + std::to_string(k) + "].",
          findings);
  Apply(kVehicleChecks, {vehicle, figures}, "", findings);
  return findings;
}

}  // namespace dispersa
