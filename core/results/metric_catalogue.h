// Names and meanings of metrics for readers.
#pragma once

#include <string>

#include "core/flight/metrics.h"

namespace dispersa {

struct MetricInfo {
  std::string title;       ///< "Pitch error, peak, stage 2"
  std::string symbol;      ///< "max |e_θ|" (empty for an unknown name)
  std::string unit;        ///< "°", "km", "" for a pure number
  std::string group;       ///< "Attitude" (empty for an unknown name)
  std::string definition;  ///< one sentence (empty for an unknown name)
  std::string over;        ///< the part of a flight (empty for an unknown name)
  Worse worse = Worse::kLarger;
  bool is_part = false;  ///< of one stage or of the coast
  bool known = false;    ///< a metric of flights
  Circle circle = {};    ///< where it repeats
};

/// `name` is a metric's name without prefix. If it is no metric, only the unit at its end is known.
MetricInfo DescribeMetric(const std::string& name);
/// Where it repeats, as DescribeMetric() has it. A campaign's own metric says so by its name: it ends in
/// longitude_deg (from -180), azimuth_deg or clock_deg (from 0).
Circle CircleOf(const std::string& metric);

/// Unit of a column from the end of its name, and the name without it: "wind_max_speed_m_s" gives "m/s" and
/// "wind_max_speed".
struct NameAndUnit {
  std::string stem;
  std::string unit;
};
NameAndUnit SplitUnit(const std::string& name);

/// The value by which cases are ranked: larger is worse. A metric that is neither good nor bad is ranked as
/// it is.
double Badness(Worse worse, double value);
/// "larger", "smaller", "farther_from_zero", "neither".
const char* WorseName(Worse worse);

}  // namespace dispersa
