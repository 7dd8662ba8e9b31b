// What browsers read besides HTML: files of this folder, which the build embeds.
#pragma once

#include <string_view>

namespace dispersa {

/// page.css, for the <style> of every page.
std::string_view StyleSheet();

/// report.js, for the report's <script>, after the element of CaseData(). It draws nothing that the page does
/// not show without it: it names the case under the pointer, marks it in every chart and table, copies its
/// replay command at a click, and zooms. Charts tell it their axes by the attributes that SvgChart writes.
std::string_view ReportScript();

}  // namespace dispersa
