// The small files of a data folder. They tell when a disk, a copy or an editor has changed them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace dispersa {

/// The text of an object with "version", and a last member "checksum": the SHA-256 of the same object without
/// it, as compact JSON.
std::string Sealed(nlohmann::ordered_json object);

/// The object in such a text. A version before `first_sealed` has no checksum. Throws std::runtime_error with
/// words that follow "it ": the text is no whole JSON object, or its checksum does not fit.
nlohmann::ordered_json Unseal(const std::string& text, int first_sealed);

}  // namespace dispersa
