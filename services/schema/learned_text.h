// The JSON Schemas of the input files, as they were learned when dispersa was built.
#pragma once

#include <string>

#include "core/campaign_yaml/file_kind.h"

namespace dispersa {

/// The JSON Schema of a kind of file, a line an entry.
const std::string& LearnedSchemaText(FileKind kind);

}  // namespace dispersa
