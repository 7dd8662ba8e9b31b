// The service of many campaigns on a data folder that is made up: what becomes of campaigns that have ended,
// what their owners may still launch, what clients, browsers and monitors are told. What flies here is made
// up, too.
#include <nlohmann/json.hpp>

#include "core/flight/engine_version.h"
#include "services/coordinator/packed_files.h"
#include "services/coordinator/prometheus_text.h"
#include "services/coordinator/sealed_json.h"
#include "services/coordinator/web_rows.h"
#include "tests/distributed/made_up_service.h"
#include "tests/test.h"

namespace dispersa::coordinator_service_rules_test {
namespace {

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
  /// Of a state each, "name-0" launched first.
  void PutMany(int count, const std::function<CampaignState(int)>& state) {
    Put({Entry('a', CampaignState::kWaiting)});
    nlohmann::ordered_json json =
        nlohmann::ordered_json::parse(TextOfFile(folder_ / "data" / Id('a') / "state.json"));
    std::filesystem::remove_all(folder_ / "data" / Id('a'));
    for (int i = 0; i < count; ++i) {
      const std::string id = std::to_string(1000 + i) + std::string(60, 'b');
      json["id"] = id;
      json["name"] = "name-" + std::to_string(i);
      json["order"] = 1 + i;
      json["state"] = CampaignStateName(state(i));
      std::filesystem::create_directories(folder_ / "data" / id);
      std::ofstream(folder_ / "data" / id / "state.json") << Sealed(json);
    }
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
  EXPECT_EQ(LaunchUnder("disk=10MB"),
            "'ann' would have another campaign beside 0.01 GB on the coordinator's disk, allowed: less than "
            "0.01 GB; delete campaigns that have ended (dispersa-coordinator --quota disk)");
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
  entry.engine = EngineVersion();
  entry.attempts = 4;
  entry.requirements = {{"q_max_pa", "words", 0.9, 97, 1, {}, {}, "pass", 91.5, {80.0, 95.25}}};
  return entry;
}

TEST_F(ServiceRules, ARepairedCampaignHasNoVerdictAndTheOthersKeepTheirs) {
  Put({Passed('a'), Passed('b')});
  Start();
  service_->Repair(Id('a'), "node1");
  for (int restart = 0; restart < 2; ++restart) {
    EXPECT_EQ(At('a').state, CampaignState::kWaiting);
    EXPECT_EQ(At('a').verdict, "");
    EXPECT_THAT(At('a').requirements, IsEmpty());
    EXPECT_EQ(At('a').conflicts, 0u);
    EXPECT_THAT(At('a').distrusted, ElementsAre("node1"));
    EXPECT_EQ(At('b').verdict, "pass");
    EXPECT_EQ(At('b').conflicts, 2u);
    EXPECT_EQ(At('b').requirements, Passed('b').requirements);
    Start();
  }
  service_->Repair(Id('a'), "node2");
  EXPECT_THAT(At('a').distrusted, ElementsAre("node1", "node2")) << "the first one's results are still there";
}

// Whoever cancels it then must not fetch a verdict on results that are gone.
TEST_F(ServiceRules, ARepairedCampaignHasNoReportAndTheOthersKeepTheirs) {
  Put({Passed('a'), Passed('b')});
  const auto results = [&](char letter) { return folder_ / "data" / Id(letter) / "results"; };
  for (const char letter : {'a', 'b'}) {
    std::filesystem::create_directories(results(letter) / "histories");
    for (const char* name : {"campaign.yaml", "results.sqlite", "attempts.jsonl", "cases.csv", "summary.json",
                             "report.html.gz", "histories/nominal.csv.gz"})
      std::ofstream(results(letter) / name) << "text";
  }
  Start();
  service_->Repair(Id('a'), "node1");
  EXPECT_THAT(StoredFilesIn(results('a')), ElementsAre("attempts.jsonl", "campaign.yaml", "results.sqlite"));
  EXPECT_EQ(StoredFilesIn(results('b')).size(), 7u);
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
  for (const auto& [days, left] : {std::pair(0.02, "a"), std::pair(0.01, "")}) {
    Start({}, {.days = days});
    service_->Step();
    EXPECT_EQ(Left(), left) << "it ended 1097 s ago";
  }
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
  const auto before = rows.Make(*service_, workforce_);
  service_->Relaunch(Id('a'), 0, {"commit=2"});
  const auto labelled = rows.Make(*service_, workforce_);
  EXPECT_THAT(before->Find("a")->labels, IsEmpty());
  EXPECT_THAT(labelled->Find("a")->labels, ElementsAre("commit=2"));
  EXPECT_EQ(labelled->Find("b"), before->Find("b")) << "what has not changed is not made again";
  service_->Relaunch(Id('b'), 5);
  EXPECT_EQ(rows.Make(*service_, workforce_)->Find("b")->priority, 5);
  EXPECT_EQ(rows.Make(*service_, workforce_)->Find("a")->priority, 0);
  unix_time_s_ += 10;
  service_->Repair(Id('a'), "node1");
  service_->Cancel(Id('a'));
  EXPECT_EQ(rows.Make(*service_, workforce_)->Find("a")->ended_unix_s, 2010);
  EXPECT_EQ(rows.Make(*service_, workforce_)->Find("a")->state, "cancelled");
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
  PutMany(101, [](int) { return CampaignState::kWaiting; });
  Start();
  const std::string text = PrometheusText(*service_, workforce_, {});
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_disk_bytes{campaign=\"1000"));
  EXPECT_THAT(text, HasSubstr("dispersa_campaign_disk_bytes{campaign=\"1099"));
  EXPECT_THAT(text, Not(HasSubstr("dispersa_campaign_disk_bytes{campaign=\"1100")));
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

// Campaigns that fly: what each of several has, and what stays of it.
class FlyingRules : public ServiceRules {
 protected:
  /// With two requirements that differ in everything.
  static Campaign Judged(std::uint64_t cases, std::uint64_t seed = 1) {
    std::string text = Smoke(cases, seed).canonical_yaml;
    const std::size_t begin = text.find("\nrequirements:\n") + 1;
    std::size_t end = begin;
    do end = text.find('\n', end) + 1;
    while (text[end] == ' ' || text[end] == '-');
    text.replace(begin, end - begin,
                 "requirements:\n"
                 "  - {metric: pitch_error_peak_deg, below: 1, probability: 0.8, consumer_risk: 0.1}\n"
                 "  - {metric: q_max_pa, above: 2000, probability: 0.5, consumer_risk: 0.2}\n");
    return ParseCampaign(text, "judged");
  }
  void Return(const Campaign& campaign, std::uint64_t case_index, double peak_deg = 0.1, double q_pa = 5000.0,
              const std::string& worker = "node1_ab") {
    CaseResult result = MadeUpWorkforce::ResultOf(case_index);
    result.metrics[MetricColumn("pitch_error_peak_deg")] = peak_deg;
    result.metrics[MetricColumn("q_max_pa")] = q_pa;
    workforce_.Return(worker, campaign.flight_id, result);
  }
  void Second() {
    workforce_.time_s += 1.0;
    service_->Step();
  }
};

TEST_F(FlyingRules, EachRequirementAndEachCampaignHasItsOwnNumbers) {
  Start();
  const Campaign one = Judged(10), other = Smoke(20, 2);
  ASSERT_TRUE(Reaches(Launch(one), CampaignState::kFlying));
  ASSERT_TRUE(Reaches(Launch(other), CampaignState::kFlying));
  Second();
  Return(one, 0, 1.5, 5000.0);
  Return(one, 1, 1.5, 1000.0);
  Return(one, 2, 0.5, 1000.0);
  Return(one, 3, 0.5, 1000.0);
  for (std::uint64_t i = 0; i < 7; ++i) Return(other, i);
  Second();
  const auto index = WebRows().Make(*service_, workforce_);
  const std::vector<RequirementOutcome>& shown = index->Find(one.id)->requirements;
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_THAT(shown[0].words, HasSubstr("for 80 % of flights at 10 % risk"));
  EXPECT_THAT(shown[1].words, HasSubstr("for 50 % of flights at 20 % risk"));
  EXPECT_EQ(shown[0].probability, 0.8);
  EXPECT_EQ(shown[1].probability, 0.5);
  EXPECT_EQ(shown[0].failures, 2);
  EXPECT_EQ(shown[1].failures, 3);
  EXPECT_THAT(shown[0].words, HasSubstr("pitch_error_peak_deg below 1 "));
  EXPECT_THAT(shown[1].words, HasSubstr("q_max_pa above 2000 "));
  const std::string figures = PrometheusText(*service_, workforce_, {});
  EXPECT_EQ(service_->View(one.id).rate_per_s, 4.0);
  EXPECT_EQ(service_->View(other.id).rate_per_s, 7.0);
  EXPECT_THAT(figures, HasSubstr("\ndispersa_results_per_second 11\n"));
  EXPECT_EQ(service_->View(one.id).eta_s, 6.0 / 4.0);
  EXPECT_EQ(index->Find(other.id)->eta_s, 13.0 / 7.0);
  const std::string labels = "{campaign=\"" + other.id.substr(0, 12) + "\",name=\"smoke\",owner=\"\"}";
  EXPECT_THAT(figures, HasSubstr("dispersa_campaign_results_per_second" + labels + " 7\n"));
  for (const CampaignProgress& told : {*(workforce_.published.end() - 2), workforce_.published.back()}) {
    EXPECT_EQ(told.state, "flying");
    EXPECT_EQ(told.total, told.campaign_id == one.id ? 10u : 20u);
    EXPECT_EQ(told.done, told.campaign_id == one.id ? 4u : 7u);
  }
}

TEST_F(FlyingRules, AnExpelledWorkersResultsGiveNoRateBelowZero) {
  Start();
  const Campaign campaign = Smoke(20);
  ASSERT_TRUE(Reaches(Launch(campaign), CampaignState::kFlying));
  for (std::uint64_t i = 0; i < 5; ++i) Return(campaign, i);
  Second();
  workforce_.Expel({{"node1", {"case 4 gives other bits"}}});
  Second();
  EXPECT_EQ(service_->View(campaign.id).progress.done, 0u);
  EXPECT_EQ(service_->View(campaign.id).rate_per_s, 0.0);
  EXPECT_EQ(service_->View(campaign.id).eta_s, std::nullopt);
  EXPECT_THAT(PrometheusText(*service_, workforce_, {}), HasSubstr("\ndispersa_results_per_second 0\n"));
}

// What an entry says of an earlier life: 3 stored results, which are gone, 2 contradictions, a distrusted
// worker.
TEST_F(FlyingRules, AnEntryFollowsWhatTheLedgerFinds) {
  const Campaign campaign = Smoke(4);
  CatalogueEntry entry = Entry('a', CampaignState::kWaiting);
  entry.id = campaign.id, entry.flight_id = campaign.flight_id, entry.cases = 4;
  entry.done = 3, entry.conflicts = 2, entry.distrusted = {"node9"};
  {
    Catalogue catalogue(folder_ / "data");
    catalogue.Add(entry, campaign.canonical_yaml);
  }
  Start();
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  const auto now = [&]() -> const CatalogueEntry& { return service_->catalogue().entries().at(campaign.id); };
  EXPECT_THAT(now().distrusted, IsEmpty()) << "its results were removed when it was opened";
  Return(campaign, 1);
  Return(campaign, 1, 0.2);
  Second();
  EXPECT_EQ(now().done, 1u) << "a restart must not promise three";
  EXPECT_EQ(now().conflicts, 3u);
  Return(campaign, 2);
  service_->Repair(campaign.id, "node2");
  EXPECT_EQ(now().done, 2u);
  EXPECT_EQ(now().conflicts, 0u);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(campaign.id).progress.done, 2u);
  service_->Cancel(campaign.id);
  workforce_.Expel({{"node1", {"case 1 gives other bits"}}});
  service_->Relaunch(campaign.id, 0);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(campaign.id).progress.done, 0u) << "those of an expelled worker";
}

// Three lives of a worker end in the one case.
TEST_F(FlyingRules, QuarantinedCasesAreKnownWhenACampaignEnds) {
  Start();
  const Campaign campaign = Smoke(2);
  ASSERT_TRUE(Reaches(Launch(campaign), CampaignState::kFlying));
  Return(campaign, 1);
  for (const char* worker : {"a", "b", "c"}) {
    workforce_.Join(worker);
    const std::vector<FlyOrder> orders = workforce_.Tick();
    ASSERT_EQ(orders.size(), 1u);
    workforce_.dispatcher.On(
        worker, Report{worker, MadeUpWorkforce::kEpoch, 1, campaign.flight_id, {}, {{0, orders[0].attempt}}},
        workforce_.time_s);
    workforce_.time_s += 10.5;
    workforce_.Tick();
  }
  EXPECT_EQ(service_->View(campaign.id).progress.quarantined, 1u);
  service_->Cancel(campaign.id);
  EXPECT_EQ(service_->View(campaign.id).progress.quarantined, 1u);
  EXPECT_EQ(service_->View(campaign.id).progress.done, 1u);
}

// The folder of the first is read while the second is opened; that of another one is not.
TEST_F(FlyingRules, WhatIsBeingTakenOverIsNotDeleted) {
  const Campaign few = Smoke(3), more = Smoke(5), unlike = Smoke(3, 2);
  Start();
  for (const Campaign& campaign : {few, unlike}) {
    Launch(campaign);
    service_->Cancel(campaign.id);
  }
  Launch(more);
  service_->Step();
  EXPECT_THROW(service_->Delete(few.id), Refused);
  EXPECT_NO_THROW(service_->Delete(unlike.id));
  ASSERT_TRUE(Reaches(more.id, CampaignState::kFlying));
  EXPECT_NO_THROW(service_->Delete(few.id));
}

class DeskRules : public ServiceRules {
 protected:
  void StartWithKeys() {
    Start();
    desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "");
  }
  int Code(const std::string& client, const std::string& method, const Json& arguments,
           const std::string& data = "") {
    return desk_->Answer({client, 5, method, arguments.dump(), data}).code;
  }
  const std::string ann_ = "_run_ann_1", bob_ = "_run_bob_2";
};

TEST_F(DeskRules, EachOwnerLabelsItsOwnCampaigns) {
  Put({Entry('a', CampaignState::kDone), Entry('b', CampaignState::kDone, "bob")});
  StartWithKeys();
  const auto label = [&](const std::string& client, char letter, const std::string& text) {
    return Code(client, "launch", {{"id", Id(letter)}, {"flight_id", Id(letter)}, {"labels", {text}}});
  };
  EXPECT_EQ(label(ann_, 'a', "by=ann"), 0);
  EXPECT_EQ(label(bob_, 'b', "by=bob"), 0);
  EXPECT_EQ(label(bob_, 'a', "by=bob"), 2);
  EXPECT_EQ(label(bob_, 'a', "by=ann"), 0) << "it is there already";
  EXPECT_THAT(At('a').labels, ElementsAre("by=ann"));
  EXPECT_THAT(At('b').labels, ElementsAre("by=bob"));
}

TEST_F(DeskRules, EachClientSendsFourTextsAtATime) {
  StartWithKeys();
  const auto upload = [&](const std::string& client, char letter) {
    return Code(client, "upload", {{"id", Id(letter)}, {"size", 10}, {"offset", 0}}, "part");
  };
  for (const char letter : {'a', 'b', 'c', 'd'}) EXPECT_EQ(upload(bob_, letter), 0);
  EXPECT_EQ(upload(bob_, 'e'), 5);
  EXPECT_EQ(upload(bob_, 'a'), 0) << "one of his four";
  for (const char letter : {'f', 'g', 'h', 'i'}) EXPECT_EQ(upload(ann_, letter), 0);
}

TEST_F(DeskRules, ANewCampaignHasTheLastOfTheLabelsThatItIsGiven) {
  StartWithKeys();
  const Campaign campaign = Smoke(2);
  std::vector<std::string> labels;
  for (int i = 0; i < 34; ++i) labels.push_back("n=" + std::to_string(i % 33));
  const std::string& text = campaign.canonical_yaml;
  ASSERT_EQ(Code(ann_, "upload", {{"id", campaign.id}, {"size", text.size()}, {"offset", 0}}, text), 0);
  while (!service_->catalogue().entries().contains(campaign.id))
    ASSERT_EQ(
        Code(ann_, "launch", {{"id", campaign.id}, {"flight_id", campaign.flight_id}, {"labels", labels}}),
        0);
  const CatalogueEntry& entry = service_->catalogue().entries().at(campaign.id);
  EXPECT_EQ(entry.owner, "ann");
  ASSERT_EQ(entry.labels.size(), 32u);
  EXPECT_EQ(entry.labels.front(), "n=2");
  EXPECT_EQ(entry.labels.back(), "n=0") << "given again";
}

// All that have not ended, and the youngest of the others: 500 in all.
TEST_F(DeskRules, ALongListLeavesOutTheOldestThatHaveEnded) {
  PutMany(502, [](int i) { return i == 0 ? CampaignState::kWaiting : CampaignState::kDone; });
  Start();
  const Json list = Ask("list", Json::object());
  ASSERT_EQ(list.at("campaigns").size(), 500u);
  EXPECT_EQ(list.at("unlisted"), 2);
  EXPECT_EQ(list.at("campaigns")[0].at("name"), "name-0");
  EXPECT_EQ(list.at("campaigns")[1].at("name"), "name-3");
  EXPECT_EQ(list.at("campaigns")[499].at("name"), "name-501");
}

TEST_F(DeskRules, EachWorkerHasItsOwnState) {
  Start();
  workforce_.Join("a", 3);
  workforce_.dispatcher.On("b",
                           WorkerStatus{"b",
                                        "other",
                                        1,
                                        EngineVersion(),
                                        5,
                                        10,
                                        WorkerState::kDraining,
                                        7,
                                        MadeUpWorkforce::kEpoch,
                                        {},
                                        {}},
                           workforce_.time_s);
  const Json status = Ask("status", Json::object()), workers = status.at("workers");
  EXPECT_EQ(status.at("schema"), "dispersa/status/1");
  EXPECT_TRUE(status.at("web").is_null());
  ASSERT_EQ(workers.size(), 2u);
  EXPECT_EQ(workers[0],
            Json::parse(R"({"id": "a", "host": "host", "slots": 3, "state": "ready", "flown": 0})"));
  EXPECT_EQ(workers[1].at("state"), "draining");
  EXPECT_EQ(workers[1].at("slots"), 5);
  EXPECT_EQ(workers[1].at("flown"), 7);
  EXPECT_THAT(PrometheusText(*service_, workforce_, {}), HasSubstr("\ndispersa_slots 8\n"));
}

}  // namespace
}  // namespace dispersa::coordinator_service_rules_test
