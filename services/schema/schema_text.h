// JSON Schemas of the input files, for editors: completion, hints, and most errors while one types.
#pragma once

#include <string>

#include "core/campaign_yaml/file_kind.h"

namespace dispersa {

/// The schema of a kind of file, in the draft that editors take (07). It refuses nothing that the reader
/// takes; what two maps say together and how numbers are ordered only the reader knows (`dispersa validate`).
std::string SchemaText(FileKind kind);

}  // namespace dispersa
