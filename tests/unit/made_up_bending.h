// A body that bends in shapes known in closed form: cubics of the station, with eight masses on a line.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/dynamics/bending.h"
#include "core/structure/bending_table.h"

namespace dispersa {

inline constexpr double kBodyLength_m = 20.0, kBodyPivot_m = 19.5, kBodyUnit_m = 2.0;
inline constexpr std::array<double, kRateGyros> kBodyGyros_m = {3.0, 9.0, 15.0};

struct MadeUpMode {
  std::array<double, 4> powers{};  ///< deflection by powers of the station
  double frequency_rad_s = 10.0;
  double mass_kg = 500.0;
  std::array<double, kModes> shortening{};

  double Deflection(double s) const { return powers[0] + s * (powers[1] + s * (powers[2] + s * powers[3])); }
  double Slope(double s) const { return powers[1] + s * (2.0 * powers[2] + s * 3.0 * powers[3]); }
};

/// The mass in the middle of each strip.
inline double BodyMass(std::size_t strip) { return 100.0 * (1.0 + static_cast<double>(strip)); }

/// Eight strips of 2.5 m. Their shares sum to 1, the shifts to 0 with a first moment of 1.
inline LoadTable MadeUpLoads() {
  LoadTable loads;
  loads.slender = {0.5, 0.1, 0.05, 0.05, 0.1, 0.1, 0.05, 0.05};
  double squares = 0.0;
  for (std::size_t i = 0; i < kStrips; ++i) {
    loads.strip_station_m[i] = 1.25 + 2.5 * static_cast<double>(i);
    const double arm = loads.strip_station_m[i] - 10.0;
    loads.shift_1_m[i] = arm;
    squares += arm * arm;
    loads.slender_station_m += loads.slender[i] * loads.strip_station_m[i];
  }
  for (double& shift : loads.shift_1_m) shift /= squares;
  for (std::size_t i = 0; i < kLoadStations; ++i) loads.station_m[i] = 2.5 * (1.0 + static_cast<double>(i));
  return loads;
}

inline std::array<double, BendingTable::kRowSize> RowOf(const MadeUpMode& mode, const LoadTable& loads) {
  std::array<double, BendingTable::kRowSize> row{};
  row[BendingTable::kFrequency] = mode.frequency_rad_s;
  row[BendingTable::kInverseMass] = 1.0 / mode.mass_kg;
  row[BendingTable::kPivotDeflection] = mode.Deflection(kBodyPivot_m);
  row[BendingTable::kPivotSlope] = mode.Slope(kBodyPivot_m);
  row[BendingTable::kUnitSlope] = mode.Slope(kBodyUnit_m);
  for (std::size_t i = 0; i < kRateGyros; ++i)
    row[BendingTable::kGyroSlope + i] = mode.Slope(kBodyGyros_m[i]);
  for (std::size_t i = 0; i < kModes; ++i) row[BendingTable::kShortening + i] = mode.shortening[i];
  for (std::size_t i = 0; i < kStrips; ++i) {
    row[BendingTable::kStripsAt + i] = mode.Deflection(loads.strip_station_m[i]);
    row[BendingTable::kStripsAt + kStrips + i] = mode.Slope(loads.strip_station_m[i]);
  }
  for (std::size_t i = 0; i < kLoadStations; ++i)
    for (std::size_t k = 0; k <= i; ++k)
      row[BendingTable::kMomentAt + i] += BodyMass(k) * mode.Deflection(loads.strip_station_m[k]) *
                                          (loads.station_m[i] - loads.strip_station_m[k]);
  return row;
}

/// Of one propellant level, so that shapes do not change. `planes`: the modes of plane y, and of plane z
/// where it differs.
inline BendingTable MadeUpTable(const std::vector<std::vector<MadeUpMode>>& planes) {
  const LoadTable loads = MadeUpLoads();
  BendingTable table;
  table.modes = static_cast<int>(planes[0].size());
  table.planes = static_cast<int>(planes.size());
  table.propellant_kg = {0.0};
  for (const std::vector<MadeUpMode>& modes : planes)
    for (const MadeUpMode& mode : modes) {
      const auto row = RowOf(mode, loads);
      table.rows.insert(table.rows.end(), row.begin(), row.end());
    }
  return table;
}

/// One lane that bends as a table says.
inline lanes::BendingTableLanes<double> BendingOf(const BendingTable& table, double propellant_kg,
                                                  double damping_ratio = 0.0) {
  lanes::BendingTableLanes<double> bending{};
  bending.modes = table.modes;
  bending.planes = table.planes;
  bending.table[0] = &table;
  for (double& factor : bending.frequency_factor) factor = 1.0;
  bending.damping_ratio = damping_ratio;
  bending.slope_factor = 1.0;
  lanes::ShapesAt(bending, propellant_kg);
  return bending;
}

/// Two different modes in each of two different planes.
inline std::vector<std::vector<MadeUpMode>> TwoPlanes() {
  return {{{{1.0, -0.3, 0.01, 0.0004}, 12.0, 400.0, {0.02, 0.005}},
           {{-0.8, 0.25, -0.02, 0.0006}, 31.0, 250.0, {0.005, 0.07}}},
          {{{0.9, -0.2, 0.005, 0.0007}, 14.0, 500.0, {0.03, -0.004}},
           {{-0.5, 0.35, -0.03, 0.0005}, 37.0, 300.0, {-0.004, 0.06}}}};
}

}  // namespace dispersa
