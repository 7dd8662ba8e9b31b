// Parts of the paper's page. Each returns HTML whose numbers come from the study.
#pragma once

#include <string>

#include "core/paper/paper_study.h"

namespace dispersa {

std::string PaperHeadline(const PaperStudy& study);           ///< result of the comparison of laws
std::string PaperVehicleSection(const PaperStudy& study);     ///< Table 1
std::string PaperTrajectorySection(const PaperStudy& study);  ///< Table 2, Figs. 2 and 3
std::string PaperDispersionSection(const PaperStudy& study);  ///< Table 3
std::string PaperPnSection(const PaperStudy& study);          ///< Fig. 5
std::string PaperPitchSection(const PaperStudy& study);       ///< Figs. 6 to 9
std::string PaperRobustnessSection(const PaperStudy& study);  ///< Fig. 10
std::string PaperComparisonSection(const PaperStudy& study);  ///< the baselines
std::string PaperMarginSection(const PaperStudy& study);      ///< gain, phase and delay margins
std::string PaperLyapunovSection(const PaperStudy& study);    ///< statistics of dV/dt
std::string PaperCompletionSection(const PaperStudy& study);  ///< our additions to the vehicle

/// The claim of the paper, the result found here, and their difference with its reason (may be empty).
/// Arguments are HTML.
std::string PaperFindings(const std::string& claim, const std::string& found, const std::string& difference);

/// How a campaign was flown here, and the command that flies it as its file says.
std::string PaperSource(const PaperStudy& study, const std::vector<std::string>& names);

/// "0.0123°"
std::string Degrees(double value);

/// Statistics of a metric in degrees: median, 99 % and maximum over completed flights, and the number of lost
/// flights.
struct MetricDigest {
  std::size_t n = 0;  ///< flights, the lost among them
  std::size_t lost = 0;
  double p50 = 0.0, max = 0.0;
  std::string p99;  ///< with its unit; a bound, "≥ 0.0123°", where so few flights do not reach so far
};
MetricDigest Digested(const CaseColumns& cases, const std::string& metric);

}  // namespace dispersa
