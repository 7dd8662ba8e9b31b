// The figures of the models' pages.
#pragma once

#include <string>
#include <vector>

#include "tests/tools/figure_sheet.h"
#include "tests/tools/work_precision.h"

namespace dispersa {

/// The US Standard Atmosphere, 1976, with tabulated points; `data` is the folder tests/data.
FigureSheet AtmosphereSheet(const std::string& data);
/// Its largest deviations from each reference, as a table in Markdown.
std::string AtmosphereTable(const std::string& data);

/// Tables of the shipped vehicle beside those of a public launcher; `campaigns` is the folder of the shipped
/// campaigns.
FigureSheet AerodynamicsSheet(const std::string& campaigns, const std::string& data);

/// The build-up on the rebuilt public launcher against that launcher's own table, in Markdown.
std::string AerodynamicsTable(const std::string& data);

/// NASA's check case 17 with two sets of data, beside one of NASA's simulators.
FigureSheet TwoStageSheet(const std::string& campaigns, const std::string& data);

FigureSheet WorkPrecisionSheet(const std::vector<WorkPoint>& points);

}  // namespace dispersa
