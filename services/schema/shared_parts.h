// Writes equal parts of a JSON Schema once, under `$defs`.
#pragma once

#include <nlohmann/json.hpp>

namespace dispersa {

/// The same schema with its repeated parts in "$defs", each named by the first key that holds it. Parts that
/// are in "$defs" already keep their names.
nlohmann::ordered_json WithSharedParts(nlohmann::ordered_json schema);

}  // namespace dispersa
