#include "core/vehicle/nozzle_layout.h"

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/matrices.h"
#include "core/math/rotation.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

namespace {

// Least independence of a matrix of rank 3 or 2 with scaled rows. It is 1 if each axis has drives of its own.
constexpr double kIndependence = 1e-6;
constexpr double kOnAxis_m = 1e-3;

using Effect = Eigen::Matrix<double, kSteeredAxes, Eigen::Dynamic>;

// A column for each drive of the banks that the nozzles need.
// Of a drive by itself, whatever group it is in.
Eigen::Vector3d EffectOf(const NozzleLayout& o, int drive) {
  const int k = NozzleOf(drive);
  const double y = o.towards_y[drive], z = o.towards_z[drive];
  return o.share[k] * Eigen::Vector3d(o.y_m[k] * z - o.z_m[k] * y, z, -y);
}

struct Placed {
  NozzleLayout layout;
  Effect effect;         // G: of roll in m, of pitch and yaw without unit
  Eigen::VectorXd ease;  // W^-1
  // The command that each drive follows: its own, or that of the first of its group (-1: it is not there).
  std::vector<int> leader;
};

// The cross as a list: the numbering of core/README.md.
std::vector<Nozzle> Cross(double radius_m) {
  constexpr double kTowardsZ = 0.5 * kPi, kTowardsMinusY = kPi;
  return {{"right", radius_m, 0.0, 0.25, {kTowardsZ}, 0.0},
          {"left", -radius_m, 0.0, 0.25, {kTowardsZ}, 0.0},
          {"bottom", 0.0, radius_m, 0.25, {kTowardsMinusY}, 0.0},
          {"top", 0.0, -radius_m, 0.25, {kTowardsMinusY}, 0.0}};
}

// A group's effects count as those of its first nozzle, with the least limit.
void JoinGroups(Placed& placed) {
  for (std::size_t drive = 0; drive < placed.leader.size(); ++drive) {
    const int leader = placed.leader[drive], here = static_cast<int>(drive);
    if (leader < 0 || leader == here) continue;
    placed.effect.col(leader) += placed.effect.col(here);
    placed.effect.col(here).setZero();
    placed.ease[leader] = std::min(placed.ease[leader], placed.ease[here]);
    placed.ease[here] = 0.0;
  }
}

Placed Place(const Gimbal& gimbal) {
  const std::vector<Nozzle> nozzles = gimbal.nozzles.empty() ? Cross(gimbal.radius_m) : NozzlesOf(gimbal);
  Placed placed;
  NozzleLayout& o = placed.layout;
  o.nozzles = static_cast<int>(nozzles.size());
  const int drives = o.banks() * kDrives;
  placed.effect = Effect::Zero(kSteeredAxes, drives);
  placed.ease = Eigen::VectorXd::Zero(drives);
  placed.leader.assign(static_cast<std::size_t>(drives), -1);
  double radius2_m2 = 0.0;
  for (int k = 0; k < o.nozzles; ++k) {
    const Nozzle& nozzle = nozzles[static_cast<std::size_t>(k)];
    o.share[k] = nozzle.thrust_share;
    o.y_m[k] = nozzle.y_m;
    o.z_m[k] = nozzle.z_m;
    o.limit_rad[k] = nozzle.limit_rad > 0.0 ? nozzle.limit_rad : gimbal.limit_rad;
    radius2_m2 += nozzle.thrust_share * (nozzle.y_m * nozzle.y_m + nozzle.z_m * nozzle.z_m);
    for (std::size_t hinge = 0; hinge < nozzle.towards_rad.size(); ++hinge) {
      const int drive = DriveOf(k, static_cast<int>(hinge));
      const SinCos towards = SineCosine(nozzle.towards_rad[hinge]);
      // A quarter turn's cosine is 6e-17; it is meant to be nothing.
      const auto exact = [](double x) { return std::fabs(x) < 1e-15 ? 0.0 : x; };
      o.there[drive] = 1.0;
      o.towards_y[drive] = exact(towards.cos);
      o.towards_z[drive] = exact(towards.sin);
      placed.effect.col(drive) = EffectOf(o, drive);
      const double ease = o.limit_rad[k] / gimbal.limit_rad;
      placed.ease[drive] = ease * ease;
      placed.leader[static_cast<std::size_t>(drive)] = drive;
      for (int first = 0; first < k && !nozzle.group.empty(); ++first)
        if (nozzles[static_cast<std::size_t>(first)].group == nozzle.group) {
          placed.leader[static_cast<std::size_t>(drive)] = DriveOf(first, static_cast<int>(hinge));
          break;
        }
    }
  }
  o.flow_radius_m = Sqrt(radius2_m2);
  JoinGroups(placed);
  return placed;
}

// Determinant of G W^-1 G' with rows scaled to length 1; 0 where an axis has nothing.
double Independence(const Placed& placed, int first_axis) {
  Eigen::MatrixXd rows = placed.effect.bottomRows(kSteeredAxes - first_axis);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double length = Sqrt((rows.row(i).array().square() * placed.ease.transpose().array()).sum());
    if (!(length > 0.0)) return 0.0;
    rows.row(i) /= length;
  }
  const Eigen::MatrixXd product = rows * placed.ease.asDiagonal() * rows.transpose();
  return DeterminantOf(product);
}

bool TurnsInRoll(const Placed& placed) { return placed.effect.row(0).cwiseAbs().maxCoeff() > 1e-9; }

}  // namespace

std::vector<Nozzle> NozzlesOf(const Gimbal& gimbal) {
  std::vector<Nozzle> nozzles;
  for (const Nozzle& entry : gimbal.nozzles) {
    const NozzleRing& ring = entry.ring;
    for (int k = 0; k < ring.count; ++k) {
      Nozzle& one = nozzles.emplace_back(entry);
      one.ring = {};
      if (ring.count == 1) continue;
      const double at_rad = ring.first_rad + kTwoPi * k / ring.count;
      const SinCos place = SineCosine(at_rad);
      one.name += std::to_string(k + 1);
      one.y_m = ring.radius_m * place.cos;
      one.z_m = ring.radius_m * place.sin;
      for (double& towards_rad : one.towards_rad)
        if (ring.turned) towards_rad += at_rad;
    }
  }
  double left = 1.0, equal = 0.0;
  for (const Nozzle& one : nozzles) {
    left -= one.thrust_share;
    if (one.thrust_share == 0.0) equal += 1.0;
  }
  for (Nozzle& one : nozzles)
    if (one.thrust_share == 0.0) one.thrust_share = left / equal;
  return nozzles;
}

namespace {

// `effect_of`: of a drive by itself.
template <class EffectOfDrive>
NozzleLayout Allocated(Placed placed, double command_limit_rad, const EffectOfDrive& effect_of) {
  NozzleLayout& o = placed.layout;
  o.rolls = TurnsInRoll(placed);
  const int first = o.rolls ? 0 : 1;  // without authority in roll, of pitch and yaw alone
  const Eigen::MatrixXd effect = placed.effect.bottomRows(kSteeredAxes - first);
  const Eigen::MatrixXd eased = placed.ease.asDiagonal() * effect.transpose();
  const Eigen::MatrixXd product = effect * eased;
  const Eigen::MatrixXd inverse = eased * InverseOf(product);
  // Deflections over the nozzles' limits, at a command of the gimbal's limit.
  const auto reach = [&](int axis) {
    double most = 0.0;
    for (int k = 0; k < o.nozzles; ++k) {
      const auto commanded = [&](int hinge) {
        const int leader = placed.leader[static_cast<std::size_t>(DriveOf(k, hinge))];
        return leader < 0 ? 0.0 : inverse(leader, axis - first);
      };
      const double a = commanded(0), b = commanded(1);
      const double size = Sqrt(a * a + b * b);
      if (size > 0.0) most = std::max(most, size * command_limit_rad / o.limit_rad[k]);
    }
    return most;
  };
  double scale[kSteeredAxes] = {};
  if (o.rolls) scale[0] = 1.0 / reach(0);
  scale[1] = scale[2] = 1.0 / std::max(reach(1), reach(2));
  // Rounds to 1e-12, the distance of doubles near 6144, so that values that should be 1 or 0 are exact.
  const auto rounded = [](double x) { return (x + 0x1.8p12) - 0x1.8p12; };
  for (int axis = first; axis < kSteeredAxes; ++axis) {
    for (int drive = 0; drive < o.banks() * kDrives; ++drive) {
      const int leader = placed.leader[static_cast<std::size_t>(drive)];
      if (leader < 0) continue;
      o.allocation[drive][axis] = rounded(scale[axis] * inverse(leader, axis - first));
      o.felt[axis][drive] = effect_of(o, drive)[axis] / scale[axis];
    }
  }
  o.pitch_share = scale[1];
  o.roll_arm_m = scale[0];
  return o;
}

}  // namespace

NozzleLayout BuildNozzleLayout(const Gimbal& gimbal) {
  DISPERSA_ASSERT(NozzleProblems(gimbal, "").empty());
  if (gimbal.fixed) {  // in parts, as those of a cross on the axis
    NozzleLayout fixed;
    fixed.nozzles = kNozzles;
    fixed.rolls = true;  // nobody asks its thrusters to
    for (int k = 0; k < kNozzles; ++k) fixed.share[k] = 1.0 / kNozzles;
    return fixed;
  }
  return Allocated(Place(gimbal), gimbal.limit_rad, EffectOf);
}

Matrix3 CantOf(const Boosters& boosters, double angle_rad) {
  const SinCos at = SineCosine(angle_rad);
  return RotationMatrix(FromRotationVector(boosters.cant_rad * Vector3(0.0, at.sin, -at.cos)));
}

NozzleLayout BuildBoostLayout(const Gimbal& stage, const Boosters& boosters, const BoostGeometry& geometry) {
  Placed placed = Place(stage);
  NozzleLayout& o = placed.layout;
  const int first = o.banks() * kNozzles;
  o.nozzles = first + boosters.count;
  const int drives = o.banks() * kDrives, before = static_cast<int>(placed.leader.size());
  placed.effect.conservativeResize(Eigen::NoChange, drives);
  placed.effect.rightCols(drives - before).setZero();
  placed.ease.conservativeResize(drives);
  placed.ease.tail(drives - before).setZero();
  placed.leader.resize(static_cast<std::size_t>(drives), -1);
  if (boosters.steer_alone) {
    placed.effect.leftCols(before).setZero();
    placed.ease.head(before).setZero();
    for (int drive = 0; drive < before; ++drive) placed.leader[static_cast<std::size_t>(drive)] = -1;
  }
  // The moment by a radian, over the stage's thrust, and across the axis also over its lever.
  const auto effect_of = [&](const NozzleLayout& layout, int drive) -> Eigen::Vector3d {
    const int k = NozzleOf(drive);
    if (k < first) return EffectOf(layout, drive);
    const Vector3 towards(0.0, layout.towards_y[drive], layout.towards_z[drive]);
    const Vector3 arm(-geometry.booster_lever_m, layout.y_m[k], layout.z_m[k]);
    const double angle_rad = boosters.angles_rad[static_cast<std::size_t>(k - first)];
    Vector3 moment = geometry.thrust_ratio * arm.cross(CantOf(boosters, angle_rad) * towards);
    moment.tail<2>() /= geometry.stage_lever_m;
    return moment;
  };
  for (int i = 0; i < boosters.count; ++i) {
    const int k = first + i;
    const SinCos at = SineCosine(boosters.angles_rad[static_cast<std::size_t>(i)]);
    o.share[k] = geometry.thrust_ratio;
    o.y_m[k] = boosters.radius_m * at.cos;
    o.z_m[k] = boosters.radius_m * at.sin;
    o.limit_rad[k] = boosters.gimbal.limit_rad;
    for (std::size_t hinge = 0; hinge < boosters.towards_rad.size() && boosters.turn_nozzles(); ++hinge) {
      const int drive = DriveOf(k, static_cast<int>(hinge));
      const SinCos towards = SineCosine(boosters.towards_rad[hinge]);
      o.there[drive] = 1.0;
      o.towards_y[drive] = towards.cos;
      o.towards_z[drive] = towards.sin;
      placed.effect.col(drive) = effect_of(o, drive);
      const double ease = o.limit_rad[k] / stage.limit_rad;
      placed.ease[drive] = ease * ease;
      placed.leader[static_cast<std::size_t>(drive)] = drive;
    }
  }
  return Allocated(std::move(placed), stage.limit_rad, effect_of);
}

std::vector<StructProblem> NozzleProblems(const Gimbal& gimbal, const std::string& path) {
  std::vector<StructProblem> problems;
  if (gimbal.nozzles.empty()) return problems;
  const std::string list = path + ".nozzles";
  const std::vector<Nozzle> all = NozzlesOf(gimbal);
  if (all.size() > kListedNozzles)
    return {{list, "are " + std::to_string(all.size()) + " in all", "up to 33 nozzles of a stage"}};
  double shares = 0.0, y_m = 0.0, z_m = 0.0;
  for (const Nozzle& nozzle : all) {
    shares += nozzle.thrust_share;
    y_m += nozzle.thrust_share * nozzle.y_m;
    z_m += nozzle.thrust_share * nozzle.z_m;
    if (!(nozzle.thrust_share > 0.0))
      return {{list, "leave no thrust to " + nozzle.name, "thrust_share that sum to less than 1 beside it"}};
  }
  for (std::size_t k = 0; k < gimbal.nozzles.size(); ++k) {
    const Nozzle& nozzle = gimbal.nozzles[k];
    const std::string item = list + "[" + std::to_string(k) + "]";
    for (std::size_t other = 0; other < k && !nozzle.group.empty(); ++other)
      if (gimbal.nozzles[other].group == nozzle.group &&
          gimbal.nozzles[other].towards_rad.size() != nozzle.towards_rad.size())
        problems.push_back({item + ".group", "has nozzles with another number of hinges",
                            "nozzles with as many turns_towards_deg in one group"});
    if (nozzle.limit_rad > gimbal.limit_rad)
      problems.push_back(
          {item + ".limit_deg", "is beyond the limit_deg of its drives", "up to the gimbal's limit_deg"});
    const bool has_two = nozzle.towards_rad.size() > 1;
    const double between = has_two ? nozzle.towards_rad[1] - nozzle.towards_rad[0] : 0.0;
    if (has_two && std::fabs(Cos(between)) > 1e-9)
      problems.push_back({item + ".turns_towards_deg",
                          "has hinges that are not at right angles, but " +
                              std::to_string(between * kDegPerRad) + " deg apart",
                          "one direction, or two that are 90 deg apart"});
    for (std::size_t other = 0; other < k; ++other)
      if (gimbal.nozzles[other].name == nozzle.name)
        problems.push_back(
            {item + ".name", "is that of another nozzle, " + nozzle.name, "a name of its own"});
  }
  for (std::size_t k = 0; problems.empty() && k < all.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      if (all[other].name == all[k].name)
        problems.push_back(
            {list, "have two of the name " + all[k].name, "names that differ with the numbers of rings"});
  // Shares and places are written with a few digits.
  if (std::fabs(shares - 1.0) > 1e-6)
    problems.push_back({list, "have shares of the thrust that sum to " + std::to_string(shares),
                        "thrust_share that sum to 1"});
  if (std::fabs(y_m) > kOnAxis_m || std::fabs(z_m) > kOnAxis_m)
    problems.push_back({list,
                        "push beside the axis: the mean of their places, by thrust_share, is y " +
                            std::to_string(y_m) + " m, z " + std::to_string(z_m) + " m",
                        "a mean on the axis, to 1 mm"});
  if (!problems.empty()) return problems;

  const Placed placed = Place(gimbal);
  const std::string pitch_and_yaw =
      "hinges by which pitch and yaw are commanded, as turns_towards_deg: [90, 180] "
      "of one nozzle";
  for (int axis = 1; axis < kSteeredAxes; ++axis)
    if (!(placed.effect.row(axis).cwiseAbs().maxCoeff() > 1e-9))
      problems.push_back(
          {list, std::string("do not turn the vehicle in ") + (axis == 1 ? "pitch" : "yaw"), pitch_and_yaw});
  if (!problems.empty()) return problems;
  if (Independence(placed, 1) < kIndependence)
    problems.push_back(
        {list, "cannot turn the vehicle in pitch and in yaw one without the other", pitch_and_yaw});
  else if (TurnsInRoll(placed) && Independence(placed, 0) < kIndependence)
    problems.push_back({list,
                        "turn the vehicle in roll with every command of pitch or yaw, and cannot undo it",
                        "hinges by which roll is commanded too, or none that turn the vehicle in roll"});
  return problems;
}

}  // namespace dispersa
