#include "core/flight/history_columns.h"

#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "core/flight/history.h"
#include "core/flight/orbit.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

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

unsigned PartsOf(int column) {
  static const std::vector<unsigned> parts = [] {
    const std::map<std::string, unsigned> of = {{"ned_v_n_m_s", kNorthEastDown | kInstant},
                                                {"ned_v_e_m_s", kNorthEastDown | kInstant},
                                                {"ned_v_d_m_s", kNorthEastDown | kInstant},
                                                {"altitude_m", kPlace},
                                                {"latitude_deg", kPlace},
                                                {"longitude_deg", kPlace},
                                                {"yaw_deg", kNorthEastDown | kInstant},
                                                {"pitch_deg", kNorthEastDown | kInstant},
                                                {"roll_deg", kNorthEastDown | kInstant},
                                                {"mach", kInstant},
                                                {"qbar_pa", kInstant},
                                                {"alpha_deg", kFlow | kInstant},
                                                {"beta_deg", kFlow | kInstant},
                                                {"mass_kg", kInstant},
                                                {"thrust_n", kInstant},
                                                {"inertial_velocity_m_s", kOrbit},
                                                {"flight_path_angle_deg", kOrbit},
                                                {"pitch_program_deg", kProgram},
                                                {"pitch_launch_deg", kLaunchAttitude},
                                                {"axial_load_g", kInstant},
                                                {"lateral_load_g", kInstant},
                                                {"incidence_deg", kFlow | kInstant}};
    std::vector<unsigned> list;
    for (const std::string& name : HistoryColumns()) {
      const auto found = of.find(name);
      list.push_back(found == of.end() ? 0u : found->second);
    }
    return list;
  }();
  return parts[static_cast<std::size_t>(column)];
}

void AppendKinematics(const Earth& earth, double time_s, const RigidBodyState& s, const AirData& air,
                      const Vector3& v_AB_B, double mass_kg, std::vector<double>& row, unsigned parts) {
  Geodetic place{};
  if (parts & kPlace) place = ToGeodetic(earth, InertialToEarth(earth, time_s, s.p_EoC_I));
  Vector3 v_EC_N = Vector3::Zero();
  YawPitchRoll attitude{};
  if (parts & kNorthEastDown) {
    // The axes of the place in I: the longitude of `air.place` is measured there.
    const Matrix3 R_IN = NedAxes(air.place.latitude_rad, air.place.longitude_rad);
    const double omega = earth.rotation_rate_rad_s;
    const Vector3 v_EC_I(s.v_IC_I.x() + omega * s.p_EoC_I.y(), s.v_IC_I.y() - omega * s.p_EoC_I.x(),
                         s.v_IC_I.z());
    v_EC_N = R_IN.transpose() * v_EC_I;
    attitude = ToYawPitchRoll(Inverse(QuaternionOf(R_IN)) * s.q_IB);
  }
  const double speed = parts & kFlow ? v_AB_B.norm() : 0.0;
  const double alpha = speed > 0.0 ? Atan2(v_AB_B.z(), v_AB_B.x()) : 0.0;
  const double beta = speed > 0.0 ? Asin(Clamp(v_AB_B.y() / speed, -1.0, 1.0)) : 0.0;
  row.insert(row.end(), {time_s,
                         s.p_EoC_I.x(),
                         s.p_EoC_I.y(),
                         s.p_EoC_I.z(),
                         s.v_IC_I.x(),
                         s.v_IC_I.y(),
                         s.v_IC_I.z(),
                         v_EC_N.x(),
                         v_EC_N.y(),
                         v_EC_N.z(),
                         place.altitude_m,
                         place.latitude_rad * kDegPerRad,
                         place.longitude_rad * kDegPerRad,
                         attitude.yaw * kDegPerRad,
                         attitude.pitch * kDegPerRad,
                         attitude.roll * kDegPerRad,
                         s.w_IB_B.x() * kDegPerRad,
                         s.w_IB_B.y() * kDegPerRad,
                         s.w_IB_B.z() * kDegPerRad,
                         air.mach,
                         air.qbar_pa,
                         alpha * kDegPerRad,
                         beta * kDegPerRad,
                         mass_kg});
}

void AppendLauncher(const FlightModel& model, const TickSample& s, std::vector<double>& row, unsigned parts) {
  const LauncherInstant& now = s.instant;
  OrbitElements orbit{};
  if (parts & kOrbit)
    orbit = ElementsOf(model.nominal_plant().environment.earth, s.state.p_EoC_I, s.state.v_IC_I);
  PitchYawRoll attitude{};
  if (parts & kLaunchAttitude) attitude = ToPitchYawRoll(Inverse(model.frame().q_IL) * s.state.q_IB);
  Vector3 specific = Vector3::Zero();
  if (parts & kInstant) specific = now.loads.force_n / (now.loads.mass_kg * kStandardGravity);
  const AxisTelemetry& t = s.gimbal.telemetry[kPitch];
  const auto steered = [&](double value) { return s.unsteered ? kEmpty : value; };
  const auto powered = [&](double value) { return s.burning ? steered(value) : kEmpty; };
  const auto told = [&](std::size_t i) { return s.law_telemetry ? powered((*s.law_telemetry)[i]) : kEmpty; };
  const auto& n = s.nozzle_rad;
  const LauncherStack& stack = model.nominal_plant().stacks[static_cast<std::size_t>(s.stack)];
  const NozzleLayout* const list = stack.gimbal.nozzles.empty() && !model.nominal_plant().boosters_steer()
                                       ? nullptr
                                       : &model.nominal_plant().LayoutOf(s.stack, s.boosting);
  const auto felt = [&](Axis axis, double of_cross_rad) {
    if (list == nullptr) return of_cross_rad * kDegPerRad;
    double rad = 0.0;
    const std::size_t drives = static_cast<std::size_t>(list->banks()) * kDrives;
    for (std::size_t i = 0; i < drives; ++i) rad += list->felt[axis][i] * n[i];
    return rad * kDegPerRad;
  };
  row.insert(row.end(), {s.stack + 1.0,
                         now.thrust_n,
                         orbit.speed_m_s,
                         orbit.flight_path_angle_rad * kDegPerRad,
                         steered(s.reference.angles.pitch * kDegPerRad),
                         attitude.pitch * kDegPerRad,
                         steered(-s.error.angle_rad.y() * kDegPerRad),
                         steered(-s.error.angle_rad.z() * kDegPerRad),
                         steered(-s.error.angle_rad.x() * kDegPerRad),
                         steered(-s.error.rate_rad_s.y() * kDegPerRad),
                         steered(felt(kPitch, 0.5 * (n[0] + n[1]))),
                         steered(felt(kYaw, 0.5 * (n[2] + n[3]))),
                         steered(felt(kRoll, 0.25 * (n[0] - n[1] + n[2] - n[3]))),
                         steered(n[0] * kDegPerRad),
                         steered(n[1] * kDegPerRad),
                         steered(n[2] * kDegPerRad),
                         steered(n[3] * kDegPerRad),
                         powered(s.gimbal.pitch_rad * kDegPerRad),
                         powered(t.command_rad_s2 * kDegPerRad),
                         powered(t.adaptation_norm * kDegPerRad),
                         powered(t.v),
                         powered(t.v_rate_sign),
                         powered(t.projected ? 1.0 : 0.0),
                         powered(t.frozen ? 1.0 : 0.0),
                         powered(std::popcount(t.rules_fired)),
                         powered(t.total_gain),
                         static_cast<double>(s.thrusters[kRoll]),
                         static_cast<double>(s.thrusters[kPitch]),
                         static_cast<double>(s.thrusters[kYaw]),
                         s.expelled_mass_kg,
                         specific.x(),
                         Sqrt(specific.y() * specific.y() + specific.z() * specific.z()),
                         parts & kFlow ? TotalIncidence(now.v_AB_B) * kDegPerRad : 0.0,
                         told(0),
                         told(1),
                         told(2),
                         told(3)});
  static_assert(kLawTelemetry == 4);
}

}  // namespace dispersa
