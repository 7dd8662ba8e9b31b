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

LauncherPhase PhaseOf(const TickSample& sample) {
  LauncherPhase phase;
  phase.stack = sample.stack;
  phase.burning = true;
  phase.ignition_s = sample.time_s - sample.since_ignition_s;
  phase.expelled_mass_kg = sample.expelled_mass_kg;
  phase.jettisoned = sample.jettisoned;
  phase.boosters_burning = sample.boosters_burning;
  return phase;
}

/// One axis of the flight's equations at one instant. Its linear state: attitude, rate, deflection, its rate,
/// the modes' coordinates, their rates, and the drift.
class AxisAtInstant {
 public:
  AxisAtInstant(const LauncherPlant& plant, const TickSample& sample, Axis axis, LateralPath path);

  AxisPlant Linear(const SensorModel& sensors) const;

 private:
  /// Of axis, modes and drift, where one linear state or the command (kCommand) departs by `step`.
  Eigen::VectorXd Accelerations(int departed, double step) const;
  /// The slope of the accelerations along one linear state or the command.
  void PutSlope(int departed, double step, AxisPlant& linear) const;
  void PutEquations(AxisPlant& linear) const;
  void PutDrives(AxisPlant& linear) const;
  void PutSensors(const SensorModel& sensors, AxisPlant& linear) const;
  double ModeSlope(int column, int mode) const;
  double Tabulated(int column, int mode) const;
  Eigen::RowVectorXd RateAt(int column) const;

  static constexpr int kCommand = -1;

  const LauncherPlant& plant_;
  const TickSample& sample_;
  const Axis axis_;
  const LauncherStack& stack_;
  const LauncherModel equations_;
  const LauncherPhase phase_;
  std::array<double, kMostDrives> pattern_{};  ///< deflection of each drive for one of the axis
  int drives_;
  Vector3 about_ = Vector3::Zero();  ///< in B
  Vector3 across_I_;
  // The modes of the plane that the axis turns in; nothing here twists.
  const int modes_;
  const int plane_;
  const int first_mode_;
  const bool drifts_;
  const int size_;
  const int drift_;  ///< place of the drift in the linear state; no place: its size
};

AxisAtInstant::AxisAtInstant(const LauncherPlant& plant, const TickSample& sample, Axis axis,
                             LateralPath path)
    : plant_(plant),
      sample_(sample),
      axis_(axis),
      stack_(plant.stacks[static_cast<std::size_t>(sample.stack)]),
      equations_(plant),
      phase_(PhaseOf(sample)),
      modes_(stack_.bending && axis != kRoll ? stack_.bending->modes : 0),
      plane_(axis == kPitch ? 1 : 0),
      first_mode_(plane_ * kModes),
      drifts_(path == LateralPath::kDrifts && axis != kRoll),
      size_(4 + 2 * modes_ + (drifts_ ? 1 : 0)),
      drift_(drifts_ ? size_ - 1 : size_) {
  const NozzleLayout& layout = plant.LayoutOf(sample.stack, sample.boosting);
  drives_ = layout.banks() * kDrives;
  for (int i = 0; i < drives_; ++i)
    if (NozzleOf(i) != sample.stuck_nozzle)
      pattern_[static_cast<std::size_t>(i)] = layout.allocation[i][axis];
  about_[axis] = 1.0;
  across_I_ = Rotate(sample.state.q_IB, Vector3::UnitX().cross(about_));
}

AxisPlant AxisAtInstant::Linear(const SensorModel& sensors) const {
  AxisPlant linear;
  linear.drifts = drifts_;
  linear.a = Eigen::MatrixXd::Zero(size_, size_);
  linear.b = Eigen::VectorXd::Zero(size_);
  PutEquations(linear);
  PutDrives(linear);
  PutSensors(sensors, linear);
  return linear;
}

Eigen::VectorXd AxisAtInstant::Accelerations(int departed, double step) const {
  RigidBodyState state = sample_.state;
  if (departed == 0) state.q_IB = state.q_IB * FromRotationVector(step * about_);
  if (departed == 1) state.w_IB_B += step * about_;
  if (departed == drift_) state.v_IC_I += step * across_I_;
  std::array<double, kLauncherSize> y{}, dydt{};
  WriteState(state, y.data());
  LauncherPhase at = phase_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives_); ++i) {
    const int drive = static_cast<int>(i);
    y[static_cast<std::size_t>(AngleOf(drive))] =
        sample_.nozzle_rad[i] + (departed == 2 ? step * pattern_[i] : 0.0);
    y[static_cast<std::size_t>(RateOf(drive))] = departed == 3 ? step * pattern_[i] : 0.0;
    at.command_rad[i] = sample_.nozzle_rad[i] + (departed == kCommand ? step * pattern_[i] : 0.0);
  }
  std::copy(sample_.bending.begin(), sample_.bending.end(), y.begin() + kModalState);
  if (departed >= 4 + modes_ && departed < drift_)
    y[static_cast<std::size_t>(kModalRate + first_mode_ + departed - 4 - modes_)] += step;
  else if (departed >= 4 && departed < drift_)
    y[static_cast<std::size_t>(kModalState + first_mode_ + departed - 4)] += step;
  equations_.Derivative(at, sample_.time_s, y.data(), dydt.data());
  const RigidBodyState rates = ReadState(dydt.data());
  Eigen::VectorXd found(2 + modes_);
  found[0] = rates.w_IB_B[axis_];
  found[1 + modes_] = rates.v_IC_I.dot(across_I_);
  for (int k = 0; k < modes_; ++k)
    found[1 + k] = dydt[static_cast<std::size_t>(kModalRate + first_mode_ + k)];
  return found;
}

void AxisAtInstant::PutSlope(int departed, double step, AxisPlant& linear) const {
  const Eigen::VectorXd slope =
      (Accelerations(departed, step) - Accelerations(departed, -step)) / (2.0 * step);
  for (int k = 0; k <= modes_ + (drifts_ ? 1 : 0); ++k) {
    const int row = k == 0 ? 1 : 3 + modes_ + k;  // the drift's follows the modes'
    (departed == kCommand ? linear.b[row] : linear.a(row, departed)) = slope[k];
  }
}

void AxisAtInstant::PutEquations(AxisPlant& linear) const {
  PutSlope(0, kAngleStep_rad, linear);
  PutSlope(1, kRateStep_rad_s, linear);
  PutSlope(2, kAngleStep_rad, linear);
  if (stack_.gimbal.nozzle_inertia_kg_m2 > 0.0) {
    PutSlope(3, kRateStep_rad_s, linear);
    PutSlope(kCommand, kAngleStep_rad, linear);
  }
  for (int k = 0; k < modes_; ++k) {
    PutSlope(4 + k, kDeflectionStep_m, linear);
    PutSlope(4 + modes_ + k, kDeflectionStep_m, linear);
    linear.a(4 + k, 4 + modes_ + k) = 1.0;
  }
  if (drifts_) PutSlope(drift_, kDriftStep_m_s, linear);
  linear.a(0, 1) = 1.0;
}

void AxisAtInstant::PutDrives(AxisPlant& linear) const {
  const Gimbal& gimbal = DrivesOf(plant_, sample_, pattern_);
  const double w = gimbal.bandwidth_rad_s;
  linear.a(2, 3) = 1.0;
  linear.a(3, 2) = -w * w;
  linear.a(3, 3) = -2.0 * gimbal.damping_ratio * w;
  linear.b[3] = w * w;
}

void AxisAtInstant::PutSensors(const SensorModel& sensors, AxisPlant& linear) const {
  linear.attitude = Eigen::RowVectorXd::Unit(size_, 0);
  for (int k = 0; k < modes_; ++k) linear.attitude[4 + k] = ModeSlope(ModeTable::kUnitSlope, k);
  linear.rates.clear();
  const SensorModel::Weights& weights = sensors.stages[static_cast<std::size_t>(sample_.stack)];
  if (weights.unit != 0.0) linear.rates.push_back({RateAt(ModeTable::kUnitSlope), {}, weights.unit, 0.0});
  for (std::size_t g = 0; g < sensors.gyros.size(); ++g) {
    if (weights.gyro[g] == 0.0) continue;
    linear.rates.push_back({RateAt(ModeTable::kGyroSlope + static_cast<int>(g)), sensors.gyros[g].section,
                            weights.gyro[g], 0.5 * (sensors.gyros[g].sample_ticks - 1)});
  }
  if (modes_ > 0)
    linear.lowest_mode_rad_s = plant_.bending.frequency_factor[0] * Tabulated(ModeTable::kFrequency, 0);
}

/// How a place turns with a mode, in the axis' sense.
double AxisAtInstant::ModeSlope(int column, int mode) const {
  const double sign = axis_ == kPitch ? 1.0 : -1.0;
  return sign * plant_.bending.slope_factor * Tabulated(column, mode);
}

double AxisAtInstant::Tabulated(int column, int mode) const {
  const ModeTable* const table = stack_.BendingWithout(sample_.jettisoned);
  return table->At(table->planes == 1 ? 0 : plane_, mode, column,
                   stack_.burn.Propellant(sample_.since_ignition_s));
}

/// The rate that a place shows.
Eigen::RowVectorXd AxisAtInstant::RateAt(int column) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Unit(size_, 1);
  for (int k = 0; k < modes_; ++k) row[4 + modes_ + k] = ModeSlope(column, k);
  return row;
}

}  // namespace

AxisPlant LineariseAxis(const LauncherPlant& plant, const TickSample& sample, Axis axis,
                        const SensorModel& sensors, LateralPath path) {
  return AxisAtInstant(plant, sample, axis, path).Linear(sensors);
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
