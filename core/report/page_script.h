// The script of report.html: which case is where.
#pragma once

#include <string_view>

namespace dispersa {

/// For the page's <script>, after the element of CaseData(). It draws nothing that the page does not show without it:
/// it names the case under the pointer, marks it in every chart and table, copies its replay command at a click, and
/// zooms. Charts tell it their axes by the attributes that SvgChart writes.
std::string_view PageScript();

}  // namespace dispersa
