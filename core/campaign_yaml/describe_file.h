// The keys of a whole file, for those that have none: schemas and tables of keys.
#pragma once

#include "core/campaign_yaml/file_kind.h"
#include "core/input/fields.h"

namespace dispersa {

void DescribeFile(FileKind kind, Fields& fields);

}  // namespace dispersa
