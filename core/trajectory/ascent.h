// The 3DOF model of an ascent: a point mass in three dimensions with the attitude of the flight program.
// Environment, aerodynamics, propulsion, mass and sequence are those of the 6DOF flight. The paper's planar
// equations (1) to (7) are a special case.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/environment/weather_profile.h"
#include "core/flight/flight_model.h"
#include "core/flight/launch_frame.h"
#include "core/flight/orbit.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Programmed incidence, rad, negative (nose down). It is 0 to t1, falls to -alpha_max at t3, returns to 0 at
/// t2, and is 0 after. The ramps are quintics without rate or acceleration at their ends (10 s³ - 15 s⁴ + 6
/// s⁵), so the autopilot sees no jump.
double ProgrammedIncidence(const FlightProgram& program, double time_s);

/// The data that all ascents of a vehicle share.
struct AscentModel {
  Vehicle vehicle;
  LauncherPlant plant;
  FlightWeather weather;  ///< of the plant's environment
  double tick_s = 0.01;   ///< burnout is detected on the autopilot's ticks
  /// Propellant that the reaction control expels during the coast. A point mass has no attitude to hold, so
  /// the mass is removed at once when the last stage begins. Only that stage's thrust and thin air depend on
  /// it.
  double reaction_control_propellant_kg = 0.0;
};

/// Largest integration steps. A step ends at every event and at every kink of thrust or program.
struct AscentSteps {
  double air_s = 0.1;    ///< to the first stage's burnout, where kinks in the tables of the air matter
  double burn_s = 0.5;   ///< while a later motor burns
  double coast_s = 5.0;  ///< while no motor burns
};

inline AscentSteps HalvedSteps(const AscentSteps& steps) {
  return {0.5 * steps.air_s, 0.5 * steps.burn_s, 0.5 * steps.coast_s};
}

struct AscentOptions {
  AscentSteps steps;
  bool record = false;    ///< keep samples and the attitude program, one for each step
  double mach_low = 0.8;  ///< of the transonic range
  double mach_high = 1.2;
};

struct AscentSample {
  double time_s = 0.0;
  int stage = 0;  ///< 1-based
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;           ///< inertial
  double relative_velocity_m_s = 0.0;  ///< to the rotating Earth
  double flight_path_angle_rad = 0.0;  ///< inertial
  double relative_path_angle_rad = 0.0;
  double alpha_rad = 0.0;  ///< programmed
  double pitch_rad = 0.0;  ///< in the launch-inertial frame (the paper's phi)
  double yaw_rad = 0.0;
  double roll_rad = 0.0;
  double mach = 0.0;
  double qbar_pa = 0.0;
  double axial_load_g = 0.0;
  double mass_kg = 0.0;
  Vector3 p_EoC_I = Vector3::Zero();
  Vector3 v_IC_I = Vector3::Zero();
};

struct AscentResult {
  bool completed = false;  ///< false: the ascent fell back to the ground
  double end_time_s = 0.0;
  Orbit orbit;  ///< at injection
  Vector3 p_EoC_I = Vector3::Zero();
  Vector3 v_IC_I = Vector3::Zero();
  double last_ignition_s = 0.0;
  /// Burn times of engines that are cut off at a velocity, by stage; infinite for burns to depletion.
  std::array<double, kMaxStages> cut_off_s = AllStages(HUGE_VAL);
  std::vector<double> jettison_s;  ///< one for each of the plant's jettisons (infinite: never)
  std::array<double, kMaxStages> earlier_ignition_s{};  ///< stages before the last with an ignition timer
  double q_max_pa = 0.0;
  double q_alpha_max_pa_rad = 0.0;
  double axial_load_max_g = 0.0;
  double lateral_load_max_g = 0.0;
  double turn_rate_max_rad_s = 0.0;  ///< of the body axis in the pitch-over
  double mach_at_t2 = 0.0;
  double transonic_alpha_max_rad = 0.0;  ///< largest |programmed alpha| between the Mach limits
  std::vector<AscentSample> samples;     ///< with `record`
  AttitudeProgram attitude;              ///< with `record`
};

AscentModel BuildAscentModel(const Vehicle& vehicle, double tick_s);

/// Flies the program. Event times are exact: steps end at them, and they are never rounded. At a kink the
/// program is evaluated on the side of the step.
AscentResult FlyAscent(const AscentModel& model, const FlightProgram& program, const AscentOptions& options);

/// Default number of ascents side by side: one AVX2 register.
inline constexpr int kAscentWidth = 4;

/// FlyAscent for each program, `width` at a time (1, 4 or 8). The width does not change a bit of the results.
/// Throws std::invalid_argument for another width.
std::vector<AscentResult> FlyAscents(const AscentModel& model, std::span<const FlightProgram> programs,
                                     const AscentOptions& options, int width = kAscentWidth);

}  // namespace dispersa
