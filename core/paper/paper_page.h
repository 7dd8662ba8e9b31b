// The paper's tables and figures on one page, readable offline, and the data of each figure beside it.
#pragma once

#include <filesystem>
#include <string>

#include "core/paper/paper_study.h"

namespace dispersa {

/// The page. It holds no date, time of computation, path or name of a machine.
std::string PaperPage(const PaperStudy& study);

/// Writes paper.html and data/*.csv into a folder. Throws ResultError.
void WritePaper(const PaperStudy& study, const std::filesystem::path& directory);

}  // namespace dispersa
