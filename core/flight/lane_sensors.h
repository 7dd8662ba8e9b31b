// Sensors of W flights (core/math/lanes.h): inertial unit and rate gyros.
//
// The inertial unit is strap-down: it integrates the rates at its own place. From one measurement to the next
// its attitude turns by the vehicle's true rotation there, plus the gyros' bias and noise, half before and
// half after. So its errors turn with the vehicle. Rate gyros are second-order systems. Their input is the
// true rate at their places, which grows linearly from tick to tick. Their output is sampled and rounded.
// Without thrust the rates are those of the inertial unit.
#pragma once

#include "core/dynamics/bending.h"
#include "core/flight/sensor_model.h"
#include "core/flight/simpson_step.h"
#include "core/flight/standing.h"
#include "core/math/lane_vector.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
struct InertialUnit {
  Turn<T> truth, measured;  ///< at the last measurement
  T time_s;                 ///< of it
  Vector<T> drift_rad_s;    ///< bias and noise since

  /// A lane at rest at a true attitude, aligned to `believed` (w, x, y, z).
  DISPERSA_INLINE void Start(int lane, const Turn<T>& q, const double* believed) {
    SetLane(truth, lane, LaneOf(q, lane));
    SetLane(measured, lane, {believed[0], believed[1], believed[2], believed[3]});
    Lane(time_s, lane) = 0.0;
    SetLane(drift_rad_s, lane, Zero<double>());
  }
  DISPERSA_INLINE void Measure(MaskOf<T> lanes, T now_s, Turn<T> now) {
    const Vector<T> half = (T(0.5) * (now_s - time_s)) * drift_rad_s;
    const Turn<T> turned = Compose(Inverse(truth), now);
    const Turn<T> then = TurnedBy(Compose(TurnedBy(measured, half), turned), half);
    Blend<T>(lanes, then, measured);
    Blend<T>(lanes, now, truth);
    time_s = Select(lanes, now_s, time_s);
  }
};

template <class T>
struct GyroMemory {
  Vector<T> first, second;  ///< of the section, direct form II transposed
  Vector<T> output_rad_s;
};

/// One tick of the burning lanes. `fresh` lanes have just ignited: their gyros are at rest in the lane's
/// rate. `sampled` lanes are at a tick of the gyro.
template <class T>
DISPERSA_INLINE void StepGyro(const GyroModel& gyro, MaskOf<T> acting, MaskOf<T> fresh, MaskOf<T> sampled,
                              Vector<T> rate_rad_s, GyroMemory<T>& memory) {
  const DigitalSection& f = gyro.section;
  for (int axis = 0; axis < 3; ++axis) {
    const T u = rate_rad_s[axis];
    T &first = memory.first[axis], &second = memory.second[axis], &output = memory.output_rad_s[axis];
    const T at_rest2 = T(f.b2 - f.a2) * u;
    const T s2 = Select(fresh, at_rest2, second);
    const T s1 = Select(fresh, Fma(T(f.b1 - f.a1), u, at_rest2), first);
    const T y = Fma(T(f.b0), u, s1);
    first = Select(acting, Fma(T(f.b1), u, Fma(T(-f.a1), y, s2)), s1);
    second = Select(acting, Fma(T(f.b2), u, T(-f.a2) * y), s2);
    const T quantum(gyro.quantum_rad_s);
    const T shown = gyro.quantum_rad_s > 0.0 ? Nearest(y / quantum) * quantum : y;
    output = Select((acting & sampled) | fresh, shown, output);
  }
}

/// All sensors of the lanes, with what they remember.
template <class T>
class Sensors {
 public:
  /// In a lane that does not fly they are perfect.
  void Configure(const FlightModel& model) {
    model_ = &model.sensors();
    tick_s_ = model.definition().autopilot.tick_s;
    unit_weight_ = unit_.truth.w = unit_.measured.w = T(1.0);
  }
  void StartFlight(int lane, const FlightRecord& record, const Turn<T>& q) {
    const FlightInputs& in = record.inputs;
    const Vector<double> bias{in.sensors.gyro_bias_roll_rad_s, in.sensors.gyro_bias_pitch_rad_s,
                              in.sensors.gyro_bias_yaw_rad_s};
    SetLane(bias_rad_s_, lane, bias);
    SetLane(drifts_, lane,
            record.noisy || in.launch_azimuth_error_rad != 0.0 || bias.x != 0.0 || bias.y != 0.0 ||
                bias.z != 0.0);
    unit_.Start(lane, q, record.believed_attitude);
    EndStage(lane);
  }
  /// A stage's weights of gyros and unit; without thrust only the unit has weight.
  void StartStage(int lane, const SensorModel::Weights& weights) {
    for (int i = 0; i < kRateGyros; ++i) Lane(gyro_weight_[i], lane) = weights.gyro.data()[i];
    Lane(unit_weight_, lane) = weights.unit;
    SetLane(gyros_fresh_, lane, true);
  }
  void EndStage(int lane) {
    for (T& weight : gyro_weight_) Lane(weight, lane) = 0.0;
    Lane(unit_weight_, lane) = 1.0;
  }

  /// Whether any of these lanes sees anything but the truth.
  bool AreImperfect(const StepState<T>& step, MaskOf<T> live) const {
    return step.bending().modes > 0 || model_->uses_gyros || Any(drifts_ & live);
  }
  /// What they see at the lanes' ticks, of the lanes in `imperfect`; the others see the truth.
  struct Sight {
    MaskOf<T> imperfect;
    Turn<T> attitude;
    Vector<T> rate_rad_s;
  };
  Sight Measure(const Standing<T>& at, StepState<T>& step) {
    const bool bends = step.bending().modes > 0;
    Sight seen{at.live, step.motion().q, step.motion().w};
    if (bends) {
      step.UpdateShapes(at.time_s);
      seen.attitude = TurnedBy(seen.attitude, UnitTurn(step.bending(), step.bending_state()));
      seen.rate_rad_s = seen.rate_rad_s + TurnRate(step.bending(), step.bending_state(), -1);
    }
    if (model_->uses_gyros) seen.rate_rad_s = GyroRates(at, step, seen.rate_rad_s);
    if (!bends && !model_->uses_gyros) seen.imperfect = at.live & drifts_;
    if (!Any(drifts_ & at.live)) return seen;
    AverageNoise(at);
    unit_.Measure(at.live, at.time_s, seen.attitude);
    Blend<T>(drifts_, unit_.measured, seen.attitude);
    DriftOn(at, step);
    seen.rate_rad_s = Select(drifts_, seen.rate_rad_s + unit_.drift_rad_s, seen.rate_rad_s);
    return seen;
  }

 private:
  /// The blend of gyros and inertial unit.
  Vector<T> GyroRates(const Standing<T>& at, const StepState<T>& step, Vector<T> unit_rad_s) {
    const MaskOf<T> burning = at.live & step.phase().burning;
    Vector<T> blend = unit_weight_ * unit_rad_s;
    const int gyros = static_cast<int>(model_->gyros.size());
    for (int g = 0; g < gyros; ++g) {
      const GyroModel& gyro = model_->gyros.data()[g];
      Vector<T> rate = step.motion().w;
      if (step.bending().modes > 0) rate = rate + TurnRate(step.bending(), step.bending_state(), g);
      const T period(static_cast<double>(gyro.sample_ticks)), last = period * Nearest(at.tick / period);
      const MaskOf<T> sampled = (last >= at.tick) & (last <= at.tick);
      StepGyro(gyro, burning, burning & gyros_fresh_, sampled, rate, gyros_[g]);
      blend = Along(blend, gyro_weight_[g], gyros_[g].output_rad_s);
    }
    gyros_fresh_ = gyros_fresh_ & !burning;
    return blend;
  }
  /// Bias and noise until the next measurement. Only a tick at which the autopilot acts takes a sample.
  void DriftOn(const Standing<T>& at, const StepState<T>& step) {
    unit_.drift_rad_s = bias_rad_s_;
    const unsigned acting = Bits(at.live & (step.phase().burning | at.coasting));
    for (int lane = 0; lane < kWidth<T>; ++lane) {
      if (!(acting >> lane & 1u) || !at.slot[lane].record->noisy) continue;
      double noise[kAxes];
      at.slot[lane].record->DrawNoise(noise);
      SetLane(unit_.drift_rad_s, lane, LaneOf(unit_.drift_rad_s, lane) + VectorAt(noise));
    }
  }
  /// The unit samples at every tick, although the samples within a cycle of the reaction control are not
  /// used. Over the n ticks of a cycle it turns by the mean of n samples; the first one is known.
  void AverageNoise(const Standing<T>& at) {
    for (int lane = 0; lane < kWidth<T>; ++lane) {
      if (!(Bits(at.live & drifts_) >> lane & 1u) || !at.slot[lane].record->noisy) continue;
      const double ticks = Nearest((Lane(at.time_s, lane) - Lane(unit_.time_s, lane)) / tick_s_);
      if (ticks < 2.0) continue;
      double others[kAxes];
      at.slot[lane].record->DrawNoise(others);
      const Vector<double> bias = LaneOf(bias_rad_s_, lane), first = LaneOf(unit_.drift_rad_s, lane) - bias;
      const Vector<double> sum = first + Sqrt(ticks - 1.0) * VectorAt(others);
      SetLane(unit_.drift_rad_s, lane, bias + (1.0 / ticks) * sum);
    }
  }

  const SensorModel* model_;
  double tick_s_;
  Vector<T> bias_rad_s_;
  InertialUnit<T> unit_;
  MaskOf<T> drifts_;  ///< whose gyros have a bias or noise, or whose unit is misaligned
  GyroMemory<T> gyros_[kRateGyros];
  T gyro_weight_[kRateGyros], unit_weight_;  ///< of the measured rates
  MaskOf<T> gyros_fresh_;                    ///< have not been read since ignition
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
