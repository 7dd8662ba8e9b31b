// Measured weathers of which each flight meets one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/environment/weather_table.h"

namespace dispersa {

inline constexpr std::size_t kMostSoundings = 500;

/// One of them. It is drawn in proportion to its weight.
struct DatedWeather {
  std::string file;       ///< without folders
  std::string time = {};  ///< UTC, YYYY-MM-DD or YYYY-MM-DDTHH; empty: not known
  WeatherTable table = {};
  double weight = 1.0;
};
void Describe(Fields& fields, DatedWeather& sounding);

/// 1 to 12; 0: the text is no time of a sounding.
int MonthOf(const std::string& time);

/// Each month that has soundings is equally likely, of any year, and so is each sounding of a month.
/// Precondition: all have a month.
void WeighByMonth(std::vector<DatedWeather>& soundings);

/// What a flight meets that names none of them: every 100 m from the lowest level to the highest, the
/// weighted means of both winds and of the logarithms of pressure and density. Below and above its levels
/// each is continued as a flight meets it. Without air in any of them the mean has none. Two or more
/// soundings.
WeatherTable MeanWeather(const std::vector<DatedWeather>& soundings);

/// Where a table's wind ends: its last altitude, or the one above which it only fades, as a sounding's does
/// whose air goes on.
double WindTop(const WeatherTable& table);

}  // namespace dispersa
