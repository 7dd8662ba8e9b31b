// The coordinates of the search for each distribution: a value has the same tail probability as the standard
// normal coordinate.
#include "core/search/dispersion_space.h"

#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/distributions.h"

namespace dispersa::search_dispersion_space_test {

double Below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

using namespace made_up;

/// The wind's altitude, fed by this law, where the coordinate is z.
double ValueAt(const ScalarDistribution& distribution, double z, bool absolute = false) {
  Campaign campaign;
  campaign.dispersions = {Of("w", distribution, "wind_altitude_m", absolute)};
  const DispersionSpace space(campaign);
  return space.Inputs({{z}})[0].air.wind_altitude_m;
}

struct Law {
  const char* name;
  ScalarDistribution distribution;
  std::function<double(double)> below;  ///< its distribution function
};

TEST(DispersionSpace, AValueIsAsFarOutAsItsCoordinate) {
  const double from = Below(-1.0), to = Below(0.5);
  const std::vector<Law> laws = {
      {"normal", Normal(3.0, 2.0), [](double x) { return Below((x - 3.0) / 2.0); }},
      {"lognormal", LogNormal(2.0, 0.5), [](double x) { return Below(std::log(x / 2.0) / 0.5); }},
      {"uniform", Uniform(2.0, 5.0), [](double x) { return (x - 2.0) / 3.0; }},
      {"triangular", Triangular(0.0, 1.0, 4.0),
       [](double x) { return x < 1.0 ? x * x / 4.0 : 1.0 - (4.0 - x) * (4.0 - x) / 12.0; }},
      {"truncated", TruncatedNormal(3.0, 2.0, 1.0, 4.0),
       [=](double x) { return (Below((x - 3.0) / 2.0) - from) / (to - from); }},
      {"empirical", Empirical({0.0, 1.0, 11.0}),
       [](double x) { return x < 1.0 ? 0.5 * x : 0.5 + (x - 1.0) / 20.0; }}};
  for (const Law& law : laws)
    for (const double z : {-3.0, -1.0, -0.2, 0.0, 0.7, 2.5})
      EXPECT_NEAR(law.below(ValueAt(law.distribution, z)), Below(z), 1e-9) << law.name << " at " << z;
}

// A Rayleigh's value has one tail: it is exceeded as rarely as |z| is, whichever side z is on.
TEST(DispersionSpace, ARayleighIsExceededAsRarelyAsTheSizeOfItsCoordinate) {
  const ScalarDistribution rayleigh = Rayleigh(3.0);
  for (const double z : {0.5, 1.0, 3.0, 6.0}) {
    const double value = ValueAt(rayleigh, z);
    EXPECT_NEAR(std::exp(-value * value / 18.0) / (2.0 * Below(-z)), 1.0, 1e-6) << z;
    EXPECT_EQ(ValueAt(rayleigh, -z), value);
  }
}

TEST(DispersionSpace, WhatIsNotDrawnByAQuantileIsHeld) {
  for (const double z : {-2.0, 0.0, 2.0}) {
    EXPECT_EQ(ValueAt(TwoPoint(5.0, 4.0, 9.0), z), 5.0);
    EXPECT_EQ(ValueAt(Values({1.0, 2.0, 4.0}), z), 2.0);
    EXPECT_EQ(ValueAt({.kind = Distribution::kConstant, .nominal = 7.0, .values = {7.0}}, z), 7.0);
  }
}

TEST(DispersionSpace, AMagnitudeHasNoSign) {
  const ScalarDistribution normal = Normal(0.0, 2.0);
  EXPECT_EQ(ValueAt(normal, -1.5, true), 3.0);
  Campaign campaign;
  campaign.dispersions = {Of("w", normal, "wind_altitude_m", true)};
  EXPECT_EQ(DispersionSpace(campaign).Value(0, {-1.5}), 3.0);  // what a search tells of the point
}

TEST(DispersionSpace, OnlyAFullTurnIsADirection) {
  Campaign campaign;
  campaign.dispersions = {Of("turn", Uniform(-kPi, kPi), "wind_azimuth_deg"),
                          Of("half", Uniform(0.0, kPi), "wind_azimuth_deg"),
                          Of("two", TwoPoint(0.0, 0.0, 1.0), "drag_factor")};
  const DispersionSpace space(campaign);
  const auto& coordinates = space.coordinates();
  EXPECT_EQ(coordinates[0].kind, CoordinateKind::kDirection);
  EXPECT_EQ(coordinates[1].kind, CoordinateKind::kNormal);
  EXPECT_EQ(coordinates[2].kind, CoordinateKind::kHeld);
}

// Correlated normals: the second stands 0.6 with the first and 0.8 alone.
TEST(DispersionSpace, CorrelatedCoordinatesAreMixedByTheirWeights) {
  Campaign campaign;
  const ScalarDistribution normal = Normal(10.0, 2.0);
  campaign.dispersions = {Of("a", normal, "wind_altitude_m"), Of("b", normal, "wind_width_m")};
  campaign.dispersions[1].mix = {{0, 0.6}, {1, 0.8}};
  const FlightInputs inputs = DispersionSpace(campaign).Inputs({{1.0, -3.0}})[0];
  EXPECT_DOUBLE_EQ(inputs.air.wind_altitude_m, 12.0);
  EXPECT_DOUBLE_EQ(inputs.air.wind_width_m, 10.0 + 2.0 * (0.6 - 2.4));
}

}  // namespace dispersa::search_dispersion_space_test
