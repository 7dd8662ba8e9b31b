#include "core/campaign_yaml/parse_sounding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "core/campaign_yaml/named_files.h"
#include "core/campaign_yaml/parse_csv.h"
#include "core/campaign_yaml/text_problems.h"
#include "core/environment/weather_ensemble.h"
#include "core/input/number_text.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

enum Quantity {
  kHeight,
  kGeopotential,
  kPressureOf,
  kTemperatureOf,
  kDewPoint,
  kDewPointDepression,
  kHumidity,
  kDensityOf,
  kWindSpeed,
  kDirection,
  kNorthOf,
  kEastOf,
  kQuantities
};

struct UnitOf {
  std::string_view name;
  double factor = 1.0, offset = 0.0;
};
using Units = std::vector<UnitOf>;

// Units by their names in the headers of columns, in lower case.
const Units& UnitsOf(Quantity quantity) {
  static const Units length = {{"m"}, {"km", 1e3}, {"ft", 0.3048}, {"kft", 304.8}};
  static const Units pressure = {{"pa"},        {"hpa", 1e2},       {"kpa", 1e3},        {"mb", 1e2},
                                 {"mbar", 1e2}, {"inhg", 3386.389}, {"mmhg", 133.322387}};
  static const Units temperature = {
      {"k"}, {"c", 1.0, 273.15}, {"degc", 1.0, 273.15}, {"f", 5.0 / 9.0, 459.67 * 5.0 / 9.0}};
  static const Units difference = {{"k"}, {"c"}};
  static const Units part = {{"%", 0.01}, {"percent", 0.01}, {"1"}};
  static const Units density = {{"kg_m3"}, {"kg/m3"}, {"g_m3", 1e-3}, {"g/m3", 1e-3}};
  static const Units speed = {{"m_s"},
                              {"m/s"},
                              {"kt", 1852.0 / 3600.0},
                              {"kts", 1852.0 / 3600.0},
                              {"knot", 1852.0 / 3600.0},
                              {"knots", 1852.0 / 3600.0},
                              {"km_h", 1.0 / 3.6},
                              {"km/h", 1.0 / 3.6},
                              {"mph", 0.44704},
                              {"ft_s", 0.3048},
                              {"ft/s", 0.3048}};
  static const Units angle = {{"deg", kRadPerDeg}, {"degree", kRadPerDeg}, {"degrees", kRadPerDeg}, {"rad"}};
  switch (quantity) {
    case kPressureOf:
      return pressure;
    case kTemperatureOf:
    case kDewPoint:
      return temperature;
    case kDewPointDepression:
      return difference;
    case kHumidity:
      return part;
    case kDensityOf:
      return density;
    case kWindSpeed:
    case kNorthOf:
    case kEastOf:
      return speed;
    case kDirection:
      return angle;
    default:
      return length;
  }
}

struct NameOf {
  std::string_view name;
  Quantity quantity;
};
// Names of columns without their units, in lower case, with '_' between words.
constexpr NameOf kNames[] = {{"altitude", kHeight},
                             {"alt", kHeight},
                             {"height", kHeight},
                             {"geometric_height", kHeight},
                             {"geopotential", kGeopotential},
                             {"geopotential_height", kGeopotential},
                             {"geopotential_altitude", kGeopotential},
                             {"gph", kGeopotential},
                             {"hght", kGeopotential},
                             {"pressure", kPressureOf},
                             {"pres", kPressureOf},
                             {"temperature", kTemperatureOf},
                             {"temp", kTemperatureOf},
                             {"air_temperature", kTemperatureOf},
                             {"dew_point", kDewPoint},
                             {"dewpoint", kDewPoint},
                             {"dew_point_temperature", kDewPoint},
                             {"dwpt", kDewPoint},
                             {"relative_humidity", kHumidity},
                             {"humidity", kHumidity},
                             {"relh", kHumidity},
                             {"rh", kHumidity},
                             {"density", kDensityOf},
                             {"speed", kWindSpeed},
                             {"wind_speed", kWindSpeed},
                             {"sknt", kWindSpeed},
                             {"sped", kWindSpeed},
                             {"direction", kDirection},
                             {"wind_direction", kDirection},
                             {"wind_from_direction", kDirection},
                             {"drct", kDirection},
                             {"north", kNorthOf},
                             {"northward_wind", kNorthOf},
                             {"v", kNorthOf},
                             {"v_wind", kNorthOf},
                             {"east", kEastOf},
                             {"eastward_wind", kEastOf},
                             {"u", kEastOf},
                             {"u_wind", kEastOf}};

struct Meaning {
  Quantity quantity = kQuantities;  ///< of no quantity that is read
  UnitOf unit;                      ///< without name: the column names none
};

std::string Lower(std::string_view text) {
  std::string lower;
  for (const char c : text) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t_");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t_") - begin + 1));
}

Quantity QuantityOf(std::string_view name) {
  for (const NameOf& known : kNames)
    if (known.name == name) return known.quantity;
  return kQuantities;
}

const UnitOf* FindUnit(Quantity quantity, std::string_view name) {
  for (const UnitOf& unit : UnitsOf(quantity))
    if (unit.name == name) return &unit;
  return nullptr;
}

// "altitude_ft", "altitude (ft)", "altitude [ft]", "wind speed_kt".
Meaning MeaningOf(std::string_view header) {
  std::string text = Lower(header);
  Meaning of;
  if (const std::size_t open = text.find_first_of("(["); open != std::string::npos) {
    const std::size_t close = text.find_first_of(")]", open);
    std::string name = Trimmed(text.substr(0, open));
    std::replace(name.begin(), name.end(), ' ', '_');
    of.quantity = QuantityOf(name);
    if (of.quantity == kQuantities || close == std::string::npos) return of;
    if (const UnitOf* unit = FindUnit(of.quantity, Trimmed(text.substr(open + 1, close - open - 1))))
      of.unit = *unit;
    return of;
  }
  std::replace(text.begin(), text.end(), ' ', '_');
  of.quantity = QuantityOf(text);
  for (std::size_t at = text.find('_'); at != std::string::npos; at = text.find('_', at + 1)) {
    const Quantity quantity = QuantityOf(text.substr(0, at));
    if (quantity == kQuantities) continue;
    const UnitOf* const unit = FindUnit(quantity, text.substr(at + 1));
    if (unit != nullptr) return {quantity, *unit};
  }
  return of;
}

std::string UnitNames(Quantity quantity) {
  std::string names;
  for (const UnitOf& unit : UnitsOf(quantity)) names += (names.empty() ? "" : ", ") + std::string(unit.name);
  return names;
}

// What stands for a value that was not measured. 999.9 and 9999 are heights and pressures, too.
bool IsMissing(Quantity quantity, std::string_view text) {
  if (text.empty() || text.find_first_not_of('/') == std::string_view::npos || text == "-" || text == "--")
    return true;
  const std::string lower = Lower(text);
  if (lower == "nan" || lower == "na" || lower == "m" || lower == "null" || lower == "msg") return true;
  const std::optional<double> value = ParseNumber(text);
  if (!value) return false;
  for (const double code : {-9999.0, -8888.0, -999.0, -999.9, -9999.9, 99999.0, 999999.0})
    if (*value == code) return true;
  if (quantity == kHeight || quantity == kGeopotential || quantity == kPressureOf) return false;
  return *value == 999.9 || *value == 9999.0 || *value == 9999.9 ||
         (quantity != kTemperatureOf && *value == 999.0);
}

struct Limits {
  double low, high;
  const char* words;
};
// In SI, of a sounding's values. What becomes a column of the table is judged there once more.
Limits LimitsOf(Quantity quantity) {
  switch (quantity) {
    case kPressureOf:
      return {1e-3, 1.2e5, "above 0 and up to 1200 hPa"};
    case kTemperatureOf:
    case kDewPoint:
      return {100.0, 1000.0, "from 100 to 1000 K"};
    case kDewPointDepression:
      return {0.0, 100.0, "from 0 to 100 K"};
    case kHumidity:
      return {0.0, 1.2, "from 0 to 120 %"};
    case kDensityOf:
      return {1e-12, 10.0, "above 0 and up to 10 kg/m3"};
    case kWindSpeed:
      return {0.0, 500.0, "from 0 to 500 m/s"};
    case kDirection:
      return {0.0, kTwoPi, "from 0 to 360 degrees, clockwise from north, where the wind comes from"};
    case kNorthOf:
    case kEastOf:
      return {-500.0, 500.0, "from -500 to 500 m/s"};
    default:
      return {-1000.0, 200000.0, "from -1 to 200 km"};
  }
}

// A level's values in SI as its cells are read, each at its place.
class LevelReader {
 public:
  LevelReader(const std::string& file, int line, std::vector<InputProblem>& problems)
      : file_(file), line_(line), problems_(problems) {
    values_.fill(SoundingLevel::kNone);
  }

  void Take(const Meaning& meaning, std::string_view text, int column) {
    if (meaning.quantity == kQuantities || IsMissing(meaning.quantity, text)) return;
    const std::optional<double> number = ParseNumber(text);
    const Limits limits = LimitsOf(meaning.quantity);
    const double value = number ? *number * meaning.unit.factor + meaning.unit.offset : SoundingLevel::kNone;
    if (!(value >= limits.low && value <= limits.high)) {
      problems_.push_back(
          {file_, line_, column, "",
           "'" + std::string(text) + "'" + (number ? " " + std::string(meaning.unit.name) : "") +
               " is no value of this column",
           std::string("a number ") + limits.words + ", or -9999, 999.9, // or nothing if missing"});
      return;
    }
    values_[meaning.quantity] = value;
  }

  SoundingLevel Level() const {
    SoundingLevel level;
    level.source = line_;
    level.height_m = values_[kHeight];
    level.geopotential_m = values_[kGeopotential];
    level.pressure_pa = values_[kPressureOf];
    level.temperature_k = values_[kTemperatureOf];
    level.density_kg_m3 = values_[kDensityOf];
    level.north_m_s = values_[kNorthOf];
    level.east_m_s = values_[kEastOf];
    const double speed_m_s = values_[kWindSpeed];
    // A calm has no direction.
    const double from_rad = speed_m_s == 0.0 && std::isnan(values_[kDirection]) ? 0.0 : values_[kDirection];
    if (!level.has_wind() && !std::isnan(speed_m_s) && !std::isnan(from_rad)) {
      const WindNorthEast wind = FromAzimuth(speed_m_s, from_rad);
      level.north_m_s = wind.north_m_s;
      level.east_m_s = wind.east_m_s;
    }
    const double dew_point_k = std::isnan(values_[kDewPoint])
                                   ? level.temperature_k - values_[kDewPointDepression]
                                   : values_[kDewPoint];
    if (!std::isnan(dew_point_k))
      level.vapour_pa = SaturationPressure(dew_point_k);
    else if (!std::isnan(level.temperature_k) && !std::isnan(values_[kHumidity]))
      level.vapour_pa = values_[kHumidity] * SaturationPressure(level.temperature_k);
    return level;
  }

 private:
  const std::string& file_;
  int line_;
  std::vector<InputProblem>& problems_;
  std::array<double, kQuantities> values_;
};

// A field of fixed width, with the column of its first character.
struct Field {
  std::string text;
  int column = 1;
};
Field FieldOf(std::string_view line, std::size_t begin, std::size_t end) {
  if (begin >= line.size()) return {"", static_cast<int>(begin) + 1};
  const std::string_view part = line.substr(begin, std::min(end, line.size()) - begin);
  const std::size_t first = part.find_first_not_of(' ');
  if (first == std::string_view::npos) return {"", static_cast<int>(begin) + 1};
  return {std::string(part.substr(first, part.find_last_not_of(' ') - first + 1)),
          static_cast<int>(begin + first) + 1};
}

// ---- University of Wyoming ----
// Columns end where the words of the line with their names end. The units stand below the names.

constexpr std::string_view kWyomingNames[] = {"PRES", "HGHT"};

// Of a table of fixed columns, not of one with commas.
bool IsWyomingHeader(std::string_view line) {
  return line.find_first_of(",;") == std::string_view::npos &&
         std::all_of(std::begin(kWyomingNames), std::end(kWyomingNames),
                     [&](std::string_view name) { return line.find(name) != std::string_view::npos; });
}

// "12Z 15 Jan 2020" as a DatedWeather's time.
std::string WyomingTime(const std::string& title) {
  constexpr std::string_view kMonths = "JanFebMarAprMayJunJulAugSepOctNovDec";
  constexpr std::string_view kBefore = "Observations at ";
  const std::size_t at = title.find(kBefore);
  std::istringstream words(at == std::string::npos ? "" : title.substr(at + kBefore.size()));
  std::string hour, day, month, year;
  words >> hour >> day >> month >> year;
  const std::size_t place = month.size() == 3 ? kMonths.find(month) : std::string_view::npos;
  if (place == std::string_view::npos || place % 3 != 0 || hour.size() != 3 || day.empty()) return "";
  return fmt::format("{}-{:02}-{:0>2}T{}", year, place / 3 + 1, day, hour.substr(0, 2));
}

std::string WithoutTags(std::string_view line) {
  std::string text;
  bool in_tag = false;
  for (const char c : line) {
    in_tag |= c == '<';
    if (!in_tag) text += c;
    in_tag &= c != '>';
  }
  return text;
}

Sounding ReadWyoming(const std::vector<std::string_view>& lines, const std::string& file,
                     std::vector<InputProblem>& problems) {
  Sounding sounding;
  struct Column {
    std::size_t begin, end;
    Meaning meaning;
  };
  std::vector<Column> columns;
  std::size_t header = 0;
  while (!IsWyomingHeader(lines[header])) {
    if (const std::size_t at = lines[header].find("Observations at"); at != std::string_view::npos)
      sounding.title = Trimmed(WithoutTags(lines[header]));
    ++header;
  }
  sounding.time = WyomingTime(sounding.title);
  const std::string_view names = lines[header];
  const std::string_view units = header + 1 < lines.size() ? lines[header + 1] : std::string_view();
  for (std::size_t begin = 0, at = names.find_first_not_of(' '); at != std::string_view::npos;) {
    const std::size_t end = std::min(names.find(' ', at), names.size());
    const std::string name(names.substr(at, end - at));
    Meaning meaning{QuantityOf(Lower(name)), {}};
    const Field unit = FieldOf(units, begin, end);
    if (meaning.quantity == kQuantities) {
      sounding.not_read.push_back(name);
    } else if (const UnitOf* known = FindUnit(meaning.quantity, Lower(unit.text))) {
      meaning.unit = *known;
    } else {
      problems.push_back({file, static_cast<int>(header) + 2, unit.column, "",
                          "'" + unit.text + "' is no unit of the column " + name,
                          UnitNames(meaning.quantity)});
    }
    columns.push_back({begin, end, meaning});
    begin = end;
    at = names.find_first_not_of(' ', end);
  }
  bool in_table = true;
  for (std::size_t i = header + 2; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    if (line.find("Station latitude:") != std::string_view::npos) {
      const std::string value = Trimmed(line.substr(line.find(':') + 1));
      if (const std::optional<double> latitude = ParseNumber(value); latitude && std::fabs(*latitude) <= 90.0)
        sounding.latitude_rad = *latitude * kRadPerDeg;
    }
    if (!in_table || line.starts_with("---") || Trimmed(line).empty()) continue;
    if (line.find('<') != std::string_view::npos || IsWyomingHeader(line)) {
      in_table = false;
      if (IsWyomingHeader(line))
        problems.push_back({file, static_cast<int>(i) + 1, 1, "", "a second sounding begins here",
                            "one sounding in a file"});
      continue;
    }
    LevelReader reader(file, static_cast<int>(i) + 1, problems);
    for (const Column& column : columns) {
      const Field field = FieldOf(line, column.begin, column.end);
      reader.Take(column.meaning, field.text, field.column);
    }
    sounding.levels.push_back(reader.Level());
  }
  return sounding;
}

// ---- IGRA 2 ----
// A header record and its levels, in fixed columns (igra2-data-format.txt of the archive, NOAA).

struct IgraColumn {
  std::size_t begin, end;
  Meaning meaning;
};
const std::vector<IgraColumn>& IgraColumns() {
  static const std::vector<IgraColumn> columns = {
      {9, 15, {kPressureOf, {"Pa"}}},
      {16, 21, {kGeopotential, {"m"}}},
      {22, 27, {kTemperatureOf, {"tenths of a degree C", 0.1, 273.15}}},
      {28, 33, {kHumidity, {"tenths of a percent", 1e-3}}},
      {34, 39, {kDewPointDepression, {"tenths of a degree C", 0.1}}},
      {40, 45, {kDirection, {"deg", kRadPerDeg}}},
      {46, 51, {kWindSpeed, {"tenths of m/s", 0.1}}}};
  return columns;
}

bool IsIgraHeader(std::string_view line) {
  return line.size() >= 36 && line[0] == '#' && line[12] == ' ' &&
         std::all_of(line.begin() + 13, line.begin() + 17, [](char c) { return c >= '0' && c <= '9'; });
}

std::string IgraDate(std::string_view line) {
  return fmt::format("{}-{}-{}T{}", line.substr(13, 4), line.substr(18, 2), line.substr(21, 2),
                     line.substr(24, 2));
}

Sounding ReadIgra(const std::vector<std::string_view>& lines, const std::string& file,
                  const std::string& date, std::vector<InputProblem>& problems) {
  std::vector<std::size_t> headers;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (IsIgraHeader(lines[i]) && (date.empty() || IgraDate(lines[i]).starts_with(date)))
      headers.push_back(i);
  Sounding sounding;
  if (headers.size() != 1) {
    const std::size_t second = headers.size() > 1 ? headers[1] : 0;
    problems.push_back({file, static_cast<int>(second) + 1, 1, "",
                        headers.empty()
                            ? "the file has no sounding of " + date
                            : fmt::format("the file has {} soundings{}, here that of {}", headers.size(),
                                          date.empty() ? "" : " of " + date, IgraDate(lines[second])),
                        "one sounding: dispersa convert FILE --date YYYY-MM-DDTHH --out FILE"});
    return sounding;
  }
  const std::string_view header = lines[headers.front()];
  constexpr std::size_t kLongestHeader = 75;
  if (header.size() > kLongestHeader) {
    problems.push_back({file, static_cast<int>(headers.front()) + 1, 1, "",
                        "the file has IGRA's derived parameters, in other columns",
                        "IGRA's soundings, whose file is STATION-data.txt"});
    return sounding;
  }
  const std::string station = Trimmed(header.substr(1, 11));
  sounding.time = IgraDate(header);
  sounding.title = fmt::format("IGRA 2 station {}, {} UTC", station, sounding.time);
  if (MonthOf(sounding.time) == 0) sounding.time.resize(10);  // an hour of 99 is not known
  if (const auto latitude = ParseNumber(FieldOf(header, 55, 62).text);
      latitude && std::fabs(*latitude) <= 900000.0)
    sounding.latitude_rad = *latitude * 1e-4 * kRadPerDeg;
  const Field count = FieldOf(header, 32, 36);
  const std::optional<std::uint64_t> levels = ParseInteger(count.text);
  std::size_t end = headers.front() + 1;
  while (end < lines.size() && !lines[end].starts_with('#') && !lines[end].empty()) ++end;
  if (const std::size_t there = end - headers.front() - 1; !levels || *levels != there)
    problems.push_back({file, static_cast<int>(headers.front()) + 1, count.column, "",
                        fmt::format("the record says '{}' levels, and {} follow", count.text, there),
                        "the number of levels that follow"});
  for (std::size_t i = headers.front() + 1; i < end; ++i) {
    LevelReader reader(file, static_cast<int>(i) + 1, problems);
    for (const IgraColumn& column : IgraColumns()) {
      const Field field = FieldOf(lines[i], column.begin, column.end);
      reader.Take(column.meaning, field.text, field.column);
    }
    sounding.levels.push_back(reader.Level());
  }
  return sounding;
}

}  // namespace

bool IsSoundingText(const std::string& text) {
  constexpr std::size_t kHeadLines = 64;  // a page has some of HTML before its table
  const std::vector<std::string_view> lines = LinesOf(WithoutByteOrderMark(text), kHeadLines);
  return !lines.empty() &&
         (IsIgraHeader(lines.front()) || std::any_of(lines.begin(), lines.end(), IsWyomingHeader));
}

std::vector<std::string> TimesOf(const std::string& text) {
  std::vector<std::string> times;
  for (const std::string_view line : LinesOf(WithoutByteOrderMark(text)))
    if (IsIgraHeader(line)) times.push_back(IgraDate(line));
  return times;
}

std::string TimeInName(const std::string& file) {
  const auto is_digit = [&](std::size_t i) { return i < file.size() && file[i] >= '0' && file[i] <= '9'; };
  for (std::size_t begin = 0; begin < file.size(); ++begin) {
    if (begin > 0 && is_digit(begin - 1)) continue;
    std::string digits;
    for (std::size_t i = begin; i < file.size() && digits.size() < 10; ++i) {
      const bool is_between = digits.size() == 4 || digits.size() == 6 || digits.size() == 8;
      if (is_digit(i))
        digits += file[i];
      else if (!is_between || std::string_view("-_T ").find(file[i]) == std::string_view::npos)
        break;
    }
    if (digits.size() < 8) continue;
    const std::string day = digits.substr(0, 4) + "-" + digits.substr(4, 2) + "-" + digits.substr(6, 2);
    if (MonthOf(day) == 0) continue;
    const std::string hour = digits.size() == 10 ? day + "T" + digits.substr(8) : day;
    return MonthOf(hour) > 0 ? hour : day;
  }
  return "";
}

bool IsSoundingTable(const InputNode& table) {
  std::array<bool, kQuantities> has{};
  bool other_unit = false;
  for (const InputMember& column : table.members) {
    const Meaning meaning = MeaningOf(column.key);
    if (meaning.quantity == kQuantities) continue;
    has[meaning.quantity] = true;
    // Units of our own tables are metres, kilometres and m/s; the air's are those of unit tables.
    other_unit |=
        (meaning.quantity == kHeight && (meaning.unit.name == "ft" || meaning.unit.name == "kft")) ||
        ((meaning.quantity == kNorthOf || meaning.quantity == kEastOf) && meaning.unit.name != "m_s") ||
        (meaning.quantity == kTemperatureOf && meaning.unit.name != "k") || meaning.quantity == kGeopotential;
  }
  const bool has_wind = (has[kWindSpeed] && has[kDirection]) || (has[kNorthOf] && has[kEastOf] && other_unit);
  return (has[kHeight] || has[kGeopotential] || has[kPressureOf]) && has_wind;
}

Sounding ReadSounding(const std::string& text, const std::string& file, const std::string& date,
                      std::vector<InputProblem>& problems) {
  const std::vector<std::string_view> lines = LinesOf(WithoutByteOrderMark(text));
  return IsIgraHeader(lines.front()) ? ReadIgra(lines, file, date, problems)
                                     : ReadWyoming(lines, file, problems);
}

Sounding ReadSounding(const InputNode& table, std::vector<InputProblem>& problems) {
  Sounding sounding;
  std::vector<Meaning> meanings;
  std::array<const InputMember*, kQuantities> first{};
  for (const InputMember& column : table.members) {
    const Meaning& meaning = meanings.emplace_back(MeaningOf(column.key));
    if (meaning.quantity == kQuantities) {
      const std::string first_cell = column.value.items.empty() ? "" : column.value.items.front().text;
      const std::optional<double> number = ParseNumber(first_cell);
      if (column.key == "time")
        sounding.time = TimeInName(first_cell);
      else if (column.key == "latitude" && number && std::fabs(*number) <= 90.0)
        sounding.latitude_rad = *number * kRadPerDeg;
      else
        sounding.not_read.push_back(column.key);
      continue;
    }
    if (meaning.unit.name.empty())
      problems.push_back({*table.file, column.line, column.column, "",
                          "the column '" + column.key + "' names no unit",
                          "one of " + UnitNames(meaning.quantity) + ", as in altitude_ft or altitude (ft)"});
    if (first[meaning.quantity] != nullptr)
      problems.push_back(
          {*table.file, column.line, column.column, "",
           "the columns '" + first[meaning.quantity]->key + "' and '" + column.key + "' are the same",
           "each quantity once"});
    first[meaning.quantity] = &column;
  }
  const std::size_t rows = table.members.empty() ? 0 : table.members.front().value.items.size();
  for (std::size_t row = 0; row < rows; ++row) {
    LevelReader reader(*table.file, table.members.front().value.items[row].line, problems);
    for (std::size_t c = 0; c < meanings.size(); ++c) {
      const InputNode& cell = table.members[c].value.items[row];
      reader.Take(meanings[c], cell.text, cell.column);
    }
    sounding.levels.push_back(reader.Level());
  }
  return sounding;
}

namespace {

// Every column of a table that a flight reads, with its values as texts: no balloon measures a millimetre.
template <typename Visit>
void EachColumn(const WeatherTable& table, const Visit& visit) {
  const auto column = [&](const char* name, const std::vector<double>& values, const auto& text_of) {
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(text_of(value));
    if (!texts.empty()) visit(name, texts);
  };
  const auto thousandths = [](double value) { return FormatNumber(std::round(1e3 * value) / 1e3); };
  const auto eight_digits = [](double value) { return fmt::format("{:.8g}", value); };
  column("altitude_m", table.altitude_m, thousandths);
  column("north_m_s", table.north_m_s, thousandths);
  column("east_m_s", table.east_m_s, thousandths);
  column("pressure_pa", table.pressure_pa, eight_digits);
  column("density_kg_m3", table.density_kg_m3, eight_digits);
}

// Of a sounding that was read without problems.
SoundingProfile Profile(const Sounding& sounding, const std::string& file,
                        std::vector<InputProblem>& problems) {
  SoundingProfile profile = ProfileOf(sounding.levels, sounding.latitude_rad);
  const bool has_wind = profile.without_wind < profile.table.altitude_m.size();
  if (profile.table.altitude_m.size() < 2 || !has_wind)
    problems.push_back({file, 1, 1, "",
                        profile.table.altitude_m.size() < 2
                            ? fmt::format("{} of {} levels have a height and a value",
                                          profile.table.altitude_m.size(), profile.levels)
                            : std::string("no level has a wind"),
                        "two levels or more, with heights or pressures, and a wind"});
  return profile;
}

}  // namespace

InputNode TableOf(const Sounding& sounding, const std::string& file, std::vector<InputProblem>& problems) {
  const std::size_t before = problems.size();
  const SoundingProfile profile = Profile(sounding, file, problems);
  if (problems.size() > before) return {};
  InputNode place;
  place.file = std::make_shared<const std::string>(file);
  InputNode node = MapAt(place);
  node.is_table = true;
  EachColumn(profile.table, [&](const char* name, const std::vector<std::string>& texts) {
    InputNode column = ListAt(place);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      place.line = profile.sources[i];
      column.items.push_back(ScalarAt(place, texts[i]));
    }
    SetMember(node, name, std::move(column));
  });
  return node;
}

std::string ConvertSounding(const std::string& path, const std::string& date) {
  std::vector<InputProblem> problems;
  Sounding sounding;
  const auto [file, text] = ReadInputFile(path, problems);
  if (!problems.empty() || !CheckUtf8(text, file, problems)) throw InputError(problems);
  if (IsSoundingText(text)) {
    sounding = ReadSounding(text, file, date, problems);
  } else {
    const InputNode table = ParseCsv(text, file, problems);
    if (problems.empty() && !IsSoundingTable(table))
      problems.push_back(
          {file, table.line, 1, "", "the file is no sounding",
           "text of the University of Wyoming, IGRA 2, or a CSV file with an altitude or pressure, and "
           "the wind's speed and direction or north and east, each with its unit"});
    if (problems.empty()) sounding = ReadSounding(table, problems);
  }
  if (!problems.empty()) throw InputError(problems);
  const SoundingProfile profile = Profile(sounding, file, problems);
  if (!problems.empty()) throw InputError(problems);
  std::string csv = "# Wind and air of a sounding, for dispersions: {wind_profile: {table: FILE}}.\n";
  if (!sounding.title.empty()) csv += "# " + sounding.title + "\n";
  csv += fmt::format("# {} levels, of which {} are here; {} got heights by their pressures.\n",
                     profile.levels, profile.table.altitude_m.size(), profile.with_heights_by_pressure);
  csv += fmt::format("# {} without wind are linear between their neighbours; {} without air exponential.\n",
                     profile.without_wind, profile.without_air);
  if (profile.wind_top_m < profile.table.altitude_m.back())
    csv += fmt::format("# The last wind is at {:.0f} m. Above, it fades.\n", profile.wind_top_m);
  csv += fmt::format("# Geometric altitudes in m, by normal gravity at {}.\n",
                     sounding.latitude_rad
                         ? fmt::format("{:.2f} degrees of latitude", *sounding.latitude_rad * kDegPerRad)
                         : std::string("45 degrees of latitude, for the file names none"));
  csv +=
      "# Wind in m/s towards north and towards east. Density is that of moist air where the file has "
      "humidity.\n";
  if (!sounding.not_read.empty())
    csv += fmt::format("# Columns not read: {}\n", fmt::join(sounding.not_read, ", "));
  std::vector<std::string> rows(profile.table.altitude_m.size() + 1);
  EachColumn(profile.table, [&](const char* name, const std::vector<std::string>& texts) {
    rows[0] += (rows[0].empty() ? "" : ",") + std::string(name);
    for (std::size_t i = 0; i < texts.size(); ++i) rows[i + 1] += (rows[i + 1].empty() ? "" : ",") + texts[i];
  });
  for (const std::string& row : rows) csv += row + "\n";
  return csv;
}

}  // namespace dispersa
