// Motor and propellant, as a stage has them and each of its boosters.
#pragma once

#include <vector>

#include "core/input/fields.h"
#include "core/vehicle/bodies.h"
#include "core/vehicle/motor.h"

namespace dispersa {

/// The keys motor, and grain or tanks.
inline void DescribePropulsion(Fields& fields, Motor& motor, Grain& grain, std::vector<Tank>& tanks) {
  fields.Map("motor", "motor or engine", [&](Fields& map) { Describe(map, motor); });
  fields.Either({{Has("motor.liquid"),
                  [&] {
                    fields.Misplaced("grain", {}, "the motor is liquid", "tanks in place of the grain");
                    fields.List(
                        "tanks", 1, SIZE_MAX, tanks,
                        "of a liquid engine: upright cylinders about its axis; their lengths may overlap");
                  }},
                 {Else(), [&] {
                    fields.Misplaced("tanks", {}, "the motor is not liquid",
                                     "a grain in place of the tanks, or motor: {liquid: {...}}");
                    fields.Map("grain", "of a solid motor", [&](Fields& map) { Describe(map, grain); });
                  }}});
}

}  // namespace dispersa
