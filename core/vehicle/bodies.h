// Bodies of revolution on the axis, which make up a vehicle's mass.
//
// Stations are distances aft of the nose tip of the full vehicle.
#pragma once

#include <optional>
#include <string>

#include "core/input/fields.h"

namespace dispersa {

/// The keys of a hollow or solid tube. `bore` explains its inner diameter.
template <class Tube>
void DescribeTube(Fields& fields, Tube& tube, const char* bore, std::optional<double> absent_bore_m = {}) {
  fields.Quantity("top_station", kLength, kNonNegative, tube.top_station_m, "upper end");
  fields.Quantity("bottom_station", kLength, kPositive, tube.bottom_station_m, "lower end");
  fields.Quantity("outer_diameter", kLength, kPositive, tube.outer_diameter_m, "outside");
  fields.Quantity("inner_diameter", kLength, kNonNegative, tube.inner_diameter_m, bore, absent_bore_m);
}

/// A homogeneous hollow or solid cylinder on the axis: the building block of mass properties.
struct MassElement {
  std::string name;
  double fraction = 0.0;  ///< of the stage's dry mass
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;
};

inline void Describe(Fields& fields, MassElement& element) {
  fields.Text("name", element.name, "name of the element");
  fields.Number("fraction", UpTo(1.0), element.fraction, "part of the stage's dry mass");
  DescribeTube(fields, element, "inside", 0.0);
}

/// Solid propellant: a tube that burns from its bore outwards, so its length and station stay.
struct Grain {
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;
};

inline void Describe(Fields& fields, Grain& grain) { DescribeTube(fields, grain, "of the bore at ignition"); }

/// Liquid propellant in an upright cylinder with flat ends, round the axis. It drains at the bottom: the
/// liquid stands there, and its surface falls.
struct Tank {
  std::string name;
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double diameter_m = 0.0;
  double propellant_mass_kg = 0.0;
  double density_kg_m3 = 0.0;

  double Volume() const;  ///< m³, of the tank
};

inline void Describe(Fields& fields, Tank& tank) {
  fields.Text("name", tank.name, "name of the propellant");
  fields.Quantity("propellant_mass", kMass, kPositive, tank.propellant_mass_kg,
                  "at ignition, residual included");
  fields.Quantity("density", kDensity, kPositive, tank.density_kg_m3, "of the liquid");
  fields.Quantity("top_station", kLength, kNonNegative, tank.top_station_m, "upper end");
  fields.Quantity("bottom_station", kLength, kPositive, tank.bottom_station_m,
                  "lower end, bottom of the liquid");
  fields.Quantity("diameter", kLength, kPositive, tank.diameter_m, "inside");
}

/// Condition at which the flight computer jettisons a mass.
enum class JettisonTrigger {
  kAtTime,      ///< s since lift-off
  kAtAltitude,  ///< m, geodetic
  kAtHeatFlux,  ///< free-molecular heating has fallen to this many W/m² (see Jettison)
};

/// A mass on the axis that leaves while a stage is attached: fairing, skirt, escape tower. It is a tube,
/// released at rest against the body, without impulse and without flow about it. The rest keeps its
/// aerodynamics.
struct Jettison {
  std::string name;
  double mass_kg = 0.0;
  double top_station_m = 0.0;
  double bottom_station_m = 0.0;
  double outer_diameter_m = 0.0;
  double inner_diameter_m = 0.0;
  JettisonTrigger trigger = JettisonTrigger::kAtTime;
  double threshold = 0.0;  ///< of the trigger, in its unit
};
/// Largest number of jettisoned bodies of a vehicle.
inline constexpr int kMaxJettisons = 8;

inline void Describe(Fields& fields, Jettison& jettison) {
  fields.Text("name", jettison.name, "name of the body");
  fields.Quantity("mass", kMass, kPositive, jettison.mass_kg,
                  "in the stage's lift-off mass, not in its dry mass");
  DescribeTube(fields, jettison, "inside", 0.0);
  fields.Map("at", "when it leaves", [&](Fields& at) {
    std::size_t trigger = static_cast<std::size_t>(jettison.trigger);
    at.OneOf({{"time", kTime, kPositive, "since lift-off"},
              {"altitude", kLength, kPositive, "geodetic"},
              {"heat_flux", kHeatFlux, kPositive,
               "above 80 km, when half density times speed cubed over the rotating Earth falls to it"}},
             trigger, jettison.threshold);
    jettison.trigger = static_cast<JettisonTrigger>(trigger);
  });
}

}  // namespace dispersa
