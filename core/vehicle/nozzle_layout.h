// Places and hinges of a stage's nozzles, and the share of each nozzle in a command about an axis.
//
// A nozzle has up to two hinges, each with its own drive. A hinge is named by a direction u across the body:
// a positive angle turns the nozzle's thrust towards u. The hinge's axis is across the body at right angles
// to u. Two hinges of a nozzle are at right angles, and the first carries the second, as in a Cardan joint.
// Deflections a and b turn the thrust to cos a cos b x + sin a cos b u1 + sin b u2, of unit length.
//
// To first order drive i of a nozzle at (y, z) with share q of the thrust T turns the body by T q (y u_z - z
// u_y) about x, T L q u_z about y and -T L q u_y about z. L is the pivots' distance aft of the centre of
// gravity. Commands go to the drives by the weighted pseudo-inverse of that matrix G, W^-1 G' (G W^-1 G')^-1
// (Penrose, Proc. Cambridge Phil. Soc. 51, 1955). It minimises the sum of the squares of deflection over
// limit. Its columns do not depend on T and L, so one matrix serves a stage from ignition to burnout. They
// are scaled such that a command of the gimbal's limit about one axis takes a nozzle to its own limit. Pitch
// and yaw have the scale of whichever needs more.
//
// Nozzles of a group share one command about each of their hinges. To the pseudo-inverse a group is one
// nozzle with the sum of their effects and the least of their limits.
//
// Four nozzles with their drives are a bank. Every vehicle has one bank. Clusters of more than four engines
// have further ones, which cost nothing where they are not.
//
// Valid for deflections below 40 deg, where the flight's series of sine and cosine end.
#pragma once

#include <string>
#include <vector>

#include "core/math/linear.h"

namespace dispersa {

struct Boosters;
struct Gimbal;
struct Nozzle;
struct StructProblem;

inline constexpr int kNozzles = 4;  ///< of a bank
/// Drives of a bank by number: the nozzles' first hinges, then their second ones. The drives of a further
/// bank follow those of the bank before.
inline constexpr int kDrives = 2 * kNozzles;
inline constexpr int kSteeredAxes = 3;     ///< roll, pitch, yaw
inline constexpr int kListedNozzles = 33;  ///< of a stage, at most
/// Nozzles of all stages together beyond four in each, at most.
inline constexpr int kFurtherNozzles = 64;
inline constexpr int kBanks = (kListedNozzles + kNozzles - 1) / kNozzles;
inline constexpr int kMostNozzles = kBanks * kNozzles, kMostDrives = kBanks * kDrives;
/// Drive of a nozzle's first (0) or second (1) hinge, and back.
constexpr int DriveOf(int nozzle, int hinge) {
  return nozzle / kNozzles * kDrives + nozzle % kNozzles + hinge * kNozzles;
}
constexpr int NozzleOf(int drive) { return drive / kDrives * kNozzles + drive % kNozzles; }

/// Plain arrays: lanes read them (core/dynamics/launcher_lanes.h). A nozzle or drive that a stage does not
/// have has zeros.
struct NozzleLayout {
  int nozzles = 0;
  bool rolls = false;               ///< commands of roll turn the vehicle (else its reaction control must)
  double share[kMostNozzles] = {};  ///< of the thrust
  double y_m[kMostNozzles] = {}, z_m[kMostNozzles] = {};
  double limit_rad[kMostNozzles] = {};  ///< of the whole deflection that is commanded
  double there[kMostDrives] = {};       ///< 1 of a drive that the stage has
  double towards_y[kMostDrives] = {}, towards_z[kMostDrives] = {};
  double allocation[kMostDrives][kSteeredAxes] = {};  ///< rad of a drive for a radian commanded about an axis
  double felt[kSteeredAxes][kMostDrives] = {};        ///< and back: what deflections stand for
  double pitch_share = 0.0;                           ///< moment of a radian of pitch, or yaw, over T L
  double roll_arm_m = 0.0;     ///< moment of a radian of roll over T (0: nozzles do not roll)
  double flow_radius_m = 0.0;  ///< of gyration of the flow about the axis, for the damping of roll

  int banks() const { return (nozzles + kNozzles - 1) / kNozzles; }
};
/// The nozzles of a gimbal's list, each by itself and with its share. Empty: four in a cross.
std::vector<Nozzle> NozzlesOf(const Gimbal& gimbal);
/// Precondition: a gimbal without problems. Without a list of nozzles it has four in a cross.
NozzleLayout BuildNozzleLayout(const Gimbal& gimbal);

/// How boosters with nozzles that turn compare with their stage: the ratio of one's thrust to the stage's,
/// and how far the centre of gravity is ahead of each.
struct BoostGeometry {
  double thrust_ratio = 0.0, stage_lever_m = 0.0, booster_lever_m = 0.0;
};
/// Turns the thrust of the booster at an angle by its cant.
Matrix3 CantOf(const Boosters& boosters, double angle_rad);
/// Commands while boosters burn, for the stage's nozzles and theirs together, which have banks of their own
/// behind the stage's. Their share is the ratio of thrusts. It is one matrix for all of the boosters' burn.
NozzleLayout BuildBoostLayout(const Gimbal& stage, const Boosters& boosters, const BoostGeometry& geometry);

/// Contradictions in a list of nozzles. Paths begin with `path`, that of the gimbal.
std::vector<StructProblem> NozzleProblems(const Gimbal& gimbal, const std::string& path);

}  // namespace dispersa
