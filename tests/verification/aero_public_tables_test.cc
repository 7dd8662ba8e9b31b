// The component build-up against public tables of other launchers (tests/data/aero/SOURCE.md), on the body of
// tests/public_launcher.h. The geometry is partly inferred, so two estimates of two similar bodies are
// compared, in shape and size. The bands are 35 %. Handbook methods claim 10 to 20 % each, and the geometry
// takes the rest (0.3 m of fairing nose change CA by 20 %).
#include "core/math/constants.h"
#include "core/math/table.h"
#include "tests/public_launcher.h"
#include "tests/test.h"

namespace dispersa::aero_public_tables_test {
namespace {

std::vector<PublicAeroRow> Read(const std::string& name, const std::string& kind = "") {
  return ReadPublicAero(DISPERSA_TEST_DATA "/aero", name, kind);
}

class PublicLauncher : public testing::Test {
 protected:
  double At(const std::vector<double>& values, double mach, double incidence_deg) const {
    return Table2D{table_.mach, table_.incidence_rad, values}(mach, incidence_deg * kRadPerDeg);
  }

  const AeroTable table_ = PublicLauncherBuildUp();
  const std::vector<PublicAeroRow> public_ = Read("slv_cadac_derived_stability.csv", "slv3");
};

TEST_F(PublicLauncher, ReferenceAreaIsThePublicOne) {
  EXPECT_NEAR(table_.reference_area_m2, 3.243, 5e-4);  // as printed
  ASSERT_EQ(public_.size(), 17u);
}

TEST_F(PublicLauncher, AxialForceHasThePublicSizeAtEveryMachNumber) {
  for (const PublicAeroRow& row : public_) {
    const double expected = row.at("CA0_power_on");
    EXPECT_NEAR(At(table_.ca, row.at("mach"), 0.0), expected, 0.35 * expected) << row.at("mach");
  }
}

TEST_F(PublicLauncher, AxialForcePeaksWhereThePublicOneDoes) {
  double peak = 0.0;
  double peak_mach = 0.0;
  for (double mach = 0.0; mach <= 5.0; mach += 0.01) {
    const double ca = At(table_.ca, mach, 0.0);
    if (ca > peak) {
      peak = ca;
      peak_mach = mach;
    }
  }
  // The public peak is at the node 1.2, between 1.05 and 1.6.
  EXPECT_GT(peak_mach, 1.05);
  EXPECT_LT(peak_mach, 1.6);
  const double rise = 1.027 / 0.2364;  // of the public table, Mach 1.2 over 0.6, power on
  EXPECT_NEAR(peak / At(table_.ca, 0.6, 0.0), rise, 0.35 * rise);
  const double decay = 1.027 / 0.3655;  // Mach 1.2 over 20
  EXPECT_NEAR(peak / At(table_.ca, 20.0, 0.0), decay, 0.35 * decay);
}

TEST_F(PublicLauncher, NormalForceSlopeHasThePublicSizeAtEveryMachNumber) {
  for (const PublicAeroRow& row : public_) {
    const double expected = row.at("CN_alpha_per_rad_0_2deg");
    const double ours = At(table_.cn, row.at("mach"), 2.0) / (2.0 * kRadPerDeg);
    EXPECT_NEAR(ours, expected, 0.35 * expected) << row.at("mach");
  }
}

TEST_F(PublicLauncher, CentreOfPressureIsWithinAnEighthOfTheLength) {
  // An eighth, 2.1 m, is one diameter: the public values themselves move by 1.4 m with Mach number.
  // Subsonically, where both are slender-body theory with cross-flow, within 0.25 m.
  for (const PublicAeroRow& row : public_) {
    const double ours_m = At(table_.xcp_station_m, row.at("mach"), 2.0);
    const double tolerance_m = row.at("mach") <= 0.8 ? 0.25 : kPublicLauncherLength_m / 8.0;
    EXPECT_NEAR(ours_m, row.at("xcp_from_nose_m"), tolerance_m) << row.at("mach");
  }
}

TEST_F(PublicLauncher, NormalForceGrowsWithIncidenceAsThePublicOne) {
  // To 30 degrees, where cross-flow is most of it.
  const std::vector<PublicAeroRow> rows = Read("slv_cadac_normal_force.csv");
  ASSERT_EQ(rows.size(), 187u);
  for (const PublicAeroRow& row : rows) {
    const double expected = row.at("cn");
    EXPECT_NEAR(At(table_.cn, row.at("mach"), row.at("alpha_deg")), expected, 0.35 * expected)
        << row.at("mach") << " " << row.at("alpha_deg");
  }
}

TEST(PublicTwoStageRocket, DragGrowsWithLiftAsItsDoes) {
  // CD - CD0 over CL tan(a) is 1 where the normal force tilts and the axial force stays. NESC's rocket has
  // 0.95 to 1.21 from 4 degrees (below, its two digits leave nothing of the difference).
  const AeroTable table = PublicLauncherBuildUp();
  const auto at = [&](const std::vector<double>& values, double incidence_rad) {
    return Table2D{table.mach, table.incidence_rad, values}(3.0, incidence_rad);
  };
  int compared = 0;
  for (const PublicAeroRow& row : Read("nesc_twostage_v2_mach3.csv")) {
    const double a = row.at("alpha_deg") * kRadPerDeg;
    if (row.at("alpha_deg") < 4.0) continue;
    const double lift = at(table.cn, a) * std::cos(a) - at(table.ca, a) * std::sin(a);
    const double drag = at(table.ca, a) * std::cos(a) + at(table.cn, a) * std::sin(a);
    const double ours = (drag - at(table.ca, 0.0)) / (lift * std::tan(a));
    const double theirs = (row.at("CD") - 0.21) / (row.at("CL") * std::tan(a));
    EXPECT_NEAR(ours, theirs, 0.35 * theirs) << row.at("alpha_deg");
    ++compared;
  }
  EXPECT_EQ(compared, 4);
}

}  // namespace
}  // namespace dispersa::aero_public_tables_test
