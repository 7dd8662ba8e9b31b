#include "core/flight/history_columns.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/flight/history.h"
#include "core/flight/history_row.h"
#include "core/math/lane_eigen.h"

namespace dispersa {

namespace {
constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
}

const std::vector<std::string>& KinematicColumnNames() {
  static const std::vector<std::string> names = {
      "time_s",        "eci_x_m",     "eci_y_m",     "eci_z_m",     "eci_vx_m_s", "eci_vy_m_s",
      "eci_vz_m_s",    "ned_v_n_m_s", "ned_v_e_m_s", "ned_v_d_m_s", "altitude_m", "latitude_deg",
      "longitude_deg", "yaw_deg",     "pitch_deg",   "roll_deg",    "p_deg_s",    "q_deg_s",
      "r_deg_s",       "mach",        "qbar_pa",     "alpha_deg",   "beta_deg",   "mass_kg"};
  return names;
}

const std::vector<LauncherColumn>& LauncherColumns() {
  constexpr auto kRules = &LawInfo::rules, kAdaptation = &LawInfo::adaptation,
                 kAugmentation = &LawInfo::augmentation, kForeign = &LawInfo::foreign;
  static const std::vector<LauncherColumn> columns = {{"stage"},
                                                      {"thrust_n"},
                                                      {"inertial_velocity_m_s"},
                                                      {"flight_path_angle_deg"},
                                                      {"pitch_program_deg"},
                                                      {"pitch_launch_deg"},
                                                      {"pitch_error_deg"},
                                                      {"yaw_error_deg"},
                                                      {"roll_error_deg"},
                                                      {"pitch_rate_error_deg_s"},
                                                      {"deflection_pitch_deg"},
                                                      {"deflection_yaw_deg"},
                                                      {"deflection_roll_deg"},
                                                      {"nozzle1_deg"},
                                                      {"nozzle2_deg"},
                                                      {"nozzle3_deg"},
                                                      {"nozzle4_deg"},
                                                      {"command_pitch_deg"},
                                                      {"control_pitch_deg_s2"},
                                                      {"adaptation_norm_deg_s2", kAdaptation},
                                                      {"lyapunov_v", kRules},
                                                      {"lyapunov_v_rate_sign", kRules},
                                                      {"adaptation_projected", kAdaptation},
                                                      {"adaptation_frozen", kAdaptation},
                                                      {"rules_fired", kRules},
                                                      {"total_gain", kAugmentation},
                                                      {"thruster_roll"},
                                                      {"thruster_pitch"},
                                                      {"thruster_yaw"},
                                                      {"rcs_propellant_kg"},
                                                      {"axial_load_g"},
                                                      {"lateral_load_g"},
                                                      {"incidence_deg"},
                                                      {"law_telemetry_1", kForeign},
                                                      {"law_telemetry_2", kForeign},
                                                      {"law_telemetry_3", kForeign},
                                                      {"law_telemetry_4", kForeign}};
  return columns;
}

namespace {

lanes::RigidMotion<double> MotionOf(const RigidBodyState& s) {
  return {ToLanes(s.p_EoC_I), ToLanes(s.v_IC_I), {s.q_IB.w, s.q_IB.x, s.q_IB.y, s.q_IB.z}, ToLanes(s.w_IB_B)};
}

/// The command about an axis that the deflections stand for.
double FeltAbout(const FlightModel& model, const TickSample& s, Axis axis, double of_cross_rad) {
  const LauncherStack& stack = model.nominal_plant().stacks[static_cast<std::size_t>(s.stack)];
  if (stack.gimbal.nozzles.empty() && !model.nominal_plant().boosters_steer()) return of_cross_rad;
  const NozzleLayout& list = model.nominal_plant().LayoutOf(s.stack, s.boosting);
  double rad = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(list.banks()) * kDrives; ++i)
    rad += list.felt[axis][i] * s.nozzle_rad[i];
  return rad;
}

}  // namespace

void AppendKinematics(const Earth& earth, double time_s, const RigidBodyState& state, const AirData& air,
                      const Vector3& v_AB_B, double mass_kg, std::vector<double>& rows) {
  double row[kBodyColumns];
  lanes::FillBody<double>(earth, {time_s, MotionOf(state), ToLanes(v_AB_B), air.mach, air.qbar_pa, mass_kg},
                          kWholeRow, row);
  rows.insert(rows.end(), std::begin(row), std::end(row));
}

void AppendRow(const FlightModel& model, const TickSample& s, std::vector<double>& rows) {
  const LauncherInstant& now = s.instant;
  const auto& n = s.nozzle_rad;
  const AxisTelemetry& law = s.gimbal.telemetry[kPitch];
  lanes::LauncherSeen<double> seen;
  static_cast<lanes::BodySeen<double>&>(seen) = {s.time_s,     MotionOf(s.state), ToLanes(now.v_AB_B),
                                                 now.air.mach, now.air.qbar_pa,   now.loads.mass_kg};
  seen.stage = s.stack + 1.0;
  seen.burning = s.burning;
  seen.steered = !s.unsteered;
  seen.thrust_n = now.thrust_n;
  seen.force_n = ToLanes(now.loads.force_n);
  seen.R_IL = lanes::MatrixAt(model.frame().R_IL.data());
  seen.program_pitch_rad = s.reference.angles.pitch;
  seen.errors = {ToLanes(s.error.angle_rad), ToLanes(s.error.rate_rad_s)};
  seen.felt_pitch_rad = FeltAbout(model, s, kPitch, 0.5 * (n[0] + n[1]));
  seen.felt_yaw_rad = FeltAbout(model, s, kYaw, 0.5 * (n[2] + n[3]));
  seen.felt_roll_rad = FeltAbout(model, s, kRoll, 0.25 * (n[0] - n[1] + n[2] - n[3]));
  std::copy_n(n.begin(), kNozzles, seen.nozzle_rad);
  seen.command_pitch_rad = s.gimbal.pitch_rad;
  seen.control_rad_s2 = law.command_rad_s2;
  seen.adaptation_norm_rad_s2 = law.adaptation_norm;
  seen.v = law.v;
  seen.v_rate_sign = law.v_rate_sign;
  seen.projected = law.projected ? 1.0 : 0.0;
  seen.frozen = law.frozen ? 1.0 : 0.0;
  seen.rules_fired = std::popcount(law.rules_fired);
  seen.total_gain = law.total_gain;
  seen.thruster_roll = s.thrusters[kRoll];
  seen.thruster_pitch = s.thrusters[kPitch];
  seen.thruster_yaw = s.thrusters[kYaw];
  seen.expelled_kg = s.expelled_mass_kg;
  std::fill(std::begin(seen.law_telemetry), std::end(seen.law_telemetry), kEmpty);
  if (s.law_telemetry) std::copy(s.law_telemetry->begin(), s.law_telemetry->end(), seen.law_telemetry);
  double row[kBodyColumns + kLauncherColumns];
  lanes::FillLauncher<double>(model.nominal_plant().environment.earth, seen, kWholeRow, row);
  rows.insert(rows.end(), std::begin(row), std::end(row));
}

}  // namespace dispersa
