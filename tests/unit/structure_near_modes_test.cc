// Sums over a beam's masses as points, and modes sought among those of other masses, against twice as many
// and against the whole solution.
#include "core/structure/mass_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/campaign_yaml/load.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/structure/bending_table.h"
#include "core/structure/load_table.h"

namespace dispersa::structure_near_modes_test {
namespace {

Vehicle Flexible() { return LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml"); }

// Three sigma of a new motor at once: 3 % of dry mass, 1 % of propellant, a payload 20 kg heavier.
Vehicle Dispersed(const Vehicle& nominal) {
  FlightInputs inputs;
  inputs.dry_mass_factor = {1.03, 0.97, 1.03, 0.97, 1.0, 1.0};
  inputs.propellant_factor = {0.99, 1.01, 0.99, 1.01, 1.0, 1.0};
  inputs.payload_mass_kg = 20.0;
  inputs.payload_element = 1.0;
  return WithDispersedMasses(nominal, inputs);
}

// The largest departure of a column from another table's, against the largest value of that column.
double DepartureOf(const BendingTable& table, const BendingTable& from, int column) {
  double largest = 0.0, departure = 0.0;
  for (std::size_t level = 0; level < table.propellant_kg.size(); ++level)
    for (int mode = 0; mode < table.modes; ++mode) {
      const int at = static_cast<int>(level);
      largest = std::max(largest, std::fabs(from.Row(0, at, mode)[column]));
      departure =
          std::max(departure, std::fabs(table.Row(0, at, mode)[column] - from.Row(0, at, mode)[column]));
    }
  return largest > 0.0 ? departure / largest : departure;
}

TEST(MassPoints, AreFineEnough) {
  const Vehicle vehicle = Flexible();
  for (int stage = 0; stage < 4; ++stage) {
    const double propellant_kg = 0.6 * vehicle.stages[static_cast<std::size_t>(stage)].propellant_mass_kg;
    const StackModes stack = BuildStackModes(vehicle, stage);
    const BendingMode& mode = stack.levels[0][4].modes[2];
    const double station_m = 0.6 * vehicle.stages[static_cast<std::size_t>(stage)].bottom_station_m;
    const BeamMasses masses = BuildBeamMasses(vehicle, stage, propellant_kg);
    const auto shape = [&](double s) { return ShapeOf(stack, BeamPlane::kY, mode, s); };
    // Between two nodes each: one cell, two, sixteen.
    const auto moment = [&](int cells) {
      std::vector<double> cuts_m = {station_m};
      const std::vector<double>& nodes = stack.station_m[0];
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        for (int part = 0; part < cells; ++part)
          cuts_m.push_back(nodes[i] + (nodes[i + 1] - nodes[i]) * part / cells);
      return InertiaMoment(MassPointsOf(masses, cuts_m), station_m, AtStations(shape));
    };
    const double fine = moment(16);
    EXPECT_LT(std::fabs(moment(1) / fine - 1.0), 1e-6) << stage;
    EXPECT_LT(std::fabs(moment(2) / fine - 1.0), 1e-7) << stage;
  }
}

TEST(NearModes, AreThoseOfTheWholeSolution) {
  const Vehicle nominal = Flexible(), vehicle = Dispersed(nominal);
  for (int stage = 0; stage < 4; ++stage) {
    const StackModes near = BuildStackModes(nominal, stage);
    const StackModes sought = BuildStackModes(vehicle, stage, 0, &near),
                     whole = BuildStackModes(vehicle, stage);
    const LoadTable loads = BuildLoadTable(vehicle, stage);
    const BendingTable a = BuildBendingTable(vehicle, sought, loads, 3),
                       b = BuildBendingTable(vehicle, whole, loads, 3);
    const BendingTable of_nominal = BuildBendingTable(nominal, near, loads, 3);
    const struct {
      int column;
      double bound;
    } columns[] = {{BendingTable::kFrequency, 1e-6},
                   {BendingTable::kInverseMass, 5e-4},
                   {BendingTable::kPivotDeflection, 5e-4},
                   {BendingTable::kUnitSlope, 5e-4},
                   {BendingTable::kMomentAt + 3, 1e-4}};
    for (const auto& each : columns) {
      const double departure = DepartureOf(a, b, each.column);
      RecordProperty("stage_" + std::to_string(stage) + "_column_" + std::to_string(each.column),
                     std::to_string(departure));
      EXPECT_LT(departure, each.bound) << "stage " << stage << ", column " << each.column;
      // It is the dispersion that is followed, not the nominal modes that are taken.
      EXPECT_LT(departure, 0.05 * DepartureOf(of_nominal, b, each.column)) << stage << " " << each.column;
    }
  }
}

}  // namespace
}  // namespace dispersa::structure_near_modes_test
