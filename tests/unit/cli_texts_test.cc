// Full texts that commands print about vehicles, searches and campaigns.
#include <nlohmann/json.hpp>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/pages/trajectory_page.h"
#include "services/cli/progress.h"
#include "services/cli/terminal.h"
#include "services/cli/vehicle_text.h"
#include "services/client/reference_search.h"
#include "services/fleet_cli/campaign_text.h"
#include "services/log/log.h"
#include "services/program/failure.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::cli_texts_test {
namespace {

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines = {""};
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return lines;
}

// 13 t with 4 t in 40 s at 200 kN: Isp 200e3 * 40 / (4000 * 9.80665) = 203.9 s, dv 2000 ln(13 / 9) = 735 m/s,
// 10 t of its own of which 6 are dry, 200e3 / (13 t g) = 1.57 g at release and 200e3 / (9 t g) = 2.27 g at
// the end. Above it 3 t with 1 t in 20 s at 50 kN: 102.0 s, 1000 ln(3 / 2) = 405 m/s, 1.70 g and 2.55 g.
TEST(VehicleText, IsTheRocketEquationInATable) {
  Vehicle vehicle = SampleVehicle();
  const std::vector<std::string> lines = Lines(VehicleText(vehicle));
  ASSERT_EQ(lines.size(), 10u);
  EXPECT_EQ(lines[1], "sample: 13000 kg, 20 m");
  EXPECT_EQ(lines[2],
            "stage        at ignition  propellant       dry   dry/own    thrust     burn      Isp   ideal dv "
            "      T/W  burnout");
  EXPECT_EQ(lines[3],
            "                      kg          kg        kg                  kN        s        s        m/s "
            " ignition        g");
  EXPECT_EQ(lines[4],
            "first              13000        4000      6000     0.600     200.0     40.0    203.9        735 "
            "     1.57     2.27");
  EXPECT_EQ(lines[5],
            "second              3000        1000      2000     0.667      50.0     20.0    102.0        405 "
            "     1.70     2.55");
  EXPECT_EQ(lines[6], "together" + std::string(84, ' ') + "1141");
  EXPECT_EQ(lines[8], "limits: none, so no load is checked");
}

TEST(VehicleText, NamesBoostersJettisonsAndLimits) {
  Vehicle vehicle = SampleVehicle();
  vehicle.limits.q_max_pa = 90e3;
  vehicle.limits.lateral_load_g = 1.5;
  vehicle.boosters.count = 3;
  vehicle.boosters.dry_mass_kg = 150.0;
  vehicle.boosters.propellant_mass_kg = 800.0;
  vehicle.boosters.motor = {.thrust_n = 80e3, .burning_time_s = 25.0, .thrust_curve = {}};
  vehicle.stages[1].jettisoned = {
      {.name = "fairing", .mass_kg = 60.0, .trigger = JettisonTrigger::kAtHeatFlux, .threshold = 1135.0},
      {.name = "skirt", .mass_kg = 20.0, .trigger = JettisonTrigger::kAtAltitude, .threshold = 9e4},
      {.name = "ring", .mass_kg = 5.0, .trigger = JettisonTrigger::kAtTime, .threshold = 70.5}};
  const std::string text = VehicleText(vehicle);
  EXPECT_NE(text.find("\n3 boosters beside first, each of 950 kg with 800 kg of propellant, 80 kN and 25 s\n"
                      "jettisoned from second: fairing, 60 kg, at a heat flux of 1135 W/m2; the masses above "
                      "include it\n"
                      "jettisoned from second: skirt, 20 kg, at 90000 m; the masses above include it\n"
                      "jettisoned from second: ring, 5 kg, at 70.5 s; the masses above include it\n"
                      "limits: q_max_pa 90000, lateral_load_max_g 1.5\n"),
            std::string::npos)
      << text;
  vehicle.aerodynamics.clear();
  EXPECT_NE(VehicleText(vehicle).find(
                "80 kN and 25 s; the aerodynamics are built up from the core's profile alone\n"),
            std::string::npos);
}

TEST(VehicleText, AsJsonHasTheSameNumbers) {
  const auto json = VehicleJson(SampleVehicle());
  EXPECT_EQ(json["name"], "sample");
  const double first_m_s = 2000.0 * std::log(13.0 / 9.0), second_m_s = 1000.0 * std::log(1.5);
  EXPECT_NEAR(json["ideal_delta_v_m_s"], first_m_s + second_m_s, 1e-9);
  const auto& stage = json["stages"][0];
  EXPECT_EQ(stage["name"], "first");
  EXPECT_EQ(stage["liftoff_mass_kg"], 13000.0);
  EXPECT_EQ(stage["propellant_mass_kg"], 4000.0);
  EXPECT_EQ(stage["dry_mass_kg"], 6000.0);
  EXPECT_NEAR(stage["structural_fraction"], 0.6, 1e-12);
  EXPECT_NEAR(stage["specific_impulse_s"], 2000.0 / 9.80665, 1e-9);
  EXPECT_NEAR(stage["ideal_delta_v_m_s"], first_m_s, 1e-9);
  EXPECT_NEAR(stage["thrust_to_weight"], 200.0 / 13.0 / 9.80665, 1e-9);
  EXPECT_NEAR(stage["burnout_load_g"], 200.0 / 9.0 / 9.80665, 1e-9);
}

TEST(DurationText, RoundsToTheSecondAndCarries) {
  EXPECT_EQ(DurationText(0.0), "0s");
  EXPECT_EQ(DurationText(0.2), "0s");
  EXPECT_EQ(DurationText(59.4), "59s");
  EXPECT_EQ(DurationText(59.5), "1m00s");
  EXPECT_EQ(DurationText(185.0), "3m05s");
  EXPECT_EQ(DurationText(3599.6), "1h00m");
  EXPECT_EQ(DurationText(3720.0), "1h02m");
  EXPECT_EQ(DurationText(7380.0), "2h03m");
  EXPECT_EQ(DurationText(93'600.0), "26h00m");
  EXPECT_EQ(DurationText(360'000.0), "100h00m");
}

nlohmann::ordered_json SampleCampaign() {
  return {{"id", "0123456789abcdef"},
          {"state", "flying"},
          {"done", 40},
          {"total", 100},
          {"name", "trial"},
          {"rate_per_s", 0.0},
          {"eta_s", nullptr},
          {"quarantined", 0},
          {"code", nullptr},
          {"problem", nullptr},
          {"requirements", nlohmann::ordered_json::array()}};
}

TEST(ProgressBar, IsThirtyWideWhateverTheCounts) {
  EXPECT_EQ(ProgressBar(0, 10), std::string(30, '.'));
  EXPECT_EQ(ProgressBar(5, 10), std::string(15, '#') + std::string(15, '.'));
  EXPECT_EQ(ProgressBar(10, 10), std::string(30, '#'));
  EXPECT_EQ(ProgressBar(11, 10), std::string(30, '#')) << "results of a total that fell";
  EXPECT_EQ(ProgressBar(1, 0), std::string(30, '.'));
}

TEST(CampaignStatusText, SaysHowFarACampaignIs) {
  nlohmann::ordered_json campaign = SampleCampaign();
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  flying          40/100      -                  trial\n");  // of an earlier version
  campaign["owner"] = nullptr;
  campaign["launched_utc"] = nullptr;
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  flying          40/100      -                  trial\n");
  campaign["owner"] = "ann";
  campaign["launched_utc"] = "2026-01-31T12:34:56Z";
  campaign["rate_per_s"] = 12.34;
  campaign["eta_s"] = 65;
  campaign["quarantined"] = 2;
  campaign["labels"] = {"commit=1a2b3c4", "branch=main"};
  campaign["requirements"].push_back(
      {{"failures", 3}, {"n", 40}, {"metric", "alpha_max_deg"}, {"so_far", "inconclusive"}});
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  flying          40/100      2026-01-31 12:34Z  trial  12.3/s\n"
            "              1m05s left  2 quarantined  of ann  commit=1a2b3c4  branch=main\n"
            "  3 of 40 fail alpha_max_deg (inconclusive so far)\n");
}

TEST(CampaignStatusText, SaysHowACampaignEnded) {
  nlohmann::ordered_json campaign = SampleCampaign();
  campaign["state"] = "failed";
  campaign["code"] = 1;
  campaign["problem"] = "/var/lib/dispersa/0123/results/results.sqlite: its folder is gone, and nothing can";
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  failed          40/100      -                  trial\n"
            "              /var/lib/dispersa/0123/results/results.sqlite: its folder is gone,\n"
            "              and nothing can\n");
  campaign = SampleCampaign();
  campaign["state"] = "done";
  campaign["code"] = 3;
  campaign["verdict_words"] = "a requirement failed";
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  done            40/100      -                  trial\n"
            "              a requirement failed\n");
}

// Columns and not bytes; the widest states and numbers; an item that no line has room for.
TEST(CampaignStatusText, IsReadableIn80Columns) {
  nlohmann::ordered_json campaign = SampleCampaign();
  campaign["state"] = "reporting";
  campaign["done"] = campaign["total"] = 5000000;
  campaign["name"] = "äöüäöüäöüäöüäöüäö";
  campaign["launched_utc"] = "2026-01-31T12:34:56Z";
  campaign["labels"] = {std::string(100, 'k'), "a=b"};
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  reporting  5000000/5000000  2026-01-31 12:34Z  äöüäöüäöüäöüäöüäö\n"
            "              " +
                std::string(100, 'k') + "\n              a=b\n");
}

// The object says the code that the process ends with.
TEST(EndFor, AFailurePrintsItsCodeAndText) {
  LogForPeople(LogColor::kNever);  // to stderr, as every program does
  for (const ExitCode code : {kExitInternalError, kExitIncomplete, kExitInterrupted}) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(EndFor(Failure{code, "no coordinator"}, true), code);
    const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(json["schema"], "dispersa/error/1");
    EXPECT_EQ(json["code"], static_cast<int>(code));
    ASSERT_EQ(json["errors"].size(), 1u);
    EXPECT_EQ(json["errors"][0]["message"], "no coordinator");
    testing::internal::CaptureStdout();
    EXPECT_EQ(EndFor(Failure{code, "no coordinator"}, false), code);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  }
}

// A reference that reaches the target and cannot be flown is none.
TEST(CheckFlight, OfALostFlightDecides) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  FoundReference found;
  found.result.reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  found.result.reached = true;
  const auto json = [&] { return FoundReferenceJson(vehicle, found, "r.yaml"); };
  EXPECT_TRUE(found.reached());
  EXPECT_EQ(found.Statement(), "");
  EXPECT_TRUE(json()["check_flight"].is_null());
  found.check = CheckFlight{Outcome::kCompleted, 512.25, ""};
  EXPECT_TRUE(found.reached());
  EXPECT_EQ(CheckFlightText(*found.check), "check flight: completed at 512.25 s");
  EXPECT_EQ(json()["check_flight"].dump(), R"({"outcome":"completed","end_time_s":512.25,"reason":""})");
  found.check = CheckFlight{Outcome::kLostControl, 26.0, "the attitude error is large"};
  EXPECT_FALSE(found.reached());
  EXPECT_EQ(found.Statement(), "check flight: lost at 26 s, because the attitude error is large");
  EXPECT_EQ(json()["reached"], false);
  EXPECT_NE(TrajectoryPage(found.result, found.check).find("check flight: lost at 26 s"), std::string::npos);
  // A target that is missed is said first.
  found.result.reached = false;
  found.result.statement = "The target is not reached.";
  EXPECT_EQ(found.Statement(), "The target is not reached.");
}

TEST(FitColumns, CutsWhatWouldWrap) {
  const struct {
    const char* text;
    std::size_t columns;
    const char* fitted;
  } kCases[] = {{"", 3, ""},           {"abc", 4, "abc"},  {"abc", 3, "abc"}, {"abcd", 3, "ab…"},
                {"0.5 °", 5, "0.5 °"}, {"°°°°", 3, "°°…"}, {"abcd", 1, "…"},  {"abcd", 0, ""}};
  for (const auto& [text, columns, fitted] : kCases)
    EXPECT_EQ(FitColumns(text, columns), fitted) << text << columns;
}

TEST(FailureOf, SaysWhatTheSystemRefuses) {
  const Failure memory = FailureOf(std::bad_alloc());
  EXPECT_EQ(memory.code, kExitIncomplete);
  EXPECT_EQ(
      memory.message,
      "the memory is used up; raise its limit (`ulimit -v`, a container's limit) or take fewer --threads or "
      "--workers");
  const Failure thread = FailureOf(std::system_error(EAGAIN, std::generic_category()));
  EXPECT_EQ(thread.code, kExitIncomplete);
  EXPECT_EQ(
      thread.message,
      "the system refuses another thread; raise the limit of memory or threads (`ulimit -v`, `ulimit -u`) or "
      "take fewer --threads or --workers");
  const Failure other = FailureOf(std::system_error(EIO, std::generic_category()));
  EXPECT_EQ(other.code, kExitInternalError);
  EXPECT_EQ(other.message, "internal error: Input/output error");
}

}  // namespace
}  // namespace dispersa::cli_texts_test
