#include "core/modes/beam_table.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "core/math/functions.h"
#include "core/modes/bending_places.h"
#include "core/structure/free_body.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

bool FliesAtAllLevels(const StackModes& stack, std::size_t mode, double highest_rad_s) {
  for (const std::vector<BendingLevel>& plane : stack.levels)
    for (const BendingLevel& level : plane)
      if (mode >= level.modes.size() || level.modes[mode].frequency_rad_s >= highest_rad_s) return false;
  return true;
}

using FourColumns = std::array<FourShapes, ModeTable::kRowSize>;

// The values of a level's first modes at the nodes, side by side.
ShapeColumns SideBySide(const BendingLevel& level, std::size_t modes) {
  const std::size_t nodes = level.modes[0].deflection.size();
  ShapeColumns columns(kNodeRows * nodes, (modes + 3) / 4);
  std::fill_n(columns.Four(0), columns.rows * columns.fours, FourShapes(0.0));
  for (std::size_t k = 0; k < modes; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) {
      FourShapes* const at = columns.Four(k / 4) + kNodeRows * i;
      Values(at)[k % 4] = level.modes[k].deflection[i];
      Values(at + 1)[k % 4] = level.modes[k].slope_1_m[i];
      Values(at + 2)[k % 4] = level.modes[k].bow[i];
    }
  }
  return columns;
}

// The integrals of the products of one mode's slopes with those of four (at the middles of the pieces) from a
// place to the end.
class SlopesBehind {
 public:
  // `one`: lane of the first value.
  SlopesBehind(double piece_m, const double* one, const FourShapes* four)
      : behind_(std::make_unique_for_overwrite<FourShapes[]>(kShorteningPieces + 1)) {
    behind_[kShorteningPieces] = 0.0;
    for (std::size_t i = kShorteningPieces; i-- > 0;)
      behind_[i] = behind_[i + 1] + FourShapes(one[4 * i]) * four[i] * FourShapes(piece_m);
  }
  FourShapes At(const PieceEdge& at) const {
    return behind_[at.before] + FourShapes(at.part) * (behind_[at.before + 1] - behind_[at.before]);
  }
  // Weighted with the share of the mass ahead: each mass counts for all of the beam behind it.
  FourShapes ByMass(const std::vector<MassPoint>& points, const std::vector<const MassPlace*>& places) const {
    FourShapes sum = 0.0;
    double mass_kg = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum = sum + FourShapes(points[i].mass_kg) * At(places[i]->edge);
      mass_kg += points[i].mass_kg;
    }
    return sum / FourShapes(mass_kg);
  }

 private:
  std::unique_ptr<FourShapes[]> behind_;  // from each edge of the pieces
};

// Four modes where the lift is summed.
struct LiftShapes {
  std::unique_ptr<FourStations[]> at;  // in the order in which LiftDistribution asks for incidences
  std::unique_ptr<std::array<FourShapes, kLiftCauses>[]> force;  // by piece

  LiftShapes(const LoadTable& loads, const PlanePlaces& places, const FourShapes* modes)
      : at(std::make_unique_for_overwrite<FourStations[]>(places.lift().size())),
        force(
            std::make_unique_for_overwrite<std::array<FourShapes, kLiftCauses>[]>(loads.lift.pieces.size())) {
    for (std::size_t i = 0; i < places.lift().size(); ++i) at[i] = FourAt(places.lift()[i], modes);
    for (const bool by_rate : {false, true}) {
      std::size_t piece = 0, next = 0;
      loads.lift.ForEach(
          [&](double) {
            const FourStations& shape = at[next++];
            return by_rate ? shape.deflection : shape.slope_1_m;
          },
          [&](double, FourShapes by_slender, FourShapes by_shift) {
            force[piece][by_rate ? kRateSlender : kSlopeSlender] = by_slender;
            force[piece][by_rate ? kRateShift : kSlopeShift] = by_shift;
            ++piece;
          });
    }
  }
  // Of a mode of these by its lane, at the middle of a piece.
  double Deflection(std::size_t piece, std::size_t lane) const {
    return Values(&at[PlanePlaces::MiddleOf(piece)].deflection)[lane];
  }
};

// What the lift by a unit of each of `four` modes does. `all`: those of all modes that fly.
void AddLift(const LoadTable& loads, const LiftShapes& four, const std::vector<LiftShapes>& all,
             std::size_t modes, FourColumns& columns) {
  const std::vector<LiftPiece>& pieces = loads.lift.pieces;
  // The sums over the first pieces of the forces times a factor.
  const auto add = [&](int effect, std::size_t piece_count, const auto& factor_of) {
    std::array<FourShapes, kLiftCauses> sum = {0.0, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < piece_count; ++i) {
      const FourShapes factor = factor_of(i);
      for (std::size_t cause = 0; cause < kLiftCauses; ++cause)
        sum[cause] = sum[cause] + four.force[i][cause] * factor;
    }
    for (int cause = 0; cause < kLiftCauses; ++cause)
      columns[static_cast<std::size_t>(ModeTable::LiftColumn(cause, effect))] =
          sum[static_cast<std::size_t>(cause)];
  };
  add(kForceEffect, pieces.size(), [](std::size_t) { return 1.0; });
  add(kFirstEffect, pieces.size(), [&](std::size_t i) { return pieces[i].Middle(); });
  for (std::size_t j = 0; j < modes; ++j)
    add(kWorkEffects + static_cast<int>(j), pieces.size(),
        [&](std::size_t i) { return all[j / 4].Deflection(i, j % 4); });
  for (std::size_t s = 0; s < static_cast<std::size_t>(loads.stations); ++s) {
    const auto behind = std::partition_point(pieces.begin(), pieces.end(), [&](const LiftPiece& piece) {
      return piece.Middle() < loads.station_m[s];
    });
    add(kSectionEffects + static_cast<int>(s), static_cast<std::size_t>(behind - pieces.begin()),
        [&](std::size_t i) { return loads.station_m[s] - pieces[i].Middle(); });
  }
}

// The stages above, which a separation leaves as a body of their own.
std::optional<FreeBody> UpperOf(const Vehicle& vehicle, const StackModes& stack) {
  const int above = LastBurn(vehicle, stack.stage) + 1;
  if (above == static_cast<int>(vehicle.stages.size())) return {};
  const double full_kg = vehicle.stages[static_cast<std::size_t>(above)].propellant_mass_kg;
  return FreeBody(BuildBeamMasses(vehicle, above, full_kg, stack.gone), stack.station_m[0]);
}

}  // namespace

int ModesBelow(const Vehicle& vehicle, const StackModes& stack, double highest_rad_s) {
  int modes = 0;
  while (modes < std::min(kModes, vehicle.structure_beam->flown_modes) &&
         FliesAtAllLevels(stack, static_cast<std::size_t>(modes), highest_rad_s))
    ++modes;
  return modes;
}

namespace {

// The parts of a plane at which its modes are read, the same at every level of propellant.
struct PlaneParts {
  const PlanePlaces& places;
  const Boosters* boosters;  // null: it carries none
  const FreeBody* upper;     // null: nothing is above
  double damping_ratio;
  BeamPlace pivot, unit, link;  // link: the boosters'
  std::vector<BeamPlace> gyros;
  std::deque<MassPlace> found;  // that `places` did not know
  std::vector<const MassPlace*> at_upper;
};
PlaneParts PartsOf(const Vehicle& vehicle, const StackModes& stack, std::size_t plane,
                   const PlanePlaces& places, const FreeBody* upper) {
  const auto place_at = [&](double station_m) { return PlaceAt(stack, kBeamPlanes[plane], station_m); };
  const bool has_boosters = CarriedBy(vehicle, stack.stage) & ~stack.gone & kBoostersGone;
  const Stage& stage = vehicle.stages[static_cast<std::size_t>(stack.stage)];
  PlaneParts parts{places,
                   has_boosters ? &vehicle.boosters : nullptr,
                   upper,
                   vehicle.structure_beam->damping_ratio,
                   place_at(stage.gimbal.pivot_station_m),
                   place_at(vehicle.sensors.inertial_unit_station_m),
                   {},
                   {},
                   {},
                   {}};
  for (const RateGyro& gyro : vehicle.sensors.rate_gyros) parts.gyros.push_back(place_at(gyro.station_m));
  if (has_boosters) parts.link = place_at(vehicle.boosters.attachment_station_m);
  if (upper) parts.at_upper = places.Of(upper->points, stack, parts.found);
  return parts;
}

// The masses of a level, and its modes where they are read, four side by side.
struct LevelShapes {
  std::vector<MassPoint> points;
  std::vector<const MassPlace*> at_points;
  ShapeColumns shapes;
  std::vector<std::unique_ptr<FourShapes[]>> slopes;  // at the middles of the pieces
  std::vector<LiftShapes> lifts;
};
LevelShapes ShapesOf(const Vehicle& vehicle, const StackModes& stack, const LoadTable& loads,
                     const BendingLevel& level, std::size_t count, PlaneParts& parts) {
  const PlanePlaces& places = parts.places;
  std::vector<MassPoint> points =
      MassPointsOf(BuildBeamMasses(vehicle, stack.stage, level.propellant_kg, stack.gone), places.cuts_m());
  std::vector<const MassPlace*> at_points = places.Of(points, stack, parts.found);
  LevelShapes of{std::move(points), std::move(at_points), SideBySide(level, count), {}, {}};
  for (std::size_t four = 0; four < of.shapes.fours; ++four) {
    of.slopes.push_back(std::make_unique_for_overwrite<FourShapes[]>(kShorteningPieces));
    for (std::size_t i = 0; i < kShorteningPieces; ++i)
      of.slopes[four][i] = FourAt(places.pieces()[i], of.shapes.Four(four)).slope_1_m;
    of.lifts.emplace_back(loads, places, of.shapes.Four(four));
  }
  return of;
}

void SetStations(const PlaneParts& parts, const FourShapes* modes, FourColumns& columns) {
  columns[ModeTable::kDamping] = parts.damping_ratio;
  const FourStations at_pivot = FourAt(parts.pivot, modes);
  columns[ModeTable::kPivotDeflection] = at_pivot.deflection;
  columns[ModeTable::kPivotSlope] = at_pivot.slope_1_m;
  columns[ModeTable::kUnitSlope] = FourAt(parts.unit, modes).slope_1_m;
  for (std::size_t g = 0; g < parts.gyros.size(); ++g)
    columns[ModeTable::kGyroSlope + g] = FourAt(parts.gyros[g], modes).slope_1_m;
}

// By each of all modes, with these four.
void SetShortening(const PlaneParts& parts, const LevelShapes& level, std::size_t four, std::size_t count,
                   FourColumns& columns) {
  for (std::size_t j = 0; j < count; ++j) {
    const SlopesBehind behind(parts.places.piece_m(), Values(level.slopes[j / 4].get()) + j % 4,
                              level.slopes[four].get());
    columns[ModeTable::kShortening + j] = behind.ByMass(level.points, level.at_points);
    if (parts.boosters)
      columns[ModeTable::kBehindBoosters + j] =
          behind.At(parts.places.EdgeBefore(parts.boosters->attachment_station_m));
  }
}

// The nozzles of boosters, on a rigid link.
void SetBoosters(const PlaneParts& parts, const FourShapes* modes, FourColumns& columns) {
  const FourStations at_link = FourAt(parts.link, modes);
  const double behind_m = parts.boosters->nozzle_station_m - parts.boosters->attachment_station_m;
  columns[ModeTable::kBoosterDeflection] = at_link.deflection + at_link.slope_1_m * behind_m;
  columns[ModeTable::kBoosterSlope] = at_link.slope_1_m;
}

// The work of the straight body's lift.
void AddStraightLift(const LoadTable& loads, const LiftShapes& four, FourColumns& columns) {
  for (std::size_t i = 0; i < loads.lift.pieces.size(); ++i) {
    const LiftPiece& piece = loads.lift.pieces[i];
    const FourShapes deflection = four.at[PlanePlaces::MiddleOf(i)].deflection;
    FourShapes* const lift = &columns[ModeTable::kStraightLift];
    lift[0] = lift[0] + (piece.area_to - piece.area_from) * deflection;
    lift[1] = lift[1] + piece.shift_1_m * deflection;
  }
}

// The mean motion of the stages above.
void SetUpper(const PlaneParts& parts, const FourShapes* modes, FourColumns& columns) {
  const FourStations mean = parts.upper->MeanOf(
      [&](const MassPoint&, std::size_t i) { return FourAt(parts.at_upper[i]->place, modes); });
  columns[ModeTable::kUpperShift] = mean.deflection;
  columns[ModeTable::kUpperTurn] = mean.slope_1_m;
}

// Bending moments by the inertia of the modes.
void SetMoments(const LoadTable& loads, const LevelShapes& level, const FourShapes* modes,
                FourColumns& columns) {
  const std::size_t points = level.points.size();
  const auto of_points = std::make_unique_for_overwrite<FourStations[]>(points);
  for (std::size_t i = 0; i < points; ++i) of_points[i] = FourAt(level.at_points[i]->place, modes);
  const auto at_point = [&](const MassPoint&, std::size_t i) { return of_points[i]; };
  for (std::size_t i = 0; i < static_cast<std::size_t>(loads.stations); ++i)
    columns[ModeTable::kMomentAt + i] = InertiaMoment(level.points, loads.station_m[i], at_point);
}

// The rows of these four modes, or of those of them that fly.
void AppendRows(const BendingLevel& level, std::size_t four, std::size_t count, const FourColumns& columns,
                ModeTable& table) {
  for (std::size_t mode = 4 * four; mode < std::min(count, 4 * four + 4); ++mode) {
    const std::size_t row = table.rows.size();
    const double* const lane = Values(columns.data()) + mode % 4;
    for (std::size_t column = 0; column < columns.size(); ++column) table.rows.push_back(lane[4 * column]);
    table.rows[row + ModeTable::kFrequency] = level.modes[mode].frequency_rad_s;
    table.rows[row + ModeTable::kInverseMass] = 1.0 / level.modes[mode].generalized_mass_kg;
  }
}

// Of the modes whose rows begin at `row`.
void SetResidual(const BendingLevel& level, const PlaneParts& parts, std::size_t row, std::size_t count,
                 ModeTable& table) {
  if (level.by_pivot_load[0].deflection.empty()) return;
  const StationShape by_force = parts.pivot.Of(level.by_pivot_load[0]),
                     by_couple = parts.pivot.Of(level.by_pivot_load[1]);
  double residual[3] = {by_force.deflection, by_force.slope_1_m, by_couple.slope_1_m};
  for (std::size_t mode = 0; mode < count; ++mode) {
    const double* const of = table.rows.data() + row + ModeTable::kRowSize * mode;
    const double deflection = of[ModeTable::kPivotDeflection], slope = of[ModeTable::kPivotSlope];
    const double softness = of[ModeTable::kInverseMass] / Square(of[ModeTable::kFrequency]);
    residual[0] -= softness * deflection * deflection;
    residual[1] -= softness * deflection * slope;
    residual[2] -= softness * slope * slope;
  }
  for (std::size_t i = 0; i < 3; ++i) table.rows[row + ModeTable::kResidual + i] = residual[i];
}

void AppendLevel(const LoadTable& loads, const BendingLevel& level, const PlaneParts& parts,
                 const LevelShapes& of, std::size_t count, ModeTable& table) {
  const std::size_t row = table.rows.size();
  for (std::size_t four = 0; four < of.shapes.fours; ++four) {
    const FourShapes* const modes = of.shapes.Four(four);
    FourColumns columns;
    columns.fill(0.0);
    SetStations(parts, modes, columns);
    SetShortening(parts, of, four, count, columns);
    if (parts.boosters) SetBoosters(parts, modes, columns);
    AddStraightLift(loads, of.lifts[four], columns);
    AddLift(loads, of.lifts[four], of.lifts, count, columns);
    if (parts.upper) SetUpper(parts, modes, columns);
    SetMoments(loads, of, modes, columns);
    AppendRows(level, four, count, columns, table);
  }
  SetResidual(level, parts, row, count, table);
}

}  // namespace

BeamTable BuildBeamTable(const Vehicle& vehicle, const StackModes& stack, const LoadTable& loads, int modes,
                         const BeamTable* near) {
  BeamTable table;
  table.modes = modes;
  table.planes = stack.axisymmetric ? 1 : 2;
  for (const BendingLevel& level : stack.levels[0]) table.propellant_kg.push_back(level.propellant_kg);
  if (modes == 0) return table;
  if (near && near->places && near->places->AreOf(stack))
    table.places = near->places;
  else
    table.places = std::make_shared<const BendingPlaces>(stack, loads);

  const std::optional<FreeBody> upper = UpperOf(vehicle, stack);
  const std::size_t count = static_cast<std::size_t>(modes);
  for (std::size_t p = 0; p < static_cast<std::size_t>(table.planes); ++p) {
    PlaneParts parts = PartsOf(vehicle, stack, p, table.places->Of(p), upper ? &*upper : nullptr);
    table.rows.reserve(table.planes * stack.levels[p].size() * count * ModeTable::kRowSize);
    for (const BendingLevel& level : stack.levels[p])
      AppendLevel(loads, level, parts, ShapesOf(vehicle, stack, loads, level, count, parts), count, table);
  }
  return table;
}

}  // namespace dispersa
