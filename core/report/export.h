// Results for other tools.
#pragma once

#include <filesystem>
#include <string>

#include "core/report/campaign_summary.h"
#include "core/report/result_folder.h"

namespace dispersa {

/// One JSON object a case and line, keys as the columns of cases.csv; an empty cell is null.
void ExportJsonLines(const ResultFolder& folder, const std::filesystem::path& file);

/// HDF5 with the groups of README.md, a dataset a column; the same results give the same bytes. ResultError.
void ExportHdf5(const ResultFolder& folder, const std::filesystem::path& file);

/// JUnit XML: a test case a requirement. Not met: a failure; not decided or incomplete: an error; a study's:
/// skipped, or a failure where a flown point violates it. Without requirements one test case for the flights.
std::string JUnitXml(const CampaignSummary& summary);

}  // namespace dispersa
