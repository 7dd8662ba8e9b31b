// Output of `dispersa validate` for a valid vehicle: one screen of text, or JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/vehicle/vehicle.h"

namespace dispersa {

std::string VehicleText(const Vehicle& vehicle);
nlohmann::ordered_json VehicleJson(const Vehicle& vehicle);

}  // namespace dispersa
