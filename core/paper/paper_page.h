// The paper's tables and figures on one page: an index of what it claims and of the reports that show it.
#pragma once

#include <string>

#include "core/paper/paper_study.h"

namespace dispersa {

/// The page, which lies beside the result folders of the study. It holds no date, time of computation, path
/// or name of a machine.
std::string PaperPage(const PaperStudy& study);

}  // namespace dispersa
