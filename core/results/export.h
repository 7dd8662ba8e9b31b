// Results for other tools.
#pragma once

#include <filesystem>
#include <string>

#include "core/results/result_folder.h"

namespace dispersa {

/// One JSON object a case and line, keys as the columns of cases.csv; an empty cell is null.
void ExportJsonLines(const ResultFolder& folder, const std::filesystem::path& file);

/// HDF5 with the groups of README.md, a dataset a column; the same results give the same bytes. ResultError.
void ExportHdf5(const ResultFolder& folder, const std::filesystem::path& file);

}  // namespace dispersa
