// JSON Schemas of the input files, for editors: completion, hints, and most errors while one types.
#pragma once

#include <string>

#include "core/campaign_yaml/file_kind.h"

namespace dispersa {

enum class SchemaSet {
  kWhole,  ///< one file holds everything
  kSplit,  ///< it refers to "vehicle.json" beside it, where a vehicle may stand
};
/// The schema of a kind of file in draft 07, which editors use. It refuses nothing that the reader accepts.
/// Only the reader (`dispersa validate`) knows relations between two maps and the order of numbers.
std::string SchemaText(FileKind kind, SchemaSet set);

}  // namespace dispersa
