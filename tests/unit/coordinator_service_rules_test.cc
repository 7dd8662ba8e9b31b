// The service of many campaigns on a data folder that is made up: what becomes of campaigns that have ended,
// what their owners may still launch, what clients, browsers and monitors are told. Nothing flies here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "services/coordinator/prometheus_text.h"
#include "services/coordinator/web_rows.h"
#include "tests/distributed/made_up_service.h"

namespace dispersa::coordinator_service_rules_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMb = 1'000'000;

std::string Id(char letter) { return std::string(64, letter); }

CatalogueEntry Entry(char letter, CampaignState state, const std::string& owner = "ann") {
  CatalogueEntry entry;
  entry.id = entry.flight_id = Id(letter);
  entry.name = std::string("name-") + letter;
  entry.owner = owner;
  entry.state = state;
  entry.cases = 100;
  entry.bytes = 1;
  entry.ended_unix_s = HasEnded(state) ? 1000 : 0;
  return entry;
}

class ServiceRules : public ServiceTest {
 protected:
  void Put(const std::vector<CatalogueEntry>& entries) {
    Catalogue catalogue(folder_ / "data");
    for (const CatalogueEntry& entry : entries) catalogue.Add(entry, "text");
  }
  void Start(const std::vector<std::string>& quotas = {}, const Retention& retention = {}) {
    service_.reset();
    ServiceOptions options{folder_ / "data"};
    options.retention = retention;
    options.unix_time_s = [this] { return unix_time_s_; };
    for (const std::string& each : quotas) ASSERT_EQ(options.quotas.Add(each), "");
    service_ = std::make_unique<Service>(options, workforce_);
    desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "ann");
  }
  const CatalogueEntry& At(char letter) const { return service_->catalogue().entries().at(Id(letter)); }
  std::string Left() const {
    std::string left;
    for (const auto& [id, entry] : service_->catalogue().entries()) left += id[0];
    return left;
  }
  Json Ask(const std::string& method, const Json& arguments) {
    return Json::parse(desk_->Answer({"client", 5, method, arguments.dump(), ""}).text);
  }

  std::int64_t unix_time_s_ = 2000;
};

class QuotaRules : public ServiceRules {
 protected:
  /// Of ann: two that have not ended, with 30 and 50 cases, and one that has. Of bob: one of each.
  QuotaRules() {
    std::vector<CatalogueEntry> all = {Entry('a', CampaignState::kWaiting),
                                       Entry('b', CampaignState::kFlying), Entry('c', CampaignState::kDone),
                                       Entry('d', CampaignState::kWaiting, "bob"),
                                       Entry('e', CampaignState::kCancelled, "bob")};
    const std::uint64_t cases[] = {30, 50, 1000, 70, 1000}, bytes[] = {2, 3, 5, 100, 200};
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].cases = cases[i];
      all[i].bytes = bytes[i] * kMb;
    }
    Put(all);
  }
  /// What a new campaign of ann with `cases` is told.
  std::string LaunchUnder(const std::string& quota, std::uint64_t cases = 1) {
    Start({quota});
    CatalogueEntry entry = Entry('f', CampaignState::kWaiting);
    entry.cases = cases;
    try {
      service_->Launch(entry, "text");
    } catch (const Refused& refused) {
      return refused.what();
    }
    service_.reset();
    std::filesystem::remove_all(folder_ / "data" / Id('f'));
    return "launched";
  }
};

TEST_F(QuotaRules, CasesOfAllThatHaveNotEndedAreAdded) {
  EXPECT_EQ(LaunchUnder("cases=100", 20), "launched") << "30 + 50 + 20";
  EXPECT_THAT(LaunchUnder("cases=99", 20),
              HasSubstr("'ann' would have 100 cases in campaigns that have not"));
}

TEST_F(QuotaRules, CampaignsAreThoseThatHaveNotEnded) {
  EXPECT_EQ(LaunchUnder("campaigns=3"), "launched");
  EXPECT_THAT(LaunchUnder("campaigns=2"), HasSubstr("'ann' would have 3 campaigns that have not ended"));
}

TEST_F(QuotaRules, TheDiskIsThatOfAllWhetherTheyHaveEndedOrNot) {
  EXPECT_EQ(LaunchUnder("disk=11MB"), "launched") << "2 + 3 + 5";
  EXPECT_THAT(LaunchUnder("disk=10MB"),
              HasSubstr("another campaign beside 0.01 GB on the coordinator's disk"));
}

// Its own cases count once, whether it is new or continues.
TEST_F(QuotaRules, WhatContinuesCountsOnce) {
  Start({"cases=1080"});
  service_->Cancel(Id('a'));
  service_->Cancel(Id('b'));
  service_->Relaunch(Id('a'), 0);
  EXPECT_EQ(At('a').state, CampaignState::kWaiting) << "30";
  Start({"cases=79"});
  EXPECT_THROW(service_->Relaunch(Id('b'), 0), Refused);
  EXPECT_EQ(At('b').state, CampaignState::kCancelled);
}

/// A campaign that passed.
CatalogueEntry Passed(char letter) {
  CatalogueEntry entry = Entry(letter, CampaignState::kDone);
  entry.done = 97;
  entry.quarantined = 3;
  entry.conflicts = 2;
  entry.verdict = "pass";
  entry.engine = "1";
  entry.attempts = 4;
  entry.requirements = {{"q_max_pa", "words", 0.9, 97, 1, {}, {}, "pass"}};
  return entry;
}

TEST_F(ServiceRules, ARepairedCampaignHasNoVerdictAndTheOthersKeepTheirs) {
  Put({Passed('a'), Passed('b')});
  Start();
  service_->Repair(Id('a'), "node1");
  for (int restart = 0; restart < 2; ++restart) {
    EXPECT_EQ(At('a').state, CampaignState::kWaiting);
    EXPECT_EQ(At('a').verdict, "");
    EXPECT_EQ(At('a').engine, "");
    EXPECT_THAT(At('a').requirements, IsEmpty());
    EXPECT_EQ(At('a').conflicts, 0u);
    EXPECT_THAT(At('a').distrusted, ElementsAre("node1"));
    EXPECT_EQ(At('b').verdict, "pass");
    EXPECT_EQ(At('b').conflicts, 2u);
    Start();
  }
  service_->Repair(Id('a'), "node2");
  EXPECT_THAT(At('a').distrusted, ElementsAre("node1", "node2")) << "the first one's results are still there";
}

TEST_F(ServiceRules, ACampaignThatIsLaunchedAgainHasNoVerdictAndItsNewLabels) {
  Put({Passed('a'), Passed('b')});
  Start();
  service_->Relaunch(Id('a'), 7, {"commit=1"});
  service_->Relaunch(Id('b'), 0);
  EXPECT_EQ(At('a').priority, 7);
  EXPECT_EQ(At('a').verdict, "");
  EXPECT_EQ(At('a').conflicts, 2u) << "whoever repairs it forgets them";
  EXPECT_THAT(At('a').labels, ElementsAre("commit=1"));
  EXPECT_THAT(At('b').labels, IsEmpty());
}

TEST_F(ServiceRules, OldCampaignsGoUntilTheOthersFitOnceAMinute) {
  std::vector<CatalogueEntry> all;
  for (const char letter : {'a', 'b', 'c', 'd'}) {
    all.push_back(Entry(letter, CampaignState::kDone));
    all.back().bytes = (letter == 'b' ? 10 : 1) * kMb;
    all.back().ended_unix_s = 1000 - letter;  // the last letter first
  }
  Put(all);
  Start({}, {.bytes = 11 * kMb});
  service_->Step();
  EXPECT_EQ(Left(), "ab") << "13 MB - 1 - 1";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "data" / Id('c')));
  Start({}, {.bytes = 2 * kMb});
  service_->Step();
  EXPECT_EQ(Left(), "a") << "10 MB went";
  CatalogueEntry later = Entry('e', CampaignState::kDone);
  later.bytes = 5 * kMb;
  later.ended_unix_s = 1;
  service_->Launch(later, "text");
  workforce_.time_s += 59.0;
  service_->Step();
  EXPECT_EQ(Left(), "ae");
  workforce_.time_s += 2.0;
  service_->Step();
  EXPECT_EQ(Left(), "a");
}

TEST_F(ServiceRules, TheLineOfADeletedCampaignSaysWhatWasFlownAndHowItStood) {
  CatalogueEntry done = Passed('a'), cancelled = Entry('b', CampaignState::kCancelled, "bob");
  cancelled.done = 12;
  Put({done, cancelled});
  for (const char letter : {'a', 'b'}) {
    const std::filesystem::path results = folder_ / "data" / Id(letter) / "results";
    std::filesystem::create_directories(results);
    std::ofstream(results / "summary.json") << R"({"verdict": "pass"})";
  }
  Start();
  service_->Delete(Id('a'));
  service_->Delete(Id('b'));
  std::istringstream lines(TextOfFile(folder_ / "data" / "deleted.jsonl"));
  std::string first, second;
  std::getline(lines, first);
  std::getline(lines, second);
  const Json of_a = Json::parse(first), of_b = Json::parse(second);
  EXPECT_EQ(of_a.at("cases"), 97);
  EXPECT_EQ(of_a.at("verdict"), "pass");
  EXPECT_EQ(of_b.at("cases"), 12);
  EXPECT_EQ(of_b.at("owner"), "bob");
  EXPECT_EQ(of_b.at("verdict"), "") << "its report is of results that are gone";
}

TEST_F(ServiceRules, ALaterCampaignIsTheYoungerAlsoAfterARestart) {
  Put({Entry('b', CampaignState::kDone), Entry('c', CampaignState::kDone)});
  Put({Entry('a', CampaignState::kDone)});
  Start();
  EXPECT_THAT(service_->catalogue().InOrder(), ElementsAre(Id('b'), Id('c'), Id('a')));
}

// A campaign that has ended is launched again for its label alone.
TEST_F(ServiceRules, BrowsersSeeEveryChangeOfACampaignThatHasEnded) {
  Put({Entry('a', CampaignState::kDone), Entry('b', CampaignState::kDone)});
  Start();
  WebRows rows;
  const auto before = rows.Make(*service_);
  service_->Relaunch(Id('a'), 0, {"commit=2"});
  const auto labelled = rows.Make(*service_);
  EXPECT_THAT(before->Find("a")->labels, IsEmpty());
  EXPECT_THAT(labelled->Find("a")->labels, ElementsAre("commit=2"));
  EXPECT_EQ(labelled->Find("b"), before->Find("b")) << "what has not changed is not made again";
  service_->Relaunch(Id('b'), 5);
  EXPECT_EQ(rows.Make(*service_)->Find("b")->priority, 5);
  EXPECT_EQ(rows.Make(*service_)->Find("a")->priority, 0);
  unix_time_s_ += 10;
  service_->Repair(Id('a'), "node1");
  service_->Cancel(Id('a'));
  EXPECT_EQ(rows.Make(*service_)->Find("a")->ended_unix_s, 2010);
  EXPECT_EQ(rows.Make(*service_)->Find("a")->state, "cancelled");
}

TEST_F(ServiceRules, MonitorsSeeTheSumOfAllCampaigns) {
  CatalogueEntry waiting = Entry('c', CampaignState::kWaiting),
                 other = Entry('d', CampaignState::kWaiting, "bob");
  waiting.done = 10, waiting.quarantined = 2, waiting.conflicts = 1, waiting.bytes = 50;
  other.done = 30, other.quarantined = 5, other.conflicts = 4, other.bytes = 70, other.cases = 40;
  CatalogueEntry first = Passed('a'), second = Passed('b');
  first.bytes = 1000, second.bytes = 300, second.done = 50, second.quarantined = 50;
  Put({first, second, waiting, other});
  Start();
  const std::string text = PrometheusText(*service_, workforce_, {});
  EXPECT_THAT(text,
              HasSubstr("dispersa_campaigns{state=\"done\"} 2\ndispersa_campaigns{state=\"waiting\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("\ndispersa_cases_done 187\n")) << "97 + 50 + 10 + 30";
  EXPECT_THAT(text, HasSubstr("\ndispersa_cases_waiting 93\n")) << "88 + 5";
  EXPECT_THAT(text, HasSubstr("\ndispersa_cases_quarantined 60\n")) << "3 + 50 + 2 + 5";
  EXPECT_THAT(text, HasSubstr("\ndispersa_conflicts 9\n")) << "2 + 2 + 1 + 4";
  EXPECT_THAT(text, HasSubstr("\ndispersa_disk_bytes 1420\n"));
  const std::string ann = "campaign=\"" + std::string(12, 'c') + "\",name=\"name-c\",owner=\"ann\"",
                    bob = "campaign=\"" + std::string(12, 'd') + "\",name=\"name-d\",owner=\"bob\"";
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_cases{" + ann + ",state=\"done\"} 10\n"));
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_cases{" + bob + ",state=\"done\"} 30\n"));
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_disk_bytes{" + bob + "} 70\n"));
  EXPECT_THAT(text, Not(HasSubstr("name-a"))) << "it has ended";
}

TEST_F(ServiceRules, MonitorsSeeTheFirstHundredOfTheQueue) {
  Put({Entry('a', CampaignState::kWaiting)});
  const Json state = Json::parse(TextOfFile(folder_ / "data" / Id('a') / "state.json"));
  for (int i = 0; i < 101; ++i) {
    Json other = state;
    const std::string id = std::to_string(1000 + i) + std::string(60, 'b');
    other["id"] = id;
    other["order"] = 2 + i;
    std::filesystem::create_directories(folder_ / "data" / id);
    std::ofstream(folder_ / "data" / id / "state.json") << other;
  }
  Start();
  const std::string text = PrometheusText(*service_, workforce_, {});
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_disk_bytes{campaign=\"aaaaaaaaaaaa\""));
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_disk_bytes{campaign=\"1098"));
  EXPECT_THAT(text, Not(HasSubstr("dispersa_campaign_disk_bytes{campaign=\"1099")));
}

TEST_F(ServiceRules, ALabelHasAKeyOfThirtyTwoAndAValueOfAHundred) {
  Put({Entry('a', CampaignState::kDone)});
  Start();
  const auto answer = [&](const std::string& key, const std::string& value) {
    const Json arguments = {{"id", Id('a')}, {"flight_id", Id('a')}, {"labels", {key + "=" + value}}};
    return desk_->Answer({"client", 5, "launch", arguments.dump(), ""}).code;
  };
  EXPECT_EQ(answer(std::string(32, 'k'), "1"), 0);
  EXPECT_EQ(answer(std::string(33, 'k'), "1"), 2);
  EXPECT_EQ(answer("k", std::string(100, 'v')), 0);
  EXPECT_EQ(answer("k", std::string(101, 'v')), 2);
  EXPECT_EQ(At('a').labels.size(), 2u);
}

// Of two campaigns with all numbers different, each has its own.
TEST_F(ServiceRules, AListSaysOfEachCampaignItsOwnNumbers) {
  CatalogueEntry done = Passed('a'), waiting = Entry('b', CampaignState::kWaiting, "bob");
  done.code = 3, done.bytes = 77, done.labels = {"commit=1"};
  waiting.cases = 50, waiting.done = 20, waiting.quarantined = 1, waiting.code = 9, waiting.priority = 4;
  Put({done, waiting});
  Start();
  const Json list = Ask("list", Json::object()).at("campaigns");
  const Json &first = list.at(0), &second = list.at(1);
  EXPECT_EQ(first.at("id"), Id('b')) << "the higher priority";
  EXPECT_EQ(first.at("total"), 50);
  EXPECT_EQ(first.at("done"), 20);
  EXPECT_EQ(first.at("quarantined"), 1);
  EXPECT_EQ(first.at("owner"), "bob");
  EXPECT_TRUE(first.at("code").is_null());
  EXPECT_TRUE(first.at("verdict").is_null());
  EXPECT_EQ(first.at("rate_per_s"), 0.0);
  EXPECT_TRUE(first.at("eta_s").is_null());
  EXPECT_EQ(second.at("total"), 100);
  EXPECT_EQ(second.at("done"), 97);
  EXPECT_EQ(second.at("quarantined"), 3);
  EXPECT_EQ(second.at("code"), 3);
  EXPECT_EQ(second.at("verdict"), "pass");
  EXPECT_EQ(second.at("bytes"), 77);
  EXPECT_THAT(second.at("labels"), ElementsAre("commit=1"));
}

}  // namespace
}  // namespace dispersa::coordinator_service_rules_test
