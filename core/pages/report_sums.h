// The sums of what a report consists of: whoever cuts or changes a file is found out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dispersa {

/// In the result folder, in the format of the program sha256sum.
inline constexpr char kSumsName[] = "SHA256SUMS";

/// Of cases.csv, nominal.json, summary.json, report.html and what histories/ holds.
void WriteSums(const std::filesystem::path& folder);

/// Files of the report that are not as they were written, or missing. A report.html.gz stands for its page. A
/// report of an earlier release has no sums: then its summary.json has to be whole JSON. Throws ResultError.
std::vector<std::string> ChangedReports(const std::filesystem::path& folder);

}  // namespace dispersa
