// The style sheet and the script of pages: files of this folder, which the build embeds.
#pragma once

#include <string_view>

namespace dispersa {

/// page.css, for the <style> of every page.
std::string_view StyleSheet();

/// chart_data.js, for the <script> of every page with charts: the keyboard reaches the data of each.
std::string_view ChartScript();

/// report.js, for the report's <script>, after ChartScript() and the element of CaseData(). The page shows
/// the same content without it. The script names the case under the pointer, marks it in every chart and
/// table, copies its replay command at a click, and zooms. It reads the axes of charts from the attributes
/// that SvgChart writes.
std::string_view ReportScript();

/// coast_lines.txt: tests/tools/coast_lines.py makes it.
std::string_view CoastLineData();

/// glossary.md of the docs site.
std::string_view GlossarySource();

}  // namespace dispersa
