#include "core/environment/wind_statistics.h"
#include "tests/test.h"

namespace dispersa::environment_wind_statistics_test {

WindStatistics Example() {
  return {.altitude_m = {0.0, 1000.0, 4000.0},
          .mean_north_m_s = {1.0, 2.0, -3.0},
          .mean_east_m_s = {5.0, 10.0, 20.0},
          .sigma_north_m_s = {2.0, 3.0, 4.0},
          .sigma_east_m_s = {4.0, 6.0, 8.0},
          .correlation_ne = 0.6,
          .correlation_length_m = 2000.0};
}

struct Profile {
  std::vector<double> north_m_s, east_m_s;
};

// By the weights, as a campaign draws the levels.
Profile DrawWind(const WindStatistics& s, const std::vector<double>& normals) {
  const std::vector<std::vector<double>> weights = WindWeights(s);
  const auto sum = [&](const std::vector<double>& row) {
    double z = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i) z += row[i] * normals[i];
    return z;
  };
  Profile profile;
  for (std::size_t k = 0; k < s.altitude_m.size(); ++k) {
    profile.north_m_s.push_back(s.mean_north_m_s[k] + s.sigma_north_m_s[k] * sum(weights[2 * k]));
    profile.east_m_s.push_back(s.mean_east_m_s[k] + s.sigma_east_m_s[k] * sum(weights[2 * k + 1]));
  }
  return profile;
}

// A unit normal in the lowest north component, by hand: it reaches east by the correlation and decays
// upward by exp(-dh / 2000 m).
TEST(WindWeights, FollowsTheAutoregression) {
  const Profile table = DrawWind(Example(), {1.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  const double first = std::exp(-0.5);
  const double second = std::exp(-2.0);
  const double rounding = 1e-14;
  EXPECT_NEAR(table.north_m_s[0], 1.0 + 2.0, rounding);
  EXPECT_NEAR(table.north_m_s[1], 2.0 + 3.0 * first, rounding);
  EXPECT_NEAR(table.north_m_s[2], -3.0 + 4.0 * second, rounding);
  EXPECT_NEAR(table.east_m_s[0], 5.0 + 4.0 * 0.6, rounding);
  EXPECT_NEAR(table.east_m_s[1], 10.0 + 6.0 * 0.6 * first, rounding);
  EXPECT_NEAR(table.east_m_s[2], 20.0 + 8.0 * 0.6 * second, rounding);
  const Profile own = DrawWind(Example(), {0.0, 1.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_NEAR(own.north_m_s[0], 1.0, rounding);
  EXPECT_NEAR(own.east_m_s[0], 5.0 + 4.0 * 0.8, rounding);
}

// So each component has the stated deviation.
TEST(WindWeights, AreRowsOfUnitLength) {
  for (const std::vector<double>& row : WindWeights(Example())) {
    double squares = 0.0;
    for (const double weight : row) squares += weight * weight;
    EXPECT_NEAR(squares, 1.0, 1e-14);
  }
}

// 40000 profiles of a fixed seed: a mean scatters by sigma / 200, a second moment by about sigma² / 140;
// five of those.
TEST(WindWeights, HasTheGivenMoments) {
  const WindStatistics statistics = Example();
  constexpr int kProfiles = 40000;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  double mean = 0.0, north2 = 0.0, east2 = 0.0, cross = 0.0, levels = 0.0;
  for (int i = 0; i < kProfiles; ++i) {
    std::vector<double> normals(2 * statistics.altitude_m.size());
    for (double& value : normals) value = normal(generator);
    const Profile table = DrawWind(statistics, normals);
    const double north = (table.north_m_s[2] + 3.0) / 4.0;
    const double east = (table.east_m_s[2] - 20.0) / 8.0;
    mean += east / kProfiles;
    north2 += north * north / kProfiles;
    east2 += east * east / kProfiles;
    cross += north * east / kProfiles;
    levels += east * (table.east_m_s[1] - 10.0) / 6.0 / kProfiles;
  }
  EXPECT_NEAR(mean, 0.0, 0.025);
  EXPECT_NEAR(north2, 1.0, 0.036);
  EXPECT_NEAR(east2, 1.0, 0.036);
  EXPECT_NEAR(cross, 0.6, 0.036);
  EXPECT_NEAR(levels, std::exp(-1.5), 0.036);
}

}  // namespace dispersa::environment_wind_statistics_test
