// Parts of a JSON Schema that stand in several places are written once, under `$defs`.
#pragma once

#include <nlohmann/json.hpp>

namespace dispersa {

/// The same schema, its repeated parts in "$defs" and named by the first key that holds them. What "$defs"
/// holds already keeps its name.
nlohmann::ordered_json WithSharedParts(nlohmann::ordered_json schema);

}  // namespace dispersa
