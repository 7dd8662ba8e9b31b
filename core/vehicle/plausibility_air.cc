// Plausibility of aerodynamic tables.
#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/plausibility_checks.h"

namespace dispersa::plausibility {
namespace {

// The value of a table, at an incidence that it has, over Mach number: the one farthest from a value.
double Farthest(const AeroTable& table, const std::vector<double>& values, std::size_t incidence,
                double from) {
  double farthest = from;
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const double value = values[m * table.incidence_rad.size() + incidence];
    if (std::fabs(value - from) > std::fabs(farthest - from)) farthest = value;
  }
  return farthest;
}
// The slope of the normal force from 0 to the first incidence of the table, or to 2 degrees if that is
// nearer.
double NormalSlope(const AeroTable& table, bool of_largest) {
  if (table.incidence_rad.size() < 2 || table.incidence_rad[0] != 0.0) return kNothing;
  double found = kNothing;
  for (std::size_t m = 0; m < table.mach.size(); ++m) {
    const double* row = table.cn.data() + m * table.incidence_rad.size();
    const double slope = (row[1] - row[0]) / table.incidence_rad[1];
    if (std::isnan(found) || (of_largest ? slope > found : slope < found)) found = slope;
  }
  return found;
}

// For incidences up to 10 degrees. Beyond, and tail first, the axial force may pull a body forwards.
double LeastAxial(const AeroTable& table) {
  constexpr double kSmall_rad = 10.0 * kRadPerDeg;
  double least = kAny;
  for (std::size_t i = 0; i < table.incidence_rad.size(); ++i) {
    if (i > 0 && table.incidence_rad[i] > kSmall_rad) break;
    for (std::size_t m = 0; m < table.mach.size(); ++m)
      least = std::min(least, table.ca[m * table.incidence_rad.size() + i]);
  }
  return least;
}

// Of ca with the motor out over that with power, at the smallest incidence.
double PowerOffExcess(const AeroTable& table, bool of_largest) {
  double found = kNothing;
  for (std::size_t m = 0; m < table.mach.size() && !table.ca_power_off.empty(); ++m) {
    const double excess = table.ca_power_off[table.RowOf(m, 0)] - table.ca[table.RowOf(m, 0)];
    if (std::isnan(found) || (of_largest ? excess > found : excess < found)) found = excess;
  }
  return found;
}

double LeastOfTable(const std::vector<double>& values) {
  return values.empty() ? kNothing : *std::min_element(values.begin(), values.end());
}
double GreatestOfTable(const std::vector<double>& values) {
  return values.empty() ? kNothing : *std::max_element(values.begin(), values.end());
}

// Checks of the aerodynamic table of each stack.
constexpr Check kAeroChecks[] = {
    {"reference_area_m2", "is the cross-section of the stack's lowest stage times", "", Usual(0.3, 4.0),
     "the usual reference is the cross-section",
     [](const Subject& s) {
       return s.table().reference_area_m2 / (0.25 * kPi * Square(s.stage().diameter_m));
     }},
    {"reference_length_m", "is the diameter of the stack's lowest stage times", "", Usual(0.5, 2.0),
     "the usual reference is the diameter; with the length dampings are many times as large",
     [](const Subject& s) { return s.table().reference_length_m / s.stage().diameter_m; }},
    {"table.mach", "begin at", "", Usual(0.0, 0.9),
     "a launcher is at rest before it flies; below the first one its values hold",
     [](const Subject& s) { return s.index == 0 ? s.table().mach.front() : kNothing; }},
    {"table.mach", "end at", "", Usual(2.0, 50.0),
     "a first stage burns out at Mach 4 to 10, an orbit is at 25; above the last one its values hold",
     [](const Subject& s) { return s.table().mach.back(); }},
    {"table.incidence_deg", "ends at", "deg", Usual(5.0, 180.0),
     "dispersed flights meet 5 to 10 deg; a range to 3.14 may be in radians",
     [](const Subject& s) { return s.table().incidence_rad.back() * kDegPerRad; }},
    {"table.ca", "is at least", "", Usual(0.02, kAny).Possible(0.0, kAny),
     "the air resists; skin friction alone gives 0.05 to 0.1",
     [](const Subject& s) { return LeastAxial(s.table()); }},
    {"table.ca", "is at most, at the smallest incidence,", "", Usual(0.0, 2.0).Possible(0.0, 20.0),
     "0.2 to 1.2 of launchers, about 1.5 of a blunt face",
     [](const Subject& s) { return Farthest(s.table(), s.table().ca, 0, 0.0); }},
    {"table.ca_power_off", "exceeds ca, at the smallest incidence, by at least", "",
     Usual(-0.01, 0.5).Possible(-2.0, 2.0),
     "without a jet the base is sucked at: 0.05 to 0.25 of its share of the cross-section",
     [](const Subject& s) { return PowerOffExcess(s.table(), false); }},
    {"table.ca_power_off", "exceeds ca, at the smallest incidence, by at most", "",
     Usual(-0.01, 0.5).Possible(-2.0, 2.0),
     "without a jet the base is sucked at: 0.05 to 0.25 of its share of the cross-section",
     [](const Subject& s) { return PowerOffExcess(s.table(), true); }},
    {"table.ca_uncertainty", "is, as one standard deviation, at most", "", Usual(0.0, 0.5),
     "5 to 10 % of wind tunnels; a part may stand under percent",
     [](const Subject& s) { return GreatestOfTable(s.table().uncertainty.ca); }},
    {"table.cn_uncertainty", "is, as one standard deviation, at most", "", Usual(0.0, 0.5),
     "5 to 10 % of wind tunnels", [](const Subject& s) { return GreatestOfTable(s.table().uncertainty.cn); }},
    {"table.xcp_uncertainty_m", "is, as one standard deviation and part of the stack's length, at most", "",
     Usual(0.0, 0.1), "0.1 to 1 diameter",
     [](const Subject& s) {
       return GreatestOfTable(s.table().uncertainty.xcp_m) / s.stage().bottom_station_m;
     }},
    {"table.cn", "is at an incidence of 0", "", Usual(-0.001, 0.001).Possible(-0.05, 0.05),
     "a body of revolution has no normal force there: incidence is the total angle between axis and flow",
     [](const Subject& s) {
       return s.table().incidence_rad[0] == 0.0 ? Farthest(s.table(), s.table().cn, 0, 0.0) : kNothing;
     }},
    {"table.cn", "rises from an incidence of 0 by at least", "a radian", Usual(0.5, kAny).Possible(0.0, kAny),
     "2 by slender-body theory", [](const Subject& s) { return NormalSlope(s.table(), false); }},
    {"table.cn", "rises from an incidence of 0 by at most", "a radian", Usual(0.0, 40.0).Possible(0.0, 500.0),
     "2 to 4 of bodies, to 30 of finned rockets on their cross-section; 57 times as much has radians under "
     "degrees",
     [](const Subject& s) { return NormalSlope(s.table(), true); }},
    {"table.xcp_station_m", "lies, as part of the stack's length, at most", "",
     Usual(0.0, 1.0).Possible(-1.0, 2.0), "the air presses on the body",
     [](const Subject& s) { return GreatestOfTable(s.table().xcp_station_m) / s.stage().bottom_station_m; }},
    {"table.xcp_station_m", "lies, as part of the stack's length, at least", "",
     Usual(0.0, 1.0).Possible(-1.0, 2.0), "the air presses on the body",
     [](const Subject& s) { return LeastOfTable(s.table().xcp_station_m) / s.stage().bottom_station_m; }},
    {"table.cmq_per_rad", "is at most", "", Usual(-kAny, 0.0).Possible(-kAny, 0.0),
     "the air takes from a turning body; above 0 it drives it",
     [](const Subject& s) { return GreatestOfTable(s.table().cmq_per_rad); }},
    {"table.cmq_per_rad", "is at least", "", Usual(-10000.0, kAny).Possible(-1e6, kAny),
     "slender-body theory gives with the length L and the diameter d about -(L/d)²: -400 of a fineness of 20",
     [](const Subject& s) { return LeastOfTable(s.table().cmq_per_rad); }},
    {"table.clp_per_rad", "is at most", "", Usual(-kAny, 0.0).Possible(-kAny, 0.0),
     "the air takes from a rolling body; above 0 it drives it",
     [](const Subject& s) { return GreatestOfTable(s.table().clp_per_rad); }},
};

}  // namespace

std::span<const Check> AeroChecks() { return kAeroChecks; }

}  // namespace dispersa::plausibility
