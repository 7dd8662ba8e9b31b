// Two result folders compared.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/analysis/comparison.h"
#include "core/results/case_columns.h"

namespace dispersa {

struct FolderComparison {
  Comparison comparison;
  CaseColumns a, b;  ///< with all inputs
};

/// Every case with all its inputs.
CaseColumns AllColumns(const ResultFolder& folder);

/// `metrics`: names without prefix; empty: every metric that a flight of both defines. Errors of
/// OpenStored(), and InputError for a name that is no metric.
FolderComparison CompareFolders(const std::string& a, const std::string& b,
                                const std::vector<std::string>& metrics,
                                double practical_share = kPracticalShare);

/// compare.json and compare.html, in a folder that is made if it is missing.
void WriteComparison(const FolderComparison& compared, const std::filesystem::path& folder);

}  // namespace dispersa
