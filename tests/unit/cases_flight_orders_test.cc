#include "core/cases/flight_orders.h"

#include "core/campaign_yaml/load.h"
#include "core/cases/result_bytes.h"
#include "core/flight/history.h"
#include "tests/test.h"

namespace dispersa::cases_flight_orders_test {
namespace {

const FlightsHere& Flights() {
  static const FlightsHere flights(LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml"));
  return flights;
}

std::string Message(const CaseResult& result, const std::vector<double>& history = {}) {
  Packer out;
  Pack(result, out);
  out.Numbers(history);
  return out.Take();
}

TEST(FlightOrders, AnAnswerIsWhatWasFlownHere) {
  History history;
  history.step_s = 1.0;
  const CaseResult flown = Flights().Fly(Flights().Draw(3), 3, &history, Scheme::kSimpson);
  std::vector<FlownOnce> answers;
  CarryOut(Flights(), OrderFlight(Flights().Draw(3), 3, 1.0, Scheme::kSimpson),
           [&](const std::string& message) { answers.push_back(TakeAnswer(Flights(), message)); });
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(Message(answers[0].result, answers[0].history), Message(flown, history.values));
  CarryOut(Flights(), OrderCases({3, 4}),
           [&](const std::string& message) { answers.push_back(TakeAnswer(Flights(), message)); });
  EXPECT_EQ(answers.size(), 3u);
  CarryOut(Flights(), OrderSideBySide({std::nullopt, 3}),
           [&](const std::string& message) { answers.push_back(TakeAnswer(Flights(), message)); });
  ASSERT_EQ(answers.size(), 5u);
  EXPECT_EQ(answers[4].result.digest, flown.digest);
}

// A law can write into the way of the answers whatever it likes.
TEST(FlightOrders, AnAnswerOfAnotherFormIsNone) {
  const CaseResult good = Flights().Fly({}, 0, nullptr, Scheme::kSimpson);
  const auto spoilt = [&](auto spoil) {
    CaseResult result = good;
    spoil(result);
    return Message(result);
  };
  EXPECT_EQ(TakeAnswer(Flights(), spoilt([](CaseResult& r) { r.reason = "\x1b[31m<b>\n"; })).result.reason,
            "\\x1b[31m<b>\\x0a");
  EXPECT_EQ(TakeAnswer(Flights(), spoilt([](CaseResult& r) { r.reason = std::string(5000, 'a'); }))
                .result.reason.size(),
            1003u);
  const std::vector<std::string> messages = {
      "",
      Message(good).substr(1),
      Message(good) + "x",
      Message(good, {1.0}),
      spoilt([](CaseResult& r) { r.metrics.pop_back(); }),
      spoilt([](CaseResult& r) { r.metrics.push_back(0.0); }),
      spoilt([](CaseResult& r) { r.inputs.pop_back(); }),
      spoilt([](CaseResult& r) { r.inputs.clear(); }),
      spoilt([](CaseResult& r) { r.outcome = static_cast<Outcome>(6); }),
      spoilt([](CaseResult& r) { r.outcome = static_cast<Outcome>(-1); }),
      spoilt([](CaseResult& r) { r.end_stage = 5; }),
      spoilt([](CaseResult& r) { r.end_stage = -1; })};
  for (std::size_t i = 0; i < messages.size(); ++i)
    EXPECT_THROW(TakeAnswer(Flights(), messages[i]), ContainedEnd) << i;
}

TEST(Description, OfAPluginIsBoundedPrintableText) {
  const std::string dots = std::string(64, 'a') + "...";
  for (const auto& [said, shown] :
       std::vector<std::pair<std::string, std::string>>{{"pd 1.2", "pd 1.2"},
                                                        {"", ""},
                                                        {std::string(64, 'a'), std::string(64, 'a')},
                                                        {std::string(70, 'a'), dots},
                                                        {"\x1b[2J", "\\x1b[2J"},
                                                        {"a\nb\tc", "a\\x0ab\\x09c"},
                                                        {"<i>&", "<i>&"},
                                                        {"\xff", "\\xff"},
                                                        {"\x7f", "\\x7f"}}) {
    const PluginDescription description = DescriptionOf({said, said, "gain"});
    EXPECT_EQ(description.name, shown);
    EXPECT_EQ(description.version, shown);
    EXPECT_EQ(description.parameters, std::vector<std::string>{"gain"});
  }
  EXPECT_THROW(DescriptionOf({"name"}), PluginError);
  for (const std::string name : {"g\xc3\xa4in", "a\n"})
    EXPECT_THROW(DescriptionOf({"n", "1", name}), PluginError);
}

}  // namespace
}  // namespace dispersa::cases_flight_orders_test
