// The paper's equations against the engine (U. Ansari, S. Alam, S. M. un Nabi Jafri, "Trajectory optimization
// and Adaptive Fuzzy based Launch Vehicle Attitude Control"): the exact form of (9) to (17), written here
// once more from first principles; the printed form; and the planar equations (1) to (7).
//
// Axes of the paper, here: launch frame L fixed to the Earth, x downrange, y up at the site, z right; body
// x forward, y up, z right. Rotation order, each about the axis that the ones before have made:
//   L -> velocity axes: theta about z, sigma about y
//     (velocity = V (cos theta cos sigma, sin theta cos sigma, -sin sigma) in L),
//   velocity axes -> body: nu about x (the paper has nu = 0), then alpha about z, then beta about y.
// This order alpha, beta is what the thrust terms of (9) to (11) imply. Forces of the air in velocity axes
// before nu are (-D, L, C). a_c = 2 Omega x v and a_e = Omega x (Omega x p).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/campaign_yaml/load.h"
#include "core/dynamics/launcher.h"
#include "core/flight/flight_model.h"
#include "core/flight/launch_frame.h"
#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "core/trajectory/ascent.h"

namespace dispersa::paper_equations_test {
namespace {

using std::cos;
using std::sin;

constexpr double kRadius_m = 6371000.0;

const Vehicle& Slv4() {
  static const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  return vehicle;
}

Matrix3 AboutX(double a) {
  Matrix3 r;
  r << 1, 0, 0, 0, cos(a), -sin(a), 0, sin(a), cos(a);
  return r;
}
Matrix3 AboutY(double a) {
  Matrix3 r;
  r << cos(a), 0, sin(a), 0, 1, 0, -sin(a), 0, cos(a);
  return r;
}
Matrix3 AboutZ(double a) {
  Matrix3 r;
  r << cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1;
  return r;
}

// A state in the paper's variables.
struct PaperState {
  double range_angle = 0.0;  // eta, in the launch plane
  double cross_m = 0.0;      // out of the launch plane
  double altitude_m = 0.0;
  double V = 0.0, theta = 0.0, sigma = 0.0, nu = 0.0, alpha = 0.0, beta = 0.0;
  Vector3 w = Vector3::Zero();  // inertial angular velocity in the paper's body axes
  double delta_phi = 0.0, delta_psi = 0.0, delta_gamma = 0.0;
  double misalignment = 0.0, misalignment_clock = 0.0;  // from right towards down
  double time_s = 0.0;
};

// Rates in the paper's variables.
struct PaperRates {
  double V_dot = 0.0, theta_dot = 0.0, sigma_dot = 0.0;
  Vector3 w_dot = Vector3::Zero();
};

// Everything about one state that equations need besides the state.
struct Setting {
  LauncherPlant plant;
  LauncherPhase phase;
  LaunchFrame frame;
  Matrix3 R_IL;  // the paper's L

  explicit Setting(int stack) {
    static const LauncherPlant nominal = BuildNominalPlant(Slv4());
    plant = nominal;
    plant.environment.earth = SphericalEarth(kRadius_m, true);
    plant.flow_coriolis = false;  // the paper knows nothing of the flow inside
    phase.stack = stack;
    phase.burning = true;
    frame = BuildLaunchFrame(plant.environment.earth, Slv4().site, 2.8);
    R_IL.col(0) = frame.R_IL.col(0);
    R_IL.col(1) = -frame.R_IL.col(2);
    R_IL.col(2) = frame.R_IL.col(1);
  }
  const LauncherStack& stack() const { return plant.stacks[static_cast<std::size_t>(phase.stack)]; }
  Vector3 omega_L() const {
    return R_IL.transpose() * Vector3(0.0, 0.0, plant.environment.earth.rotation_rate_rad_s);
  }
};

Matrix3 VelocityAxes(const PaperState& s) { return AboutZ(s.theta) * AboutY(s.sigma); }
Matrix3 BodyInVelocityAxes(const PaperState& s) { return AboutX(s.nu) * AboutZ(s.alpha) * AboutY(s.beta); }
Vector3 PositionInL(const PaperState& s) {
  const double r = kRadius_m + s.altitude_m;
  return Vector3(r * sin(s.range_angle), r * cos(s.range_angle), s.cross_m);
}

// The engine's own answer -----------------------------------------------------------------------------

// Columns: the engine's body axes (forward, right, down) in the paper's.
Matrix3 EngineBodyInPaperBody() {
  Matrix3 m;
  m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return m;
}

std::array<double, kLauncherSize> EngineState(const Setting& setting, const PaperState& s) {
  const Matrix3 R_LV = VelocityAxes(s);
  const Matrix3 R_LB = R_LV * BodyInVelocityAxes(s);
  const Vector3 omega_I(0.0, 0.0, setting.plant.environment.earth.rotation_rate_rad_s);
  RigidBodyState state;
  state.p_EoC_I = setting.R_IL * PositionInL(s);
  state.v_IC_I = setting.R_IL * R_LV.col(0) * s.V + omega_I.cross(state.p_EoC_I);
  state.q_IB = QuaternionOf(setting.R_IL * R_LB * EngineBodyInPaperBody());
  state.w_IB_B = EngineBodyInPaperBody().transpose() * s.w;
  std::array<double, kLauncherSize> y{};
  WriteState(state, y.data());
  // Positive pitch of the engine turns the thrust down and the nose up: -delta_phi. Likewise roll.
  y[kNozzleAngle + 0] = -(s.delta_phi + s.delta_gamma);
  y[kNozzleAngle + 1] = -(s.delta_phi - s.delta_gamma);
  y[kNozzleAngle + 2] = s.delta_psi - s.delta_gamma;
  y[kNozzleAngle + 3] = s.delta_psi + s.delta_gamma;
  return y;
}

PaperRates Engine(const Setting& setting, const PaperState& s) {
  const auto y = EngineState(setting, s);
  std::array<double, kLauncherSize> dydt{};
  LauncherModel(setting.plant).Derivative(setting.phase, s.time_s, y.data(), dydt.data());
  const RigidBodyState rate = ReadState(dydt.data()), state = ReadState(y.data());
  // v_EC = v_IC - Omega x p; its rate as seen from the turning Earth.
  const Vector3 omega_I(0.0, 0.0, setting.plant.environment.earth.rotation_rate_rad_s);
  const Vector3 v_I = state.v_IC_I - omega_I.cross(state.p_EoC_I);
  const Vector3 a_I = rate.v_IC_I - omega_I.cross(state.v_IC_I) - omega_I.cross(v_I);
  const Vector3 v = setting.R_IL.transpose() * v_I, a = setting.R_IL.transpose() * a_I;
  PaperRates out;
  out.V_dot = v.dot(a) / v.norm();
  out.theta_dot = (v.x() * a.y() - v.y() * a.x()) / (v.x() * v.x() + v.y() * v.y());
  // sigma = -asin(vz / V)
  out.sigma_dot = -(a.z() - v.z() / v.norm() * out.V_dot) / std::hypot(v.x(), v.y());
  out.w_dot = EngineBodyInPaperBody() * rate.w_IB_B;
  return out;
}

// The equations ------------------------------------------------------------------------------------------

// Quantities that the equations take as given: mass, inertia, stations, thrust, coefficients.
struct Given {
  double m, P, x_z, x_R, x_d, z_r, Jx, Jt;
  double D, L, C;   // before nu
  Vector3 damping;  // moments that (12) to (14) leave out, in the paper's body axes
};

Given GivenAt(const Setting& setting, const PaperState& s) {
  const LauncherStack& stack = setting.stack();
  const double since = s.time_s - setting.phase.ignition_s;
  const MassProperties mass = stack.mass.At(stack.burn.Propellant(since));
  Given g;
  g.m = mass.mass_kg;
  g.P = 0.25 * stack.burn.vacuum_thrust_n;
  g.x_z = mass.cg_station_m;
  g.x_R = stack.gimbal.pivot_station_m;
  g.z_r = stack.gimbal.radius_m;
  g.Jx = mass.axial_inertia_kg_m2;
  g.Jt = mass.transverse_inertia_kg_m2;

  const auto y = EngineState(setting, s);
  const AirData air =
      ComputeAirData(setting.plant.environment, ReadState(y.data()).p_EoC_I, ReadState(y.data()).v_IC_I);
  const BodyAerodynamics& body = stack.aerodynamics;
  const double qs = 0.5 * air.density_kg_m3 * s.V * s.V * body.area_m2;
  // Velocity in body axes: (cos a cos b, -sin a, cos a sin b).
  const double across = std::hypot(sin(s.alpha), cos(s.alpha) * sin(s.beta));
  const double incidence = std::atan2(across, cos(s.alpha) * cos(s.beta));
  const double axial = qs * body.ca.table(air.mach, incidence);
  const double normal = qs * body.cn.table(air.mach, incidence);
  const Vector3 force(-axial, normal * sin(s.alpha) / across, -normal * cos(s.alpha) * sin(s.beta) / across);
  const Vector3 in_velocity_axes = AboutZ(s.alpha) * AboutY(s.beta) * force;
  g.D = -in_velocity_axes.x();
  g.L = in_velocity_axes.y();
  g.C = in_velocity_axes.z();
  g.x_d = body.xcp_station_m.table(air.mach, incidence);

  const double flow = stack.burn.full_flow_kg_s;
  const double lever = g.x_R - g.x_z;
  const double twice_v = 2.0 * s.V;
  const Matrix3 R_LB = VelocityAxes(s) * BodyInVelocityAxes(s);
  const Vector3 w_air = s.w - R_LB.transpose() * setting.omega_L();
  const double roll = qs * body.length_m * body.length_m / twice_v * body.clp.table(air.mach, 0.0);
  const double pitch = qs * body.length_m * body.length_m / twice_v * body.cmq.table(air.mach, 0.0);
  const double roll_inertia = flow * (mass.axial_inertia_per_kg - g.z_r * g.z_r);
  const double pitch_inertia = flow * (mass.transverse_inertia_per_kg - lever * lever);
  g.damping = Vector3(roll * w_air.x() + roll_inertia * s.w.x(), pitch * w_air.y() + pitch_inertia * s.w.y(),
                      pitch * w_air.z() + pitch_inertia * s.w.z());
  return g;
}

Vector3 Gravity(const Setting& setting, const PaperState& s) {
  const Vector3 p = PositionInL(s);
  return -setting.plant.environment.earth.mu_m3_s2 / std::pow(p.norm(), 3) * p;
}
Vector3 Coriolis(const Setting& setting, const PaperState& s) {
  return 2.0 * setting.omega_L().cross(VelocityAxes(s).col(0) * s.V);
}
Vector3 Transport(const Setting& setting, const PaperState& s) {
  return setting.omega_L().cross(setting.omega_L().cross(PositionInL(s)));
}

// The exact equations: (9) to (14) with every misprint of services/docs/pages/verification.md corrected.
PaperRates Exact(const Setting& setting, const PaperState& s) {
  const Given g = GivenAt(setting, s);
  // Nozzles right, left (z = ±r) and bottom, top (y = -r, +r), each turned in its plane; then the
  // misalignment tilts all of them towards (0, -sin, cos) of its clock.
  const Vector3 towards(0.0, -sin(s.misalignment_clock), cos(s.misalignment_clock));
  const Vector3 axis = Vector3(1.0, 0.0, 0.0).cross(towards);
  const auto tilted = [&](const Vector3& f) -> Vector3 {
    return f * cos(s.misalignment) + axis.cross(f) * sin(s.misalignment) +
           axis * axis.dot(f) * (1.0 - cos(s.misalignment));
  };
  struct Nozzle {
    Vector3 place, force;
  };
  const double right = s.delta_phi + s.delta_gamma, left = s.delta_phi - s.delta_gamma;
  const double bottom = s.delta_psi - s.delta_gamma, top = s.delta_psi + s.delta_gamma;
  const double l = g.x_R - g.x_z;
  const Nozzle nozzles[] = {{Vector3(-l, 0.0, g.z_r), Vector3(cos(right), sin(right), 0.0)},
                            {Vector3(-l, 0.0, -g.z_r), Vector3(cos(left), sin(left), 0.0)},
                            {Vector3(-l, -g.z_r, 0.0), Vector3(cos(bottom), 0.0, -sin(bottom))},
                            {Vector3(-l, g.z_r, 0.0), Vector3(cos(top), 0.0, -sin(top))}};
  Vector3 thrust = Vector3::Zero(), moment = g.damping;
  for (const Nozzle& nozzle : nozzles) {
    const Vector3 force = g.P * tilted(nozzle.force);
    thrust += force;
    moment += nozzle.place.cross(force);
  }
  const Vector3 air_in_velocity_axes(-g.D, g.L, g.C);
  const Vector3 air_B = (AboutZ(s.alpha) * AboutY(s.beta)).transpose() * air_in_velocity_axes;
  moment += Vector3(g.x_z - g.x_d, 0.0, 0.0).cross(air_B);

  const Matrix3 R_LV = VelocityAxes(s);
  const Vector3 outside =
      R_LV.transpose() * (Gravity(setting, s) - Coriolis(setting, s) - Transport(setting, s));
  const Vector3 f = BodyInVelocityAxes(s) * thrust + AboutX(s.nu) * air_in_velocity_axes + g.m * outside;
  PaperRates out;
  out.V_dot = f.x() / g.m;
  out.theta_dot = f.y() / (g.m * s.V * cos(s.sigma));
  out.sigma_dot = -f.z() / (g.m * s.V);
  const Vector3& w = s.w;
  out.w_dot = Vector3(moment.x() / g.Jx, (moment.y() + (g.Jt - g.Jx) * w.x() * w.z()) / g.Jt,
                      (moment.z() + (g.Jx - g.Jt) * w.y() * w.x()) / g.Jt);
  return out;
}

// The right sides of (9) to (14) as printed, divided by mV, m, -mV, J. Local path angle by (16).
PaperRates Printed(const Setting& setting, const PaperState& s) {
  const Given g = GivenAt(setting, s);
  const double local = s.theta + s.range_angle;
  const double weight =
      g.m * setting.plant.environment.earth.mu_m3_s2 / std::pow(kRadius_m + s.altitude_m, 2);
  const Matrix3 R_LV = VelocityAxes(s);
  const Vector3 fictitious = R_LV.transpose() * (Coriolis(setting, s) + Transport(setting, s));
  PaperRates out;
  out.theta_dot = (4.0 * g.P * sin(s.alpha) * cos(s.beta) - weight * cos(local) +
                   2.0 * g.P * s.delta_phi * cos(s.alpha) + g.L - g.m * fictitious.y()) /
                  (g.m * s.V);
  out.V_dot = (4.0 * g.P * cos(s.alpha) * cos(s.beta) - weight * sin(local) * cos(s.sigma) - g.D -
               g.m * fictitious.x()) /
              g.m;
  out.sigma_dot = (-4.0 * g.P * sin(s.beta) - weight * sin(local) * sin(s.sigma) -
                   2.0 * g.P * s.delta_psi * cos(s.beta) + g.C - g.m * fictitious.z()) /
                  (-g.m * s.V);
  const Vector3& w = s.w;
  out.w_dot.x() = -g.P * s.delta_gamma * g.z_r / g.Jx;
  out.w_dot.y() =
      (-g.C * (g.x_d - g.x_z) - 2.0 * g.P * (g.x_R - g.x_z) * s.delta_psi + (g.Jt - g.Jx) * w.x() * w.z()) /
      g.Jt;
  out.w_dot.z() =
      (-g.L * (g.x_d - g.x_z) - 2.0 * g.P * (g.x_R - g.x_z) * s.delta_phi + (g.Jx - g.Jt) * w.y() * w.x()) /
      g.Jt;
  return out;
}

// The contribution of the listed misprints to Printed - Engine, at first order.
PaperRates ListedMisprints(const Setting& setting, const PaperState& s) {
  const Given g = GivenAt(setting, s);
  const double arm = g.x_d - g.x_z;
  PaperRates out;
  // (12) has P where four nozzles give 4P, and no damping.
  out.w_dot.x() = (3.0 * g.P * s.delta_gamma * g.z_r - g.damping.x()) / g.Jx;
  // (13) has the sign of C turned, side force where the force normal to the body acts, no damping.
  out.w_dot.y() = (-2.0 * g.C * arm + g.D * s.beta * arm - g.damping.y()) / g.Jt;
  // (14) has lift where normal force acts, no damping.
  out.w_dot.z() = (g.D * s.alpha * arm - g.damping.z()) / g.Jt;
  return out;
}

// (i) ----------------------------------------------------------------------------------------------------

double Between(Stream& draws, double low, double high) { return low + (high - low) * draws.Uniform(); }

TEST(PaperEquations, ExactFormAgreesWithTheEngineAtRandomStates) {
  // Verifies: forces, moments, signs, frames and the rotating Earth of LauncherModel. Relative 1e-9; the
  // floor of 1e-9 (m/s², rad/s²) is rounding: 465 m/s of the Earth's surface subtracted from velocities of
  // 100 m/s leave 1e-15 of incidence, times 1e3 1/s² of control and aerodynamic stiffness.
  Stream draws(7, 0, "states");
  constexpr double kRelative = 1e-9, kFloor = 1e-9;
  for (int k = 0; k < 2000; ++k) {
    Setting setting(k % 4);
    PaperState s;
    s.time_s = Between(draws, 0.0, setting.stack().burn.duration_s);
    s.range_angle = Between(draws, -0.01, 0.3);
    s.cross_m = Between(draws, -2e5, 2e5);
    s.altitude_m = Between(draws, 0.0, 60e3);
    s.V = Between(draws, 100.0, 3000.0);
    s.theta = Between(draws, -0.5, 1.4);
    s.sigma = Between(draws, -0.5, 0.5);
    s.nu = Between(draws, -3.0, 3.0);
    s.alpha = Between(draws, -0.3, 0.3);
    s.beta = Between(draws, -0.3, 0.3);
    s.w = Vector3(Between(draws, -0.5, 0.5), Between(draws, -0.5, 0.5), Between(draws, -0.5, 0.5));
    s.delta_phi = Between(draws, -0.1, 0.1);
    s.delta_psi = Between(draws, -0.1, 0.1);
    s.delta_gamma = Between(draws, -0.1, 0.1);
    s.misalignment = Between(draws, 0.0, 0.05);
    s.misalignment_clock = Between(draws, -3.0, 3.0);
    // The plant's own tilt: towards right at clock 0, towards down at 90°.
    setting.plant.stacks[static_cast<std::size_t>(k % 4)].thrust_tilt =
        RotationMatrix(FromRotationVector(Vector3(0.0, -s.misalignment * sin(s.misalignment_clock),
                                                  s.misalignment * cos(s.misalignment_clock))));
    const PaperRates ours = Exact(setting, s), engine = Engine(setting, s);
    const auto agree = [&](double a, double b, const char* what) {
      EXPECT_NEAR(a, b, kFloor + kRelative * std::fabs(b)) << what << " at state " << k;
    };
    agree(ours.V_dot, engine.V_dot, "V'");
    agree(s.V * ours.theta_dot, s.V * engine.theta_dot, "V theta'");
    agree(s.V * ours.sigma_dot, s.V * engine.sigma_dot, "V sigma'");
    agree(ours.w_dot.x(), engine.w_dot.x(), "wx'");
    agree(ours.w_dot.y(), engine.w_dot.y(), "wy'");
    agree(ours.w_dot.z(), engine.w_dot.z(), "wz'");
    if (HasFailure()) return;
  }
}

// (ii) ---------------------------------------------------------------------------------------------------

// A direction along which all angles, rates and deflections are scaled down together.
PaperState Scaled(std::uint64_t direction, double scale) {
  Stream draws(8, direction, "directions");
  PaperState s;
  s.range_angle = Between(draws, 0.0, 0.2);
  s.altitude_m = Between(draws, 5e3, 20e3);
  s.V = Between(draws, 300.0, 900.0);
  s.theta = Between(draws, 0.3, 1.2);
  s.time_s = Between(draws, 10.0, 60.0);
  const auto sign = [&](double size) { return draws.Uniform() < 0.5 ? -size : size; };
  s.sigma = scale * sign(Between(draws, 0.2, 0.4));
  s.nu = scale * sign(Between(draws, 0.2, 0.4));
  s.alpha = scale * sign(Between(draws, 0.2, 0.4));
  s.beta = scale * sign(Between(draws, 0.2, 0.4));
  s.w = scale * Vector3(sign(0.3), sign(0.2), sign(0.25));
  s.delta_phi = scale * sign(Between(draws, 0.2, 0.4));
  s.delta_psi = scale * sign(Between(draws, 0.2, 0.4));
  s.delta_gamma = scale * sign(Between(draws, 0.2, 0.4));
  return s;
}

// Order of a residual: the slope of log |r| over log scale from 1/64 to 1/1024.
double OrderOf(const std::function<double(double)>& residual) {
  return std::log(std::fabs(residual(1.0 / 64.0)) / std::fabs(residual(1.0 / 1024.0))) / std::log(16.0);
}

// A third-order term of the other sign, 1/64 of the second or a little more, bends the slope by a tenth.
constexpr double kQuadratic = 1.85;

class PrintedEquation : public testing::TestWithParam<std::uint64_t> {
 protected:
  const Setting setting_{0};
  double Order(double (*component)(const PaperRates&), bool corrected) const {
    return OrderOf([&](double scale) {
      const PaperState s = Scaled(GetParam(), scale);
      const double listed = corrected ? component(ListedMisprints(setting_, s)) : 0.0;
      return component(Printed(setting_, s)) - component(Engine(setting_, s)) - listed;
    });
  }
};

TEST_P(PrintedEquation, Nine) {
  EXPECT_GT(Order([](const PaperRates& r) { return r.theta_dot; }, false), kQuadratic);
}
TEST_P(PrintedEquation, Ten) {
  EXPECT_GT(Order([](const PaperRates& r) { return r.V_dot; }, false), kQuadratic);
}
TEST_P(PrintedEquation, Eleven) {
  EXPECT_GT(Order([](const PaperRates& r) { return r.sigma_dot; }, false), kQuadratic);
}
// (12) to (14) are off at first order as printed, and quadratic without the listed misprints.
TEST_P(PrintedEquation, TwelveWithItsListedMisprints) {
  const auto component = [](const PaperRates& r) { return r.w_dot.x(); };
  EXPECT_GT(Order(component, true), kQuadratic);
  EXPECT_LT(Order(component, false), 1.3);
}
TEST_P(PrintedEquation, ThirteenWithItsListedMisprints) {
  const auto component = [](const PaperRates& r) { return r.w_dot.y(); };
  EXPECT_GT(Order(component, true), kQuadratic);
  EXPECT_LT(Order(component, false), 1.3);
}
TEST_P(PrintedEquation, FourteenWithItsListedMisprints) {
  const auto component = [](const PaperRates& r) { return r.w_dot.z(); };
  EXPECT_GT(Order(component, true), kQuadratic);
  EXPECT_LT(Order(component, false), 1.3);
}

// R_LB = Rz(phi) Ry(psi) Rx(gamma): the angles that (15) and (17) speak of.
double PitchOf(const PaperState& s) {
  const Matrix3 R_LB = VelocityAxes(s) * BodyInVelocityAxes(s);
  return std::atan2(R_LB(1, 0), R_LB(0, 0));
}
double YawOf(const PaperState& s) {
  const Matrix3 R_LB = VelocityAxes(s) * BodyInVelocityAxes(s);
  return -std::asin(R_LB(2, 0));
}

TEST_P(PrintedEquation, Fifteen) {
  EXPECT_GT(OrderOf([](double scale) {
              const PaperState s = Scaled(GetParam(), scale);
              return s.theta + s.alpha - PitchOf(s);
            }),
            kQuadratic);
}
TEST_P(PrintedEquation, Sixteen) {
  EXPECT_GT(OrderOf([](double scale) {
              const PaperState s = Scaled(GetParam(), scale);
              const Vector3 up = PositionInL(s).normalized();
              return s.theta + s.range_angle - std::asin(up.dot(VelocityAxes(s).col(0)));
            }),
            kQuadratic);
}
TEST_P(PrintedEquation, SeventeenNeedsPsiEqualSigmaPlusBeta) {
  EXPECT_GT(OrderOf([](double scale) {
              const PaperState s = Scaled(GetParam(), scale);
              return s.sigma + s.beta - YawOf(s);
            }),
            kQuadratic);
  // As printed, sigma = beta + psi.
  EXPECT_LT(OrderOf([](double scale) {
              const PaperState s = Scaled(GetParam(), scale);
              return s.sigma - s.beta - YawOf(s);
            }),
            1.1);
}

INSTANTIATE_TEST_SUITE_P(Directions, PrintedEquation, testing::Range<std::uint64_t>(0, 8));

// (1) to (7) ---------------------------------------------------------------------------------------------

// The planar equations with (2)'s left side corrected to the rate of the path angle, flown by a Runge-Kutta
// method of this test. State: V, path angle, h, l.
class PlanarFlight {
 public:
  PlanarFlight(const AscentModel& model, const FlightProgram& program) : model_(model), program_(program) {}

  std::array<double, 4> Fly() {
    std::vector<MotorBurn> burns;
    for (const LauncherStack& stack : model_.plant.stacks) burns.push_back(stack.burn);
    std::vector<StageTimes> times = BuildTimeline(model_.vehicle, burns, model_.tick_s, 0.0);
    const double ignition4 = times[2].burnout_s + program_.coast_s;
    times = BuildTimeline(model_.vehicle, burns, model_.tick_s, ignition4);
    y_ = {0.0, 0.5 * kPi, 0.0, 0.0};
    double at = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      stage_ = i;
      ignition_s_ = times[i].ignition_s;
      At(at, times[i].ignition_s, 0.0);
      double from = times[i].ignition_s;
      for (const double kink : {program_.t1_s, program_.t3_s, program_.t2_s})
        if (kink > from && kink < times[i].burnout_s) {
          At(from, kink, 1.0);
          from = kink;
        }
      At(from, times[i].burnout_s, 1.0);
      burnt_ = true;
      if (i + 1 < times.size()) {
        At(times[i].burnout_s, times[i].separation_s, 0.0);
        at = times[i].separation_s;
        Separate(i);
      }
      burnt_ = false;
    }
    return y_;
  }

 private:
  double Alpha(double t) const { return ProgrammedIncidence(program_, t); }  // (7)

  std::array<double, 4> Rate(double t, const std::array<double, 4>& y) const {
    const auto [V, path, h, l] = y;
    const Vehicle& vehicle = model_.vehicle;
    const Stage& stage = vehicle.stages[stage_];
    const double flow = stage.propellant_mass_kg / stage.motor.burning_time_s;
    const double m =
        stage.liftoff_mass_kg - (burnt_ ? stage.propellant_mass_kg : thrust_ * flow * (t - ignition_s_));
    const double four_p = thrust_ * stage.motor.thrust_n;
    const double alpha = Alpha(t);
    const double r = kRadius_m + h;
    const double g = model_.plant.environment.earth.mu_m3_s2 / (r * r);
    const AirState air = StandardAtmosphere1976(h);
    const BodyAerodynamics& body = model_.plant.stacks[stage_].aerodynamics;
    const double mach = V / air.speed_of_sound_m_s;
    const double qs = 0.5 * air.density_kg_m3 * V * V * body.area_m2;
    const double axial = qs * body.ca.table(mach, std::fabs(alpha));
    const double normal = std::copysign(qs * body.cn.table(mach, std::fabs(alpha)), alpha);
    const double D = axial * cos(alpha) + normal * sin(alpha);
    const double L = normal * cos(alpha) - axial * sin(alpha);
    // Rising vertically the path angle stays 90°, and (2) is 0 / 0 at rest.
    const bool vertical = t < program_.t1_s;
    return {(four_p * cos(alpha) - D) / m - g * sin(path),
            vertical ? 0.0 : (four_p * sin(alpha) + L) / (m * V) - g * cos(path) / V + V / r * cos(path),
            V * sin(path), vertical ? 0.0 : kRadius_m / r * V * cos(path)};
  }

  // Fourth-order steps of at most 10 ms, the rate of the last point taken on this side of the interval's end.
  void At(double from, double to, double thrust) {
    thrust_ = thrust;
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / 0.01 - 1e-9)));
    const double dt = (to - from) / steps;
    for (int i = 0; i < steps && to > from; ++i) {
      const double t = from + i * dt;
      const auto moved = [&](const std::array<double, 4>& k, double by) {
        std::array<double, 4> z = y_;
        for (std::size_t j = 0; j < 4; ++j) z[j] += by * k[j];
        return z;
      };
      const double end = i + 1 == steps ? std::nextafter(to, from) : t + dt;
      const auto k1 = Rate(t, y_), k2 = Rate(t + 0.5 * dt, moved(k1, 0.5 * dt));
      const auto k3 = Rate(t + 0.5 * dt, moved(k2, 0.5 * dt)), k4 = Rate(end, moved(k3, dt));
      for (std::size_t j = 0; j < 4; ++j) y_[j] += dt / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
    }
  }

  // The centre of gravity jumps forward along the body and takes the velocity of the turning body there; the
  // body turns with the inertial direction of the path, at -g cos(path) / V.
  void Separate(std::size_t below) {
    const StackMass& upper = model_.plant.stacks[below + 1].mass;
    const double forward = model_.plant.stacks[below].mass.At(0.0).cg_station_m -
                           upper.At(upper.propellant_mass_kg).cg_station_m;
    const double r = kRadius_m + y_[2];
    const double turn_rate = -model_.plant.environment.earth.mu_m3_s2 / (r * r) * cos(y_[1]) / y_[0];
    const double turned = forward * cos(y_[1]) / r;
    y_[2] += forward * sin(y_[1]);
    y_[1] += turned;
    y_[3] += kRadius_m * turned;
    const double across = forward * turn_rate;
    y_[1] += std::atan2(across, y_[0]);
    y_[0] = std::hypot(y_[0], across);
  }

  const AscentModel& model_;
  const FlightProgram& program_;
  std::array<double, 4> y_{};
  std::size_t stage_ = 0;
  double ignition_s_ = 0.0, thrust_ = 0.0;
  bool burnt_ = false;
};

TEST(PaperEquations, PlanarFormIsTheLimitOfTheProduction3Dof) {
  // Verifies: FlyAscent on the equator of a sphere that does not turn, eastward, over the whole flight.
  AscentModel model = BuildAscentModel(Slv4(), 0.01);
  model.plant.environment.earth = SphericalEarth(kRadius_m, false);
  model.vehicle.site = {0.0, 0.0, 0.0};
  FlightProgram program;
  program.alpha_max_rad = 5.8 * kRadPerDeg;
  program.t1_s = 3.35;
  program.t3_s = 8.4;
  program.t2_s = 21.3;
  program.coast_s = 340.0;
  program.launch_azimuth_rad = 0.5 * kPi;
  AscentOptions options;
  options.steps = {0.02, 0.05, 0.5};
  options.record = true;
  const AscentResult flown = FlyAscent(model, program, options);
  ASSERT_TRUE(flown.completed);
  const auto [V, path, h, l] = PlanarFlight(model, program).Fly();

  // I: x through the site, y east. All motion stays in that plane.
  const Vector3 &p = flown.p_EoC_I, &v = flown.v_IC_I;
  EXPECT_NEAR(p.z(), 0.0, 1e-6);
  EXPECT_NEAR(v.z(), 0.0, 1e-9);
  const double eta = std::atan2(p.y(), p.x());
  const double path_3dof = std::asin(p.dot(v) / (p.norm() * v.norm()));
  // The kinks of the tables leave each integration centimetres (they fall between steps).
  EXPECT_NEAR(p.norm() - kRadius_m, h, 0.1);
  EXPECT_NEAR(eta * kRadius_m, l, 0.2);  // (4), (6)
  EXPECT_NEAR(v.norm(), V, 2e-4);
  EXPECT_NEAR(path_3dof * kDegPerRad, path * kDegPerRad, 1e-6);
  EXPECT_GT(h, 200e3) << "a flight that goes nowhere proves nothing";

  // (5): phi = alpha - eta + path angle, at every sample after the turn has begun.
  for (const AscentSample& s : flown.samples) {
    if (s.time_s < program.t1_s || s.velocity_m_s == 0.0) continue;
    const double range_angle = s.relative_path_angle_rad - (s.pitch_rad - s.alpha_rad);
    EXPECT_GE(range_angle, -1e-9);
    EXPECT_LE(range_angle, eta + 1e-9);
  }
}

}  // namespace
}  // namespace dispersa::paper_equations_test
