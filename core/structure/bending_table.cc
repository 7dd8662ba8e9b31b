#include "core/structure/bending_table.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/math/functions.h"
#include "core/structure/inertia_moment.h"
#include "core/vehicle/beam_masses.h"

namespace dispersa {

namespace {

/// Places along the beam at which the shortening is summed.
constexpr int kShorteningSteps = 400;

bool FliesAtAllLevels(const StackModes& stack, std::size_t mode, double highest_rad_s) {
  for (const std::vector<BendingLevel>& plane : stack.levels)
    for (const BendingLevel& level : plane)
      if (mode >= level.modes.size() || level.modes[mode].frequency_rad_s >= highest_rad_s) return false;
  return true;
}

// The share of the mass ahead of each place, from the nose aft.
std::vector<double> MassAhead(const BeamMasses& masses, const std::vector<double>& places) {
  const double step = places[1] - places[0];
  std::vector<double> ahead(places.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double here = 0.0;
    for (const SpreadMass& m : masses.spread)
      if (places[i] >= m.top_station_m && places[i] < m.bottom_station_m)
        here += m.MassPerLength(places[i]) * step;
    for (const FixedMass& m : masses.fixed)
      if (m.station_m >= places[i] - 0.5 * step && m.station_m < places[i] + 0.5 * step) here += m.mass_kg;
    ahead[i] = sum + 0.5 * here;
    sum += here;
  }
  for (double& share : ahead) share /= sum;
  return ahead;
}

// What the lift by a unit of a mode does. `deflections`: of each mode that flies, at the middle of each
// piece.
template <typename Shape>
void AddLift(const LoadTable& loads, const std::vector<std::vector<double>>& deflections, const Shape& at,
             double* row) {
  for (const bool by_rate : {false, true}) {
    double* const slender = row + BendingTable::LiftColumn(by_rate ? kRateSlender : kSlopeSlender, 0);
    double* const shift = slender + kLiftEffects;
    std::size_t piece = 0;
    const auto add = [&](double force, double station_m, double* effects) {
      effects[kForceEffect] += force;
      effects[kFirstEffect] += force * station_m;
      for (std::size_t j = 0; j < deflections.size(); ++j)
        effects[kWorkEffects + j] += force * deflections[j][piece];
      for (std::size_t i = 0; i < kLoadStations; ++i)
        effects[kSectionEffects + i] += force * std::max(loads.station_m[i] - station_m, 0.0);
    };
    loads.lift.ForEach(
        [&](double station_m) {
          const StationShape shape = at(station_m);
          return by_rate ? shape.deflection : shape.slope_1_m;
        },
        [&](double station_m, double by_slender, double by_shift) {
          add(by_slender, station_m, slender);
          add(by_shift, station_m, shift);
          ++piece;
        });
  }
}

/// The stages above, which a separation leaves as a body of their own.
struct UpperBody {
  BeamMasses masses;
  double mass_kg = 0.0, cg_station_m = 0.0, inertia_kg_m2 = 0.0;  ///< across the axis

  /// By how much a shape moves its centre of gravity and turns it: what leaves it the momentum and angular
  /// momentum of its masses.
  template <typename Shape>
  StationShape MeanOf(const Shape& at) const {
    StationShape sum;
    ForEachMass(at, [&](double mass, double station_m, double own_inertia, const StationShape& shape) {
      sum.deflection += mass * shape.deflection;
      sum.slope_1_m += mass * shape.deflection * (station_m - cg_station_m) + own_inertia * shape.slope_1_m;
    });
    return {sum.deflection / mass_kg, sum.slope_1_m / inertia_kg_m2};
  }

  explicit UpperBody(BeamMasses of) : masses(std::move(of)) {
    double first = 0.0;
    const auto still = [](double) { return StationShape{}; };
    ForEachMass(still, [&](double mass, double station_m, double, const StationShape&) {
      mass_kg += mass;
      first += mass * station_m;
    });
    cg_station_m = first / mass_kg;
    ForEachMass(still, [&](double mass, double station_m, double own_inertia, const StationShape&) {
      inertia_kg_m2 += mass * Square(station_m - cg_station_m) + own_inertia;
    });
  }

 private:
  // Every mass with its centre, its inertia about that, and the shape there.
  template <typename Shape, typename Take>
  void ForEachMass(const Shape& at, const Take& take) const {
    constexpr int kPieces = 50;
    for (const SpreadMass& m : masses.spread) {
      const double step = (m.bottom_station_m - m.top_station_m) / kPieces;
      for (int i = 0; i < kPieces; ++i) {
        const double x = m.top_station_m + step * (i + 0.5), mass = m.MassPerLength(x) * step;
        take(mass, x, mass * m.Gyration2(x), at(x));
      }
    }
    for (const FixedMass& m : masses.fixed) {
      StationShape shape = at(m.station_m);
      shape.deflection += shape.slope_1_m * (m.cg_station_m - m.station_m);
      take(m.mass_kg, m.cg_station_m, m.inertia_kg_m2, shape);
    }
  }
};

std::optional<UpperBody> UpperOf(const Vehicle& vehicle, int stage) {
  const std::size_t above = static_cast<std::size_t>(stage) + 1;
  if (above == vehicle.stages.size()) return {};
  return UpperBody(BuildBeamMasses(vehicle, stage + 1, vehicle.stages[above].propellant_mass_kg));
}

}  // namespace

double BendingTable::At(int plane, int mode, int column, double kg) const {
  std::size_t level = 0;
  while (level + 2 < propellant_kg.size() && kg < propellant_kg[level + 1]) ++level;
  const int low = static_cast<int>(level);
  if (propellant_kg.size() == 1) return Row(plane, 0, mode)[column];
  const double fraction =
      std::clamp((propellant_kg[level] - kg) / (propellant_kg[level] - propellant_kg[level + 1]), 0.0, 1.0);
  const double from = Row(plane, low, mode)[column], to = Row(plane, low + 1, mode)[column];
  return from + fraction * (to - from);
}

int ModesBelow(const Vehicle& vehicle, const StackModes& stack, double highest_rad_s) {
  int modes = 0;
  while (modes < std::min(kModes, vehicle.structure_beam->flown_modes) &&
         FliesAtAllLevels(stack, static_cast<std::size_t>(modes), highest_rad_s))
    ++modes;
  return modes;
}

BendingTable BuildBendingTable(const Vehicle& vehicle, const StackModes& stack, const LoadTable& loads,
                               int modes) {
  const Stage& stage = vehicle.stages[static_cast<std::size_t>(stack.stage)];
  BendingTable table;
  table.modes = modes;
  table.planes = stack.axisymmetric ? 1 : 2;
  for (const BendingLevel& level : stack.levels[0]) table.propellant_kg.push_back(level.propellant_kg);

  const std::optional<UpperBody> upper = UpperOf(vehicle, stack.stage);
  for (std::size_t p = 0; p < static_cast<std::size_t>(table.planes); ++p) {
    const BeamPlane plane = kBeamPlanes[p];
    const double top = stack.station_m[p].front();
    const double step = (stack.station_m[p].back() - top) / kShorteningSteps;
    std::vector<double> places;
    for (int i = 0; i < kShorteningSteps; ++i) places.push_back(top + step * (i + 0.5));
    for (const BendingLevel& level : stack.levels[p]) {
      const BeamMasses masses = BuildBeamMasses(vehicle, stack.stage, level.propellant_kg);
      const std::vector<double> ahead = MassAhead(masses, places);
      std::vector<std::vector<double>> slopes(static_cast<std::size_t>(table.modes)),
          deflections(slopes.size());
      for (std::size_t k = 0; k < slopes.size(); ++k) {
        for (const double place : places)
          slopes[k].push_back(ShapeOf(stack, plane, level.modes[k], place).slope_1_m);
        for (const LiftPiece& piece : loads.lift.pieces)
          deflections[k].push_back(ShapeOf(stack, plane, level.modes[k], piece.Middle()).deflection);
      }
      for (std::size_t k = 0; k < slopes.size(); ++k) {
        const BendingMode& mode = level.modes[k];
        const auto at = [&](double station_m) { return ShapeOf(stack, plane, mode, station_m); };
        std::array<double, BendingTable::kRowSize> row{};
        row[BendingTable::kFrequency] = mode.frequency_rad_s;
        row[BendingTable::kInverseMass] = 1.0 / mode.generalized_mass_kg;
        const StationShape pivot = at(stage.gimbal.pivot_station_m);
        row[BendingTable::kPivotDeflection] = pivot.deflection;
        row[BendingTable::kPivotSlope] = pivot.slope_1_m;
        row[BendingTable::kUnitSlope] = at(vehicle.sensors.inertial_unit_station_m).slope_1_m;
        for (std::size_t g = 0; g < vehicle.sensors.rate_gyros.size(); ++g)
          row[BendingTable::kGyroSlope + g] = at(vehicle.sensors.rate_gyros[g].station_m).slope_1_m;
        for (std::size_t j = 0; j < slopes.size(); ++j) {
          double sum = 0.0;
          for (std::size_t i = 0; i < places.size(); ++i) sum += ahead[i] * slopes[j][i] * slopes[k][i];
          row[BendingTable::kShortening + j] = sum * step;
        }
        for (std::size_t i = 0; i < loads.lift.pieces.size(); ++i) {
          const LiftPiece& piece = loads.lift.pieces[i];
          row[BendingTable::kStraightLift] += (piece.area_to - piece.area_from) * deflections[k][i];
          row[BendingTable::kStraightLift + 1] += piece.shift_1_m * deflections[k][i];
        }
        AddLift(loads, deflections, at, row.data());
        if (upper) {
          const StationShape mean = upper->MeanOf(at);
          row[BendingTable::kUpperShift] = mean.deflection;
          row[BendingTable::kUpperTurn] = mean.slope_1_m;
        }
        for (std::size_t i = 0; i < kLoadStations; ++i)
          row[BendingTable::kMomentAt + i] = InertiaMoment(masses, loads.station_m[i], at);
        table.rows.insert(table.rows.end(), row.begin(), row.end());
      }
    }
  }
  return table;
}

}  // namespace dispersa
