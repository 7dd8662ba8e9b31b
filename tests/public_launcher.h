// The public three-stage launcher of tests/data/aero, as a body for the aerodynamic build-up.
//
// The launcher's tables are Missile DATCOM's; its geometry is not published. Known are the reference diameter
// (2.032 m), the gimbal's station (16.84 m from the nose), and the masses and inertias. These put the stages'
// propellant at 4.1, 7.0 and 12.7 m, with radii of gyration of cylinders of about 1.5, 1.6 and 1.9 m. The
// profile below has these. The diameter and bluntness of its payload fairing follow from the hypersonic
// limits of the upper stages' tables. These are C_Na 1.15 and CA 0.36 on 3.243 m^2, Newtonian.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/vehicle/aerodynamics_build_up.h"

namespace dispersa {

inline constexpr double kPublicLauncherLength_m = 16.84;

inline AeroTable PublicLauncherBuildUp() {
  Vehicle vehicle;
  vehicle.surface_roughness_m = 2e-5;
  vehicle.profile = {{ProfileShape::kTangentOgive, 1.5, 1.68}, {ProfileShape::kCylinder, 2.1, 1.68},
                     {ProfileShape::kFrustum, 0.6, 1.42},      {ProfileShape::kCylinder, 4.7, 1.42},
                     {ProfileShape::kFrustum, 1.4, 2.032},     {ProfileShape::kCylinder, 6.54, 2.032}};
  Stage stage;
  stage.diameter_m = 2.032;
  stage.bottom_station_m = kPublicLauncherLength_m;
  vehicle.stages = {stage};
  return BuildAerodynamics(vehicle)[0];
}

/// Columns of one row by name.
using PublicAeroRow = std::map<std::string, double>;

/// Rows of a file of numbers in `folder`; `kind` selects by the first column where that is a name. Throws
/// when the file cannot be read.
inline std::vector<PublicAeroRow> ReadPublicAero(const std::string& folder, const std::string& name,
                                                 const std::string& kind = "") {
  std::ifstream file(folder + "/" + name);
  if (!file) throw std::runtime_error("cannot read " + folder + "/" + name);
  std::vector<std::string> columns;
  std::vector<PublicAeroRow> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (columns.empty()) {
      columns = values;
    } else if (kind.empty() || values[0] == kind) {
      PublicAeroRow row;
      for (std::size_t i = kind.empty() ? 0 : 1; i < columns.size(); ++i)
        row[columns[i]] = std::stod(values[i]);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace dispersa
