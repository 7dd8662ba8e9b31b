// Verifies atmosphere, gravitation, geodesy and rotation against NASA's 6DOF check cases
// (NASA/TM-2015-218675): the environment that each simulator reports along its flight.
#include "core/environment/atmosphere.h"
#include "core/environment/earth.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::nesc_environment_test {
namespace {

constexpr double kFoot = 0.3048;
// The sphere of case 5: what all three simulators flew, position minus altitude at the start. The report
// prints 20902255.199 ft, which is 0.204 m more.
constexpr double kSphereRadius_m = 6371007.1809;
constexpr double kSlugPerCubicFoot = 14.5939029 / (kFoot * kFoot * kFoot);
constexpr double kPoundPerSquareFoot = 4.4482216 / (kFoot * kFoot);
constexpr double kRankine = 1.0 / 1.8;

using Row = std::map<std::string, double>;

std::vector<Row> Read(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + path);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    Row& row = rows.emplace_back();
    // sim_05 holds a column twice; the values are the same.
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      row[name] = std::stod(cell);
    }
  }
  return rows;
}

double Relative(double actual, double expected) { return std::fabs(actual / expected - 1.0); }

// Parameters: check case and simulator, as in the files' names.
class CheckCase : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  std::string case_ = std::get<0>(GetParam());
  std::vector<Row> rows_ =
      Read(DISPERSA_TEST_DATA "/nesc/Atmos_" + case_ + "_sim_" + std::get<1>(GetParam()) + ".csv");
  Earth earth_ = case_ == "05" ? SphericalEarth(kSphereRadius_m, true) : Wgs84();
};

// The simulators differ among themselves by 2e-5 in density, 2.1e-5 in pressure and 1.8e-6 in speed of
// sound at the same altitude, for they round the constants of the standard differently.
TEST_P(CheckCase, Atmosphere) {
  ASSERT_EQ(rows_.size(), 31u);
  for (const Row& row : rows_) {
    const double altitude_m = row.at("altitudeMsl_ft") * kFoot;
    const AirState air = StandardAtmosphere1976(altitude_m);
    EXPECT_LT(Relative(air.temperature_k, row.at("ambientTemperature_dgR") * kRankine), 1e-8) << altitude_m;
    EXPECT_LT(Relative(air.pressure_pa, row.at("ambientPressure_lbf_ft2") * kPoundPerSquareFoot), 2.1e-5)
        << altitude_m;
    EXPECT_LT(Relative(air.density_kg_m3, row.at("airDensity_slug_ft3") * kSlugPerCubicFoot), 2.1e-5)
        << altitude_m;
    EXPECT_LT(Relative(air.speed_of_sound_m_s, row.at("speedOfSound_ft_s") * kFoot), 2e-6) << altitude_m;
  }
}

// Twelve digits printed.
TEST_P(CheckCase, Gravitation) {
  for (const Row& row : rows_) {
    const Vector3 p_EoP(row.at("eiPosition_ft_X") * kFoot, row.at("eiPosition_ft_Y") * kFoot,
                        row.at("eiPosition_ft_Z") * kFoot);
    EXPECT_LT(Relative(Gravitation(earth_, p_EoP).norm(), row.at("localGravity_ft_s2") * kFoot), 1e-11);
  }
}

// Inertial position and time give altitude, latitude and longitude. Simulator 4 prints positions to 1e-4 ft,
// half of which is 1.5e-5 m and, on the Earth's radius, 2.4e-12 rad.
TEST_P(CheckCase, Geodesy) {
  for (const Row& row : rows_) {
    const Vector3 p_EoP_I(row.at("eiPosition_ft_X") * kFoot, row.at("eiPosition_ft_Y") * kFoot,
                          row.at("eiPosition_ft_Z") * kFoot);
    const Geodetic place = ToGeodetic(earth_, InertialToEarth(earth_, row.at("time"), p_EoP_I));
    EXPECT_NEAR(place.altitude_m, row.at("altitudeMsl_ft") * kFoot, 2e-5);
    EXPECT_NEAR(place.longitude_rad, row.at("longitude_deg") * kRadPerDeg, 3e-12);
    EXPECT_NEAR(place.latitude_rad, row.at("latitude_deg") * kRadPerDeg, 3e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Nesc, CheckCase,
                         ::testing::Combine(::testing::Values("01", "02", "03", "05", "07", "09"),
                                            ::testing::Values("04", "05", "06")),
                         [](const auto& test) {
                           return "case_" + std::get<0>(test.param) + "_sim_" + std::get<1>(test.param);
                         });

}  // namespace
}  // namespace dispersa::nesc_environment_test
