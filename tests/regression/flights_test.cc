// Today's results of a few flights of every kind, to the bit: digest, metrics, and drawn inputs.
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/input/number_text.h"
#include "tests/regression/golden.h"
#include "tests/test.h"

namespace dispersa::flights_test {
namespace {

/// Flights of one campaign; the golden has the kind's name.
struct Kind {
  const char* name;
  const char* campaign;
  std::vector<std::uint64_t> cases = {0, 1};
  bool nominal = false;
  const char* autopilot = nullptr;  ///< in place of the campaign's
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

#define SHIPPED DISPERSA_CAMPAIGNS "/"
#define MADE_UP DISPERSA_TEST_DATA "/goldens/"
const Kind kKinds[] = {
    {"rigid", SHIPPED "table3.yaml", {0, 1, 2}, true},
    {"full", SHIPPED "full.yaml"},
    {"corners", SHIPPED "aero20.yaml"},
    {"masses", MADE_UP "masses.yaml"},
    {"turbulence", SHIPPED "table3_turbulence.yaml"},
    {"nozzles", SHIPPED "table3_nozzles.yaml"},
    {"stuck_nozzle", SHIPPED "stuck_nozzle.yaml", {0, 1, 2}},
    {"gyros", MADE_UP "gyros.yaml"},
    {"boosters", MADE_UP "boosters.yaml", {0, 1}, true},
    {"flexible", SHIPPED "table3_flexible.yaml", {0, 1}, true},  // gyros on two stages
    {"flexible_guided", MADE_UP "flexible_guided.yaml"},
    {"guided", SHIPPED "orbit.yaml", {0, 1}, true},
    {"guided_full", SHIPPED "orbit_full.yaml"},
    {"solid_and_restart", MADE_UP "vega_open_loop.yaml", {0, 1}, true},  // listed nozzles, a fairing
    {"liquid", MADE_UP "electron_open_loop.yaml", {0, 1}, true},         // throttled; listed, a fairing
    {"guided_restart", SHIPPED "gallery/vega/campaign.yaml", {0, 1}, true},
    {"guided_liquid", SHIPPED "gallery/electron/campaign.yaml", {0, 1}, true},
    {"rail_boosters", MADE_UP "rail_boosters.yaml", {0, 1}, true},    // bodies of their own
    {"five_nozzles", MADE_UP "five_nozzles.yaml", {0, 1}, true},      // over a stage of five
    {"two_planes", MADE_UP "two_planes.yaml", {0, 1}, true},          // motor out, and tables drawn
    {"restart_masses", MADE_UP "restart_masses.yaml", {0, 1}, true},  // and a fairing
    {"jettison", SHIPPED "gallery/scout/campaign.yaml", {0, 1}, true},
    {"law_adaptive_fuzzy", SHIPPED "controllers.yaml"},
    {"law_composite_fuzzy",
     SHIPPED "controllers.yaml",
     {0, 1},
     false,
     SHIPPED "autopilots/composite_fuzzy.yaml"},
    {"law_frozen_fuzzy", SHIPPED "controllers_frozen_fuzzy.yaml"},
    {"law_lqr", SHIPPED "controllers_lqr.yaml"},
    {"law_pd", SHIPPED "controllers_pd.yaml"},
    {"law_pd_aac", SHIPPED "controllers_pd_aac.yaml"},
    {"law_pid", SHIPPED "controllers_pid.yaml"},
    {"law_pid_aac", SHIPPED "controllers_pid_aac.yaml"},
};

#undef SHIPPED
#undef MADE_UP

// Undefined metrics and inputs of a nominal flight are left out.
std::string Text(const CaseResult& result, const RowInputs& rows) {
  std::string text = std::string("outcome ") + OutcomeName(result.outcome) + "\n";
  if (!result.reason.empty()) text += "reason " + result.reason + "\n";
  text += "end_time_s " + FormatNumber(result.end_time_s) + "\n";
  text += "end_stage " + std::to_string(result.end_stage) + "\n";
  const std::vector<double> nominal = InputValues({}, rows.column_class()), all = rows.AllOf(result.inputs);
  EXPECT_EQ(result.inputs_digest, InputsDigest(all)) << "another input was applied";
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i] != nominal[i]) text += "input_" + InputColumns()[i].name + " " + FormatNumber(all[i]) + "\n";
  for (std::size_t i = 0; i < result.metrics.size(); ++i)
    if (!std::isnan(result.metrics[i]))
      text += "metric_" + MetricNames()[i] + " " + FormatNumber(result.metrics[i]) + "\n";
  // Last, so that a difference is named by what it changes.
  return text + "digest " + result.digest.Hex() + "\n";
}

class FlightGolden : public testing::TestWithParam<Kind> {};

TEST_P(FlightGolden, IsAsItWas) {
  const Kind& kind = GetParam();
  CampaignOverrides overrides;
  if (kind.autopilot != nullptr) overrides.autopilot = kind.autopilot;
  const Campaign campaign = LoadCampaign(kind.campaign, overrides);
  const CampaignFlights flights(campaign);

  std::vector<CaseOrder> orders;
  for (const std::uint64_t index : kind.cases) orders.push_back({index});
  std::vector<std::string> texts(orders.size());
  flights.FlyCases(orders, 1, [&](std::size_t order, const CaseResult& result, const History&) {
    texts[order] = "[case " + std::to_string(kind.cases[order]) + "]\n" + Text(result, flights.rows());
  });
  std::string text = "# Flights of campaign '" + campaign.name + "'.\n";
  if (kind.nominal) text += "[nominal]\n" + Text(flights.FlyNominal(), flights.rows());
  for (const std::string& each : texts) text += each;
  EXPECT_TRUE(MatchesGolden(text, std::string(DISPERSA_GOLDENS "/") + kind.name + ".txt"));
}
INSTANTIATE_TEST_SUITE_P(Kinds, FlightGolden, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

// A golden that no test reads pins nothing.
TEST(FlightGoldens, EachIsOfAKind) {
  for (const auto& entry : std::filesystem::directory_iterator(DISPERSA_GOLDENS)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(std::any_of(std::begin(kKinds), std::end(kKinds),
                            [&](const Kind& kind) { return name == std::string(kind.name) + ".txt"; }))
        << "no kind has the golden " << name;
  }
}

}  // namespace
}  // namespace dispersa::flights_test
