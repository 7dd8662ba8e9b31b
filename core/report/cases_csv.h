// cases.csv: one line a case, sorted by case index, the same bytes however the cases were flown.
#pragma once

#include <string>

#include "core/campaign/case_result.h"
#include "core/report/result_folder.h"

namespace dispersa {

/// Both with their line break. Doubles in the shortest text that reads back to the same bits.
std::string CasesCsvHeader();
std::string CasesCsvLine(const CaseResult& result);

/// From what is stored; replaces the file as a whole.
void WriteCasesCsv(const ResultFolder& folder);

}  // namespace dispersa
