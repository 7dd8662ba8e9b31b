// The memory of a coordinator of many campaigns: what a restart finds, in which order it goes on.
#include "services/coordinator/catalogue.h"

#include <nlohmann/json.hpp>

#include "core/flight/metrics.h"
#include "core/input/input_error.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/sealed_json.h"
#include "services/ledger/running_tally.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::catalogue_test {

namespace fs = std::filesystem;

class CatalogueTest : public testing::Test {
 protected:
  static CatalogueEntry Entry(const std::string& id, int priority = 0) {
    CatalogueEntry entry;
    entry.id = id;
    entry.flight_id = "f" + id;
    entry.name = "name of " + id;
    entry.priority = priority;
    entry.cases = 7;
    return entry;
  }

  const TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
};

// As an early release wrote it: without a version, seed, end, distrusted workers and owner.
TEST_F(CatalogueTest, AStateOfTheFirstVersionIsReadAndBecomesOneOfToday) {
  fs::create_directories(root_ / "data" / "a1");
  const fs::path file = root_ / "data" / "a1" / "state.json";
  std::ofstream(file) << R"({
  "id": "a1",
  "flight_id": "fa1",
  "name": "table3",
  "priority": 2,
  "order": 9,
  "cases": 20,
  "done": 20,
  "quarantined": 0,
  "conflicts": 1,
  "state": "done",
  "code": 1,
  "problem": ""
}
)";
  Catalogue catalogue(root_ / "data");
  const CatalogueEntry& entry = catalogue.At("a1");
  EXPECT_EQ(entry.name, "table3");
  EXPECT_EQ(entry.order, 9u);
  EXPECT_EQ(entry.conflicts, 1u);
  EXPECT_EQ(entry.state, CampaignState::kDone);
  EXPECT_EQ(entry.seed, 0u);
  EXPECT_THAT(entry.distrusted, ElementsAre());
  EXPECT_GT(entry.ended_unix_s, 1'500'000'000) << "when its file was written";
  EXPECT_EQ(entry.owner, "");
  EXPECT_EQ(entry.bytes, fs::file_size(file)) << "counted, because nobody has written it down";
  catalogue.Write(entry);
  EXPECT_THAT(TextOfFile(file), HasSubstr("\"version\": 4"));
}

TEST_F(CatalogueTest, EachStartHasALargerNumberAlsoWhenTheClockIsSetBack) {
  fs::create_directories(root_);
  const std::uint64_t first = NextEpoch(root_), second = NextEpoch(root_);
  EXPECT_GT(first, 1'700'000'000'000'000u) << "microseconds since 1970";
  EXPECT_GT(second, first);
  EXPECT_EQ(NextEpoch(root_, true), second + 1)
      << "younger than itself, older than who was started meanwhile";
  std::ofstream(root_ / kEpochFile) << "9000000000000000\n";  // a clock that was far ahead
  EXPECT_EQ(NextEpoch(root_), 9000000000000001u);
  EXPECT_EQ(NextEpoch(root_), 9000000000000002u);
  for (const char* damaged : {"-5\n", "5\n", "", "90000000000000000\n", "{\"version\": 2, \"epoch\": 5}"}) {
    std::ofstream(root_ / kEpochFile) << damaged;
    EXPECT_THAT(
        ErrorOf<InputError>([&] { NextEpoch(root_); }),
        AllOf(HasSubstr("epoch: is damaged: it "), HasSubstr("allowed: the file of a backup; or none")))
        << damaged;
  }
  fs::remove(root_ / kEpochFile);
  fs::create_directories(root_ / kEpochFile / "in its way");
  EXPECT_GT(NextEpoch(root_), second) << "it starts all the same";
}

TEST_F(CatalogueTest, AStateOfALaterVersionIsLeftAlone) {
  Catalogue(root_ / "data").Add(Entry("a1"), "text");
  EXPECT_EQ(Catalogue(root_ / "data").entries().size(), 1u);
  const fs::path file = root_ / "data" / "a1" / "state.json";
  nlohmann::ordered_json state = nlohmann::ordered_json::parse(std::ifstream(file));
  state["version"] = state["version"].get<int>() + 1;
  std::ofstream(file) << Sealed(state);
  const std::string later = TextOfFile(file);
  const CatalogueEntry entry = Catalogue(root_ / "data").At("a1");
  EXPECT_EQ(entry.state, CampaignState::kDamaged);
  EXPECT_THAT(entry.problem,
              HasSubstr("state.json was written by a newer dispersa: version 5, this one reads 4"));
  EXPECT_EQ(TextOfFile(file), later);
}

TEST_F(CatalogueTest, WhatWasBeingDeletedIsGoneWhenItIsOpenedAgain) {
  {
    Catalogue catalogue(root_ / "data");
    catalogue.Add(Entry("a1"), "text");
    catalogue.Add(Entry("a2"), "text");
    catalogue.Remove("a1");
    EXPECT_FALSE(catalogue.entries().contains("a1"));
    EXPECT_FALSE(fs::exists(root_ / "data" / "a1"));
  }
  fs::create_directories(root_ / "data" / ".deleted-a0" / "results");
  Catalogue catalogue(root_ / "data");
  EXPECT_FALSE(fs::exists(root_ / "data" / ".deleted-a0"));
  EXPECT_EQ(catalogue.entries().size(), 1u);
}

TEST_F(CatalogueTest, RemembersEverythingOverARestart) {
  CatalogueEntry entry = Entry("a1", -3);
  {
    Catalogue catalogue(root_ / "data");
    entry = catalogue.Add(entry, "text of a1");
    entry.state = CampaignState::kFailed;
    entry.done = 5;
    entry.quarantined = 1;
    entry.conflicts = 2;
    entry.code = 1;
    entry.problem = "it \"broke\"\n\xff";
    entry.seed = 8;
    entry.ended_unix_s = 56;
    entry.distrusted = {"node1"};
    entry.owner = "ann";
    entry.launched_unix_s = 12;
    entry.bytes = 34;
    entry.verdict = "pass";
    entry.labels = {"commit=1a2b", "a=b"};
    entry.design_id = "d1";
    entry.engine = "0.1.0+e";
    entry.attempts = 3;
    entry.requirements = {{"q_max_pa", "q_max_pa below 5", 0.5, 20, 3, 0.25, std::nullopt, "fail"}};
    catalogue.Write(entry);
  }
  Catalogue catalogue(root_ / "data");
  entry.problem = "it \"broke\"\n\xef\xbf\xbd";
  EXPECT_TRUE(catalogue.At("a1") == entry) << catalogue.StateTextOf("a1");
  EXPECT_EQ(catalogue.TextOf("a1"), "text of a1");
}

TEST_F(CatalogueTest, WhatWasUnderWayWaitsAgainAndWhatEndedHasEnded) {
  const std::vector<std::pair<CampaignState, CampaignState>> before_and_after = {
      {CampaignState::kWaiting, CampaignState::kWaiting},
      {CampaignState::kFlying, CampaignState::kWaiting},
      {CampaignState::kReporting, CampaignState::kWaiting},
      {CampaignState::kDone, CampaignState::kDone},
      {CampaignState::kCancelled, CampaignState::kCancelled},
      {CampaignState::kFailed, CampaignState::kFailed}};
  {
    Catalogue catalogue(root_);
    for (const auto& [before, after] : before_and_after) {
      CatalogueEntry entry = catalogue.Add(Entry(CampaignStateName(before)), "");
      entry.state = before;
      catalogue.Write(entry);
    }
  }
  Catalogue catalogue(root_);
  for (const auto& [before, after] : before_and_after)
    EXPECT_EQ(catalogue.At(CampaignStateName(before)).state, after) << CampaignStateName(before);
}

TEST_F(CatalogueTest, FindsACampaignByTheBeginningOfItsIdIfThatIsOne) {
  Catalogue catalogue(root_);
  for (const char* id : {"abc1", "abc2", "b"}) catalogue.Add(Entry(id), "");
  EXPECT_EQ(catalogue.Find("abc2")->id, "abc2");
  EXPECT_EQ(catalogue.Find("b")->id, "b");
  for (const char* prefix : {"", "abc", "c", "abc11"}) EXPECT_EQ(catalogue.Find(prefix), nullptr) << prefix;
}

// A verdict that somebody changed by hand is no verdict, and a campaign does not vanish.
TEST_F(CatalogueTest, ADamagedStateIsListedWithItsDamageAndLeftAlone) {
  {
    Catalogue catalogue(root_);
    for (const char* id : {"a-good", "cut", "edited", "moved", "unsealed"}) {
      CatalogueEntry entry = Entry(id);
      entry.verdict = "fail";
      catalogue.Add(entry, "text");
    }
  }
  const auto state = [&](const std::string& id) { return root_ / id / "state.json"; };
  const std::string text = TextOfFile(state("edited"));
  std::ofstream(state("cut")) << text.substr(0, text.size() / 2);
  std::string edited = text;
  edited.replace(edited.find("\"fail\""), 6, "\"pass\"");
  std::ofstream(state("edited")) << edited;
  const std::size_t checksum = text.find(",\n  \"checksum\"");
  ASSERT_NE(checksum, std::string::npos);
  std::ofstream(state("unsealed")) << text.substr(0, checksum) << "}";
  fs::rename(root_ / "moved", root_ / "elsewhere");
  fs::create_directories(root_ / "stillborn");
  std::ofstream(root_ / "stillborn" / "campaign.yaml") << "text";
  fs::create_directories(root_ / "without" / "results");
  std::ofstream(root_ / "without" / "results" / "results.sqlite") << "no state tells of it";
  fs::create_directories(root_ / "folder" / "state.json");
  Catalogue catalogue(root_);
  std::string listed;
  for (const auto& [id, entry] : catalogue.entries())
    listed += id + " " + CampaignStateName(entry.state) + " " + entry.verdict + " " +
              entry.problem.substr(0, entry.problem.find(':')) + "\n";
  EXPECT_EQ(listed,
            "a-good waiting fail \n"
            "cut damaged  state.json is not a whole JSON object\n"
            "edited damaged  state.json does not fit its checksum\n"
            "elsewhere damaged  state.json is that of campaign moved\n"
            "folder damaged  state.json cannot be read\n"
            "unsealed damaged  state.json does not fit its checksum\n"
            "without damaged  state.json is missing\n");
  EXPECT_EQ(TextOfFile(state("edited")), edited);
}

TEST_F(CatalogueTest, FindsTheFlightOfAnEarlierEngineByBothPartsOfItsId) {
  Catalogue catalogue(root_);
  for (const char* id : {"abc1", "abc2", "d3"}) catalogue.Add(Entry(id), "");
  for (const auto& [id, to] : {std::pair("abc1", "abc1-e1"), std::pair("abc2", "abc2-f1")})
    catalogue.Rename(id, to);
  for (const char* id : {"abc1"}) catalogue.Add(Entry(id), "");
  const auto found = [&](const std::string& wanted) {
    const CatalogueEntry* entry = catalogue.Find(wanted);
    return entry == nullptr ? "none" : entry->id;
  };
  EXPECT_EQ(found("abc1"), "abc1");
  EXPECT_EQ(found("abc"), "abc1");
  EXPECT_EQ(found("abc1-e1"), "abc1-e1");
  EXPECT_EQ(found("abc-e"), "abc1-e1");
  EXPECT_EQ(found("abc-f"), "abc2-f1");
  for (const char* none : {"abc-", "abc-e2", "d3-e", "-e1", "-", "abc2"})
    EXPECT_EQ(found(none), "none") << none;
  EXPECT_EQ(Catalogue(root_ / "other").Find("abc1"), nullptr);
}

TEST_F(CatalogueTest, BelongsToOneProcess) {
  const Catalogue catalogue(root_);
  EXPECT_THROW(Catalogue(root_.string()), InputError);
}

TEST(RunningTally, CountsWhatBreaksARequirementInAnyOrder) {
  Campaign campaign;
  campaign.requirements = {{"pitch_error_peak_deg", 0.5, {}, 0.9, 0.1}};
  RunningTally tally(campaign);
  CaseResult result;
  result.metrics.assign(MetricCount(kUsualStages), 0.1);
  result.outcome = Outcome::kCompleted;
  EXPECT_EQ(tally.Standings().at(0).so_far, "inconclusive") << "none flown";
  EXPECT_EQ(tally.histograms().at(0).metric, "pitch_error_peak_deg");
  // 0.9^21 > 0.1 >= 0.9^22.
  for (int i = 0; i < 21; ++i) tally.Add(result);
  EXPECT_EQ(tally.Standings().at(0).so_far, "inconclusive");
  tally.Add(result);
  EXPECT_EQ(tally.Standings().at(0).so_far, "pass");
  result.outcome = Outcome::kLostControl;  // whatever it measured
  tally.Add(result);
  result.outcome = Outcome::kCompleted;
  result.metrics[MetricColumn("pitch_error_peak_deg")] = 0.5;
  for (int i = 0; i < 9; ++i) tally.Add(result);
  const RequirementStanding standing = tally.Standings().at(0);
  EXPECT_EQ(standing.n, 32);
  EXPECT_EQ(standing.failures, 10);
  EXPECT_EQ(standing.so_far, "fail");
  result.metrics[MetricColumn("pitch_error_peak_deg")] = std::nan("");
  tally.Add(result);
  // Neither the lost one nor the undefined one.
  EXPECT_EQ(tally.n(), 33);
  EXPECT_EQ(tally.histograms().at(0).values.n(), 31);
  EXPECT_EQ(tally.histograms().at(1).values.n(), 32);
  campaign.sampling.method = SamplingMethod::kSobol;
  EXPECT_EQ(RunningTally(campaign).Standings().at(0).so_far, "study");
}

}  // namespace dispersa::catalogue_test
