// Tables of aerodynamics, weather and masses in files: the forms that they may have, and what follows
// from them.
#include "core/campaign_yaml/load.h"
#include "core/environment/weather_table.h"
#include "core/input/number_text.h"
#include "core/math/constants.h"
#include "core/vehicle/drag.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_tables_test {
namespace {

// ---- aerodynamics ----

constexpr char kWhole[] =
    "mach,incidence_deg,ca,cn,xcp_station_m\n0.5,0,0.3,0,4\n0.5,10,0.3,0.5,4\n2,0,0.3,0,3\n2,10,0.3,0.6,3\n";

// The first stage's table has these keys, and stands in first.csv.
void Tabulate(const InputFiles& files, const std::string& keys, const std::string& csv) {
  files.Write("first.csv", csv);
  files.Write("second.csv", kWhole);
  files.Edit(
      "vehicle.yaml", "surface_roughness_um: 6",
      "aerodynamics:\n  tables:\n    - {reference_area_m2: 0.785, reference_length_m: 1, table: first.csv" +
          keys +
          "}\n    - {reference_area_m2: 0.785, reference_length_m: 1, table: second.csv}\n"
          "surface_roughness_um: 6");
}
AeroTable FirstTable(const std::string& keys, const std::string& csv) {
  const InputFiles files;
  Tabulate(files, keys, csv);
  return LoadVehicle(files.Path("vehicle.yaml")).aerodynamics[0];
}
std::string ErrorsOf(const std::string& keys, const std::string& csv) {
  const InputFiles files;
  Tabulate(files, keys, csv);
  return files.Texts(CheckFile(files.Path("vehicle.yaml")).errors);
}

TEST(AeroTableFile, NeedsNoDamping) {
  const AeroTable table = FirstTable("", kWhole);
  EXPECT_TRUE(table.cmq_per_rad.empty());
  EXPECT_TRUE(table.clp_per_rad.empty());
  EXPECT_THAT(table.xcp_station_m, ElementsAre(4.0, 4.0, 3.0, 3.0));
}

// xcp = reference - d cm / cn; at an incidence of 0 the next row's.
TEST(AeroTableFile, ByMomentsAboutAStation) {
  const AeroTable table = FirstTable(", moment_reference_station_m: 6",
                                     "mach,incidence_deg,ca,cn,cm\n0.5,0,0.3,0,0\n0.5,10,0.3,0.5,1\n"
                                     "2,0,0.3,0,0\n2,10,0.3,0.6,-0.6\n");
  EXPECT_TRUE(table.is_by_moment);
  EXPECT_THAT(table.xcp_station_m, ElementsAre(4.0, 4.0, 7.0, 7.0));
}

TEST(AeroTableFile, OfSignedIncidenceIsFolded) {
  const AeroTable table = FirstTable(
      "",
      "mach,incidence_deg,ca,cn,xcp_station_m\n0.5,-10,0.30,-0.50,4\n0.5,0,0.3,0,4\n0.5,10,0.302,0.498,4\n"
      "0.5,20,0.4,1,4\n2,-10,0.3,-0.6,3\n2,0,0.3,0,3\n2,10,0.3,0.6,3\n2,20,0.4,1,3\n");
  EXPECT_THAT(table.incidence_rad, ElementsAre(0.0, 10.0 * kRadPerDeg, 20.0 * kRadPerDeg));
  EXPECT_DOUBLE_EQ(table.ca[1], 0.301);
  EXPECT_DOUBLE_EQ(table.cn[1], 0.499);
  EXPECT_EQ(table.cn[2], 1.0);
  EXPECT_EQ(table.cn[4], 0.6);
}

// Rows of alpha and beta of a body of revolution, with cn = 3 sin(incidence) at each Mach number.
std::string OfTwoAngles(double right_cy) {
  std::string text = "mach,alpha_deg,beta_deg,ca,cn,cy,xcp_station_m\n";
  for (const double mach : {0.5, 2.0})
    for (const double alpha : {-8.0, -4.0, 0.0, 4.0, 8.0})
      for (const double beta : {-4.0, 0.0, 4.0}) {
        const double v = std::sin(beta * kRadPerDeg),
                     w = std::sin(alpha * kRadPerDeg) * std::cos(beta * kRadPerDeg);
        const double cy = -3.0 * v + (alpha == 4.0 && beta == 4.0 ? right_cy : 0.0);
        for (const double value : {mach, alpha, beta, 0.3, 3.0 * w, cy, 4.0})
          text += FormatNumber(value) + ",";
        text.back() = '\n';
      }
  return text;
}

TEST(AeroTableFile, OverAlphaAndBetaIsThatOfTheTotalIncidence) {
  const AeroTable table = FirstTable("", OfTwoAngles(0.0));
  EXPECT_THAT(table.incidence_rad, ElementsAre(0.0, 4.0 * kRadPerDeg, 8.0 * kRadPerDeg));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(table.cn[i], 3.0 * std::sin(table.incidence_rad[i]), 1e-15);
  EXPECT_EQ(
      ErrorsOf("", OfTwoAngles(0.03)),
      "first.csv:13:33: cy[11]: is not that of the same total incidence without sideslip, allowed: a body "
      "of revolution: within 5 % of the greatest of the Mach number; or xcp_side_station_m or cln, of a body "
      "with two planes of symmetry\n");
}

// A value of a row of the table of OfTwoPlanes, and what is added to it.
struct Changed {
  std::string column;
  double alpha_deg = 4.0, beta_deg = 4.0;
  double by = 0.0;
};
// A body with two planes of symmetry: cn = 3 sin(incidence) at station 4 in the pitch plane, 2 at 2.5 in the
// yaw plane, an axial force of 0.3 and 0.4. Moments are about station 6, where `by_moment`.
std::string OfTwoPlanes(bool by_moment, const Changed& changed = {}, bool planes_alone = false) {
  std::string text = by_moment ? "mach,alpha_deg,beta_deg,ca,cn,cy,cm,cln,cmq_per_rad,cnr_per_rad\n"
                               : "mach,alpha_deg,beta_deg,ca,cn,cy,xcp_station_m,xcp_side_station_m,"
                                 "cmq_per_rad,cnr_per_rad\n";
  for (const double mach : {0.5, 2.0})
    for (const double alpha : {-8.0, -4.0, 0.0, 4.0, 8.0})
      for (const double beta : {-6.0, -4.0, 0.0, 4.0, 6.0}) {
        if (planes_alone && alpha != 0.0 && beta != 0.0) continue;
        const double v = std::sin(beta * kRadPerDeg),
                     w = std::sin(alpha * kRadPerDeg) * std::cos(beta * kRadPerDeg);
        const double across2 = v * v + w * w;
        const double ca = across2 == 0.0 ? 0.3 : (0.3 * w * w + 0.4 * v * v) / across2;
        const double cn = 3.0 * w, cy = -2.0 * v;
        const auto add = [&](const char* column, double value) {
          const bool changes = column == changed.column && alpha == changed.alpha_deg &&
                               beta == changed.beta_deg && mach == 2.0;
          text += FormatNumber(value + (changes ? changed.by : 0.0)) + ",";
        };
        for (const double value : {mach, alpha, beta}) text += FormatNumber(value) + ",";
        add("ca", ca);
        add("cn", cn);
        add("cy", cy);
        add("place", by_moment ? cn * (6.0 - 4.0) : 4.0);
        add("side place", by_moment ? cy * (6.0 - 2.5) : 2.5);
        add("cmq", -200.0);
        add("cnr", -150.0);
        text.back() = '\n';
      }
  return text;
}

TEST(AeroTableFile, OfTwoPlanesHasATableOfEach) {
  const std::string about_6 = ", moment_reference_station_m: 6";
  for (const AeroTable& table :
       {FirstTable("", OfTwoPlanes(false)), FirstTable(about_6, OfTwoPlanes(true)),
        FirstTable("", OfTwoPlanes(false, {}, true)), FirstTable(about_6, OfTwoPlanes(true, {}, true))}) {
    ASSERT_EQ(table.yaw_plane.size(), 1u);
    const AeroTable& yaw = table.yaw_plane[0];
    EXPECT_THAT(yaw.incidence_rad, ElementsAre(0.0, 4.0 * kRadPerDeg, 6.0 * kRadPerDeg));
    EXPECT_EQ(yaw.reference_area_m2, table.reference_area_m2);
    EXPECT_EQ(yaw.reference_length_m, table.reference_length_m);
    EXPECT_EQ(yaw.is_by_moment, table.is_by_moment);
    for (std::size_t row = 0; row < 6; ++row) {
      EXPECT_NEAR(table.cn[row], 3.0 * std::sin(table.incidence_rad[row % 3]), 1e-15);
      EXPECT_NEAR(yaw.cn[row], 2.0 * std::sin(yaw.incidence_rad[row % 3]), 1e-15);
      EXPECT_NEAR(table.xcp_station_m[row], 4.0, 1e-12);
      EXPECT_NEAR(yaw.xcp_station_m[row], 2.5, 1e-12);
      EXPECT_NEAR(table.ca[row], 0.3, 1e-15);
      EXPECT_NEAR(yaw.ca[row], row % 3 == 0 ? 0.3 : 0.4, 1e-15);
    }
    EXPECT_THAT(table.cmq_per_rad, ElementsAre(-200.0, -200.0));
    EXPECT_THAT(yaw.cmq_per_rad, ElementsAre(-150.0, -150.0));
  }
}

// The uncertainties and the base drag of a table are those of both planes.
TEST(AeroTableFile, OfTwoPlanesHasOneUncertainty) {
  const AeroTable table = FirstTable(
      ", base_area_m2: 0.157, cn_uncertainty_percent: 6, xcp_uncertainty_m: 0.3, uncertainty_is: three_sigma",
      OfTwoPlanes(false));
  const AeroTable& yaw = table.yaw_plane.at(0);
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_NEAR(yaw.uncertainty.cn[row], 0.02, 1e-15);
    EXPECT_NEAR(yaw.ca_power_off[row] - yaw.ca[row], table.ca_power_off[row] - table.ca[row], 1e-15);
  }
  const AeroTable drawn = Drawn(table, {0.0, 2.0, -1.0, 0.0});
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_NEAR(drawn.yaw_plane[0].cn[row], 1.04 * yaw.cn[row], 1e-15);
    EXPECT_NEAR(drawn.yaw_plane[0].xcp_station_m[row], 2.4, 1e-12);
  }
}

TEST(AeroTableFile, OfTwoPlanesRefusesRowsThatAreNotOfThem) {
  const std::string together =
      ": is not what the rows of the pitch plane and of the yaw plane give together, allowed: a body with "
      "two "
      "planes of symmetry: within 5 % of the greatest of the Mach number; or rows of the planes alone\n";
  // Of 0.4, 0.42 and 0.21; of a moment of the force at that row over one diameter.
  EXPECT_EQ(ErrorsOf("", OfTwoPlanes(false, {"ca", 4.0, 4.0, 0.019})), "");
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"ca", 4.0, 4.0, 0.022})),
              testing::AllOf(testing::StartsWith("first.csv:45:"), HasSubstr(": ca[43]" + together)));
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"cn", 4.0, 4.0, -0.022})), HasSubstr(": cn[43]" + together));
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"cy", 4.0, -4.0, 0.012})), HasSubstr(": cy[41]" + together));
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"place", 4.0, 4.0, 0.11})),
              HasSubstr(": xcp_station_m[43]" + together));
  EXPECT_EQ(ErrorsOf("", OfTwoPlanes(false, {"place", 4.0, 4.0, 0.09})), "");
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"side place", 4.0, 4.0, -0.09})),
              HasSubstr(": xcp_side_station_m[43]" + together));
  const std::string about_6 = ", moment_reference_station_m: 6";
  EXPECT_THAT(ErrorsOf(about_6, OfTwoPlanes(true, {"place", 4.0, 4.0, 0.022})),
              testing::AllOf(testing::StartsWith("first.csv:45:"), HasSubstr("table.cm[43]" + together)));
  EXPECT_THAT(ErrorsOf(about_6, OfTwoPlanes(true, {"side place", 4.0, 4.0, -0.012})),
              HasSubstr("table.cln[43]" + together));
  // A yaw plane that does not mirror, and one whose damping changes.
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"cy", 0.0, 4.0, 0.02})),
              HasSubstr(": cy[38]: is not that of the opposite incidence"));
  EXPECT_THAT(ErrorsOf("", OfTwoPlanes(false, {"cnr", 0.0, 4.0, 1.0})),
              HasSubstr(": cnr_per_rad[38]: the rate damping changes with incidence"));
}

TEST(AeroTableFile, OfTwoPlanesNeedsPlacesOfOneKind) {
  std::string mixed = OfTwoPlanes(false);
  mixed.replace(mixed.find("xcp_side_station_m"), 18, "cln");
  EXPECT_EQ(ErrorsOf("", mixed),
            "first.csv:1:1: the places of cn and cy do not go together, allowed: xcp_station_* with "
            "xcp_side_station_m, or cm with cln\n");
}

TEST(AeroTableFile, WithoutPowerHasTheBaseDragOfAnArea) {
  const AeroTable table = FirstTable(", base_area_m2: 0.157", kWhole);
  EXPECT_DOUBLE_EQ(table.ca_power_off[0], 0.3 + 0.2 * BaseDrag(0.5));
  EXPECT_DOUBLE_EQ(table.ca_power_off[3], 0.3 + 0.2 * BaseDrag(2.0));
}

TEST(AeroTableFile, StatesUncertaintiesOfOneOrThreeSigma) {
  const AeroTable one =
      FirstTable(", ca_uncertainty_percent: 6, xcp_uncertainty_m: 0.3, uncertainty_is: sigma", kWhole);
  EXPECT_THAT(one.uncertainty.ca, ElementsAre(0.06, 0.06, 0.06, 0.06));
  EXPECT_THAT(one.uncertainty.xcp_m, ElementsAre(0.3, 0.3, 0.3, 0.3));
  EXPECT_TRUE(one.uncertainty.cn.empty());
  const AeroTable three =
      FirstTable(", uncertainty_is: three_sigma, damping_uncertainty_percent: 30",
                 "mach,incidence_deg,ca,cn,xcp_station_m,ca_uncertainty_percent\n0.5,0,0.3,0,4,3\n"
                 "0.5,10,0.3,0.5,4,6\n2,0,0.3,0,3,9\n2,10,0.3,0.6,3,12\n");
  EXPECT_NEAR(three.uncertainty.ca[1], 0.02, 1e-15);
  EXPECT_NEAR(three.uncertainty.ca[3], 0.04, 1e-15);
  EXPECT_NEAR(three.uncertainty.damping[1], 0.1, 1e-15);
}

TEST(AeroTableFile, OfALighterStackNamesWhatHasLeft) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "    gimbal: {pivot_station_m: 3.9",
             "    jettisoned: [{name: tower, mass_kg: 5, top_station_m: 0.5, bottom_station_m: 1, "
             "outer_diameter_m: 0.2, at: {time_s: 30}}]\n    gimbal: {pivot_station_m: 3.9");
  Tabulate(
      files,
      ", lighter: [{without: [tower], reference_area_m2: 0.7, reference_length_m: 0.9, table: first.csv}]",
      kWhole);
  const Vehicle vehicle = LoadVehicle(files.Path("vehicle.yaml"));
  ASSERT_EQ(vehicle.aerodynamics[0].lighter.size(), 1u);
  EXPECT_THAT(vehicle.aerodynamics[0].lighter[0].without, ElementsAre("tower"));
  EXPECT_EQ(vehicle.aerodynamics[0].lighter[0].table.reference_area_m2, 0.7);
  files.Edit("vehicle.yaml", "without: [tower]", "without: [fairing]");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("vehicle.yaml")).errors),
      "vehicle.yaml:36:95: aerodynamics.tables[0].lighter[0].without: names 'fairing', which this stack "
      "does not jettison, allowed: of tower\n");
}

// A byte order mark of a spreadsheet is no part of a column's name.
TEST(AeroTableFile, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(FirstTable("", std::string("\xEF\xBB\xBF") + kWhole).cn[1], 0.5);
}

TEST(AeroTableFile, UncertaintyIsDrawnByItsOwnKey) {
  const InputFiles files;
  Tabulate(files, ", ca_uncertainty_percent: 6, uncertainty_is: sigma", kWhole);
  files.Edit("campaign.yaml", "  wind:", "  aerodynamic_uncertainty: {of: [ca, xcp]}\n  wind:");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  int drawn = 0;
  for (const Dispersion& dispersion : campaign.dispersions)
    if (dispersion.name.starts_with("aerodynamic_uncertainty/")) {
      ++drawn;
      EXPECT_EQ(dispersion.distribution.kind, Distribution::kNormal);
      EXPECT_EQ(dispersion.distribution.sigma, 1.0);
    }
  EXPECT_EQ(drawn, 2);
  files.Edit("campaign.yaml", "  aerodynamic_uncertainty: {of: [ca, xcp]}\n", "");
  EXPECT_THAT(files.Texts(CheckFile(files.Path("campaign.yaml")).warnings),
              HasSubstr("do not draw the uncertainty that the vehicle's aerodynamic tables state"));
  const InputFiles plain;
  plain.Edit("campaign.yaml", "  wind:", "  aerodynamic_uncertainty: {of: [ca]}\n  wind:");
  EXPECT_EQ(
      plain.Texts(CheckFile(plain.Path("campaign.yaml")).errors),
      "campaign.yaml:9:28: dispersions.aerodynamic_uncertainty: the vehicle has no aerodynamic table that "
      "states an uncertainty, allowed: tables with ca_uncertainty_percent, cn_uncertainty_percent, "
      "xcp_uncertainty_m or damping_uncertainty_percent\n");
}

// ---- weather ----

TEST(WeatherFile, MayHaveTheAir) {
  const InputFiles files;
  files.Write("weather.csv",
              "altitude_km,north_m_s,east_m_s,pressure_hpa,temperature_k\n0,1,2,1010,300\n10,3,4,280,230\n");
  files.Edit("campaign.yaml", "  wind:", "  wind_profile: {table: weather.csv}\n  wind:");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  files.Write(
      "weather.csv",
      "altitude_m,north_m_s,east_m_s,pressure_hpa,temperature_k\n0,1,2,1010,300\n10000,3,4,280,230\n");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  ASSERT_TRUE(campaign.wind_table && campaign.wind_table->has_air());
  EXPECT_EQ(campaign.wind_table->pressure_pa[1], 28000.0);
  EXPECT_NEAR(AirOfLevel(*campaign.wind_table, 0).density_kg_m3, 1.1728, 1e-4);
  EXPECT_EQ(ParseCampaign(campaign.canonical_yaml, "again").flight_id, campaign.flight_id);
}

// ---- masses ----

constexpr char kMasses[] =
    "propellant_left_kg,mass_kg,cg_station_m,axial_inertia_kg_m2,transverse_inertia_kg_m2\n"
    "1500,2000,7,180,1900\n750,1250,6.9,120,1300\n0,500,7.2,70,1000\n";

void Weigh(const InputFiles& files, const std::string& csv) {
  files.Write("masses.csv", csv);
  files.Edit("vehicle.yaml", "    gimbal: {pivot_station_m: 9.8",
             "    mass_table: masses.csv\n    gimbal: {pivot_station_m: 9.8");
}
TEST(MassTableFile, GivesTheStageItsMasses) {
  const InputFiles files;
  const Vehicle plain = LoadVehicle(files.Path("vehicle.yaml"));
  const MassProperties tubes = BuildStackMasses(plain)[1].At(500.0);
  Weigh(files, kMasses);
  const Vehicle vehicle = LoadVehicle(files.Path("vehicle.yaml"));
  const StackMass stack = BuildStackMasses(vehicle)[0];
  for (const auto& [left_kg, cg_m, axial, transverse] :
       {std::array{1500.0, 7.0, 180.0, 1900.0}, {750.0, 6.9, 120.0, 1300.0}, {0.0, 7.2, 70.0, 1000.0}}) {
    const double own_kg = 500.0 + left_kg, whole_kg = own_kg + 1000.0;
    const MassProperties at = stack.At(left_kg);
    EXPECT_NEAR(at.mass_kg, whole_kg, 1e-9);
    EXPECT_NEAR(at.cg_station_m, (own_kg * cg_m + 1000.0 * tubes.cg_station_m) / whole_kg, 1e-12);
    EXPECT_NEAR(at.axial_inertia_kg_m2, axial + tubes.axial_inertia_kg_m2, 1e-9);
    const double apart = cg_m - tubes.cg_station_m;
    EXPECT_NEAR(at.transverse_inertia_kg_m2,
                transverse + tubes.transverse_inertia_kg_m2 + own_kg * 1000.0 / whole_kg * apart * apart,
                1e-8);
  }
}

// Times are those of the nominal burn: a third of 60 s at full thrust, in round numbers of the ramps.
TEST(MassTableFile, OverTimeIsThatOfTheNominalBurn) {
  const InputFiles files;
  Weigh(files,
        "time_s,cg_station_m,axial_inertia_kg_m2,transverse_inertia_kg_m2\n0,7,180,1900\n30.1,6.9,120,1300\n"
        "60.3,7.2,70,1000\n70,7.2,70,1000\n");
  const MassTable table = LoadVehicle(files.Path("vehicle.yaml")).stages[0].mass_table;
  ASSERT_EQ(table.propellant_kg.size(), 3u);
  EXPECT_NEAR(table.propellant_kg[0], 0.0, 1e-9);
  EXPECT_NEAR(table.propellant_kg[1], 750.0, 1e-9);  // 25 kg/s, from 0.1 s on by the ramp
  EXPECT_EQ(table.propellant_kg[2], 1500.0);
  EXPECT_THAT(table.cg_station_m, ElementsAre(7.2, 6.9, 7.0));
}

// A body that is not the same about y and z. Without the column it is.
TEST(MassTableFile, MayHaveAMomentAboutZ) {
  const std::string head = "propellant_left_kg,cg_station_m,axial_inertia_kg_m2,transverse_inertia_kg_m2";
  const auto weighed = [](const std::string& csv) {
    const InputFiles files;
    Weigh(files, csv);
    return LoadVehicle(files.Path("vehicle.yaml"));
  };
  const Vehicle vehicle = weighed(head + ",yaw_inertia_kg_m2\n1500,7,180,1900,1800\n0,7.2,70,1000,960\n"),
                same = weighed(head + "\n1500,7,180,1850\n0,7.2,70,980\n");
  const StackMass stack = BuildStackMasses(vehicle)[0], mean = BuildStackMasses(same)[0];
  EXPECT_NEAR(stack.SidesAt(1500.0)[kSideAboutY], 50.0, 1e-9);
  EXPECT_NEAR(stack.SidesAt(0.0)[kSideAboutY], 20.0, 1e-9);
  EXPECT_FALSE(mean.HasSides());
  EXPECT_NEAR(stack.At(900.0).transverse_inertia_kg_m2, mean.At(900.0).transverse_inertia_kg_m2, 1e-9);
}

// Off the axis, in the columns that need not be there. What a campaign's folder keeps is read again as it
// was.
TEST(MassTableFile, MayHaveMassesOffTheAxis) {
  const InputFiles files;
  Weigh(
      files,
      "propellant_left_kg,cg_station_m,axial_inertia_kg_m2,transverse_inertia_kg_m2,cg_z_m,product_xz_kg_m2\n"
      "1500,7,180,1900,0.01,-8\n0,7.2,70,1000,0.04,-5\n");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const auto expect = [](const Vehicle& vehicle) {
    const SideSums full = BuildStackMasses(vehicle)[0].SidesAt(1500.0),
                   dry = BuildStackMasses(vehicle)[0].SidesAt(0.0);
    EXPECT_NEAR(full[kSideZ], 2000.0 * 0.01, 1e-9);
    EXPECT_NEAR(dry[kSideZ], 500.0 * 0.04, 1e-9);
    // Mass times station times place: the station counts aft, x forward.
    EXPECT_NEAR(full[kSideStationZ], 2000.0 * 7.0 * 0.01 + 8.0, 1e-9);
    EXPECT_NEAR(dry[kSideStationZ], 500.0 * 7.2 * 0.04 + 5.0, 1e-9);
    EXPECT_NEAR(full[kSideSquare], 2000.0 * 1e-4, 1e-9);
    for (const SideSum none : {kSideY, kSideStationY, kSideYz}) EXPECT_NEAR(full[none], 0.0, 1e-12);
    EXPECT_TRUE(BuildStackMasses(vehicle)[0].HasSides());
    EXPECT_FALSE(BuildStackMasses(vehicle)[1].HasSides());
  };
  expect(campaign.vehicle);
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "canonical");
  expect(again.vehicle);
  EXPECT_EQ(again.flight_id, campaign.flight_id);
}

}  // namespace
}  // namespace dispersa::campaign_yaml_tables_test
