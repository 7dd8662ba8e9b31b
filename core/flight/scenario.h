// A flight without autopilot, as a scenario file describes it: plain data, SI and radians.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/aerodynamics.h"
#include "core/dynamics/air_data.h"
#include "core/dynamics/rigid_body.h"
#include "core/math/rotation.h"

namespace dispersa {

class Fields;

/// Mass properties over the propellant that is left, linear between rows. One row: a body that does not
/// change.
struct ScenarioMass {
  std::vector<double> propellant_kg;   ///< from 0, strictly increasing
  std::vector<double> mass_kg;         ///< of the whole vehicle, in proportion to the propellant
  std::vector<double> cg_station_m;    ///< on the body axis, aft of the stations' reference point
  std::vector<Matrix3> inertia_kg_m2;  ///< about the centre of gravity, in body axes, with products of
                                       ///< inertia negated off the diagonal
};

/// Constant thrust along the body axis from ignition until the propellant is used up.
struct ScenarioMotor {
  double ignition_time_s = 0.0;
  double thrust_n = 0.0;  ///< in vacuum
  double flow_kg_s = 0.0;
  double nozzle_exit_area_m2 = 0.0;  ///< P = P_vac - p A_e, never below 0
  double nozzle_station_m = 0.0;
  double nozzle_y_m = 0.0;
  double nozzle_z_m = 0.0;
  bool jet_damping = false;   ///< moment -m_dot r x (w x r), r from CG to nozzle
  double inertia_rate = 1.0;  ///< share of the term -(dI/dt) w of Euler's equations
};

/// The whole vehicle between two separations.
struct ScenarioStage {
  std::string name;
  ScenarioMass mass;
  BodyAerodynamics aerodynamics;
  bool inertial_damping_rates = false;  ///< rate damping by inertial rates instead of Earth-relative ones
  std::optional<ScenarioMotor> motor;
  std::optional<double> separation_time_s;  ///< absent: at burnout (the last stage has none)
};

struct Scenario {
  std::string name;
  Environment environment;
  Geodetic place;
  YawPitchRoll attitude;                  ///< body against local NED
  Vector3 v_EC_N = Vector3::Zero();       ///< relative to the Earth, north, east, down
  Vector3 rates_rad_s = Vector3::Zero();  ///< p, q, r
  bool rates_are_inertial = true;         ///< else relative to the Earth
  std::vector<ScenarioStage> stages;
  double duration_s = 0.0;
  double output_step_s = 0.0;
  double integration_step_s = 0.0;  ///< upper limit: steps divide the time between outputs and events
};

/// The keys of its file.
void Describe(Fields& fields, Scenario& scenario);

/// Contradictions within one stage. Paths start at the stage ("mass_properties.ixx_kg_m2[1]",
/// "motor.nozzle_station_m").
std::vector<StructProblem> Problems(const ScenarioStage& stage);
/// Contradictions between stages, and in the steps ("stages[1].separation_time_s").
std::vector<StructProblem> Problems(const Scenario& scenario);

/// Seconds between ignition and burnout: all propellant over the flow.
double BurnTime(const ScenarioStage& stage);
/// When a stage gives way to the next one.
double SeparationTime(const ScenarioStage& stage);

}  // namespace dispersa
