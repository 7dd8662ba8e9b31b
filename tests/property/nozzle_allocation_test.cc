// Commands to drives and back, for random layouts: one to four nozzles anywhere, with none to two hinges
// each, alone and side by side.
#include "core/flight/nozzle_allocation.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "core/vehicle/vehicle.h"
#include "tests/test.h"

namespace dispersa::nozzle_allocation_test {
namespace {

constexpr double kLimit_rad = 6.0 * kRadPerDeg;

// The last nozzle stands where the mean of all is on the axis.
Gimbal DrawnGimbal(Stream& draws) {
  Gimbal gimbal;
  gimbal.pivot_station_m = 20.0;
  gimbal.limit_rad = kLimit_rad;
  const int count = 1 + static_cast<int>(4.0 * draws.Uniform());
  double left = 1.0, y_m = 0.0, z_m = 0.0;
  for (int k = 0; k < count; ++k) {
    Nozzle nozzle;
    nozzle.name = "n" + std::to_string(k);
    const bool is_last = k + 1 == count;
    nozzle.thrust_share = is_last ? left : left * (0.2 + 0.5 * draws.Uniform());
    nozzle.y_m = is_last ? -y_m / nozzle.thrust_share : 2.0 * draws.Uniform() - 1.0;
    nozzle.z_m = is_last ? -z_m / nozzle.thrust_share : 2.0 * draws.Uniform() - 1.0;
    left -= nozzle.thrust_share;
    y_m += nozzle.thrust_share * nozzle.y_m;
    z_m += nozzle.thrust_share * nozzle.z_m;
    const double towards = kTwoPi * draws.Uniform();
    const int hinges = static_cast<int>(3.0 * draws.Uniform() + 0.3);
    for (int hinge = 0; hinge < std::min(hinges, 2); ++hinge)
      nozzle.towards_rad.push_back(towards + 0.5 * kPi * hinge);
    if (draws.Uniform() < 0.5) nozzle.limit_rad = kLimit_rad * (0.3 + 0.7 * draws.Uniform());
    gimbal.nozzles.push_back(nozzle);
  }
  return gimbal;
}

// Those that can be flown.
std::vector<NozzleLayout> DrawnLayouts(std::size_t count) {
  std::vector<NozzleLayout> layouts;
  Stream draws(3, 0, "nozzles");
  while (layouts.size() < count) {
    const Gimbal gimbal = DrawnGimbal(draws);
    if (NozzleProblems(gimbal, "gimbal").empty()) layouts.push_back(BuildNozzleLayout(gimbal));
  }
  return layouts;
}

struct Command {
  double roll_rad, pitch_rad, yaw_rad;
};
// `size`: of the gimbal's limit.
Command DrawnCommand(Stream& draws, const NozzleLayout& layout, double size) {
  const auto one = [&] { return size * kLimit_rad * (2.0 * draws.Uniform() - 1.0); };
  return {layout.rolls ? one() : 0.0, one(), one()};
}

struct Drives {
  double command_rad[kDrives];
};
Drives Allocated(const lanes::BankAllocation<double>& a, const Command& c) {
  Drives drives;
  lanes::Allocate(a, c.roll_rad, c.pitch_rad, c.yaw_rad, drives.command_rad);
  return drives;
}
double Felt(const lanes::BankAllocation<double>& a, int axis, const Drives& drives) {
  return lanes::FeltAbout(a, axis, drives.command_rad, drives.command_rad + kNozzles);
}

TEST(NozzleAllocation, WhatIsFeltIsWhatWasCommanded) {
  Stream draws(4, 0, "commands");
  int rolling = 0, turning_twice = 0, fixed = 0;
  for (const NozzleLayout& layout : DrawnLayouts(300)) {
    rolling += layout.rolls;
    for (int k = 0; k < layout.nozzles; ++k) {
      turning_twice += layout.there[k + kNozzles] > 0.0;
      fixed += layout.there[k] == 0.0;
    }
    const lanes::BankAllocation<double> a = lanes::AllocationOf(layout, 0);
    // A layout that hardly rolls turns far for it: the smallest commands stay within every limit.
    const Command command = DrawnCommand(draws, layout, 0.3);
    const Drives drives = Allocated(a, command);
    if (lanes::IsSaturated(a, drives.command_rad)) continue;
    double effort = 0.0;
    for (const double angle : drives.command_rad) effort = std::max(effort, std::fabs(angle));
    // The allocation is rounded to 1e-12, of effects that may nearly cancel.
    const double tolerance = 1e-9 * kLimit_rad;
    if (layout.rolls) {
      EXPECT_NEAR(Felt(a, 0, drives), command.roll_rad, tolerance);
    }
    EXPECT_NEAR(Felt(a, 1, drives), command.pitch_rad, tolerance);
    EXPECT_NEAR(Felt(a, 2, drives), command.yaw_rad, tolerance);
    EXPECT_LE(effort, kLimit_rad * (1.0 + 1e-12));
  }
  // All kinds were among them.
  EXPECT_GT(rolling, 50);
  EXPECT_GT(turning_twice, 50);
  EXPECT_GT(fixed, 20);
}

// Each nozzle within its own limit, in the direction that was asked of it; saturation is said when one is
// there.
TEST(NozzleAllocation, KeepsEachNozzleWithinItsLimitAndDirection) {
  Stream draws(5, 0, "commands");
  int saturated = 0, free = 0;
  for (const NozzleLayout& layout : DrawnLayouts(300)) {
    const lanes::BankAllocation<double> a = lanes::AllocationOf(layout, 0);
    const Command command = DrawnCommand(draws, layout, 2.0);
    const Drives drives = Allocated(a, command);
    bool reached = false;
    for (int k = 0; k < kNozzles; ++k) {
      const auto asked = [&](int drive) {
        const double* of = layout.allocation[drive];
        return of[0] * command.roll_rad + of[1] * command.pitch_rad + of[2] * command.yaw_rad;
      };
      const double first = asked(k), second = asked(k + kNozzles), size = std::hypot(first, second);
      const double limit = layout.limit_rad[k], scale = size > limit ? limit / size : 1.0;
      EXPECT_NEAR(drives.command_rad[k], scale * first, 1e-14);
      EXPECT_NEAR(drives.command_rad[k + kNozzles], scale * second, 1e-14);
      reached |= limit > 0.0 && size > limit;
    }
    EXPECT_EQ(lanes::IsSaturated(a, drives.command_rad), reached);
    ++(reached ? saturated : free);
  }
  EXPECT_GT(saturated, 50);
  EXPECT_GT(free, 20);
}

// Of all deflections that turn the vehicle as commanded the allocation is the least, each over its nozzle's
// limit: what turns nothing is at right angles to it.
TEST(NozzleAllocation, IsTheLeastThatDoes) {
  Stream draws(6, 0, "deflections");
  for (const NozzleLayout& layout : DrawnLayouts(100)) {
    const lanes::BankAllocation<double> a = lanes::AllocationOf(layout, 0);
    Drives any;
    for (int drive = 0; drive < kDrives; ++drive)
      any.command_rad[drive] = layout.there[drive] * (2.0 * draws.Uniform() - 1.0);
    // Its effect about the axes is subtracted.
    double idle[kDrives];
    for (int drive = 0; drive < kDrives; ++drive) {
      idle[drive] = any.command_rad[drive];
      for (int axis = 0; axis < kSteeredAxes; ++axis)
        idle[drive] -= layout.allocation[drive][axis] * Felt(a, axis, any);
    }
    for (int axis = layout.rolls ? 0 : 1; axis < kSteeredAxes; ++axis) {
      double product = 0.0, size = 0.0;
      for (int drive = 0; drive < kDrives; ++drive) {
        const double over = std::pow(layout.limit_rad[drive % kNozzles] / kLimit_rad, 2);
        if (layout.there[drive] == 0.0) continue;
        product += layout.allocation[drive][axis] * idle[drive] / over;
        size += std::fabs(layout.allocation[drive][axis]) / over;
      }
      EXPECT_NEAR(product, 0.0, 1e-9 * std::max(1.0, size * size));
    }
  }
}

// Stages of different layouts, side by side.
TEST(NozzleAllocation, OfALaneIsThatOfItsStageAlone) {
  using Four = lanes::Pack<4>;
  const std::vector<NozzleLayout> layouts = DrawnLayouts(40);
  Stream draws(7, 0, "commands");
  for (std::size_t first = 0; first < layouts.size(); first += 4) {
    lanes::BankAllocation<Four> together{};
    Four roll(0.0), pitch(0.0), yaw(0.0), drives[kDrives];
    Command commands[4];
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const int at = static_cast<int>(lane);
      lanes::SetLane(together, at, lanes::AllocationOf(layouts[first + lane], 0));
      commands[lane] = DrawnCommand(draws, layouts[first + lane], 2.0);
      lanes::Lane(roll, at) = commands[lane].roll_rad;
      lanes::Lane(pitch, at) = commands[lane].pitch_rad;
      lanes::Lane(yaw, at) = commands[lane].yaw_rad;
    }
    lanes::Allocate(together, roll, pitch, yaw, drives);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const int at = static_cast<int>(lane);
      const lanes::BankAllocation<double> alone = lanes::AllocationOf(layouts[first + lane], 0);
      const Drives expected = Allocated(alone, commands[lane]);
      for (int drive = 0; drive < kDrives; ++drive)
        EXPECT_EQ(lanes::Lane(drives[drive], at), expected.command_rad[drive]);
      for (int axis = 0; axis < kSteeredAxes; ++axis)
        EXPECT_EQ(lanes::Lane(lanes::FeltAbout(together, axis, drives, drives + kNozzles), at),
                  Felt(alone, axis, expected));
      EXPECT_EQ((lanes::Bits(lanes::IsSaturated(together, drives)) >> at & 1u) != 0,
                lanes::IsSaturated(alone, expected.command_rad));
      EXPECT_EQ(lanes::Lane(together.per_drive, at), alone.per_drive);
      EXPECT_EQ(lanes::Lane(together.rolls_by_thrusters, at), layouts[first + lane].rolls ? 0.0 : 1.0);
    }
  }
}

}  // namespace
}  // namespace dispersa::nozzle_allocation_test
