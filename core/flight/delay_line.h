// From commands about the axes to the actuators of W flights side by side (core/math/lanes.h): allocation to
// the drives, and the time in between. A delay that is no whole number of ticks lets the command through
// within the tick. A command is allocated as it is given: what is on the way when boosters burn out is of the
// nozzles that burnt.
#pragma once

#include "core/flight/nozzle_allocation.h"
#include "core/flight/sequence.h"
#include "core/flight/simpson_step.h"
#include "core/flight/standing.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Commands of so many ticks are remembered for delays. A longer delay counts as the line's.
inline constexpr int kDelayLine = 128;

template <class T>
class DelayLine {
  static constexpr int kLanes = kWidth<T>;

 public:
  /// Nothing touches banks beyond `most_banks`, those of any stage.
  void Configure(int most_banks) {
    most_banks_ = most_banks;
    same_delay_ = true;
  }
  void SetAllocation(int lane, const NozzleLayout& layout) {
    // A stage without further banks sets them to nothing.
    for (int bank = 0; bank < most_banks_; ++bank)
      SetLane(allocation_[bank], lane, AllocationOf(layout, bank));
  }
  const BankAllocation<T>& allocation(int bank) const { return allocation_[bank]; }

  /// No command gets through within the tick.
  void Forget(int lane) { delay_[lane].switch_s = kFarFuture; }
  /// Nothing is on the way. `burning`: lanes of which some may have other delays.
  void StartStage(int lane, double delay_ticks, double tick_s, MaskOf<T> burning) {
    for (int bank = 0; bank < most_banks_; ++bank)
      for (auto& entry : line_[bank])
        for (T& command : entry) Lane(command, lane) = 0.0;
    Delay& delay = delay_[lane];
    delay.whole_ticks = static_cast<int>(delay_ticks + kSameInstant_s);
    const double part = delay_ticks - delay.whole_ticks;
    delay.part_s = part > kSameInstant_s ? part * tick_s : 0.0;
    if (delay.whole_ticks > kDelayLine - 2) {
      delay.whole_ticks = kDelayLine - 2;
      delay.part_s = 0.0;
    }
    Forget(lane);
    same_delay_ = true;
    common_ticks_ = delay.whole_ticks;
    for (int i = 0; i < kLanes; ++i)
      if (Bits(burning) >> i & 1u)
        same_delay_ &= delay_[i].part_s == 0.0 && delay_[i].whole_ticks == common_ticks_;
  }

  /// This tick's commands into the line, and what leaves it now to the actuators. Returns whether a command
  /// gets through within the tick: stops of lanes have changed.
  bool Pass(MaskOf<T> powered, T time_s, const T* command_rad, StepState<T>& step) {
    const T roll = command_rad[kRoll], pitch = command_rad[kPitch], yaw = command_rad[kYaw];
    const bool listed = step.plant().nozzles_listed;
    for (int bank = 0; bank < step.plant().banks; ++bank) {
      T(*const line)[kDrives] = line_[bank];
      T* const entry = line[at_];
      if (listed) {
        Allocate(allocation_[bank], roll, pitch, yaw, entry);
      } else {
        entry[0] = pitch + roll;
        entry[1] = pitch - roll;
        entry[2] = yaw + roll;
        entry[3] = yaw - roll;
      }
      if (same_delay_) {
        step.Command(powered, bank, line[(at_ - common_ticks_) & (kDelayLine - 1)]);
        continue;
      }
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!(Bits(powered) >> lane & 1u)) continue;
        const Delay& delay = delay_[lane];
        const int late = delay.part_s > 0.0 ? 1 : 0;
        const T* const next = line[(at_ - delay.whole_ticks) & (kDelayLine - 1)];
        step.CommandLane(lane, bank, line[(at_ - delay.whole_ticks - late) & (kDelayLine - 1)]);
        for (int i = 0; i < (listed ? kDrives : kNozzles); ++i)
          Lane(next_rad_[bank][i], lane) = Lane(next[i], lane);
      }
    }
    at_ = (at_ + 1) & (kDelayLine - 1);
    bool switches = false;
    for (int lane = 0; !same_delay_ && lane < kLanes; ++lane) {
      if (!(Bits(powered) >> lane & 1u) || !(delay_[lane].part_s > 0.0)) continue;
      delay_[lane].switch_s = Lane(time_s, lane) + delay_[lane].part_s;
      switches = true;
    }
    return switches;
  }
  /// When the lane's next command gets through within the tick (kFarFuture: none does).
  double switch_s(int lane) const { return delay_[lane].switch_s; }
  /// It gets through.
  void Switch(int lane, StepState<T>& step) {
    Forget(lane);
    for (int bank = 0; bank < step.plant().banks; ++bank) step.CommandLane(lane, bank, next_rad_[bank]);
  }

 private:
  struct Delay {
    int whole_ticks;  ///< between command and actuator, and
    double part_s;    ///< a part of one
    double switch_s;
  };

  int most_banks_, at_, common_ticks_;
  bool same_delay_;  ///< all lanes that burn have one of whole ticks, common_ticks_
  Delay delay_[kLanes];
  BankAllocation<T> allocation_[kBanks];  ///< of listed nozzles
  T next_rad_[kBanks][kDrives];
  T line_[kBanks][kDelayLine][kDrives];  ///< commands by tick
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
