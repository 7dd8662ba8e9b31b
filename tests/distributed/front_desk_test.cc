// The front desk without a network: its answers to clients and its refusals.
#include "services/coordinator/front_desk.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/results/result_folder.h"
#include "made_up_service.h"
#include "services/coordinator/outcomes.h"
#include "services/coordinator/web_rows.h"
#include "services/program/exit_code.h"
#include "tests/test.h"

namespace dispersa::front_desk_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class FrontDeskTest : public ServiceTest {
 protected:
  FrontDeskTest() { StartService(); }

  Reply Ask(const std::string& method, const Json& arguments, const std::string& data = "") {
    return desk_->Answer({"client", 5, method, arguments.dump(), data});
  }
  Json AskFor(const std::string& method, const Json& arguments, const std::string& data = "") {
    const Reply reply = Ask(method, arguments, data);
    EXPECT_EQ(reply.code, kExitDone) << method << ": " << reply.text;
    return Json::parse(reply.text);
  }
  /// "code: text"
  std::string Refusal(const std::string& method, const Json& arguments, const std::string& data = "") {
    const Reply reply = Ask(method, arguments, data);
    return std::to_string(reply.code) + ": " + reply.text;
  }
  std::uint64_t Upload(const std::string& id, std::uint64_t size, std::uint64_t offset,
                       const std::string& part) {
    return AskFor("upload", {{"id", id}, {"size", size}, {"offset", offset}}, part).at("received");
  }
  /// The answer when the text has been parsed.
  Reply LaunchUploaded(const Campaign& campaign, int priority = 0) {
    const Json arguments = {{"id", campaign.id}, {"flight_id", campaign.flight_id}, {"priority", priority}};
    Reply reply = Ask("launch", arguments);
    while (reply.code == 0 && Json::parse(reply.text).at("state") == "checked")
      reply = Ask("launch", arguments);
    return reply;
  }
  static std::string TooMany() { return "5: the coordinator takes 8 texts at a time already"; }
};

TEST_F(FrontDeskTest, AnAnswerNamesItsClientAndItsQuestion) {
  const Reply reply = desk_->Answer({"ann", 17, "health", "", ""});
  EXPECT_EQ(reply.client, "ann");
  EXPECT_EQ(reply.number, 17u);
  EXPECT_EQ(reply.code, kExitDone);
  EXPECT_EQ(reply.text, "{}");
}

TEST(VerdictWords, SayWhatTheCodeMeans) {
  CatalogueEntry entry;
  for (const CampaignState state :
       {CampaignState::kFlying, CampaignState::kCancelled, CampaignState::kFailed}) {
    entry.state = state;
    entry.code = kExitIncomplete;
    EXPECT_EQ(VerdictWords(entry), "") << CampaignStateName(state);
  }
  entry.state = CampaignState::kDone;
  const std::vector<std::pair<int, std::string>> expected = {
      {kExitDone, "every requirement is met"},
      {kExitInternalError, "two results of a case differ"},
      {kExitRequirementFailed, "a requirement failed"},
      {kExitInconclusive, "undecided: more cases can decide"},
      {kExitIncomplete, "incomplete"},
      {kExitNotEvidence, "not evidence"}};
  for (const auto& [code, words] : expected) {
    entry.code = code;
    EXPECT_EQ(VerdictWords(entry), words);
  }
  entry.code = kExitDone;
  entry.verdict = "nothing_judged";
  EXPECT_EQ(VerdictWords(entry), "nothing is required");
}

TEST_F(FrontDeskTest, AnUnknownRequestIsRefusedInWords) {
  EXPECT_EQ(Refusal("fly", Json::object()), "2: the coordinator does not know the request 'fly'");
  EXPECT_EQ(Refusal("cancel", Json::object()),
            "2: the coordinator does not understand the arguments of 'cancel'");
  const Reply reply = desk_->Answer({"client", 5, "list", "{", ""});
  EXPECT_EQ(reply.text, "the coordinator does not understand the arguments of 'list'");
  EXPECT_EQ(reply.code, kExitBadInput);
  EXPECT_EQ(Refusal("status", {{"id", "ab\x1b"}}), "2: no campaign, or more than one, has the id 'ab\\x1b'");
}

TEST_F(FrontDeskTest, ATextComesInPartsEachOnce) {
  const Campaign campaign = Smoke(2);
  const std::string& text = campaign.canonical_yaml;
  const Json launch = {{"id", campaign.id}, {"flight_id", campaign.flight_id}, {"priority", 3}};
  EXPECT_EQ(AskFor("launch", launch).at("state"), "unknown");
  EXPECT_EQ(Upload(campaign.id, text.size(), 0, text.substr(0, 1000)), 1000u);
  EXPECT_EQ(Upload(campaign.id, text.size(), 0, text.substr(0, 1000)), 1000u) << "the answer got lost";
  EXPECT_EQ(Upload(campaign.id, text.size(), 500, text.substr(500, 1000)), 1000u) << "not the next one";
  EXPECT_EQ(AskFor("launch", launch).at("state"), "unknown") << "half a text";
  EXPECT_EQ(Upload(campaign.id, text.size(), 1000, text.substr(1000) + "x"), 1000u) << "beyond the text";
  EXPECT_EQ(Upload(campaign.id, text.size(), 1000, text.substr(1000)), text.size());
  EXPECT_EQ(LaunchUploaded(campaign, 3).code, kExitDone);
  EXPECT_EQ(service_->catalogue().TextOf(campaign.id), text);
  EXPECT_EQ(service_->catalogue().entries().at(campaign.id).priority, 3);
}

TEST_F(FrontDeskTest, EightTextsAtATimeAndNoMore) {
  for (int i = 0; i < 8; ++i) {
    const Json part = {{"id", std::to_string(i)}, {"size", 10}, {"offset", 0}};
    EXPECT_EQ(desk_->Answer({i < 4 ? "client" : "other", 5, "upload", part.dump(), "12345"}).code, kExitDone);
  }
  const Json ninth = {{"id", "ninth"}, {"size", 10}, {"offset", 0}};
  EXPECT_EQ(Refusal("upload", ninth, "12345"), TooMany());
  EXPECT_EQ(Upload("3", 10, 5, "67890"), 10u) << "those that have begun go on";
  // A client that died frees its place after a minute.
  workforce_.time_s += 59.0;
  EXPECT_EQ(Upload("3", 10, 10, ""), 10u);
  EXPECT_EQ(Refusal("upload", ninth, "12345"), TooMany());
  workforce_.time_s += 2.0;
  EXPECT_EQ(AskFor("upload", ninth, "12345").at("received"), 5);
}

TEST_F(FrontDeskTest, ATextHasAtMost64MiB) {
  EXPECT_EQ(Upload("fits", 64 << 20, 0, ""), 0u);
  EXPECT_EQ(Refusal("upload", {{"id", "large"}, {"size", (64 << 20) + 1}, {"offset", 0}}),
            "2: the campaign's text is larger than 64 MiB");
}

TEST_F(FrontDeskTest, ACampaignHasAtMostSoManyCases) {
  StartService(8, 100);
  const Campaign fits = Smoke(100), large = Smoke(101);
  for (const Campaign* campaign : {&large, &fits})
    Upload(campaign->id, campaign->canonical_yaml.size(), 0, campaign->canonical_yaml);
  const Reply refused = LaunchUploaded(large);
  EXPECT_EQ(refused.code, kExitBadInput);
  EXPECT_EQ(refused.text, "campaign " + large.id.substr(0, 8) +
                              " has 101 cases, allowed: at most 100 (dispersa-coordinator --max-cases)");
  EXPECT_EQ(LaunchUploaded(fits).code, kExitDone);
  EXPECT_EQ(service_->catalogue().entries().size(), 1u);
}

// A campaign's folder cannot be made: the client is told, and the next one is launched.
TEST_F(FrontDeskTest, AFolderThatCannotBeMadeIsARefusal) {
  const Campaign first = Smoke(2), second = Smoke(3);
  const fs::path folder = folder_ / "data" / first.id;
  std::ofstream(folder) << "in its way";
  for (const Campaign* campaign : {&first, &second})
    Upload(campaign->id, campaign->canonical_yaml.size(), 0, campaign->canonical_yaml);
  const Reply refused = LaunchUploaded(first);
  EXPECT_EQ(refused.code, kExitInternalError);
  EXPECT_EQ(refused.text, folder.string() + ": cannot be made: Not a directory");
  EXPECT_EQ(LaunchUploaded(second).code, kExitDone);
  EXPECT_FALSE(service_->catalogue().entries().contains(first.id));
}

TEST_F(FrontDeskTest, ADeletedCampaignIsDeletedWhoeverAsksAgain) {
  const std::string id = Launch(Smoke(2));
  AskFor("cancel", {{"id", id}});
  ASSERT_TRUE(Until([&] { return service_->IsAtRest(id); }));
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(AskFor("delete", {{"id", id}}).at("id"), id) << "an answer may get lost";
  EXPECT_EQ(Refusal("delete", {{"id", id.substr(0, 8)}}),
            "2: no campaign, or more than one, has the id '" + id.substr(0, 8) + "'");
}

TEST_F(FrontDeskTest, APriorityIsOfARange) {
  EXPECT_EQ(Refusal("launch", {{"id", "a"}, {"flight_id", "b"}, {"priority", 2000000000}}),
            "2: priority 2000000000, allowed: from -1000 to 1000");
}

// One campaign of thousands of requirements: all others are listed, and so is it.
TEST_F(FrontDeskTest, AnAnswerFitsWhateverRequirementsACampaignHas) {
  Campaign all = Smoke(4);
  std::string requirements = "requirements:\n";
  for (int i = 0; i < 9000; ++i)
    requirements += "  - {metric: pitch_error_peak_deg, below: " + std::to_string(1 + i) +
                    ", probability: 0.5, consumer_risk: 0.1}\n";
  std::string text = all.canonical_yaml;
  const std::size_t begin = text.find("\nrequirements:\n") + 1;
  std::size_t end = begin;
  do end = text.find('\n', end) + 1;
  while (text[end] == ' ' || text[end] == '-');
  text.replace(begin, end - begin, requirements);
  const Campaign many = ParseCampaign(text, "many");
  const std::string one = Launch(many), other = Launch(Smoke(2, 5));
  ASSERT_TRUE(Reaches(one, CampaignState::kFlying));
  for (const char* method : {"list", "status"}) {
    const Reply reply = Ask(method, Json::object());
    EXPECT_LE(reply.text.size(), std::size_t{512} << 10);
    const Json campaigns = Json::parse(reply.text).at("campaigns");
    ASSERT_EQ(campaigns.size(), 2u);
    for (const Json& campaign : campaigns) {
      if (campaign.at("id") != one) continue;
      EXPECT_EQ(campaign.at("requirements").size() + campaign.at("requirements_unlisted").get<std::size_t>(),
                9000u);
    }
  }
}

TEST_F(FrontDeskTest, AllIdsComeInPages) {
  std::vector<std::string> ids = {Launch(Smoke(2, 1)), Launch(Smoke(2, 2))};
  std::sort(ids.begin(), ids.end());
  const Json page = AskFor("ids", Json::object());
  EXPECT_EQ(page.at("ids"), Json(ids));
  EXPECT_EQ(page.at("more"), false);
  EXPECT_EQ(AskFor("ids", {{"after", ids[0]}}).at("ids"), Json{ids[1]});
}

TEST_F(FrontDeskTest, ASnapshotOfACampaignThatFliesIsWhole) {
  const Campaign campaign = Smoke(4);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(2));
  service_->Flush();
  const Json which = {{"id", id}, {"snapshot", "monday"}};
  Json answer;
  ASSERT_TRUE(Until([&] {
    answer = AskFor("files", which);
    return !answer.contains("state");
  }));
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(3));
  service_->Flush();
  const fs::path copy = folder_ / "copy";
  fs::create_directories(copy);
  for (const Json& file : answer.at("files")) {
    Json part = which;
    part["path"] = file.at("path");
    part["offset"] = 0;
    const Reply reply = Ask("read", part);
    EXPECT_EQ(reply.data.size(), file.at("size").get<std::size_t>());
    std::ofstream(copy / file.at("path").get<std::string>(), std::ios::binary) << reply.data;
  }
  EXPECT_THAT(ResultFolder::Open(copy).PresentCases(), ElementsAre(2));
  Json text = which;
  text["path"] = "../campaign.yaml";
  text["offset"] = 0;
  EXPECT_EQ(Ask("read", text).data, campaign.canonical_yaml);
  EXPECT_EQ(Json::parse(answer.at("state_json").get<std::string>()).at("id"), id);
  Json outside = which;
  outside["path"] = "../state.json";
  outside["offset"] = 0;
  EXPECT_EQ(Ask("read", outside).code, kExitBadInput);
}

// Nothing that happens while a backup copies is half in it.
TEST_F(FrontDeskTest, ASnapshotHasTheStateOfTheMomentBeforeItsDatabase) {
  const Campaign campaign = Smoke(4);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(2));
  service_->Flush();
  const auto snapshot = [&](const char* name) {
    Json answer;
    EXPECT_TRUE(Until([&] {
      answer = AskFor("files", {{"id", id}, {"snapshot", name}});
      return !answer.contains("state");
    }));
    return answer;
  };
  snapshot("monday");
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(3));
  AskFor("cancel", {{"id", id}});
  const Json monday = snapshot("monday");
  EXPECT_EQ(Json::parse(monday.at("state_json").get<std::string>()).at("state"), "flying");
  EXPECT_THAT(monday.at("files"), SizeIs(2));
  const Json read = {{"id", id}, {"snapshot", "monday"}, {"path", "results.sqlite"}, {"offset", 0}};
  const std::string before = Ask("read", read).data;
  AskFor("files", {{"id", id}});  // somebody fetches it
  EXPECT_TRUE(Ask("read", read).data == before);
  const Json tuesday = snapshot("tuesday");
  EXPECT_EQ(Json::parse(tuesday.at("state_json").get<std::string>()).at("done"), 2);
  for (const char* path : {"results.sqlite", "../campaign.yaml"}) {
    Json again = read;
    again["path"] = path;
    EXPECT_EQ(Refusal("read", again),
              "5: the snapshot of campaign " + id.substr(0, 8) + " is gone: repeat the backup");
  }
}

TEST_F(FrontDeskTest, ACampaignIsRepairedByTheNameOfAWorker) {
  const std::string id = Launch(Smoke(2));
  EXPECT_EQ(Refusal("repair", {{"id", id}, {"worker", ""}}), "2: a worker's name has 1 to 64 characters");
  EXPECT_EQ(Refusal("repair", {{"id", "ab"}, {"worker", "w"}}),
            "2: no campaign, or more than one, has the id 'ab'");
  EXPECT_EQ(AskFor("repair", {{"id", id.substr(0, 8)}, {"worker", "node1"}}).at("id"), id);
  EXPECT_THAT(service_->catalogue().entries().at(id).distrusted, ElementsAre("node1"));
}

// What a client was told is on the disk.
TEST_F(FrontDeskTest, AStateThatCannotBeStoredChangesNothingForAClient) {
  const std::string id = Launch(Smoke(2));
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  const fs::path obstacle = folder_ / "data" / id / "state.json.tmp";
  fs::create_directories(obstacle / "in its way");
  const std::string refused =
      "1: " + (folder_ / "data" / id / "state.json").string() + ": cannot be written: Is a directory";
  EXPECT_EQ(Refusal("cancel", {{"id", id}}), refused);
  EXPECT_EQ(Refusal("launch", {{"id", id}, {"flight_id", Smoke(2).flight_id}, {"priority", 7}}), refused);
  EXPECT_EQ(StateOf(id), CampaignState::kFlying);
  EXPECT_EQ(service_->catalogue().entries().at(id).priority, 0);
  fs::remove_all(obstacle);
  EXPECT_EQ(AskFor("cancel", {{"id", id}}).at("id"), id);
  EXPECT_EQ(StateOf(id), CampaignState::kCancelled);
}

TEST_F(FrontDeskTest, ATextOfAnotherSizeBeginsAnew) {
  EXPECT_EQ(Upload("a", 10, 0, "12345"), 5u);
  EXPECT_EQ(Upload("a", 12, 5, "67890"), 0u) << "half of another text";
  EXPECT_EQ(Upload("a", 12, 0, "ab"), 2u);
}

TEST_F(FrontDeskTest, ATextIsThatOfItsIdAndOfThisEngine) {
  const Campaign campaign = Smoke(2);
  const std::string& text = campaign.canonical_yaml;
  Campaign renamed = campaign;
  renamed.id = std::string(64, 'a');
  Upload(renamed.id, text.size(), 0, text);
  const Reply of_another = LaunchUploaded(renamed);
  EXPECT_EQ(of_another.code, kExitBadInput);
  EXPECT_EQ(of_another.text, "the text is not that of campaign " + renamed.id);
  Campaign elsewhere = campaign;
  elsewhere.flight_id = "of another engine";
  const std::string differs = "campaign " + campaign.id.substr(0, 8) + " has the flight id " +
                              campaign.flight_id +
                              " here and of another engine at the client: the engines differ";
  Upload(campaign.id, text.size(), 0, text);
  EXPECT_EQ(LaunchUploaded(elsewhere).text, differs);
  EXPECT_TRUE(service_->catalogue().entries().empty());
  Upload(campaign.id, text.size(), 0, text);
  EXPECT_EQ(LaunchUploaded(campaign).code, kExitDone);
  EXPECT_EQ(LaunchUploaded(elsewhere).text, differs) << "also of one that is known";
}

TEST_F(FrontDeskTest, LaunchingAgainFliesNothingTwiceAndTakesTheNewPriority) {
  const Campaign campaign = Smoke(2);
  Upload(campaign.id, campaign.canonical_yaml.size(), 0, campaign.canonical_yaml);
  for (const int priority : {1, 4}) EXPECT_EQ(LaunchUploaded(campaign, priority).code, kExitDone);
  EXPECT_EQ(service_->catalogue().entries().size(), 1u);
  const Json listed = AskFor("list", {{"id", campaign.id.substr(0, 5)}}).at("campaigns").at(0);
  EXPECT_EQ(listed.at("priority"), 4);
  EXPECT_EQ(listed.at("state"), "waiting");
  EXPECT_EQ(listed.at("total"), 2);
  EXPECT_TRUE(listed.at("code").is_null());
  EXPECT_TRUE(listed.at("problem").is_null());
}

TEST_F(FrontDeskTest, FilesOfARunningCampaignAreNotHandedOut) {
  const std::string id = Launch(Smoke(2)), begin = id.substr(0, 8);
  const Json read = {{"id", id}, {"path", "campaign.yaml"}, {"offset", 0}};
  for (const CampaignState state : {CampaignState::kWaiting, CampaignState::kFlying}) {
    ASSERT_TRUE(Reaches(id, state));
    EXPECT_EQ(Refusal("files", {{"id", id}}), "5: campaign " + begin + " is " + CampaignStateName(state) +
                                                  ": its results can be fetched when it has ended");
    EXPECT_EQ(Refusal("read", read), "2: campaign " + begin + " has no file campaign.yaml");
  }
  EXPECT_EQ(AskFor("cancel", {{"id", id}}).at("id"), id);
  EXPECT_EQ(AskFor("list", {{"id", id}}).at("campaigns").at(0).at("code"), kExitIncomplete);
  EXPECT_EQ(Ask("read", read).data, Smoke(2).canonical_yaml);
}

TEST_F(FrontDeskTest, OfACampaignThatHasEndedTheFilesOfItsFolderAlone) {
  const std::string id = Launch(Smoke(2));
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  AskFor("cancel", {{"id", id}});
  const fs::path results = service_->catalogue().ResultsOf(id);
  fs::create_directories(results / "histories");
  const std::string large(300 << 10, 'h');
  std::ofstream(results / "histories" / "a.csv") << large;
  std::ofstream(results / "half.csv.tmp") << "half";
  fs::create_symlink("/etc/hostname", results / "link");
  const Json answer = AskFor("files", {{"id", id}});
  EXPECT_EQ(answer.at("code"), kExitIncomplete);
  std::map<std::string, std::uint64_t> sizes;
  for (const Json& file : answer.at("files")) sizes[file.at("path")] = file.at("size");
  EXPECT_THAT(sizes, ElementsAre(std::pair("attempts.jsonl", fs::file_size(results / "attempts.jsonl")),
                                 std::pair("campaign.yaml", fs::file_size(results / "campaign.yaml")),
                                 std::pair("histories/a.csv", large.size()),
                                 std::pair("results.sqlite", fs::file_size(results / "results.sqlite"))));
  for (const char* path : {"../state.json", "../campaign.yaml", "/etc/hostname", "link", "half.csv.tmp",
                           "histories/../campaign.yaml", "histories", ""}) {
    EXPECT_EQ(Refusal("read", {{"id", id}, {"path", path}, {"offset", 0}}),
              "2: campaign " + id.substr(0, 8) + " has no file " + path);
  }
  // In parts of 256 KiB, and nothing at the end.
  const auto part = [&](std::uint64_t offset) {
    return Ask("read", {{"id", id}, {"path", "histories/a.csv"}, {"offset", offset}}).data.size();
  };
  EXPECT_EQ(part(0), std::size_t{256} << 10);
  EXPECT_EQ(part(256 << 10), large.size() - (std::size_t{256} << 10));
  EXPECT_EQ(part(large.size()), 0u);
}

TEST_F(FrontDeskTest, TheWebPagesCountWhatWasFlown) {
  const Campaign campaign = Smoke(5);
  const std::string id = Launch(campaign);
  WebRows rows;
  EXPECT_EQ(rows.Make(*service_, workforce_)->Find(id)->histograms.size(), 0u) << "not open yet";
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w", 3);
  for (std::uint64_t i = 0; i < 3; ++i) {
    CaseResult result = MadeUpWorkforce::ResultOf(i);
    result.metrics[MetricColumn("pitch_error_peak_deg")] = i == 0 ? 1.0 : 0.25;
    workforce_.Return("w", campaign.flight_id, result);
  }
  const auto index = rows.Make(*service_, workforce_);
  const RequirementOutcome& requirement = index->Find(id)->requirements.at(0);
  EXPECT_EQ(requirement.metric, "pitch_error_peak_deg");
  EXPECT_EQ(requirement.failures, 1) << "1 is not below 1";
  const LiveHistogram& histogram = index->Find(id)->histograms.at(0);
  EXPECT_EQ(histogram.metric, "pitch_error_peak_deg");
  EXPECT_EQ(histogram.n, 3u);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0.0), 3.0);
  EXPECT_THAT(histogram.limits, ElementsAre(1.0));
  ASSERT_EQ(index->workers().size(), 1u);
  EXPECT_EQ(index->workers()[0].id, "w");
  EXPECT_EQ(index->workers()[0].slots, 3);
  EXPECT_EQ(index->workers()[0].state, "ready");
}

// Two clients with keys, and an administrator.
class OwnersTest : public FrontDeskTest {
 protected:
  OwnersTest() { Start({}); }

  void Start(const std::vector<std::string>& quotas) {
    service_.reset();
    ServiceOptions options{folder_ / "data"};
    for (const std::string& each : quotas) ASSERT_EQ(options.quotas.Add(each), "");
    service_ = std::make_unique<Service>(options, workforce_);
    desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "");
  }
  /// "code: text", or the text alone of what is granted.
  std::string As(const std::string& client, const std::string& method, const Json& arguments,
                 const std::string& data = "") {
    const Reply reply = desk_->Answer({client, 5, method, arguments.dump(), data});
    return reply.code == 0 ? reply.text : std::to_string(reply.code) + ": " + reply.text;
  }
  std::string LaunchAs(const std::string& client, const Campaign& campaign,
                       const Json& more = Json::object()) {
    Json arguments = {{"id", campaign.id}, {"flight_id", campaign.flight_id}};
    arguments.update(more);
    for (;;) {
      const std::string answer = As(client, "launch", arguments);
      if (answer.find("\"unknown\"") != std::string::npos) {
        const std::string& text = campaign.canonical_yaml;
        As(client, "upload", {{"id", campaign.id}, {"size", text.size()}, {"offset", 0}}, text);
      } else if (answer.find("\"checked\"") == std::string::npos) {
        return answer.find("\"state\"") == std::string::npos
                   ? answer
                   : Json::parse(answer).at("state").get<std::string>();
      }
    }
  }
  /// "2: campaign 5f3a... belongs to 'ann': ..."
  static std::string NotTheirs(const Campaign& campaign, const std::string& owner, const std::string& whose,
                               const std::string& may, const std::string& change) {
    return "2: campaign " + campaign.id.substr(0, 8) + " belongs to " + owner + ": the keys of '" + whose +
           "' may " + may + " and cannot " + change +
           " it, allowed: keys of its owner that may run, or keys that may administer";
  }

  const std::string ann_ = "_run_ann_1", bob_ = "_run_bob_2", eve_ = "_read_eve_3",
                    root_ = "_administer_root_4";
};

TEST_F(OwnersTest, OnlyOwnerAndAdministratorChangeACampaign) {
  const Campaign campaign = Smoke(2);
  const Json named = {{"id", campaign.id}};
  EXPECT_EQ(LaunchAs(ann_, campaign), "waiting");
  EXPECT_EQ(service_->catalogue().entries().at(campaign.id).owner, "ann");
  for (const char* method : {"cancel", "delete"}) {
    EXPECT_EQ(As(bob_, method, named), NotTheirs(campaign, "'ann'", "bob", "run", method));
    EXPECT_EQ(As(eve_, method, named), NotTheirs(campaign, "'ann'", "eve", "read", method));
  }
  EXPECT_EQ(As(bob_, "repair", {{"id", campaign.id}, {"worker", "w"}}),
            NotTheirs(campaign, "'ann'", "bob", "run", "repair"));
  EXPECT_EQ(StateOf(campaign.id), CampaignState::kWaiting);
  EXPECT_EQ(As("_run_ann_99", "cancel", named), Json({{"id", campaign.id}}).dump())
      << "another program of ann";
  EXPECT_EQ(LaunchAs(bob_, campaign), NotTheirs(campaign, "'ann'", "bob", "run", "continue"));
  ASSERT_TRUE(Until([&] { return service_->IsAtRest(campaign.id); }));
  EXPECT_EQ(As(root_, "delete", named), Json({{"id", campaign.id}}).dump());
  EXPECT_FALSE(service_->catalogue().entries().contains(campaign.id));
}

TEST_F(OwnersTest, AdministratorsReadmitAndEverybodySeesWhoIsExpelled) {
  workforce_.Expel({{"node1", {"case 4 gives other bits"}}, {"node1_a", {"a lie", "rack7"}}});
  const Json expelled = {{{"name", "node1"}, {"reason", "case 4 gives other bits"}},
                         {{"name", "node1_a"}, {"reason", "a lie"}}};
  EXPECT_EQ(Json::parse(As(eve_, "expelled", Json::object())).at("expelled"), expelled);
  EXPECT_EQ(As(ann_, "readmit", {{"name", "node1"}}),
            "2: the keys of 'ann' may run, and `dispersa readmit` needs the right to administer, allowed: "
            "keys that `dispersa keys issue --may administer` made");
  EXPECT_EQ(As(root_, "readmit", {{"name", "node2"}}),
            "2: nobody with the name 'node2' is expelled, allowed: names that `dispersa readmit` without a "
            "name prints");
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost)
    EXPECT_EQ(As(root_, "readmit", {{"name", "node1"}}), Json({{"name", "node1"}}).dump());
  EXPECT_EQ(Json::parse(As(eve_, "expelled", Json::object())).at("expelled"), Json::array());
  EXPECT_EQ(Json::parse(TextOfFile(folder_ / "data" / "expelled.json")).at("expelled"),
            Json({{"node1_a", {{"reason", "a lie"}, {"host", "rack7"}, {"forgiven", true}}}}));
}

TEST_F(OwnersTest, OnlyWhoAdministersDrainsAndTheCoordinatorsOwnKeys) {
  ServiceOptions options{folder_ / "data"};
  options.epoch = 7;
  const std::string own = "main_5", answer = Json({{"epoch", 7}, {"busy", 0}, {"waiting", 1}}).dump();
  for (const auto& [client, names] :
       {std::pair(root_, Json::object()), std::pair(own, Json({{"epoch", 7}}))}) {
    service_.reset();
    service_ = std::make_unique<Service>(options, workforce_);
    desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "", WebPages(), "main");
    LaunchAs(ann_, Smoke(2));
    for (const std::string& other : {ann_, std::string("_run_main_6"), std::string("node_1")})
      EXPECT_THAT(As(other, "drain", Json::object()),
                  HasSubstr("may run, and `dispersa-coordinator --drain` needs the right to administer"));
    EXPECT_EQ(As(client, "drain", {{"epoch", 6}}), answer) << "of the coordinator before this one";
    EXPECT_FALSE(service_->is_draining());
    EXPECT_EQ(As(client, "drain", names), answer);
    EXPECT_TRUE(service_->IsDrained()) << "nothing flies";
    for (const char* method : {"launch", "repair"})
      EXPECT_THAT(As(root_, method, Json::object()), HasSubstr("5: the coordinator is drained")) << method;
    for (int i = 0; i < 20; ++i) service_->Step();
    EXPECT_EQ(StateOf(Smoke(2).id), CampaignState::kWaiting);
    EXPECT_THAT(As(own, "backup", Json::object()), Not(HasSubstr("drained")));
  }
}

// Every kind of action, done and refused, by owner, administrator and the coordinator itself.
TEST_F(OwnersTest, EachActionHasItsLineAndNothingElseHasOne) {
  const Campaign campaign = Smoke(2);
  const Json named = {{"id", campaign.id}};
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost) LaunchAs(ann_, campaign);
  As(bob_, "cancel", named);  // refused
  As(eve_, "list", named);
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost) As(ann_, "cancel", named);
  LaunchAs(ann_, campaign);  // it continues
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost)
    As(root_, "give", {{"id", campaign.id}, {"to", "bob"}});
  As(bob_, "repair", {{"id", campaign.id}, {"worker", "w"}});
  workforce_.Expel({{"node1", {"case 4 gives other bits"}}});
  workforce_.time_s += 1.0;
  service_->Step();
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost)
    As(root_, "readmit", {{"name", "node1"}});
  As(bob_, "cancel", named);
  ASSERT_TRUE(Until([&] { return service_->IsAtRest(campaign.id); }));
  for (int answer_got_lost = 0; answer_got_lost < 2; ++answer_got_lost) As(bob_, "delete", named);
  std::istringstream stream(TextOfFile(folder_ / "data" / "actions.jsonl"));
  Json lines = Json::array();
  for (std::string text; std::getline(stream, text);) {
    lines.push_back(Json::parse(text));
    EXPECT_THAT(lines.back().at("time").get<std::string>(), StartsWith("20"));
    lines.back().erase("time");
  }
  const auto line = [&](const char* action, const std::string& client, const char* by, Json more = {}) {
    Json expected = {{"action", action}, {"by", by}, {"client", client}};
    if (std::string(action) != "readmit") expected.update({{"campaign", campaign.id}, {"name", "smoke"}});
    if (!more.is_null()) expected.update(more);
    return expected;
  };
  EXPECT_EQ(
      lines.dump(1),
      Json(
          {line("launch", ann_, "ann"),
           line("cancel", ann_, "ann"),
           line("launch", ann_, "ann"),
           line("give", root_, "root", {{"to", "bob"}}),
           line("repair", bob_, "bob", {{"worker", "w"}}),
           {{"action", "expel"}, {"by", nullptr}, {"worker", "node1"}, {"reason", "case 4 gives other bits"}},
           line("readmit", root_, "root", {{"worker", "node1"}}),
           line("cancel", bob_, "bob"),
           line("delete", bob_, "bob")})
          .dump(1));
  const std::string before = TextOfFile(folder_ / "data" / "actions.jsonl");
  StartService();
  EXPECT_EQ(TextOfFile(folder_ / "data" / "actions.jsonl"), before) << "a start again rewrites nothing";
  EXPECT_THAT(service_->Journals(), testing::Contains(folder_ / "data" / "actions.jsonl")) << "in a backup";
}

TEST_F(OwnersTest, AnAdministratorGivesACampaignToAnotherOwner) {
  const Campaign campaign = Smoke(2);
  LaunchAs(ann_, campaign);
  const auto give = [&](const std::string& who, const std::string& to) {
    return As(who, "give", {{"id", campaign.id}, {"to", to}});
  };
  for (const std::string& who : {ann_, bob_})
    EXPECT_THAT(give(who, "bob"), HasSubstr("`dispersa give` needs the right to administer")) << who;
  for (const char* bad : {"", "bob jones", "b\x1b"})
    EXPECT_THAT(give(root_, bad), HasSubstr("cannot own a campaign, allowed: a name of keys or of a local "
                                            "user, 1 to 64 letters, digits, '-', '_' and '.'"))
        << bad;
  EXPECT_EQ(service_->catalogue().entries().at(campaign.id).owner, "ann");
  EXPECT_EQ(give(root_, "bob"), Json({{"id", campaign.id}}).dump());
  StartService();  // it is on the disk
  desk_ = std::make_unique<FrontDesk>(*service_, workforce_, "");
  EXPECT_EQ(As(ann_, "cancel", {{"id", campaign.id}}), NotTheirs(campaign, "'bob'", "ann", "run", "cancel"));
  EXPECT_EQ(As(bob_, "cancel", {{"id", campaign.id}}), Json({{"id", campaign.id}}).dump());
}

TEST_F(OwnersTest, ACampaignOfAnotherOwnerIsFoundAndNotChanged) {
  const Campaign campaign = Smoke(2);
  LaunchAs(ann_, campaign, {{"priority", 3}});
  EXPECT_EQ(LaunchAs(bob_, campaign), "waiting");
  EXPECT_EQ(LaunchAs(bob_, campaign, {{"priority", 3}}), "waiting") << "it has this priority";
  std::string its_priority = NotTheirs(campaign, "'ann'", "bob", "run", "change the priority of");
  EXPECT_EQ(LaunchAs(bob_, campaign, {{"priority", 4}}), its_priority);
  EXPECT_EQ(LaunchAs(bob_, campaign, {{"labels", {"commit=1"}}}),
            NotTheirs(campaign, "'ann'", "bob", "run", "label"));
  const CatalogueEntry& entry = service_->catalogue().entries().at(campaign.id);
  EXPECT_EQ(entry.owner, "ann");
  EXPECT_EQ(entry.priority, 3);
  EXPECT_TRUE(entry.labels.empty());
  EXPECT_EQ(LaunchAs(ann_, campaign), "waiting");
  EXPECT_EQ(entry.priority, 3) << "none was given";
  EXPECT_EQ(LaunchAs(root_, campaign, {{"priority", 4}, {"labels", {"commit=1"}}}), "waiting");
  EXPECT_EQ(entry.priority, 4);
  EXPECT_EQ(entry.owner, "ann");
  const Json listed = Json::parse(As(eve_, "list", {{"id", campaign.id}})).at("campaigns").at(0);
  EXPECT_EQ(listed.at("owner"), "ann");
  EXPECT_EQ(listed.at("labels"), Json({"commit=1"}));
}

TEST_F(OwnersTest, KeysThatMayReadLookAndTakeAndNothingElse) {
  const Campaign campaign = Smoke(2);
  LaunchAs(ann_, campaign);
  const std::string lacks =
      "2: the keys of 'eve' may read, and `dispersa launch` needs the right to run, allowed: keys that "
      "`dispersa keys issue --may run` made";
  EXPECT_EQ(LaunchAs(eve_, Smoke(3)), lacks);
  EXPECT_EQ(LaunchAs(eve_, campaign), lacks);
  EXPECT_EQ(As(eve_, "upload", {{"id", "x"}, {"size", 1}, {"offset", 0}}, "x"), lacks);
  for (const char* method : {"list", "status"})
    EXPECT_THAT(As(eve_, method, {{"id", campaign.id}}), HasSubstr(campaign.id)) << method;
  As(ann_, "cancel", {{"id", campaign.id}});
  ASSERT_TRUE(Until([&] { return service_->IsAtRest(campaign.id); }));
  EXPECT_THAT(As(eve_, "files", {{"id", campaign.id}}), HasSubstr("\"id\""));
  const std::string no_backup =
      "2: the keys of 'bob' may run, and `dispersa backup` needs the right to administer, allowed: keys "
      "that "
      "`dispersa keys issue --may administer` made";
  EXPECT_EQ(As(bob_, "ids", Json::object()), no_backup);
  EXPECT_EQ(As(bob_, "files", {{"id", ""}}), no_backup);
  EXPECT_EQ(As(bob_, "read", {{"id", campaign.id}, {"path", "a"}, {"offset", 0}, {"snapshot", "s"}}),
            no_backup);
  EXPECT_THAT(As(root_, "ids", Json::object()), HasSubstr(campaign.id));
}

// An owner whose keys were replaced by ones that read.
TEST_F(OwnersTest, KeysThatMayReadChangeNothingUnderTheOwnersName) {
  const Campaign campaign = Smoke(2);
  LaunchAs(ann_, campaign);
  EXPECT_EQ(As("_read_ann_9", "cancel", {{"id", campaign.id}}),
            NotTheirs(campaign, "'ann'", "ann", "read", "cancel"));
}

// Nobody is its owner: a client that has a name of no letters neither.
TEST_F(OwnersTest, ACampaignOfAnEarlierVersionBelongsToAdministrators) {
  const Campaign campaign = Smoke(2);
  Launch(campaign);
  EXPECT_EQ(As(ann_, "cancel", {{"id", campaign.id}}),
            NotTheirs(campaign, "nobody, since an earlier version launched it", "ann", "run", "cancel"));
  EXPECT_EQ(As("_run__5", "cancel", {{"id", campaign.id}}).substr(0, 2), "2:");
  EXPECT_EQ(As(root_, "cancel", {{"id", campaign.id}}), Json({{"id", campaign.id}}).dump());
}

TEST_F(OwnersTest, WithoutKeysTheLocalUserOwnsAllAndMayAll) {
  StartService();  // everybody is ann
  const Campaign campaign = Smoke(2);
  EXPECT_EQ(LaunchAs("0123", campaign), "waiting");
  EXPECT_EQ(service_->catalogue().entries().at(campaign.id).owner, "ann");
  EXPECT_EQ(LaunchAs("_read_eve_1", Smoke(3)), "waiting") << "a name proves nothing here";
  EXPECT_EQ(service_->catalogue().entries().at(Smoke(3).id).owner, "ann");
  EXPECT_EQ(As("4567", "cancel", {{"id", campaign.id}}), Json({{"id", campaign.id}}).dump());
}

TEST_F(OwnersTest, AQuotaIsOfOneOwnerAndOfWhatHasNotEnded) {
  Start({"cases=10,campaigns=2"});
  const Campaign first = Smoke(4), second = Smoke(6, 2), third = Smoke(1, 3);
  EXPECT_EQ(LaunchAs(ann_, first), "waiting");
  EXPECT_EQ(LaunchAs(ann_, Smoke(7, 2)),
            "2: 'ann' would have 11 cases in campaigns that have not ended, allowed: at most 10; wait, or "
            "launch fewer (dispersa-coordinator --quota cases)");
  EXPECT_EQ(LaunchAs(ann_, second), "waiting");
  const std::string too_many =
      "2: 'ann' would have 3 campaigns that have not ended, allowed: at most 2; wait, or cancel one "
      "(dispersa-coordinator --quota campaigns)";
  EXPECT_EQ(LaunchAs(ann_, third), too_many);
  EXPECT_EQ(LaunchAs(bob_, third), "waiting") << "of another owner";
  EXPECT_EQ(LaunchAs(ann_, first), "waiting") << "nothing more";
  As(ann_, "cancel", {{"id", first.id}});
  EXPECT_EQ(LaunchAs(ann_, Smoke(1, 4)), "waiting") << "a campaign has ended";
  EXPECT_EQ(LaunchAs(ann_, first), too_many) << "continued, it would be the third";
  EXPECT_EQ(StateOf(first.id), CampaignState::kCancelled);
}

TEST_F(OwnersTest, OneOwnerDoesNotTakeAllPlaces) {
  Start({"places=1"});
  const Campaign first = Smoke(200, 1), second = Smoke(200, 2), third = Smoke(200, 3);
  LaunchAs(ann_, first, {{"priority", 9}});
  LaunchAs(ann_, second, {{"priority", 9}});
  LaunchAs(bob_, third);
  ASSERT_TRUE(Reaches(third.id, CampaignState::kFlying));
  EXPECT_EQ(StateOf(first.id), CampaignState::kFlying);
  EXPECT_EQ(StateOf(second.id), CampaignState::kWaiting) << "in spite of its priority";
  As(ann_, "cancel", {{"id", first.id}});
  ASSERT_TRUE(Reaches(second.id, CampaignState::kFlying));
}

// A team that needs more than the others, and one that gets less.
TEST_F(OwnersTest, AnOwnerMayHaveAQuotaOfItsOwn) {
  Start({"bob:cases=20,campaigns=none", "cases=10,campaigns=1", "carol:cases=3"});
  const std::string carol = ClientPrefix("carol", Right::kRun) + "1";
  EXPECT_THAT(LaunchAs(ann_, Smoke(11)), HasSubstr("allowed: at most 10;"));
  EXPECT_EQ(LaunchAs(ann_, Smoke(10)), "waiting");
  EXPECT_THAT(LaunchAs(bob_, Smoke(21)), HasSubstr("allowed: at most 20;"));
  EXPECT_EQ(LaunchAs(bob_, Smoke(17, 2)), "waiting");
  EXPECT_EQ(LaunchAs(bob_, Smoke(2, 3)), "waiting") << "two campaigns";
  EXPECT_EQ(LaunchAs(bob_, Smoke(1, 4)), "waiting");
  EXPECT_EQ(LaunchAs(bob_, Smoke(1, 5)),
            "2: 'bob' would have 21 cases in campaigns that have not ended, allowed: at most 20; wait, or "
            "launch fewer (dispersa-coordinator --quota cases)");
  EXPECT_THAT(LaunchAs(carol, Smoke(4, 6)), HasSubstr("allowed: at most 3;"));
  EXPECT_EQ(LaunchAs(carol, Smoke(3, 6)), "waiting");
  EXPECT_THAT(LaunchAs(carol, Smoke(1, 7)), HasSubstr("2 campaigns")) << "that of all";
}

TEST(QuotaTest, SaysWhatIsWrong) {
  const auto problem = [](const std::string& text) { return Quotas().Add(text); };
  EXPECT_EQ(problem("case=1"),
            "'case=1' is no limit, allowed: cases=N, campaigns=N, places=N and disk=SIZE, with commas "
            "between them, for all owners, or after OWNER: for one of them");
  EXPECT_EQ(problem("cases=0"),
            "'0' is no value of cases, allowed: a whole number from 1; none only after OWNER:");
  EXPECT_EQ(problem("ann:disk=5"), "'5' is no value of disk, allowed: a size as 200GB, or none");
  EXPECT_EQ(problem(":cases=1"), "':cases=1' has no owner before ':', allowed: the name of a client's keys");
  for (const char* text : {"", "cases", "cases=", "cases=-1", "cases=1e6", "disk=5", "disk=5d",
                           "ann:", "cases=1,,places=2", "cases=1 ", "cases=none", "ann:cases=1:2", "none"})
    EXPECT_NE(problem(text), "") << text;
}

TEST_F(OwnersTest, LabelsAreShortTexts) {
  const Campaign campaign = Smoke(2);
  for (const std::string label : {"commit", "=1", "commit=", "com mit=1", "commit=1\n",
                                  "commit="
                                  "12345678901234567890123456789012345678901234567890123456789012345678901234"
                                  "567890123456789012345678901"})
    EXPECT_THAT(LaunchAs(ann_, campaign, {{"labels", {label}}}), HasSubstr("is no label, allowed: "))
        << label;
}

}  // namespace dispersa::front_desk_test
