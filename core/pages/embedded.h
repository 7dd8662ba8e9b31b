// The style sheet and the script of pages: files of this folder, which the build embeds.
#pragma once

#include <string_view>

namespace dispersa {

/// page.css, for the <style> of every page.
std::string_view StyleSheet();

/// report.js, for the report's <script>, after the element of CaseData(). The page shows the same content
/// without it. The script names the case under the pointer, marks it in every chart and table, copies its
/// replay command at a click, and zooms. It reads the axes of charts from the attributes that SvgChart
/// writes.
std::string_view ReportScript();

}  // namespace dispersa
