#include "core/campaign_yaml/parse_sounding.h"

#include "core/campaign_yaml/parse_csv.h"
#include "core/environment/atmosphere.h"
#include "core/math/constants.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_sounding_test {

constexpr char kData[] = DISPERSA_TEST_DATA "/soundings/";

/// Columns of a converted table by name, as texts.
struct Converted {
  std::string comments;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  double At(std::size_t row, const std::string& name) const {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return std::stod(rows[row][i]);
    ADD_FAILURE() << "no column " << name;
    return 0.0;
  }
};

Converted Convert(const std::string& file, const std::string& date = "") {
  Converted table;
  std::istringstream lines(ConvertSounding(file, date));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) {
      table.comments += line + "\n";
      continue;
    }
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    table.names.empty() ? table.names = cells : table.rows.emplace_back(cells);
  }
  return table;
}

void ExpectWind(const Converted& table, std::size_t row, double speed_m_s, double from_deg) {
  EXPECT_NEAR(table.At(row, "north_m_s"), -speed_m_s * std::cos(from_deg * kRadPerDeg), 1e-3) << row;
  EXPECT_NEAR(table.At(row, "east_m_s"), -speed_m_s * std::sin(from_deg * kRadPerDeg), 1e-3) << row;
}

constexpr double kKnot = 1852.0 / 3600.0;

TEST(ConvertSounding, OfWyoming) {
  const Converted table = Convert(std::string(kData) + "wyoming.txt");
  EXPECT_EQ(table.names, (std::vector<std::string>{"altitude_m", "north_m_s", "east_m_s", "pressure_pa",
                                                   "density_kg_m3"}));
  ASSERT_EQ(table.rows.size(), 12u);
  EXPECT_THAT(table.comments, HasSubstr("74794 XMR Cape Kennedy Observations at 12Z 15 Jan 2020"));
  EXPECT_THAT(table.comments, HasSubstr("12 levels, of which 12 are here; 0 got heights by their pressures"));
  EXPECT_THAT(table.comments, HasSubstr("28.48 degrees of latitude"));
  EXPECT_THAT(table.comments, HasSubstr("Columns not read: MIXR, THTA, THTE, THTV"));
  ExpectWind(table, 0, 6.0 * kKnot, 350.0);
  ExpectWind(table, 1, 10.0 * kKnot, 10.0);
  ExpectWind(table, 7, 104.0 * kKnot, 250.0);
  EXPECT_EQ(table.At(0, "pressure_pa"), 101800.0);
  EXPECT_EQ(table.At(11, "pressure_pa"), 2000.0);
  EXPECT_NEAR(table.At(10, "altitude_m"), GeometricHeight(20700.0, 28.48 * kRadPerDeg), 1e-3);
  EXPECT_GT(table.At(10, "altitude_m"), 20790.0);
  // Saturated air of 9.28 g/kg: 0.56 % lighter than dry air. Above 300 hPa no humidity is given.
  EXPECT_NEAR(table.At(0, "density_kg_m3") * kAirGasConstant_j_kg_k * 287.55 / 101800.0, 1.0 - 0.00556, 1e-4);
  EXPECT_NEAR(table.At(9, "density_kg_m3") * kAirGasConstant_j_kg_k * 205.05 / 10000.0, 1.0, 1e-7);
  // No wind at 925 hPa: between its neighbours.
  const double part = (table.At(2, "altitude_m") - table.At(1, "altitude_m")) /
                      (table.At(3, "altitude_m") - table.At(1, "altitude_m"));
  EXPECT_NEAR(table.At(2, "east_m_s"),
              table.At(1, "east_m_s") + part * (table.At(3, "east_m_s") - table.At(1, "east_m_s")), 1e-3);
}

TEST(ConvertSounding, OfIgra) {
  const Converted table = Convert(std::string(kData) + "igra.txt"),
                  wyoming = Convert(std::string(kData) + "wyoming.txt");
  EXPECT_THAT(table.comments, HasSubstr("IGRA 2 station USM00074794, 2020-01-15T12 UTC"));
  EXPECT_THAT(table.comments, HasSubstr("13 levels, of which 13 are here; 3 got heights by their pressures"));
  ASSERT_EQ(table.rows.size(), 13u);
  // The same levels of the same day.
  for (const auto& [here, there] :
       {std::pair(0, 0), {1, 1}, {3, 2}, {4, 3}, {6, 4}, {8, 5}, {9, 7}, {10, 8}, {11, 9}}) {
    EXPECT_NEAR(table.At(here, "altitude_m"), wyoming.At(there, "altitude_m"), 0.01) << here;
    EXPECT_EQ(table.At(here, "pressure_pa"), wyoming.At(there, "pressure_pa")) << here;
    EXPECT_NEAR(table.At(here, "density_kg_m3") / wyoming.At(there, "density_kg_m3"), 1.0, 2e-4) << here;
  }
  ExpectWind(table, 0, 3.1, 350.0);
  ExpectWind(table, 5, 17.0, 270.0);
  EXPECT_NEAR(table.At(5, "altitude_m"), GeometricHeight(2400.0, 28.48 * kRadPerDeg), 1e-3);
  EXPECT_NEAR(table.At(12, "altitude_m"), 16548.0 + 287.05 / 9.80665 * 206.1 * std::log(10.0 / 7.0), 30.0);
}

TEST(ConvertSounding, OfOneDateAmongSeveral) {
  TemporaryFolder folder;
  std::stringstream text;
  text << std::ifstream(std::string(kData) + "igra.txt").rdbuf();
  std::string next = text.str();
  next.replace(next.find("01 15 12"), 8, "01 16 00");
  next.replace(next.find("101800"), 6, "101000");
  const std::string file = (folder.path() / "year.txt").string();
  std::ofstream(file) << text.str() << next;
  EXPECT_EQ(Convert(file, "2020-01-15T12").At(0, "pressure_pa"), 101800.0);
  EXPECT_EQ(Convert(file, "2020-01-16").At(0, "pressure_pa"), 101000.0);
  const auto problem = [&](const std::string& date) {
    try {
      ConvertSounding(file, date);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(file.size());
    }
    return std::string();
  };
  const std::string allowed =
      ", allowed: one sounding: dispersa convert FILE --date YYYY-MM-DDTHH --out FILE";
  EXPECT_EQ(problem(""), ":15:1: the file has 2 soundings, here that of 2020-01-16T00" + allowed);
  EXPECT_EQ(problem("2020-01"),
            ":15:1: the file has 2 soundings of 2020-01, here that of 2020-01-16T00" + allowed);
  EXPECT_EQ(problem("2020-02"), ":1:1: the file has no sounding of 2020-02" + allowed);
}

TEST(ConvertSounding, OfUnitsInAHeader) {
  const Converted table = Convert(std::string(kData) + "units.csv");
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_NEAR(table.At(1, "altitude_m"), 3048.0, 1e-3);
  EXPECT_NEAR(table.At(4, "altitude_m"), 12000.0, 1e-3);
  ExpectWind(table, 0, 10.0 * kKnot, 350.0);
  ExpectWind(table, 4, 118.0 * kKnot, 255.0);
  EXPECT_EQ(table.At(3, "pressure_pa"), 30090.0);
  EXPECT_NEAR(table.At(4, "density_kg_m3") * kAirGasConstant_j_kg_k * 217.45 / 20000.0, 1.0, 1e-7);
  EXPECT_THAT(table.comments, HasSubstr("45 degrees of latitude, for the file names none"));
  EXPECT_THAT(table.comments, HasSubstr("Columns not read: ascent_rate_m_s"));
}

// In the shape of the University of Wyoming's CSV, whose levels each have time and place. Made up.
TEST(ConvertSounding, OfWyomingsCsv) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "s.csv").string();
  const std::string header =
      "time,longitude,latitude,pressure_hPa,geopotential height_m,temperature_C,dew point temperature_C,"
      "relative humidity_%,mixing ratio_g/kg,wind direction_degree,wind speed_m/s\n";
  const auto write = [&](const std::string& latitude) {
    std::ofstream(file)
        << header << "2020-01-15 11:06:00,-80.5500," << latitude
        << ", 919.0,  874, -0.1, -0.2, 99, 4.10,240, 1.5\n2020-01-15 11:10:00,-80.5500,10.0,  "
           "5.8,34988,-27.7,-73.7,  0, 0.32,   ,    \n";
  };
  write("60.0");
  const Converted table = Convert(file);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(table.comments, HasSubstr("60.00 degrees of latitude"));
  EXPECT_THAT(table.comments, HasSubstr("Columns not read: longitude, mixing ratio_g/kg\n"));
  EXPECT_THAT(table.comments, HasSubstr("The last wind is at 873 m. Above, it fades."));
  EXPECT_NEAR(table.At(1, "altitude_m"), GeometricHeight(34988.0, 60.0 * kRadPerDeg), 1e-3);
  ExpectWind(table, 0, 1.5, 240.0);
  EXPECT_EQ(table.At(1, "east_m_s"), 0.0);
  write("-99.9900");
  EXPECT_THAT(Convert(file).comments, HasSubstr("45 degrees of latitude, for the file names none"));
}

// Every unit of every quantity against its definition.
TEST(ConvertSounding, UnitsOfColumns) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "s.csv").string();
  // The first of two levels: the second one differs in its height alone.
  const auto read = [&](const std::string& header, const std::string& cells, const std::string& name) {
    std::ofstream(file) << header << "\n" << cells << "\n60" << cells.substr(cells.find(',')) << "\n";
    return Convert(file).At(0, name);
  };
  const std::string wind = ",direction_deg,speed_m_s", calm = ",0,0";
  for (const auto& [unit, metres] : {std::pair("m", 2.0), {"km", 2000.0}, {"ft", 0.6096}, {"kft", 609.6}})
    EXPECT_NEAR(read(std::string("altitude_") + unit + wind, "2" + calm, "altitude_m"), metres, 1e-3) << unit;
  for (const auto& [unit, speed] : {std::pair("m_s", 9.0),
                                    {"kt", 4.63},
                                    {"kts", 4.63},
                                    {"knots", 4.63},
                                    {"km_h", 2.5},
                                    {"mph", 4.02336},
                                    {"ft_s", 2.7432}})
    EXPECT_NEAR(read(std::string("altitude_km,direction_deg,speed_") + unit, "2,180,9", "north_m_s"), speed,
                1e-3)
        << unit;
  EXPECT_NEAR(read("altitude_km,direction_rad,speed_m_s", "2,3,9", "north_m_s"), -9.0 * std::cos(3.0), 1e-3);
  for (const auto& [unit, pressure] : {std::pair("pa", 20.0),
                                       {"hpa", 2000.0},
                                       {"kpa", 20000.0},
                                       {"mbar", 2000.0},
                                       {"mb", 2000.0},
                                       {"inhg", 67727.78},
                                       {"mmhg", 2666.44774}})
    EXPECT_NEAR(read(std::string("altitude_km,temperature_k,direction_deg,speed_m_s,pressure_") + unit,
                     "2,280,0,0,20", "pressure_pa"),
                pressure, 1e-2)
        << unit;
  for (const auto& [unit, kelvin] : {std::pair("k", 250.0), {"c", 523.15}, {"f", 394.2611}})
    EXPECT_NEAR(1e4 / kAirGasConstant_j_kg_k /
                    read(std::string("altitude_km,pressure_hpa,direction_deg,speed_m_s,temperature_") + unit,
                         "2,100,0,0,250", "density_kg_m3"),
                kelvin, 1e-3)
        << unit;
  EXPECT_NEAR(
      read("altitude_km,pressure_hpa,direction_deg,speed_m_s,density_g_m3", "2,100,0,0,250", "density_kg_m3"),
      0.25, 1e-9);
  EXPECT_NEAR(read("geopotential_height (km),u (kt),v (kt)", "20,0,9", "altitude_m"),
              GeometricHeight(20000.0, 45 * kRadPerDeg), 1e-3);
  EXPECT_NEAR(read("altitude_ft,north_kt,east_kt", "2,9,-9", "east_m_s"), -4.63, 1e-3);
}

// Names of an archive's columns do not make a fixed table of one with commas.
TEST(ConvertSounding, OfCommasWithTheNamesOfWyoming) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "s.csv").string();
  std::ofstream(file)
      << "PRES (hPa),HGHT (m),TEMP (C),DRCT (degree),SKNT (knot)\n1000,100,15,90,10\n850,1500,5,90,20\n";
  const Converted table = Convert(file);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.At(1, "pressure_pa"), 85000.0);
  ExpectWind(table, 1, 20.0 * kKnot, 90.0);
}

// Codes for "missing", and the same numbers where they are values.
TEST(ConvertSounding, MissingValues) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "s.csv").string();
  const auto convert = [&](const std::string& level) {
    std::ofstream(file) << "altitude_m,direction_deg,speed_m_s,pressure_hpa,temperature_c\n0,90,10,1013,15\n"
                        << level << "\n20000,90,30,55,-56\n";
    return Convert(file);
  };
  for (const char* code :
       {"", "//", "/////", "-", "NaN", "M", "-9999", "-8888", "-999.9", "999.9", "9999", "9999.9", "99999"}) {
    const Converted table = convert("10000,90," + std::string(code) + ",264,-50");
    ASSERT_EQ(table.rows.size(), 3u) << code;
    EXPECT_EQ(table.At(1, "east_m_s"), -20.0) << code;
    EXPECT_EQ(table.At(1, "pressure_pa"), 26400.0) << code;
  }
  EXPECT_EQ(convert("110,90,20,999.9,14").At(1, "pressure_pa"), 99990.0);
  EXPECT_EQ(convert("9999,90,22,264,-50").At(1, "altitude_m"), 9999.0);
  EXPECT_NEAR(convert("10000,90,22,264,99").At(1, "density_kg_m3"),
              26400.0 / (kAirGasConstant_j_kg_k * 372.15), 1e-7);
  // A calm needs no direction. A direction without speed is no wind.
  EXPECT_EQ(convert("10000,//,0,264,-50").At(1, "east_m_s"), 0.0);
  EXPECT_EQ(convert("10000,90,//,264,-50").At(1, "east_m_s"), -20.0);
}

// Humidity as its part of saturation, and as dew point.
TEST(ConvertSounding, HumidityIsOfWater) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "s.csv").string();
  const auto density = [&](const std::string& name, const std::string& value) {
    std::ofstream(file) << "altitude_m,direction_deg,speed_m_s,pressure_hpa,temperature_c," << name
                        << "\n0,0,0,1000,30," << value << "\n5000,0,0,540,-10," << value << "\n";
    return Convert(file).At(0, "density_kg_m3");
  };
  const double dry = 1e5 / (kAirGasConstant_j_kg_k * 303.15);
  EXPECT_NEAR(density("rh_%", "//") / dry, 1.0, 1e-7);
  EXPECT_NEAR(density("rh_%", "50") / dry, 1.0 - 0.378 * 0.5 * 4243.0 / 1e5, 1e-5);
  EXPECT_NEAR(density("dew_point_c", "30") / dry, 1.0 - 0.378 * 4243.0 / 1e5, 2e-5);
}

TEST(IsSoundingTable, OurOwnTablesAreNone) {
  const auto is_one = [](const char* header) {
    std::vector<InputProblem> problems;
    return IsSoundingTable(ParseCsv(std::string(header) + "\n", "f", problems));
  };
  EXPECT_FALSE(is_one("altitude_m,north_m_s,east_m_s"));
  EXPECT_FALSE(is_one("altitude_km,north_m_s,east_m_s,temperature_k,pressure_hpa"));
  EXPECT_FALSE(is_one("altitude_m,mean_north_m_s,mean_east_m_s,sigma_north_m_s,sigma_east_m_s"));
  EXPECT_FALSE(is_one("time_s,thrust_n"));
  EXPECT_TRUE(is_one("altitude_m,speed_m_s,direction_deg"));
  EXPECT_TRUE(is_one("altitude_m,north_m_s,east_m_s,temperature_c,pressure_hpa"));
  EXPECT_TRUE(is_one("geopotential_height_m,north_m_s,east_m_s"));
  EXPECT_TRUE(is_one("altitude_m,north_kt,east_kt"));
}

}  // namespace dispersa::campaign_yaml_sounding_test
