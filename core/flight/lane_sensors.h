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
    Lane(truth.w, lane) = Lane(q.w, lane);
    Lane(truth.x, lane) = Lane(q.x, lane);
    Lane(truth.y, lane) = Lane(q.y, lane);
    Lane(truth.z, lane) = Lane(q.z, lane);
    Lane(measured.w, lane) = believed[0];
    Lane(measured.x, lane) = believed[1];
    Lane(measured.y, lane) = believed[2];
    Lane(measured.z, lane) = believed[3];
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

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
