// Turbulence in flight: the field of a case, and the independence of its three components.
#include "core/environment/turbulence.h"
#include "core/flight/flight_model.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_turbulence_test {
namespace {

constexpr double kSine = 0.8, kCosine = 0.6, kAzimuth_rad = 0.5;
constexpr double kTop_m = 3000.0;

FlightModel RoughModel(std::uint64_t seed = 11) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "pd");
  definition.noise_seed = seed;
  definition.turbulence_path =
      std::make_shared<const TurbulencePath>(ClimbPath{{0.0, kTop_m}, {kSine, kSine}, kAzimuth_rad});
  return FlightModel(definition);
}
FlightInputs Rough() {
  FlightInputs inputs;
  inputs.air.turbulence_exceedance = 1e-3;
  inputs.air.turbulence_wind_20ft_m_s = 15.0;
  return inputs;
}
TurbulenceField FieldOf(const FlightModel& model, const FlightInputs& inputs, std::uint64_t case_index) {
  return *model.PlantFor(inputs, case_index).environment.turbulence;
}

// At a node: along the path, across it (to the right of its plane), and normal to both; over their
// deviations.
std::array<double, 3> Components(const TurbulenceField& field, std::size_t node) {
  const double c = std::cos(kAzimuth_rad), s = std::sin(kAzimuth_rad);
  const double downrange = c * field.north_m_s[node] + s * field.east_m_s[node];
  const double across = c * field.east_m_s[node] - s * field.north_m_s[node], up = field.up_m_s[node];
  const TurbulenceScales scales = TurbulenceAt({1e-3, 15.0, 1.0}, 0.0, field.altitude_m[node]);
  return {(kCosine * downrange + kSine * up) / scales.sigma_vertical_m_s,
          across / scales.sigma_horizontal_m_s,
          (kCosine * up - kSine * downrange) / scales.sigma_horizontal_m_s};
}

// Products of independent standard normals have the deviation 1, their mean over 2000 cases 0.022, and the
// mean square 0.032: 5 of each are asked.
TEST(FlightTurbulence, ComponentsAreIndependentWithinACaseAndOfDeviationOne) {
  const FlightModel model = RoughModel();
  const FlightInputs inputs = Rough();
  constexpr int kCases = 2000;
  const std::size_t nodes[] = {0, 1, 7};
  double product[3][3][3] = {};
  for (std::uint64_t k = 0; k < kCases; ++k) {
    const TurbulenceField field = FieldOf(model, inputs, k);
    for (std::size_t n = 0; n < 3; ++n) {
      const std::array<double, 3> x = Components(field, nodes[n]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) product[n][i][j] += x[i] * x[j] / kCases;
    }
  }
  for (std::size_t n = 0; n < 3; ++n)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(product[n][i][j], i == j ? 1.0 : 0.0, i == j ? 0.16 : 0.11) << nodes[n] << " " << i << j;
}

// Across at one node and along at others: equal streams in another order would show here.
TEST(FlightTurbulence, ComponentsAreIndependentFromNodeToNode) {
  const FlightModel model = RoughModel();
  constexpr int kCases = 2000;
  double product[4][4][3] = {};
  for (std::uint64_t k = 0; k < kCases; ++k) {
    const TurbulenceField field = FieldOf(model, Rough(), k);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const std::array<double, 3> x = Components(field, a), y = Components(field, b);
        for (std::size_t i = 0; i < 3; ++i) product[a][b][i] += x[i] * y[(i + 1) % 3] / kCases;
      }
    }
  }
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(product[a][b][i], 0.0, 0.11) << a << b << i;
}

TEST(FlightTurbulence, FollowsFromSeedAndCaseAlone) {
  const TurbulenceField field = FieldOf(RoughModel(), Rough(), 3);
  FlightInputs others = Table3Inputs();
  others.air.turbulence_exceedance = Rough().air.turbulence_exceedance;
  others.air.turbulence_wind_20ft_m_s = Rough().air.turbulence_wind_20ft_m_s;
  EXPECT_EQ(FieldOf(RoughModel(), others, 3).up_m_s, field.up_m_s);
  EXPECT_NE(FieldOf(RoughModel(), Rough(), 4).up_m_s, field.up_m_s);
  EXPECT_NE(FieldOf(RoughModel(12), Rough(), 3).up_m_s, field.up_m_s);
}

TEST(FlightTurbulence, IsScaledAndLeftOutAsTheInputsSay) {
  const FlightModel model = RoughModel();
  FlightInputs inputs = Rough();
  const TurbulenceField field = FieldOf(model, inputs, 3);
  inputs.air.turbulence_scale = 2.0;  // exact in binary
  const TurbulenceField twice = FieldOf(model, inputs, 3);
  for (std::size_t node = 0; node < field.altitude_m.size(); ++node) {
    ASSERT_EQ(twice.north_m_s[node], 2.0 * field.north_m_s[node]);
    ASSERT_EQ(twice.up_m_s[node], 2.0 * field.up_m_s[node]);
  }
  inputs.air.turbulence_exceedance = 0.0;
  EXPECT_EQ(model.PlantFor(inputs, 3).environment.turbulence, nullptr);
  EXPECT_EQ(model.PlantFor(Rough()).environment.turbulence, nullptr) << "no case, no draws";
}

}  // namespace
}  // namespace dispersa::flight_turbulence_test
