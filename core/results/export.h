// Results for other tools.
#pragma once

#include <filesystem>
#include <string>

#include "core/results/result_folder.h"

namespace dispersa {

/// One line for each case: a JSON object with the columns of cases.csv as keys. An empty cell is null.
void ExportJsonLines(const ResultFolder& folder, const std::filesystem::path& file);

/// HDF5 with the groups of README.md and a dataset for each column, those of the written histories too. The
/// same results give the same bytes.
/// `incomplete` is an attribute of the file, if it is not empty. Throws ResultError.
void ExportHdf5(const ResultFolder& folder, const std::filesystem::path& file,
                const std::string& incomplete = "");

}  // namespace dispersa
