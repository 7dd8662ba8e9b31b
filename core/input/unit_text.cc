#include "core/input/unit_text.h"

namespace dispersa {
namespace {

struct WrittenUnit {
  std::string_view unit;
  std::string_view text;
};
constexpr WrittenUnit kWritten[] = {
    {"m", "m"},
    {"km", "km"},
    {"mm", "mm"},
    {"um", "µm"},
    {"m2", "m²"},
    {"s", "s"},
    {"ms", "ms"},
    {"kg", "kg"},
    {"ton", "t (1000 kg)"},
    {"g", "g"},
    {"kg_s", "kg/s"},
    {"kg_m", "kg/m"},
    {"kg_m2", "kg m²"},
    {"kg_m3", "kg/m³"},
    {"n", "N"},
    {"kn", "kN"},
    {"n_m", "N m"},
    {"kn_m", "kN m"},
    {"n_m2", "N m²"},
    {"kn_m2", "kN m²"},
    {"mn_m2", "MN m²"},
    {"pa", "Pa"},
    {"kpa", "kPa"},
    {"mpa", "MPa"},
    {"hpa", "hPa"},
    {"bar", "bar"},
    {"gpa", "GPa"},
    {"pa_rad", "Pa rad"},
    {"pa_deg", "Pa °"},
    {"kpa_rad", "kPa rad"},
    {"w_m2", "W/m²"},
    {"kw_m2", "kW/m²"},
    {"m_s", "m/s"},
    {"km_s", "km/s"},
    {"km_h", "km/h"},
    {"deg", "°"},
    {"rad", "rad"},
    {"deg_s", "°/s"},
    {"rad_s", "rad/s"},
    {"deg_s2", "°/s²"},
    {"rad_s2", "rad/s²"},
    {"hz", "Hz"},
    {"1_s", "1/s"},
    {"1_s2", "1/s²"},
    {"per_km", "1/km"},
    {"per_m", "1/m"},
    {"per_m_s", "s/m"},
    {"per_deg", "1/°"},
    {"per_rad", "1/rad"},
    {"percent", "%"},
    {"k", "K"},
    {"percent_per_k", "%/K"},
    {"db", "dB"},
};

}  // namespace

std::string_view UnitText(std::string_view unit) {
  for (const WrittenUnit& written : kWritten)
    if (written.unit == unit) return written.text;
  return "";
}

}  // namespace dispersa
