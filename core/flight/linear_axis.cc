#include "core/flight/linear_axis.h"

#include "core/math/rotation.h"

namespace dispersa {

namespace {

// A twentieth of a degree: well inside the cells of the aerodynamic tables, far above rounding.
constexpr double kAngleStep_rad = 1e-3;
constexpr double kRateStep_rad_s = 1e-3;

}  // namespace

AxisPlant LineariseAxis(const LauncherPlant& plant, const TickSample& sample, Axis axis) {
  LauncherPhase phase;
  phase.stack = sample.stack;
  phase.burning = true;
  phase.ignition_s = sample.time_s - sample.since_ignition_s;
  phase.expelled_mass_kg = sample.expelled_mass_kg;

  GimbalCommand unit;
  (axis == kRoll ? unit.roll_rad : axis == kPitch ? unit.pitch_rad : unit.yaw_rad) = 1.0;
  std::array<double, kNozzles> pattern = unit.Nozzles();
  if (sample.stuck_nozzle >= 0) pattern[static_cast<std::size_t>(sample.stuck_nozzle)] = 0.0;
  Vector3 about = Vector3::Zero();
  about[axis] = 1.0;

  const LauncherModel equations(plant);
  const auto acceleration = [&](double angle_rad, double rate_rad_s, double deflection_rad) {
    RigidBodyState state = sample.state;
    state.q_IB = state.q_IB * FromRotationVector(angle_rad * about);
    state.w_IB_B += rate_rad_s * about;
    std::array<double, kLauncherSize> y{}, dydt{};
    WriteState(state, y.data());
    for (std::size_t i = 0; i < kNozzles; ++i) y[kNozzleAngle + i] = sample.nozzle_rad[i] + deflection_rad * pattern[i];
    equations.Derivative(phase, sample.time_s, y.data(), dydt.data());
    return ReadState(dydt.data()).w_IB_B[axis];
  };
  const auto slope = [&](double angle_rad, double rate_rad_s, double deflection_rad) {
    return acceleration(angle_rad, rate_rad_s, deflection_rad) -
           acceleration(-angle_rad, -rate_rad_s, -deflection_rad);
  };

  const Gimbal& gimbal = plant.stacks[static_cast<std::size_t>(sample.stack)].gimbal;
  const double w = gimbal.bandwidth_rad_s;
  AxisPlant linear;
  linear.a(0, 1) = 1.0;
  linear.a(1, 0) = slope(kAngleStep_rad, 0.0, 0.0) / (2.0 * kAngleStep_rad);
  linear.a(1, 1) = slope(0.0, kRateStep_rad_s, 0.0) / (2.0 * kRateStep_rad_s);
  linear.a(1, 2) = slope(0.0, 0.0, kAngleStep_rad) / (2.0 * kAngleStep_rad);
  linear.a(2, 3) = 1.0;
  linear.a(3, 2) = -w * w;
  linear.a(3, 3) = -2.0 * gimbal.damping_ratio * w;
  linear.b[3] = w * w;
  return linear;
}

LinearLaw LineariseLaw(const AutopilotModel& autopilot, int stage, double since_ignition_s, Axis axis,
                       bool adapting) {
  const AxisLaw& law = autopilot.laws[static_cast<std::size_t>(axis)];
  const StageLaw& of_stage = law.stages[static_cast<std::size_t>(stage)];
  const StageControl& control = autopilot.stages[static_cast<std::size_t>(stage)];
  LinearLaw linear;
  linear.kp_1_s2 = of_stage.kp_1_s2;
  linear.kd_1_s = of_stage.kd_1_s;
  linear.effectiveness_1_s2 = (axis == kRoll ? control.roll_effectiveness_1_s2
                                             : control.pitch_effectiveness_1_s2)(since_ignition_s);
  linear.filters.assign(of_stage.filters, of_stage.filters + law.config.filters.size());
  const LawInfo& info = InfoOf(law.config.law);
  // The integral of a PID law acts whether or not anything adapts.
  if (info.integral) linear.drive_error = of_stage.ki_1_s3;
  if (adapting && info.adaptation) {
    linear.drive_error = of_stage.gamma * of_stage.pn_error;
    linear.drive_rate = of_stage.gamma * of_stage.pn_rate;
    linear.leakage_1_s = law.config.adaptation.leakage_1_s;
    linear.spread_1_s = law.config.adaptation.spread_1_s;
    linear.rules = kFuzzyRules;
    linear.drive_prediction = of_stage.gamma * of_stage.pn_rate * law.config.adaptation.composite;
    linear.predictor_1_s = law.config.adaptation.predictor_1_s;
  }
  return linear;
}

LinearLaw LineariseLearntLaw(const AutopilotModel& autopilot, const TickSample& sample, Axis axis,
                             ErrorSide side) {
  LinearLaw linear = LineariseLaw(autopilot, sample.stack, sample.since_ignition_s, axis, true);
  const AxisConfig& config = autopilot.laws[static_cast<std::size_t>(axis)].config;
  const AxisState& memory = sample.memories[static_cast<std::size_t>(axis)];
  const LawInfo& info = InfoOf(config.law);
  if (info.augmentation) linear.effectiveness_1_s2 /= memory.total_gain;
  if (info.rules && info.adaptation) {
    const double error_step = config.rules.error_range_rad / (kFuzzySets / 2);
    const double rate_step = config.rules.rate_range_rad_s / (kFuzzySets / 2);
    constexpr int kCentre = kFuzzyRules / 2;
    const auto rise = [&](int towards) {
      return memory.departure_rad_s2[kCentre + towards] - memory.departure_rad_s2[kCentre];
    };
    linear.kp_1_s2 += side.error * rise(side.error * kFuzzySets) / error_step;
    linear.kd_1_s += side.rate * rise(side.rate) / rate_step;
  }
  return linear;
}

}  // namespace dispersa
