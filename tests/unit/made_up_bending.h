// A body with bending shapes in closed form: cubics of the station, with eight masses on a line.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/dynamics/bending.h"
#include "core/modes/mode_table.h"

namespace dispersa {

inline constexpr double kBodyLength_m = 20.0, kBodyPivot_m = 19.5, kBodyUnit_m = 2.0;
inline constexpr std::array<double, kRateGyros> kBodyGyros_m = {3.0, 9.0, 15.0};

struct MadeUpMode {
  std::array<double, 4> powers{};  ///< deflection by powers of the station
  double frequency_rad_s = 10.0;
  double mass_kg = 500.0;
  std::array<double, kModes> shortening{};
  double damping = 1.0;  ///< of the ratio that BendingOf() gives

  double Deflection(double s) const { return powers[0] + s * (powers[1] + s * (powers[2] + s * powers[3])); }
  double Slope(double s) const { return powers[1] + s * (2.0 * powers[2] + s * 3.0 * powers[3]); }
};

inline constexpr std::size_t kStrips = 8;

/// The mass in the middle of each strip.
inline double BodyMass(std::size_t strip) { return 100.0 * (1.0 + static_cast<double>(strip)); }

/// Eight strips of 2.5 m. Their shares sum to 1, the shifts to 0 with a first moment of 1.
inline LoadTable MadeUpLoads() {
  constexpr double kSlender[kStrips] = {0.5, 0.1, 0.05, 0.05, 0.1, 0.1, 0.05, 0.05};
  LoadTable loads;
  double squares = 0.0, area = 0.0;
  for (std::size_t i = 0; i < kStrips; ++i) {
    LiftPiece strip;
    strip.from_m = 2.5 * static_cast<double>(i);
    strip.to_m = strip.from_m + 2.5;
    strip.area_from = area;
    strip.area_to = area += kSlender[i];
    strip.shift_1_m = strip.Middle() - 10.0;
    squares += strip.shift_1_m * strip.shift_1_m;
    loads.lift.slender_station_m += kSlender[i] * strip.Middle();
    loads.lift.pieces.push_back(strip);
  }
  for (LiftPiece& strip : loads.lift.pieces) strip.shift_1_m /= squares;
  loads.stations = kStrips - 1;
  for (std::size_t i = 0; i + 1 < kStrips; ++i) loads.station_m[i] = 2.5 * (1.0 + static_cast<double>(i));
  return loads;
}

/// The force of each strip for a normal force of 1 for each radian, where the incidence is so distributed
/// along the body, with the centre of pressure `aft_m` of slender-body theory's.
template <typename Incidence>
std::array<double, kStrips> StripForces(const LoadTable& loads, double aft_m, const Incidence& at) {
  std::array<double, kStrips> force;
  for (std::size_t i = 0; i < kStrips; ++i) {
    const LiftPiece& strip = loads.lift.pieces[i];
    // d(A alpha) of slender-body theory, and the shift's share at the incidence of its place.
    force[i] = strip.area_to * at(strip.to_m) - strip.area_from * at(strip.from_m) +
               aft_m * strip.shift_1_m * at(strip.Middle());
  }
  return force;
}

inline std::array<double, ModeTable::kRowSize> RowOf(const std::vector<MadeUpMode>& modes, std::size_t which,
                                                     const LoadTable& loads) {
  const MadeUpMode& mode = modes[which];
  std::array<double, ModeTable::kRowSize> row{};
  row[ModeTable::kFrequency] = mode.frequency_rad_s;
  row[ModeTable::kInverseMass] = 1.0 / mode.mass_kg;
  row[ModeTable::kDamping] = mode.damping;
  row[ModeTable::kPivotDeflection] = mode.Deflection(kBodyPivot_m);
  row[ModeTable::kPivotSlope] = mode.Slope(kBodyPivot_m);
  row[ModeTable::kUnitSlope] = mode.Slope(kBodyUnit_m);
  for (std::size_t i = 0; i < kRateGyros; ++i) row[ModeTable::kGyroSlope + i] = mode.Slope(kBodyGyros_m[i]);
  for (std::size_t i = 0; i < kModes; ++i) row[ModeTable::kShortening + i] = mode.shortening[i];
  const auto straight = StripForces(loads, 0.0, [](double) { return 1.0; });
  for (std::size_t i = 0; i < kStrips; ++i) {
    const LiftPiece& strip = loads.lift.pieces[i];
    row[ModeTable::kStraightLift] += straight[i] * mode.Deflection(strip.Middle());
    row[ModeTable::kStraightLift + 1] += strip.shift_1_m * mode.Deflection(strip.Middle());
  }
  for (const bool by_rate : {false, true}) {
    const auto at = [&](double s) { return by_rate ? mode.Deflection(s) : mode.Slope(s); };
    const auto slender = StripForces(loads, 0.0, at), with_shift = StripForces(loads, 1.0, at);
    for (std::size_t i = 0; i < kStrips; ++i) {
      const double place_m = loads.lift.pieces[i].Middle();
      const auto add = [&](double force, LiftCause cause) {
        double* const effects = row.data() + ModeTable::LiftColumn(cause, 0);
        effects[kForceEffect] += force;
        effects[kFirstEffect] += force * place_m;
        for (std::size_t j = 0; j < modes.size(); ++j)
          effects[kWorkEffects + j] += force * modes[j].Deflection(place_m);
        for (std::size_t k = i; k + 1 < kStrips; ++k)
          row[static_cast<std::size_t>(ModeTable::LiftColumn(cause, kSectionEffects)) + k] +=
              force * (loads.station_m[k] - place_m);
      };
      add(slender[i], by_rate ? kRateSlender : kSlopeSlender);
      add(with_shift[i] - slender[i], by_rate ? kRateShift : kSlopeShift);
    }
  }
  for (std::size_t i = 0; i + 1 < kStrips; ++i)
    for (std::size_t k = 0; k <= i; ++k) {
      const double place_m = loads.lift.pieces[k].Middle();
      row[ModeTable::kMomentAt + i] +=
          BodyMass(k) * mode.Deflection(place_m) * (loads.station_m[i] - place_m);
    }
  return row;
}

/// Of one propellant level, so that shapes do not change. `planes`: the modes of plane y, and of plane z
/// where it differs.
inline ModeTable MadeUpTable(const std::vector<std::vector<MadeUpMode>>& planes) {
  const LoadTable loads = MadeUpLoads();
  ModeTable table;
  table.modes = static_cast<int>(planes[0].size());
  table.planes = static_cast<int>(planes.size());
  table.propellant_kg = {0.0};
  for (const std::vector<MadeUpMode>& modes : planes)
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      const auto row = RowOf(modes, mode, loads);
      table.rows.insert(table.rows.end(), row.begin(), row.end());
    }
  return table;
}

/// One lane that bends as a table says.
inline lanes::StackBending<double> BendingOf(const ModeTable& table, double propellant_kg,
                                             double damping_ratio = 0.0) {
  lanes::StackBending<double> bending{};
  bending.modes = table.modes;
  bending.planes = table.planes;
  lanes::SetTable(bending, 0, &table);
  for (double& factor : bending.frequency_factor) factor = 1.0;
  bending.damping_factor = damping_ratio;
  bending.slope_factor = 1.0;
  lanes::ShapesAt(bending, propellant_kg);
  return bending;
}

/// Two different modes in each of two different planes.
inline std::vector<std::vector<MadeUpMode>> TwoPlanes() {
  return {{{{1.0, -0.3, 0.01, 0.0004}, 12.0, 400.0, {0.02, 0.005}, 1.0},
           {{-0.8, 0.25, -0.02, 0.0006}, 31.0, 250.0, {0.005, 0.07}, 1.5}},
          {{{0.9, -0.2, 0.005, 0.0007}, 14.0, 500.0, {0.03, -0.004}, 0.5},
           {{-0.5, 0.35, -0.03, 0.0005}, 37.0, 300.0, {-0.004, 0.06}, 0.75}}};
}

/// The pivots, and what drives the modes there.
inline lanes::Bent<double> BentAtPivot(const lanes::StackBending<double>& b,
                                       const lanes::BendingState<double>& s, lanes::Vector<double> force_n,
                                       lanes::Vector<double> couple_n_m) {
  return lanes::BentAt(b, s, lanes::kAtPivot, lanes::ShapesOf(b, lanes::kAtPivot), force_n, couple_n_m);
}
inline void DriveAtPivot(const lanes::StackBending<double>& b, const lanes::BendingState<double>& s,
                         lanes::Vector<double> force_n, lanes::Vector<double> couple_n_m,
                         lanes::ModalForce<double>& to) {
  lanes::DriveAt(b, s, lanes::kAtPivot, lanes::ShapesOf(b, lanes::kAtPivot), force_n, couple_n_m, to);
}

}  // namespace dispersa
