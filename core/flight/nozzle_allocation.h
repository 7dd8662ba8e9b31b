// From roll, pitch and yaw commands to the drives of a list of nozzles, and back, for W flights side by side
// (core/math/lanes.h). core/vehicle/nozzle_layout.h computes the coefficients. The cross of four nozzles has
// its own code.
#pragma once

#include "core/math/lanes.h"
#include "core/vehicle/nozzle_layout.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// The allocation of each lane's stage to the drives of a bank.
template <class T>
struct BankAllocation {
  T drive[kDrives][kSteeredAxes];
  T felt[kSteeredAxes][kDrives];
  T limit_rad[kNozzles];
  T there[kDrives];
  T per_drive;           ///< 1 over their number in all banks
  T rolls_by_thrusters;  ///< 1 of a stage whose nozzles cannot
};
DISPERSA_INLINE BankAllocation<double> AllocationOf(const NozzleLayout& layout, int bank) {
  BankAllocation<double> a;
  const int first = bank * kDrives;
  for (int i = 0; i < kDrives; ++i) {
    for (int axis = 0; axis < kSteeredAxes; ++axis) {
      a.drive[i][axis] = layout.allocation[first + i][axis];
      a.felt[axis][i] = layout.felt[axis][first + i];
    }
    a.there[i] = layout.there[first + i];
  }
  for (int i = 0; i < kNozzles; ++i) a.limit_rad[i] = layout.limit_rad[bank * kNozzles + i];
  double drives = 0.0;
  for (const double there : layout.there) drives += there;
  a.per_drive = 1.0 / drives;
  a.rolls_by_thrusters = layout.rolls ? 0.0 : 1.0;
  return a;
}

/// Commands of the drives. A nozzle that would turn by more than its limit keeps the direction: a cone of two
/// hinges.
template <class T>
DISPERSA_INLINE void Allocate(const BankAllocation<T>& a, T roll_rad, T pitch_rad, T yaw_rad,
                              T* command_rad) {
  const auto commanded = [&](int drive) __attribute__((always_inline)) {
    return Fma(a.drive[drive][0], roll_rad, Fma(a.drive[drive][1], pitch_rad, a.drive[drive][2] * yaw_rad));
  };
  for (int i = 0; i < kNozzles; ++i) {
    const T first = commanded(i), second = commanded(i + kNozzles), limit = a.limit_rad[i];
    const T square = Fma(first, first, second * second);
    const auto beyond = square > limit * limit;
    const T scale = Select(beyond, limit / Sqrt(Select(beyond, square, T(1.0))), T(1.0));
    command_rad[i] = scale * first;
    command_rad[i + kNozzles] = scale * second;
  }
}

/// The command about an axis that deflections stand for, with that of the banks before.
template <class T>
DISPERSA_INLINE T FeltAbout(const BankAllocation<T>& a, int axis, const T* first_rad, const T* second_rad,
                            T before = T(0.0)) {
  T felt = before;
  for (int i = 0; i < kNozzles; ++i)
    felt = Fma(a.felt[axis][i], first_rad[i], Fma(a.felt[axis][i + kNozzles], second_rad[i], felt));
  return felt;
}

/// Lanes in which a nozzle is commanded to its limit.
template <class T>
DISPERSA_INLINE MaskOf<T> IsSaturated(const BankAllocation<T>& a, const T* command_rad) {
  // Scaling to the limit leaves a rounding.
  constexpr double kAtLimit = 1.0 - 1e-9;
  T reached(0.0);
  for (int i = 0; i < kNozzles; ++i) {
    const T first = command_rad[i], second = command_rad[i + kNozzles], limit = T(kAtLimit) * a.limit_rad[i];
    const T square = Fma(first, first, second * second);
    reached = Select((limit > T(0.0)) & (square >= limit * limit), T(1.0), reached);
  }
  return reached > T(0.0);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
