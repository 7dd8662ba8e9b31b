// Tables of the masses that the tubes of a stage have.
#pragma once

#include <memory>

#include "core/vehicle/mass.h"

namespace dispersa {

/// The stage alone, in rows at equal steps of propellant.
inline MassTable TableOfTubes(const Vehicle& vehicle, std::size_t stage, int rows) {
  Vehicle alone = vehicle;
  alone.boosters = {};
  alone.stages = {vehicle.stages[stage]};
  Stage& own = alone.stages[0];
  own.jettisoned.clear();
  own.flown_mass = {};
  own.liftoff_mass_kg = DryMass(vehicle, static_cast<int>(stage)) + own.propellant_mass_kg;
  const StackMass mass = BuildStackMasses(alone)[0];
  MassTable table;
  for (int i = 0; i < rows; ++i) {
    const double left_kg = own.propellant_mass_kg * i / (rows - 1);
    const MassProperties at = mass.At(left_kg);
    table.propellant_kg.push_back(left_kg);
    table.cg_station_m.push_back(at.cg_station_m);
    table.axial_inertia_kg_m2.push_back(at.axial_inertia_kg_m2);
    table.transverse_inertia_kg_m2.push_back(at.transverse_inertia_kg_m2);
  }
  return table;
}

inline void TabulateMasses(Vehicle& vehicle, std::size_t stage, int rows) {
  Stage& own = vehicle.stages[stage];
  own.mass_table = TableOfTubes(vehicle, stage, rows);
  own.flown_mass.rows = std::make_shared<const MassRows>(
      BuildMassRows(own.mass_table, DryMass(vehicle, static_cast<int>(stage))));
}

}  // namespace dispersa
