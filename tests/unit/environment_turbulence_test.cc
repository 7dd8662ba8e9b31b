// Turbulence: figure 7 as published, numbers of the low-altitude model, and spectra of realisations.
#include "core/environment/turbulence.h"

#include "core/dynamics/air_data.h"
#include "core/environment/surroundings.h"
#include "core/environment/weather_profile.h"
#include "core/environment/wind.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::environment_turbulence_test {

constexpr double kFoot_m = 0.3048;

std::vector<std::vector<std::string>> Csv(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(Turbulence, IntensitiesAreThoseOfTheFigure) {
  const auto rows = Csv(DISPERSA_TEST_DATA "/wind/mil_f_8785c_turbulence_intensity.csv");
  ASSERT_EQ(rows.size(), 8u);
  const double exceedances[] = {2e-1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  int read = 0;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    for (std::size_t c = 1; c < rows[0].size(); ++c, ++read) {
      const double altitude_m = std::stod(rows[0][c]) * kFoot_m;  // "500ft"
      EXPECT_NEAR(TurbulenceIntensity(exceedances[r - 1], altitude_m), std::stod(rows[r][c]) * kFoot_m,
                  1e-12);
    }
  }
  EXPECT_EQ(read, 84);
  // Between curves by the logarithm, between altitudes linear, outside the end.
  EXPECT_NEAR(TurbulenceIntensity(std::pow(10.0, -3.5), 7500.0 * kFoot_m), 12.6 * kFoot_m, 1e-12);
  EXPECT_NEAR(TurbulenceIntensity(1e-5, 20000.0 * kFoot_m), 21.05 * kFoot_m, 1e-12);
  EXPECT_NEAR(TurbulenceIntensity(1e-9, 0.0), 18.7 * kFoot_m, 1e-12);
}

TEST(Turbulence, LowAltitudeModel) {
  const TurbulenceStrength moderate{1e-3, 30.0 * 1852.0 / 3600.0, 1.0};
  // At 1000 ft all are one: 0.177 + 0.823 = 1.
  TurbulenceScales s = TurbulenceAt(moderate, 100.0, 100.0 + 1000.0 * kFoot_m);
  EXPECT_NEAR(s.sigma_vertical_m_s, 3.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_NEAR(s.sigma_horizontal_m_s, s.sigma_vertical_m_s, 1e-12);
  EXPECT_NEAR(s.length_horizontal_m, 304.8, 1e-9);
  EXPECT_NEAR(s.length_vertical_m, 304.8, 1e-9);
  // At 100 ft: shape 0.2593.
  s = TurbulenceAt(moderate, 100.0, 100.0 + 100.0 * kFoot_m);
  EXPECT_NEAR(s.sigma_horizontal_m_s, 3.0 * 1852.0 / 3600.0 / std::pow(0.2593, 0.4), 1e-12);
  EXPECT_NEAR(s.length_horizontal_m, 30.48 / std::pow(0.2593, 1.2), 1e-9);
  EXPECT_NEAR(s.length_vertical_m, 30.48, 1e-9);
  // Halfway to 2000 ft the mean of both models: figure 7 at 2000 ft over a ground at sea level.
  s = TurbulenceAt(moderate, 0.0, 1500.0 * kFoot_m);
  const double figure = (9.6 + (10.6 - 9.6) * 250.0 / 2000.0) * kFoot_m;
  EXPECT_NEAR(s.sigma_vertical_m_s, 0.5 * (3.0 * 1852.0 / 3600.0 + figure), 1e-12);
  EXPECT_NEAR(s.length_vertical_m, 1375.0 * kFoot_m, 1e-9);
  // Above the figure's top it fades.
  s = TurbulenceAt({1e-5, 10.0, 2.0}, 0.0, 80000.0 * kFoot_m + 0.25 * kWindFade_m);
  EXPECT_NEAR(s.sigma_vertical_m_s, 2.0 * 0.75 * 5.1 * kFoot_m, 1e-12);
  EXPECT_EQ(TurbulenceAt({1e-5, 10.0, 2.0}, 0.0, 80000.0 * kFoot_m + kWindFade_m).sigma_horizontal_m_s, 0.0);
}

// Fields along a vertical path, or one at 30° over the horizon, in a plane to the north-east.
TurbulenceField Drawn(std::uint64_t index, double sine, double top_m = 9000.0) {
  const TurbulencePath path({{0.0, 50e3}, {sine, sine}, 0.25 * kPi});
  Stream along(7, index, "along"), across(7, index, "across"), normal(7, index, "normal");
  TurbulenceField field = DrawTurbulence(
      {1e-3, 10.0, 1.0}, path,
      {[&] { return along.Normal(); }, [&] { return across.Normal(); }, [&] { return normal.Normal(); }});
  while (field.altitude_m.back() > top_m)
    for (auto* values : {&field.altitude_m, &field.north_m_s, &field.east_m_s, &field.up_m_s})
      values->pop_back();
  return field;
}

// The turbulence of a vehicle that climbs at constant speed between 700 and 9000 m: components along its
// path, over the local deviation, sampled in time as a flight does.
struct Met {
  std::vector<double> along, across, normal;
};
Met Fly(const TurbulenceField& field, double sine, double speed_m_s, double step_s) {
  Met met;
  const double cosine = std::sqrt(1.0 - sine * sine), r = std::sqrt(0.5);
  for (double t = 0.0;; t += step_s) {
    const double h = 700.0 + sine * speed_m_s * t;
    if (h >= 8900.0) return met;
    const TurbulentWind w = Evaluate(field, h);
    const double sigma = TurbulenceIntensity(1e-3, h);
    const double down = r * (w.north_m_s + w.east_m_s), cross = r * (w.east_m_s - w.north_m_s);
    met.along.push_back((cosine * down + sine * w.up_m_s) / sigma);
    met.across.push_back(cross / sigma);
    met.normal.push_back((cosine * w.up_m_s - sine * down) / sigma);
  }
}

double Correlation(const std::vector<double>& x, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < x.size(); ++i) sum += x[i] * x[i - lag];
  return sum / static_cast<double>(x.size() - lag);
}

TEST(Turbulence, AFlightMeetsDrydensCorrelations) {
  // 300 fields of 8.2 km (vertical) or 16.4 km along the path, 15 and 30 lengths: a mean square of as many
  // independent values a field has a deviation near sqrt(2 / 4500) = 2 %, a correlation likewise; 4 of them
  // are asked.
  constexpr double kLength_m = 1750.0 * kFoot_m, kSpeed_m_s = 250.0, kStep_s = 0.05;
  for (const double sine : {1.0, 0.5}) {
    std::vector<double> along(40, 0.0), across(40, 0.0), normal(40, 0.0);
    constexpr int kFields = 300;
    for (std::uint64_t k = 0; k < kFields; ++k) {
      const Met met = Fly(Drawn(k, sine), sine, kSpeed_m_s, kStep_s);
      for (std::size_t lag = 0; lag < 40; ++lag) {
        along[lag] += Correlation(met.along, 4 * lag) / kFields;
        across[lag] += Correlation(met.across, 4 * lag) / kFields;
        normal[lag] += Correlation(met.normal, 4 * lag) / kFields;
      }
    }
    for (std::size_t lag = 0; lag < 40; ++lag) {
      const double d = kSpeed_m_s * kStep_s * 4.0 * static_cast<double>(lag) / kLength_m;
      EXPECT_NEAR(along[lag], std::exp(-d), 0.08) << sine << " " << d;
      EXPECT_NEAR(across[lag], std::exp(-d) * (1.0 - 0.5 * d), 0.08) << sine << " " << d;
      EXPECT_NEAR(normal[lag], std::exp(-d) * (1.0 - 0.5 * d), 0.08) << sine << " " << d;
    }
  }
}

TEST(Turbulence, AFlightMeetsDrydensSpectra) {
  constexpr double kLength_m = 1750.0 * kFoot_m, kSpeed_m_s = 400.0, kStep_s = 0.01;
  constexpr std::size_t kPoints = 2000;  // 20 s
  const double w0 = kTwoPi / (kPoints * kStep_s);
  const std::size_t bins[] = {3, 6, 12, 24, 48, 96};  // 0.15 to 4.8 Hz
  // Hann's window, whose mean square is 3/8: it keeps the steep flank from leaking into what is weak.
  const auto power = [&](const std::vector<double>& x, std::size_t bin) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < kPoints; ++i)
      sum += 0.5 * (1.0 - std::cos(kTwoPi * static_cast<double>(i) / kPoints)) * x[i] *
             std::polar(1.0, -kTwoPi * static_cast<double>(bin * i % kPoints) / kPoints);
    // One-sided density over angular frequency: 2 |X|² T / (2 pi n² 3/8).
    return 2.0 * std::norm(sum) * kStep_s / (kTwoPi * kPoints * 0.375);
  };
  for (const std::size_t centre : bins) {
    double along = 0.0, across = 0.0, expected_along = 0.0, expected_across = 0.0;
    for (std::size_t bin = centre - centre / 4; bin <= centre + centre / 4; ++bin) {
      const double k = w0 * static_cast<double>(bin) / kSpeed_m_s, lk2 = std::pow(kLength_m * k, 2);
      expected_along += 2.0 * kLength_m / kPi / (1.0 + lk2) / kSpeed_m_s;
      expected_across += kLength_m / kPi * (1.0 + 3.0 * lk2) / std::pow(1.0 + lk2, 2) / kSpeed_m_s;
    }
    const int fields = centre > 24 ? 40 : 200;  // many bins make up for few fields
    for (int f = 0; f < fields; ++f) {
      const Met met = Fly(Drawn(static_cast<std::uint64_t>(f), 1.0), 1.0, kSpeed_m_s, kStep_s);
      ASSERT_GE(met.along.size(), kPoints);
      for (std::size_t bin = centre - centre / 4; bin <= centre + centre / 4; ++bin) {
        along += power(met.along, bin) / fields;
        across += power(met.across, bin) / fields;
      }
    }
    // Periodograms are exponential: at least 200 independent ones a bin, 7 %, of which 3.5 are asked.
    // Straight lines between nodes 10.7 m apart take sinc^4 of half their wave: 10 % at the last.
    EXPECT_NEAR(along / expected_along, 1.0, 0.25) << centre;
    EXPECT_NEAR(across / expected_across, 1.0, 0.25) << centre;
  }
}

TEST(Turbulence, TheFieldIsWhatTheFlightsEquationsSee) {
  Environment environment;
  environment.wind.steady = {3.0, -2.0};
  environment.turbulence = std::make_shared<const TurbulenceField>(Drawn(3, 0.8));
  const FlightWeather weather =
      PrepareWeather(environment.wind, environment.density, {}, environment.turbulence.get());
  lanes::FlownWeather<double> lane{};
  lane.density_factor = 1.0;
  lane.jet_inverse_width = lane.gust_inverse_length = 1.0;
  lane.profile[0] = &weather.profile;
  lane.has_profiles = lane.has_updrafts = true;
  for (const double altitude_m : {-10.0, 0.5, 77.0, 1234.5, 8000.0, 9500.0}) {
    const Vector3 p = (6378137.0 + altitude_m) * Vector3(std::cos(0.4), std::sin(0.4), 0.0);
    const AirData air = ComputeAirData(environment, p, Vector3::Zero());
    const auto seen = lanes::SurroundingsAt(environment.earth, lane, {p.x(), p.y(), p.z()});
    const double omega = environment.earth.rotation_rate_rad_s;
    // 1e-9: slopes are kept as constant and slope, at altitudes of 1e4 m with slopes of 0.1 1/s.
    EXPECT_NEAR(air.v_AP_I.x(), omega * p.y() - seen.wind_m_s.x, 1e-9) << altitude_m;
    EXPECT_NEAR(air.v_AP_I.y(), -omega * p.x() - seen.wind_m_s.y, 1e-9) << altitude_m;
    EXPECT_NEAR(air.v_AP_I.z(), -seen.wind_m_s.z, 1e-9) << altitude_m;
    EXPECT_EQ(air.airspeed_m_s, air.v_AP_I.norm()) << "gusts count in the airspeed";
    EXPECT_EQ(air.mach, air.airspeed_m_s / air.speed_of_sound_m_s);
    EXPECT_DOUBLE_EQ(air.qbar_pa, 0.5 * air.density_kg_m3 * air.airspeed_m_s * air.airspeed_m_s);
  }
}

// Of three streams each blows along a direction of its own: the path's, level across it, and the third.
TEST(Turbulence, EachStreamBlowsInItsOwnDirection) {
  constexpr double kSine = 0.8, kCosine = 0.6, kAzimuth = 0.3;
  const TurbulencePath path({{0.0, 50e3}, {kSine, kSine}, kAzimuth});
  const Vector3 down_range(std::cos(kAzimuth), std::sin(kAzimuth), 0.0),
      up(0.0, 0.0, 1.0);  // north, east, up
  const Vector3 directions[3] = {kCosine * down_range + kSine * up,
                                 Vector3(-std::sin(kAzimuth), std::cos(kAzimuth), 0.0),
                                 kCosine * up - kSine * down_range};
  for (int blowing = 0; blowing < 3; ++blowing) {
    Stream draws(7, 0, "one");
    const auto stream = [&](int which) {
      return [&draws, blows = which == blowing] { return blows ? draws.Normal() : 0.0; };
    };
    const TurbulenceField field = DrawTurbulence({1e-3, 10.0, 1.0}, path, {stream(0), stream(1), stream(2)});
    double strongest = 0.0;
    for (std::size_t i = 0; i < field.altitude_m.size(); ++i) {
      const Vector3 wind(field.north_m_s[i], field.east_m_s[i], field.up_m_s[i]);
      strongest = std::max(strongest, wind.norm());
      ASSERT_NEAR((wind - directions[blowing] * wind.dot(directions[blowing])).norm(), 0.0, 1e-12) << blowing;
    }
    EXPECT_GT(strongest, 1.0) << blowing;
  }
}

// The figure's altitudes are over the sea, the low model's heights over the ground: both meet over any
// ground.
TEST(Turbulence, ItsModelsMeetOverAHighGround) {
  for (const double ground_m : {0.0, 1800.0, 4000.0}) {
    const double meet_m = ground_m + 2000.0 * kFoot_m;
    const TurbulenceScales below = TurbulenceAt({1e-3, 12.0, 1.0}, ground_m, meet_m - 1e-6),
                           above = TurbulenceAt({1e-3, 12.0, 1.0}, ground_m, meet_m);
    // A micrometre of slopes of 0.01 1/s, and of 2 for the lengths.
    EXPECT_NEAR(below.sigma_horizontal_m_s, above.sigma_horizontal_m_s, 1e-7) << ground_m;
    EXPECT_NEAR(below.sigma_vertical_m_s, above.sigma_vertical_m_s, 1e-7) << ground_m;
    EXPECT_NEAR(below.length_horizontal_m, above.length_horizontal_m, 1e-5) << ground_m;
    EXPECT_NEAR(below.length_vertical_m, above.length_vertical_m, 1e-5) << ground_m;
  }
}

}  // namespace dispersa::environment_turbulence_test
