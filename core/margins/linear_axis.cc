#include "core/margins/linear_axis.h"

#include <algorithm>

#include "core/math/rotation.h"

namespace dispersa {

namespace {

// A twentieth of a degree: well inside the cells of the aerodynamic tables, far above rounding.
constexpr double kAngleStep_rad = 1e-3;
constexpr double kRateStep_rad_s = 1e-3;
// The equations are linear in the modes.
constexpr double kDeflectionStep_m = 1e-3;
// A thousandth of the speed at which air begins to matter.
constexpr double kDriftStep_m_s = 0.1;

// The drives that stand for all of an axis: of a stage and boosters that steer together the slower ones,
// which lag most; of boosters that steer alone theirs.
const Gimbal& DrivesOf(const LauncherPlant& plant, const TickSample& sample,
                       const std::array<double, kMostDrives>& pattern) {
  const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(sample.stack)];
  if (sample.stack > 0 || !sample.boosting || !plant.boosters_steer()) return stack.gimbal;
  const Gimbal& of_boosters = plant.boosters->gimbal;
  const auto end = pattern.begin() + stack.layout.banks() * kDrives;
  const bool stage_turns = std::any_of(pattern.begin(), end, [](double share) { return share != 0.0; });
  return stage_turns && stack.gimbal.bandwidth_rad_s < of_boosters.bandwidth_rad_s ? stack.gimbal
                                                                                   : of_boosters;
}

}  // namespace

AxisPlant LineariseAxis(const LauncherPlant& plant, const TickSample& sample, Axis axis,
                        const SensorModel& sensors, LateralPath path) {
  LauncherPhase phase;
  phase.stack = sample.stack;
  phase.burning = true;
  phase.ignition_s = sample.time_s - sample.since_ignition_s;
  phase.expelled_mass_kg = sample.expelled_mass_kg;
  phase.jettisoned = sample.jettisoned;
  phase.boosters_burning = sample.boosters_burning;

  const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(sample.stack)];
  std::array<double, kMostDrives> pattern{};
  const NozzleLayout& layout = plant.LayoutOf(sample.stack, sample.boosting);
  const int drives = layout.banks() * kDrives;
  for (int i = 0; i < drives; ++i)
    if (NozzleOf(i) != sample.stuck_nozzle) pattern[static_cast<std::size_t>(i)] = layout.allocation[i][axis];
  Vector3 about = Vector3::Zero();
  about[axis] = 1.0;

  // The modes of the plane that the axis turns in; nothing here twists.
  const int modes = stack.bending && axis != kRoll ? stack.bending->modes : 0;
  const int plane = axis == kPitch ? 1 : 0;
  const int first_mode = plane * kModes;

  const bool drifts = path == LateralPath::kDrifts && axis != kRoll;
  const int size = 4 + 2 * modes + (drifts ? 1 : 0);
  const int drift = drifts ? size - 1 : size;
  const Vector3 across_I = Rotate(sample.state.q_IB, Vector3::UnitX().cross(about));

  const LauncherModel equations(plant);
  // The accelerations of axis, modes and drift where one state, by its place in the linear plant, or the
  // command (-1) departs by `step`.
  const auto accelerations = [&](int departed, double step) {
    RigidBodyState state = sample.state;
    if (departed == 0) state.q_IB = state.q_IB * FromRotationVector(step * about);
    if (departed == 1) state.w_IB_B += step * about;
    if (departed == drift) state.v_IC_I += step * across_I;
    std::array<double, kLauncherSize> y{}, dydt{};
    WriteState(state, y.data());
    LauncherPhase at = phase;
    for (std::size_t i = 0; i < static_cast<std::size_t>(drives); ++i) {
      const int drive = static_cast<int>(i);
      y[static_cast<std::size_t>(AngleOf(drive))] =
          sample.nozzle_rad[i] + (departed == 2 ? step * pattern[i] : 0.0);
      y[static_cast<std::size_t>(RateOf(drive))] = departed == 3 ? step * pattern[i] : 0.0;
      at.command_rad[i] = sample.nozzle_rad[i] + (departed == -1 ? step * pattern[i] : 0.0);
    }
    std::copy(sample.bending.begin(), sample.bending.end(), y.begin() + kModalState);
    if (departed >= 4 + modes && departed < drift)
      y[static_cast<std::size_t>(kModalRate + first_mode + departed - 4 - modes)] += step;
    else if (departed >= 4 && departed < drift)
      y[static_cast<std::size_t>(kModalState + first_mode + departed - 4)] += step;
    equations.Derivative(at, sample.time_s, y.data(), dydt.data());
    const RigidBodyState rates = ReadState(dydt.data());
    Eigen::VectorXd found(2 + modes);
    found[0] = rates.w_IB_B[axis];
    found[1 + modes] = rates.v_IC_I.dot(across_I);
    for (int k = 0; k < modes; ++k)
      found[1 + k] = dydt[static_cast<std::size_t>(kModalRate + first_mode + k)];
    return found;
  };

  const Gimbal& gimbal = DrivesOf(plant, sample, pattern);
  const double w = gimbal.bandwidth_rad_s;
  AxisPlant linear;
  linear.drifts = drifts;
  linear.a = Eigen::MatrixXd::Zero(size, size);
  linear.b = Eigen::VectorXd::Zero(size);
  const auto put = [&](int departed, double step) {
    const Eigen::VectorXd slope =
        (accelerations(departed, step) - accelerations(departed, -step)) / (2.0 * step);
    for (int k = 0; k <= modes + (drifts ? 1 : 0); ++k) {
      const int row = k == 0 ? 1 : 3 + modes + k;  // the drift's follows the modes'
      (departed < 0 ? linear.b[row] : linear.a(row, departed)) = slope[k];
    }
  };
  put(0, kAngleStep_rad);
  put(1, kRateStep_rad_s);
  put(2, kAngleStep_rad);
  if (stack.gimbal.nozzle_inertia_kg_m2 > 0.0) {
    put(3, kRateStep_rad_s);
    put(-1, kAngleStep_rad);
  }
  for (int k = 0; k < modes; ++k) {
    put(4 + k, kDeflectionStep_m);
    put(4 + modes + k, kDeflectionStep_m);
    linear.a(4 + k, 4 + modes + k) = 1.0;
  }
  if (drifts) put(drift, kDriftStep_m_s);
  linear.a(0, 1) = 1.0;
  linear.a(2, 3) = 1.0;
  linear.a(3, 2) = -w * w;
  linear.a(3, 3) = -2.0 * gimbal.damping_ratio * w;
  linear.b[3] = w * w;

  linear.attitude = Eigen::RowVectorXd::Unit(size, 0);
  linear.rates.clear();
  const BendingTable* const table = stack.BendingWithout(sample.jettisoned);
  const SensorModel::Weights& weights = sensors.stages[static_cast<std::size_t>(sample.stack)];
  const double sign = axis == kPitch ? 1.0 : -1.0;
  const auto slope_of = [&](int column, int mode) {
    const double propellant = stack.burn.Propellant(sample.since_ignition_s);
    return sign * plant.bending.slope_factor *
           table->At(table->planes == 1 ? 0 : plane, mode, column, propellant);
  };
  const auto rate_at = [&](int column) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Unit(size, 1);
    for (int k = 0; k < modes; ++k) row[4 + modes + k] = slope_of(column, k);
    return row;
  };
  for (int k = 0; k < modes; ++k) linear.attitude[4 + k] = slope_of(BendingTable::kUnitSlope, k);
  if (weights.unit != 0.0) linear.rates.push_back({rate_at(BendingTable::kUnitSlope), {}, weights.unit, 0.0});
  for (std::size_t g = 0; g < sensors.gyros.size(); ++g) {
    if (weights.gyro[g] == 0.0) continue;
    linear.rates.push_back({rate_at(BendingTable::kGyroSlope + static_cast<int>(g)), sensors.gyros[g].section,
                            weights.gyro[g], 0.5 * (sensors.gyros[g].sample_ticks - 1)});
  }
  if (modes > 0)
    linear.lowest_mode_rad_s = plant.bending.frequency_factor[0] *
                               table->At(table->planes == 1 ? 0 : plane, 0, BendingTable::kFrequency,
                                         stack.burn.Propellant(sample.since_ignition_s));
  return linear;
}

LinearLaw LineariseLaw(const AutopilotModel& autopilot, int stage, double since_ignition_s, Axis axis,
                       bool adapting) {
  const AxisLaw& law = autopilot.laws[static_cast<std::size_t>(axis)];
  const StageLaw of_stage = LawAt(law, stage, since_ignition_s);
  const StageControl& control = autopilot.stages[static_cast<std::size_t>(stage)];
  LinearLaw linear;
  linear.kp_1_s2 = of_stage.kp_1_s2;
  linear.kd_1_s = of_stage.kd_1_s;
  linear.effectiveness_1_s2 =
      (axis == kRoll ? control.roll_effectiveness_1_s2 : control.pitch_effectiveness_1_s2)(since_ignition_s);
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
