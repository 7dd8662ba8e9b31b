#include "core/structure/bending_modes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/math/assertion.h"
#include "core/structure/beam_elements.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/free_free_modes.h"
#include "core/structure/mode_tracking.h"
#include "core/structure/near_modes.h"
#include "core/vehicle/booster_course.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

/// A mode that resembles its predecessor less than this is looked at more closely.
constexpr double kSureMac = 0.9;
constexpr int kHalvings = 5;
/// Solved beside the modes asked for, so that one that falls in order is still found.
constexpr int kFurtherModes = 3;

std::size_t Index(BeamPlane plane) { return plane == BeamPlane::kY ? 0 : 1; }

// Modes at one level, in the order of those before it.
struct Level {
  double propellant_kg = 0.0;
  Eigen::VectorXd frequency_rad_s, generalized_mass_kg, mac;
  Eigen::MatrixXd shape;  // a column a mode
  Eigen::MatrixXd mass;
};

// Every column to a largest deflection of 1.
void Scale(Level& level) {
  for (Eigen::Index mode = 0; mode < level.shape.cols(); ++mode) {
    double largest = 0.0;
    for (Eigen::Index row = 0; row < level.shape.rows(); row += kNodeRows)
      largest = std::max(largest, std::fabs(level.shape(row, mode)));
    level.shape.col(mode) /= largest;
    level.generalized_mass_kg[mode] /= largest * largest;
  }
}

// The first level: in the order of frequencies, noses up.
void Begin(Level& level, Eigen::Index count) {
  count = std::min(count, level.shape.cols());
  level.frequency_rad_s.conservativeResize(count);
  level.generalized_mass_kg.conservativeResize(count);
  level.shape.conservativeResize(Eigen::NoChange, count);
  level.mac = Eigen::VectorXd::Ones(count);
  for (Eigen::Index mode = 0; mode < count; ++mode) {
    if (level.shape(0, mode) < 0.0) level.shape.col(mode) *= -1.0;
  }
}

// What `later` has of the modes of `earlier`, in their order and with their signs.
Level Continue(const Level& earlier, const Level& later) {
  const std::vector<ModeMatch> matches =
      MatchModes(earlier.shape, later.shape, 0.5 * (earlier.mass + later.mass));
  const Eigen::Index count = earlier.shape.cols();
  Level level{later.propellant_kg,
              Eigen::VectorXd(count),
              Eigen::VectorXd(count),
              Eigen::VectorXd(count),
              Eigen::MatrixXd(later.shape.rows(), count),
              later.mass};
  for (Eigen::Index mode = 0; mode < count; ++mode) {
    const ModeMatch& match = matches[static_cast<std::size_t>(mode)];
    level.frequency_rad_s[mode] = later.frequency_rad_s[match.index];
    level.generalized_mass_kg[mode] = later.generalized_mass_kg[match.index];
    level.mac[mode] = match.mac;
    level.shape.col(mode) = match.sign * later.shape.col(match.index);
  }
  return level;
}

// Continues `earlier` to a propellant level by steps so small that every mode is recognised.
template <typename Solve>
Level Follow(const Level& earlier, double propellant_kg, const Solve& solve, int halvings) {
  Level level = Continue(earlier, solve(propellant_kg));
  if (halvings == 0 || level.mac.minCoeff() >= kSureMac) return level;
  const Level middle = Follow(earlier, 0.5 * (earlier.propellant_kg + propellant_kg), solve, halvings - 1);
  level = Follow(middle, propellant_kg, solve, halvings - 1);
  level.mac = level.mac.cwiseMin(middle.mac);
  return level;
}

void Append(const Level& level, std::vector<BendingLevel>& levels) {
  BendingLevel out;
  out.propellant_kg = level.propellant_kg;
  for (Eigen::Index mode = 0; mode < level.shape.cols(); ++mode) {
    BendingMode m;
    m.frequency_rad_s = level.frequency_rad_s[mode];
    m.generalized_mass_kg = level.generalized_mass_kg[mode];
    m.mac = level.mac[mode];
    for (Eigen::Index row = 0; row < level.shape.rows(); row += kNodeRows) {
      m.deflection.push_back(level.shape(row, mode));
      m.slope_1_m.push_back(level.shape(row + 1, mode));
      m.bow.push_back(level.shape(row + 2, mode));
    }
    out.modes.push_back(std::move(m));
  }
  levels.push_back(std::move(out));
}

// Levels of propellant at which the modes are solved, falling. Boosters burn for a part of their stage's
// burn: their levels are even over that part. One more lies as far behind the separation, since a flight's
// boosters may burn longer.
std::vector<double> LevelsOf(const Vehicle& vehicle, int stage, unsigned gone) {
  const double full_kg = vehicle.stages[static_cast<std::size_t>(stage)].propellant_mass_kg;
  const int steps = vehicle.structure_beam->propellant_levels - 1;
  std::vector<double> levels_kg;
  if (stage > 0 || vehicle.boosters.count == 0 || (gone & kBoostersGone)) {
    for (int i = steps; i >= 0; --i) levels_kg.push_back(full_kg * i / steps);
    return levels_kg;
  }
  const BoosterCourse course(vehicle);
  const double burnout_kg = course.StageAtBurnout(), step_kg = (full_kg - burnout_kg) / steps;
  for (int i = steps; i > 0; --i) levels_kg.push_back(burnout_kg + step_kg * i);
  levels_kg.push_back(burnout_kg);
  levels_kg.push_back(std::max(course.StageAtSeparation() - step_kg, 0.0));
  return levels_kg;
}

// The nominal modes of a level for NearModes: those that are followed, then others by rising frequency. None
// if the mesh has too few.
std::optional<FreeFreeModes> ShapesNear(const Level& level, const FreeFreeModes& lowest) {
  const Eigen::Index followed = level.shape.cols();
  const Eigen::Index count = NearModes::ShapesFor(static_cast<int>(followed));
  FreeFreeModes shapes{Eigen::VectorXd(count), Eigen::MatrixXd(level.shape.rows(), count)};
  Eigen::Index column = 0;
  for (; column < followed; ++column) {
    shapes.frequency_rad_s[column] = level.frequency_rad_s[column];
    shapes.shape.col(column) = level.shape.col(column) / std::sqrt(level.generalized_mass_kg[column]);
  }
  for (Eigen::Index k = 0; k < lowest.frequency_rad_s.size() && column < count; ++k) {
    if ((level.frequency_rad_s.array() == lowest.frequency_rad_s[k]).any()) continue;
    shapes.frequency_rad_s[column] = lowest.frequency_rad_s[k];
    shapes.shape.col(column++) = lowest.shape.col(k);
  }
  if (column < count) return {};
  return shapes;
}

BeamPlace PivotOf(const Vehicle& vehicle, BeamPlane plane, const StackModes& stack) {
  return PlaceAt(stack, plane, vehicle.stages[static_cast<std::size_t>(stack.stage)].gimbal.pivot_station_m);
}

// `basis` takes what the modes of other masses are sought near.
void SolvePlane(const Vehicle& vehicle, BeamPlane plane, StackModes& stack, ModeBasis& basis) {
  const StructureBeam& structure = *vehicle.structure_beam;
  Beam beam;
  beam.timoshenko = structure.timoshenko;
  beam.rotary_inertia = structure.rotary_inertia;
  for (int i = stack.stage; i < static_cast<int>(structure.stages.size()); i = LastBurn(vehicle, i) + 1) {
    const std::vector<BeamSection>& sections = structure.stages[static_cast<std::size_t>(i)].sections;
    beam.sections.insert(beam.sections.end(), sections.begin(), sections.end());
  }
  const std::vector<double> levels_kg = LevelsOf(vehicle, stack.stage, stack.gone);
  const double half_kg = levels_kg[levels_kg.size() / 2];
  // One mesh for all levels, so that shapes can be compared node by node.
  const BeamMesh mesh = RefinedMesh(beam, plane,
                                    {BuildBeamMasses(vehicle, stack.stage, levels_kg.front(), stack.gone),
                                     BuildBeamMasses(vehicle, stack.stage, half_kg, stack.gone),
                                     BuildBeamMasses(vehicle, stack.stage, levels_kg.back(), stack.gone)},
                                    structure.elements, structure.modes);
  const auto& [stations, elements, difference] = mesh;
  stack.mesh_difference[Index(plane)] = difference;
  stack.station_m[Index(plane)] = stations;
  for (const BeamElement& element : elements) stack.shear_ratio[Index(plane)].push_back(element.shear_ratio);
  auto near = std::make_unique<NearModes>(stations, elements, beam.rotary_inertia);

  const int count = structure.modes + kFurtherModes;
  FreeFreeModes lowest;  // of the level solved last
  const auto solve = [&](double propellant_kg) {
    beam.masses = BuildBeamMasses(vehicle, stack.stage, propellant_kg, stack.gone);
    Level level;
    level.propellant_kg = propellant_kg;
    level.mass = MassMatrix(beam, stations, elements);
    lowest =
        near->Lowest(beam.masses, std::max(count, NearModes::ShapesFor(structure.modes) + structure.modes));
    const Eigen::Index wanted = std::min<Eigen::Index>(count, lowest.frequency_rad_s.size());
    level.frequency_rad_s = lowest.frequency_rad_s.head(wanted);
    level.shape = lowest.shape.leftCols(wanted);
    level.generalized_mass_kg = Eigen::VectorXd::Ones(level.shape.cols());
    Scale(level);
    return level;
  };
  const BeamPlace pivot = PivotOf(vehicle, plane, stack);
  bool has_shapes = true;
  const auto keep = [&](const Level& level) {
    Append(level, stack.levels[Index(plane)]);
    stack.levels[Index(plane)].back().by_pivot_load = near->ByLoadsAt(pivot, beam.masses);
    const std::optional<FreeFreeModes> shapes = ShapesNear(level, lowest);
    has_shapes = has_shapes && shapes;
    if (has_shapes) near->AddLevel(*shapes);
  };
  Level level = solve(levels_kg.front());
  Begin(level, structure.modes);
  keep(level);
  for (std::size_t i = 1; i < levels_kg.size(); ++i) {
    level = Follow(level, levels_kg[i], solve, kHalvings);
    keep(level);
  }
  if (has_shapes) basis.planes[Index(plane)] = std::move(near);
}

// The first modes of a plane, sought near nominal ones; false if they are not found there.
bool SolvePlaneNear(const Vehicle& vehicle, BeamPlane plane, const StackModes& nominal, int modes,
                    StackModes& stack) {
  const std::vector<double> levels_kg = LevelsOf(vehicle, stack.stage, stack.gone);
  const NearModes* const near = nominal.basis ? nominal.basis->planes[Index(plane)].get() : nullptr;
  if (!near) return false;
  const BeamPlace pivot = PivotOf(vehicle, plane, nominal);
  std::vector<BendingLevel> levels;
  for (const double propellant_kg : levels_kg) {
    const BeamMasses masses = BuildBeamMasses(vehicle, stack.stage, propellant_kg, stack.gone);
    std::optional<std::vector<BendingMode>> found = near->Find(levels.size(), masses, modes, kSureMac);
    if (!found) return false;
    levels.push_back({propellant_kg, std::move(*found), near->ByLoadsAt(pivot, masses)});
  }
  stack.station_m[Index(plane)] = nominal.station_m[Index(plane)];
  stack.shear_ratio[Index(plane)] = nominal.shear_ratio[Index(plane)];
  stack.mesh_difference[Index(plane)] = nominal.mesh_difference[Index(plane)];
  stack.levels[Index(plane)] = std::move(levels);
  return true;
}

// The modes of a table for one stack and plane; false if it has none.
bool TakePlane(const Vehicle& vehicle, BeamPlane plane, StackModes& stack) {
  std::vector<Level> levels;
  std::vector<double>& stations = stack.station_m[Index(plane)];
  std::vector<BeamElement> elements;
  Beam beam;
  beam.rotary_inertia = vehicle.structure_beam->rotary_inertia;
  for (const TabledMode& m : vehicle.structure_beam->table) {
    if (m.stage != stack.stage || m.plane != plane) continue;
    if (stations.empty()) {
      stations = m.station_m;
      for (std::size_t i = 0; i + 1 < stations.size(); ++i)
        elements.push_back({stations[i + 1] - stations[i], 0.0, Eigen::Matrix3d::Zero()});
      stack.shear_ratio[Index(plane)].assign(elements.size(), 0.0);
    }
    if (levels.empty() || levels.back().propellant_kg != m.propellant_kg) {
      beam.masses = BuildBeamMasses(vehicle, stack.stage, m.propellant_kg);
      Level level;
      level.propellant_kg = m.propellant_kg;
      level.mass = MassMatrix(beam, stations, elements);
      level.shape.resize(kNodeRows * static_cast<Eigen::Index>(stations.size()), 0);
      levels.push_back(std::move(level));
    }
    Level& level = levels.back();
    const Eigen::Index column = level.shape.cols();
    level.frequency_rad_s.conservativeResize(column + 1);
    level.generalized_mass_kg.conservativeResize(column + 1);
    level.shape.conservativeResize(Eigen::NoChange, column + 1);
    level.frequency_rad_s[column] = m.frequency_rad_s;
    level.generalized_mass_kg[column] = m.generalized_mass_kg;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      level.shape.block<kNodeRows, 1>(kNodeRows * static_cast<Eigen::Index>(i), column) << m.deflection[i],
          m.slope_1_m[i], 0.0;
    }
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    Scale(levels[i]);
    if (i == 0) {
      Begin(levels[i], levels[i].shape.cols());
    } else {
      levels[i] = Continue(levels[i - 1], levels[i]);
    }
    Append(levels[i], stack.levels[Index(plane)]);
  }
  return !levels.empty();
}

void CopyPlaneY(StackModes& stack) {
  stack.station_m[1] = stack.station_m[0];
  stack.shear_ratio[1] = stack.shear_ratio[0];
  stack.mesh_difference[1] = stack.mesh_difference[0];
  stack.levels[1] = stack.levels[0];
}

bool IsAxisymmetric(const StructureBeam& beam, int stage) {
  for (std::size_t i = static_cast<std::size_t>(stage); i < beam.stages.size(); ++i) {
    for (const BeamSection& s : beam.stages[i].sections) {
      if (s.z_to_y_stiffness != 1.0) return false;
    }
  }
  return true;
}

}  // namespace

BeamPlace PlaceAt(const StackModes& stack, BeamPlane plane, double station_m) {
  const std::vector<double>& stations = stack.station_m[Index(plane)];
  const std::size_t last = stations.size() - 1;
  if (station_m <= stations.front()) return {0, {1.0, station_m - stations.front()}, {0.0, 1.0}};
  if (station_m >= stations.back())
    return {last - 1, {0.0, 0.0, 0.0, 1.0, station_m - stations[last]}, {0.0, 0.0, 0.0, 0.0, 1.0}};
  const auto above = std::upper_bound(stations.begin(), stations.end(), station_m);
  const std::size_t i = static_cast<std::size_t>(above - stations.begin()) - 1;
  const double length = stations[i + 1] - stations[i];
  const BeamShape shape =
      ShapeAt((station_m - stations[i]) / length, length, stack.shear_ratio[Index(plane)][i]);
  return {i, shape.deflection, shape.rotation};
}

StationShape ShapeOf(const StackModes& stack, BeamPlane plane, const BentShape& shape, double station_m) {
  return PlaceAt(stack, plane, station_m).Of(shape);
}

StackModes BuildStackModes(const Vehicle& vehicle, int stage, unsigned gone) {
  DISPERSA_ASSERT(stage >= 0 && stage < std::ssize(vehicle.stages), stage);
  DISPERSA_ASSERT(
      vehicle.structure_beam.has_value() && !vehicle.stages[static_cast<std::size_t>(stage)].restarts, stage);
  const StructureBeam& beam = *vehicle.structure_beam;
  StackModes stack;
  stack.stage = stage;
  stack.gone = gone;
  if (beam.table.empty()) {
    stack.axisymmetric = IsAxisymmetric(beam, stage);
    ModeBasis basis;
    SolvePlane(vehicle, BeamPlane::kY, stack, basis);
    if (!stack.axisymmetric) SolvePlane(vehicle, BeamPlane::kZ, stack, basis);
    stack.basis = std::make_shared<const ModeBasis>(std::move(basis));
  } else {
    TakePlane(vehicle, BeamPlane::kY, stack);
    stack.axisymmetric = !TakePlane(vehicle, BeamPlane::kZ, stack);
  }
  if (stack.axisymmetric) CopyPlaneY(stack);
  return stack;
}

StackModes BuildStackModesNear(const Vehicle& vehicle, const StackModes& nominal, int modes) {
  StackModes stack;
  stack.stage = nominal.stage;
  stack.gone = nominal.gone;
  stack.axisymmetric = nominal.axisymmetric;
  if (!SolvePlaneNear(vehicle, BeamPlane::kY, nominal, modes, stack) ||
      (!stack.axisymmetric && !SolvePlaneNear(vehicle, BeamPlane::kZ, nominal, modes, stack)))
    return BuildStackModes(vehicle, nominal.stage, nominal.gone);
  if (stack.axisymmetric) CopyPlaneY(stack);
  return stack;
}

std::vector<StackModes> ShownStacks(const Vehicle& vehicle) {
  std::vector<StackModes> stacks;
  for (int i = 0; i < static_cast<int>(vehicle.stages.size()); i = LastBurn(vehicle, i) + 1) {
    stacks.push_back(BuildStackModes(vehicle, i));
    const unsigned carried = CarriedBy(vehicle, i);
    if (carried & ~kBoostersGone && carried & kBoostersGone)
      stacks.push_back(BuildStackModes(vehicle, i, kBoostersGone));
    if (carried != 0) stacks.push_back(BuildStackModes(vehicle, i, carried));
  }
  return stacks;
}

std::string WithoutText(const Vehicle& vehicle, const StackModes& stack) {
  std::string text = stack.gone & kBoostersGone ? std::string(", without ") + kBoostersName : "";
  unsigned bit = 1;
  for (const Stage& stage : vehicle.stages)
    for (const Jettison& jettison : stage.jettisoned) {
      if (stack.gone & bit) text += (text.empty() ? ", without " : ", ") + jettison.name;
      bit <<= 1;
    }
  return text;
}

std::vector<StackModes> BuildBendingModes(const Vehicle& vehicle) {
  std::vector<StackModes> stacks;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    if (vehicle.stages[i].restarts) {
      stacks.push_back(stacks.back());
      stacks.back().stage = static_cast<int>(i);
    } else {
      stacks.push_back(BuildStackModes(vehicle, static_cast<int>(i)));
    }
  }
  return stacks;
}

ModeAlong Along(const StackModes& stack, BeamPlane plane, int mode, double station_m) {
  ModeAlong along;
  for (const BendingLevel& level : stack.levels[Index(plane)]) {
    const BendingMode& m = level.modes[static_cast<std::size_t>(mode)];
    const StationShape at = ShapeOf(stack, plane, m, station_m);
    along.propellant_kg.push_back(level.propellant_kg);
    along.frequency_rad_s.push_back(m.frequency_rad_s);
    along.generalized_mass_kg.push_back(m.generalized_mass_kg);
    along.deflection.push_back(at.deflection);
    along.slope_1_m.push_back(at.slope_1_m);
  }
  return along;
}

std::vector<BeamSensor> ShownStations(const Vehicle& vehicle, int stage) {
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  std::vector<BeamSensor> stations;
  for (const BeamSensor& sensor : vehicle.structure_beam->sensors) {
    if (sensor.station_m <= lowest.bottom_station_m) stations.push_back(sensor);
  }
  stations.push_back({"nozzle pivot", lowest.gimbal.pivot_station_m});
  return stations;
}

}  // namespace dispersa
