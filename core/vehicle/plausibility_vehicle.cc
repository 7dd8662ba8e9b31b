// Plausibility of a vehicle as a whole.

#include "core/math/constants.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/plausibility_checks.h"
#include "core/vehicle/propulsion.h"

namespace dispersa::plausibility {
namespace {

// Of the whole stack at lift-off, in slow air at a small incidence.
double StaticMargin(const Vehicle& vehicle) {
  constexpr double kSlow = 0.3, kSmall_rad = 2.0 * kRadPerDeg;
  const AeroTable table = AerodynamicsOf(vehicle).front();
  std::size_t mach = 0, incidence = 0;
  while (mach + 1 < table.mach.size() && table.mach[mach] < kSlow) ++mach;
  while (incidence + 1 < table.incidence_rad.size() && table.incidence_rad[incidence] < kSmall_rad)
    ++incidence;
  const StackMass stack = BuildStackMasses(vehicle).front();
  return (table.xcp_station_m[table.RowOf(mach, incidence)] -
          stack.At(stack.propellant_mass_kg).cg_station_m) /
         table.reference_length_m;
}

constexpr Check kGyroChecks[] = {
    {"station_m", "lies, as part of the vehicle's length,", "", Usual(0.0, 1.0).Possible(0.0, 1.0),
     "inside the body",
     [](const Subject& s) { return s.vehicle.sensors.rate_gyros[s.index].station_m / s.length_m(); }},
};

constexpr Check kVehicleChecks[] = {
    {"site.latitude_rad", "is", "deg", Usual(-45.0, 79.5),
     "launch sites lie between 39.3 deg south (Mahia) and 78.9 deg north (Ny-Alesund); latitude and "
     "longitude "
     "may have changed places",
     [](const Subject& s) { return s.vehicle.site.latitude_rad * kDegPerRad; }},
    {"descent.parachute.deployment_altitude_m", "is above the ground of the impact area by", "m",
     Usual(50.0, kAny).Possible(0.0, kAny),
     "below the ground it never opens; ground_altitude_m and deployment altitude count from the ellipsoid",
     [](const Subject& s) {
       const Descent& descent = s.vehicle.descent;
       return descent.parachute_area_m2 > 0.0 ? descent.parachute_altitude_m - descent.ground_altitude_m
                                              : kNothing;
     }},
    {"stages[0].fins",
     "put the centre of pressure of the uncontrolled vehicle behind its centre of gravity, at lift-off, by",
     "diameters", Usual(0.0, kAny), "with a static margin below 0 it turns over; 1 to 3 are usual",
     [](const Subject& s) {
       return s.vehicle.stages[0].is_controlled() ? kNothing : StaticMargin(s.vehicle);
     }},
    {"boosters.bottom_station_m", "is, as part of the first stage's,", "", Usual(0.4, 1.15),
     "boosters stand beside the first stage",
     [](const Subject& s) {
       return s.vehicle.boosters.count > 0 ? s.vehicle.boosters.bottom_station_m / s.length_m() : kNothing;
     }},
    {"boosters.nozzle_station_m", "is, as part of the boosters' bottom_station_m,", "", Usual(0.5, 1.05),
     "the nozzles end inside the base",
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       return b.count > 0 ? b.nozzle_station_m / b.bottom_station_m : kNothing;
     }},
    {"limits.q_max_pa", "is", "Pa", Usual(5000.0, 300000.0), "launchers meet 20,000 to 90,000 Pa",
     [](const Subject& s) { return s.vehicle.limits.q_max_pa > 0.0 ? s.vehicle.limits.q_max_pa : kNothing; }},
    {"limits.q_alpha_pa_rad", "is", "Pa rad", Usual(200.0, 30000.0),
     "launchers are limited to 2000 to 7000 Pa rad",
     [](const Subject& s) {
       return s.vehicle.limits.q_alpha_pa_rad > 0.0 ? s.vehicle.limits.q_alpha_pa_rad : kNothing;
     }},
    {"limits.axial_load_g", "is", "g", Usual(2.0, 50.0), "user's manuals of solid launchers state up to 13 g",
     [](const Subject& s) {
       return s.vehicle.limits.axial_load_g > 0.0 ? s.vehicle.limits.axial_load_g : kNothing;
     }},
    {"boosters.propellant_mass_kg", "implies with thrust and burning time a specific impulse of", "s",
     Usual(180.0, 310.0).Possible(0.0, 1000.0),
     "200 to 300 s of solid rockets: Sutton and Biblarz, Rocket Propulsion Elements, 7th ed., table 2-1",
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       if (b.count == 0 || b.is_liquid()) return kNothing;
       return BuildBoosterBurn(b, 1.0, 1.0).ExhaustVelocity() / kStandardGravity;
     }},
    {"boosters.motor.liquid.specific_impulse_s", "is", "s", kLiquidImpulse.spans, kLiquidImpulse.source,
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       return b.is_liquid() ? b.motor.specific_impulse_s : kNothing;
     }},
    {"boosters.motor.liquid.residual_mass_kg", "is, as part of the propellant,", "", kResidual.spans,
     kResidual.source,
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       return b.is_liquid() ? b.motor.residual_mass_kg / b.propellant_mass_kg : kNothing;
     }},
    {"boosters.grain", "implies a propellant density of", "kg/m3",
     Usual(1500.0, 1950.0).Possible(0.0, 2100.0), "solid propellants: Sutton and Biblarz, table 12-1",
     [](const Subject& s) {
       const Boosters& b = s.vehicle.boosters;
       if (b.count == 0 || b.is_liquid()) return kNothing;
       const BoosterPropellant grains = BuildBoosterPropellant(b);
       return grains.kilograms_per_area_m2 / (b.count * kPi * grains.length_m);
     }},
    {"sensors.inertial_unit.station_m", "lies, as part of the vehicle's length,", "",
     Usual(0.0, 1.0).Possible(0.0, 1.0), "inside the body",
     [](const Subject& s) { return s.vehicle.sensors.inertial_unit_station_m / s.length_m(); }},
    {"profile", "implies a length, in diameters, of", "", Usual(4.0, 30.0),
     "Vega 10, Saturn V 11, Falcon 9 19, Scout 20",
     [](const Subject& s) {
       const double widest_m = WidestDiameter(s.vehicle, 0.0, s.length_m());
       return widest_m > 0.0 ? s.length_m() / widest_m : kNothing;
     }},
    {"stages", "imply together an ideal change of velocity, without losses, of", "m/s", Usual(500.0, 14000.0),
     "low orbits ask 9 to 10 km/s with losses, sounding rockets 1 to 4 km/s",
     [](const Subject& s) {
       double sum_m_s = 0.0;
       for (const StageFigures& one : s.figures) sum_m_s += one.ideal_delta_v_m_s;
       return sum_m_s;
     }},
    {"reaction_control.specific_impulse_s", "is", "s", Usual(30.0, 340.0).Possible(0.0, 1000.0),
     "cold gas 40 to 75 s, hydrazine 220 to 240 s, two propellants to 330 s",
     [](const Subject& s) {
       return s.has_coast_control() ? s.vehicle.reaction_control.specific_impulse_s : kNothing;
     }},
    {"reaction_control.thrust_n", "turns the last stage in pitch and yaw by", "deg/s2",
     Usual(0.01, 60.0).Possible(0.0, 1000.0),
     "a rate of 1 deg/s should take neither minutes nor less than a cycle to stop",
     [](const Subject& s) {
       if (!s.has_coast_control()) return kNothing;
       const StackMass stack = BuildStackMasses(s.vehicle).back();
       const ReactionControl& control = s.vehicle.reaction_control;
       return 2.0 * control.thrust_n * control.pitch_yaw_arm_m /
              stack.At(stack.propellant_mass_kg).transverse_inertia_kg_m2 * kDegPerRad;
     }},
};

}  // namespace

std::span<const Check> GyroChecks() { return kGyroChecks; }
std::span<const Check> VehicleChecks() { return kVehicleChecks; }

}  // namespace dispersa::plausibility
