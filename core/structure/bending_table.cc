#include "core/structure/bending_table.h"

#include <algorithm>
#include <optional>

#include "core/structure/free_body.h"
#include "core/structure/mass_points.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

/// Pieces of the beam in which the shortening is summed.
constexpr int kShorteningPieces = 400;

bool FliesAtAllLevels(const StackModes& stack, std::size_t mode, double highest_rad_s) {
  for (const std::vector<BendingLevel>& plane : stack.levels)
    for (const BendingLevel& level : plane)
      if (mode >= level.modes.size() || level.modes[mode].frequency_rad_s >= highest_rad_s) return false;
  return true;
}

// Of even pieces of the beam, from the nose aft.
struct EvenPieces {
  double top_m = 0.0, length_m = 0.0;

  explicit EvenPieces(const std::vector<double>& stations)
      : top_m(stations.front()), length_m((stations.back() - stations.front()) / kShorteningPieces) {}
  double Middle(std::size_t i) const { return top_m + length_m * (static_cast<double>(i) + 0.5); }
};

// A place between the edges of the pieces.
struct PieceEdge {
  std::size_t before;
  double part;  // of the piece behind it
};
PieceEdge EdgeBefore(const EvenPieces& pieces, double station_m) {
  const double at =
      std::clamp((station_m - pieces.top_m) / pieces.length_m, 0.0, static_cast<double>(kShorteningPieces));
  const std::size_t before = std::min<std::size_t>(static_cast<std::size_t>(at), kShorteningPieces - 1);
  return {before, at - static_cast<double>(before)};
}

// The integral of the product of two modes' slopes (at the middles of the pieces) from a place to the end.
class SlopesBehind {
 public:
  SlopesBehind(double piece_m, const std::vector<double>& slopes, const std::vector<double>& other)
      : behind_(slopes.size() + 1, 0.0) {
    for (std::size_t i = slopes.size(); i-- > 0;)
      behind_[i] = behind_[i + 1] + slopes[i] * other[i] * piece_m;
  }
  double At(const PieceEdge& at) const {
    return behind_[at.before] + at.part * (behind_[at.before + 1] - behind_[at.before]);
  }
  // Weighted with the share of the mass ahead: each mass counts for all of the beam behind it.
  double ByMass(const std::vector<MassPoint>& points, const std::vector<PieceEdge>& edges) const {
    double sum = 0.0, mass_kg = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum += points[i].mass_kg * At(edges[i]);
      mass_kg += points[i].mass_kg;
    }
    return sum / mass_kg;
  }

 private:
  std::vector<double> behind_;  // from each edge of the pieces
};

// What the lift by a unit of a mode does. `deflections`: of each mode that flies, at the middle of each
// piece. `shapes`: of the mode, where and in the order in which LiftDistribution asks for incidences.
void AddLift(const LoadTable& loads, const std::vector<std::vector<double>>& deflections,
             const std::vector<StationShape>& shapes, double* row) {
  for (const bool by_rate : {false, true}) {
    std::size_t piece = 0, next = 0;
    const auto add = [&](double force, double station_m, LiftCause cause) {
      double* const effects = row + BendingTable::LiftColumn(cause, 0);
      double* const of_sections = row + BendingTable::LiftColumn(cause, kSectionEffects);
      effects[kForceEffect] += force;
      effects[kFirstEffect] += force * station_m;
      for (std::size_t j = 0; j < deflections.size(); ++j)
        effects[kWorkEffects + j] += force * deflections[j][piece];
      for (std::size_t i = 0; i < kLoadStations; ++i)
        of_sections[i] += force * std::max(loads.station_m[i] - station_m, 0.0);
    };
    loads.lift.ForEach(
        [&](double) {
          const StationShape& shape = shapes[next++];
          return by_rate ? shape.deflection : shape.slope_1_m;
        },
        [&](double station_m, double by_slender, double by_shift) {
          add(by_slender, station_m, by_rate ? kRateSlender : kSlopeSlender);
          add(by_shift, station_m, by_rate ? kRateShift : kSlopeShift);
          ++piece;
        });
  }
}

// The places of a stack's beam at which its modes are looked at, found once for all levels.
struct StackPlaces {
  std::vector<BeamPlace> pieces;  // middles of even ones
  std::vector<BeamPlace> lift;    // in the order in which LiftDistribution asks: the middles are each third
  std::size_t lift_pieces = 0;

  StackPlaces(const StackModes& stack, BeamPlane plane, const EvenPieces& even, const LoadTable& loads)
      : lift_pieces(loads.lift.pieces.size()) {
    for (std::size_t i = 0; i < kShorteningPieces; ++i)
      pieces.push_back(PlaceAt(stack, plane, even.Middle(i)));
    loads.lift.ForEach(
        [&](double station_m) {
          lift.push_back(PlaceAt(stack, plane, station_m));
          return 0.0;
        },
        [](double, double, double) {});
  }
  static std::size_t MiddleOf(std::size_t lift_piece) { return 2 * lift_piece + 2; }
};

std::vector<StationShape> ShapesAtPlaces(const std::vector<BeamPlace>& places, const BendingMode& mode) {
  std::vector<StationShape> shapes;
  shapes.reserve(places.size());
  for (const BeamPlace& place : places) shapes.push_back(place.Of(mode));
  return shapes;
}

// The stages above, which a separation leaves as a body of their own.
std::optional<FreeBody> UpperOf(const Vehicle& vehicle, const StackModes& stack) {
  const int above = LastBurn(vehicle, stack.stage) + 1;
  if (above == static_cast<int>(vehicle.stages.size())) return {};
  const double full_kg = vehicle.stages[static_cast<std::size_t>(above)].propellant_mass_kg;
  return FreeBody(BuildBeamMasses(vehicle, above, full_kg, stack.gone), stack.station_m[0]);
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

  const std::optional<FreeBody> upper = UpperOf(vehicle, stack);
  const bool has_boosters = CarriedBy(vehicle, stack.stage) & ~stack.gone & kBoostersGone;
  const Boosters* const boosters = has_boosters ? &vehicle.boosters : nullptr;
  for (std::size_t p = 0; p < static_cast<std::size_t>(table.planes); ++p) {
    const BeamPlane plane = kBeamPlanes[p];
    const EvenPieces pieces(stack.station_m[p]);
    const StackPlaces places(stack, plane, pieces, loads);
    std::vector<BeamPlace> at_upper;
    if (upper)
      for (const MassPoint& m : upper->points) at_upper.push_back(PlaceAt(stack, plane, m.fixed_at_m));
    std::vector<double> cuts_m = stack.station_m[p];
    cuts_m.insert(cuts_m.end(), loads.station_m.begin(), loads.station_m.end());
    for (const BendingLevel& level : stack.levels[p]) {
      const std::vector<MassPoint> points =
          MassPointsOf(BuildBeamMasses(vehicle, stack.stage, level.propellant_kg, stack.gone), cuts_m);
      std::vector<BeamPlace> at_points;
      std::vector<PieceEdge> edges;
      for (const MassPoint& m : points) {
        at_points.push_back(PlaceAt(stack, plane, m.fixed_at_m));
        edges.push_back(EdgeBefore(pieces, m.fixed_at_m));
      }
      std::vector<std::vector<double>> slopes(static_cast<std::size_t>(table.modes)),
          deflections(slopes.size());
      std::vector<std::vector<StationShape>> lifts;
      for (std::size_t k = 0; k < slopes.size(); ++k) {
        for (const BeamPlace& place : places.pieces) slopes[k].push_back(place.Of(level.modes[k]).slope_1_m);
        lifts.push_back(ShapesAtPlaces(places.lift, level.modes[k]));
        for (std::size_t i = 0; i < places.lift_pieces; ++i)
          deflections[k].push_back(lifts[k][StackPlaces::MiddleOf(i)].deflection);
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
          const SlopesBehind behind(pieces.length_m, slopes[j], slopes[k]);
          row[BendingTable::kShortening + j] = behind.ByMass(points, edges);
          if (boosters)
            row[BendingTable::kBehindBoosters + j] =
                behind.At(EdgeBefore(pieces, boosters->attachment_station_m));
        }
        if (boosters) {
          const StationShape link = at(boosters->attachment_station_m);
          row[BendingTable::kBoosterDeflection] =
              link.deflection +
              link.slope_1_m * (boosters->nozzle_station_m - boosters->attachment_station_m);
          row[BendingTable::kBoosterSlope] = link.slope_1_m;
        }
        for (std::size_t i = 0; i < loads.lift.pieces.size(); ++i) {
          const LiftPiece& piece = loads.lift.pieces[i];
          row[BendingTable::kStraightLift] += (piece.area_to - piece.area_from) * deflections[k][i];
          row[BendingTable::kStraightLift + 1] += piece.shift_1_m * deflections[k][i];
        }
        AddLift(loads, deflections, lifts[k], row.data());
        if (upper) {
          const StationShape mean =
              upper->MeanOf([&](const MassPoint&, std::size_t i) { return at_upper[i].Of(mode); });
          row[BendingTable::kUpperShift] = mean.deflection;
          row[BendingTable::kUpperTurn] = mean.slope_1_m;
        }
        const std::vector<StationShape> shapes = ShapesAtPlaces(at_points, mode);
        const auto at_point = [&](const MassPoint&, std::size_t i) { return shapes[i]; };
        for (std::size_t i = 0; i < kLoadStations && loads.station_m[i] > 0.0; ++i)
          row[BendingTable::kMomentAt + i] = InertiaMoment(points, loads.station_m[i], at_point);
        table.rows.insert(table.rows.end(), row.begin(), row.end());
      }
    }
  }
  return table;
}

}  // namespace dispersa
