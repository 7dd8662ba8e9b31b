// What `dispersa validate` says of a valid vehicle, on one screen, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/vehicle/vehicle.h"

namespace dispersa {

std::string VehicleText(const Vehicle& vehicle);
nlohmann::ordered_json VehicleJson(const Vehicle& vehicle);

}  // namespace dispersa
