#include <initializer_list>

#include "core/environment/wind_statistics.h"
#include "core/input/fields.h"

namespace dispersa {
namespace {

// Of a component: the thermosphere's strongest. Values for "missing" (999.9, -9999) are beyond.
constexpr double kFastestWind_m_s = 500.0;
constexpr Range kComponent = Between(-kFastestWind_m_s, kFastestWind_m_s);
constexpr Range kDeviation = Between(0.0, kFastestWind_m_s);

// In a Check(): columns of one length, over altitudes that grow.
void CheckColumns(Fields& fields, const std::vector<double>& altitude_m,
                  std::initializer_list<const std::vector<double>*> columns, const char* allowed) {
  for (const auto* column : columns)
    if (column->size() != altitude_m.size())
      return fields.Refuse("", "the columns have different lengths", allowed);
  CheckIncreasing(fields, "altitude_m", altitude_m);
}

}  // namespace

void Describe(Fields& fields, WindTable& table, const char* allowed) {
  fields.Quantities("altitude", kLength, kAnyNumber, 2, SIZE_MAX, table.altitude_m, "geodetic, increasing");
  fields.Quantities("north", kSpeed, kComponent, 2, SIZE_MAX, table.north_m_s,
                    "towards north, at each altitude");
  fields.Quantities("east", kSpeed, kComponent, 2, SIZE_MAX, table.east_m_s, "towards east");
  fields.Check([&fields, &table, allowed] {
    CheckColumns(fields, table.altitude_m, {&table.north_m_s, &table.east_m_s}, allowed);
  });
}

void Describe(Fields& fields, WindStatistics& statistics) {
  fields.Number("correlation_ne", Inside(-1.0, 1.0), statistics.correlation_ne,
                "of the north and the east component at one altitude");
  fields.Quantity("correlation_length", kLength, kPositive, statistics.correlation_length_m,
                  "difference in altitude at which a component's autocorrelation is 1/e");
}

void DescribeLevels(Fields& fields, WindStatistics& statistics, std::size_t most) {
  fields.Quantities("altitude", kLength, kAnyNumber, 2, most, statistics.altitude_m, "geodetic, increasing");
  fields.Quantities("mean_north", kSpeed, kComponent, 2, SIZE_MAX, statistics.mean_north_m_s,
                    "at each altitude");
  fields.Quantities("mean_east", kSpeed, kComponent, 2, SIZE_MAX, statistics.mean_east_m_s,
                    "at each altitude");
  fields.Quantities("sigma_north", kSpeed, kDeviation, 2, SIZE_MAX, statistics.sigma_north_m_s,
                    "standard deviation");
  fields.Quantities("sigma_east", kSpeed, kDeviation, 2, SIZE_MAX, statistics.sigma_east_m_s,
                    "standard deviation");
  fields.Check([&fields, &statistics] {
    CheckColumns(fields, statistics.altitude_m,
                 {&statistics.mean_north_m_s, &statistics.mean_east_m_s, &statistics.sigma_north_m_s,
                  &statistics.sigma_east_m_s},
                 "one value an altitude in each column");
  });
}

}  // namespace dispersa
