// A campaign sent to a coordinator, followed, and copied back, without a network: against a real front desk,
// and against made-up coordinators.
#include "services/fleet/remote_campaign.h"

#include "core/results/database.h"
#include "core/results/gzip.h"
#include "made_up_service.h"
#include "services/coordinator/epoch.h"
#include "services/coordinator/packed_files.h"
#include "tests/test.h"

namespace dispersa::remote_campaign_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// "code: words" of what ends a call.
template <typename Run>
std::string FailureOf(Run run) {
  try {
    run();
    return "none";
  } catch (const Failure& failure) {
    return std::to_string(failure.code) + ": " + failure.message;
  }
}

/// Notes what it is shown; stops after so many looks.
class Watcher : public Observer {
 public:
  void Show(const std::string& phase, std::uint64_t done, std::uint64_t total,
            const std::string& note) override {
    shown.push_back(phase + " " + std::to_string(done) + "/" + std::to_string(total) + " " + note);
  }
  void EndPhase() override { shown.push_back("end"); }
  bool ShouldStop() override { return stops; }
  std::vector<std::string> shown;
  bool stops = false;
};

/// Answers each method as it is told to, the last answer for ever.
class MadeUpCoordinator {
 public:
  Session Connect(bool has_keys = false) {
    return {{"host", 7405},
            has_keys,
            [this](const std::string& method, const std::string& arguments, const std::string&,
                   std::chrono::milliseconds) {
              asked.push_back(method + " " + arguments);
              std::deque<std::optional<Reply>>& left = answers[method];
              if (left.empty()) return std::optional<Reply>();
              const std::optional<Reply> answer = left.front();
              if (left.size() > 1) left.pop_front();
              return answer;
            }};
  }
  void Answers(const std::string& method, const Json& text, const std::string& data = "") {
    answers[method].push_back(Reply{"c", 1, 0, text.dump(), data});
  }
  void Refuses(const std::string& method, int code, const std::string& words) {
    answers[method].push_back(Reply{"c", 1, code, words, ""});
  }
  void IsSilent(const std::string& method) { answers[method].push_back(std::nullopt); }

  std::map<std::string, std::deque<std::optional<Reply>>> answers;
  std::vector<std::string> asked;
};

TEST(Session, TheCoordinatorsRefusalIsTheFailure) {
  MadeUpCoordinator coordinator;
  coordinator.Refuses("cancel", 2, "too late");
  Session session = coordinator.Connect();
  EXPECT_EQ(FailureOf([&] { session.Ask("cancel", {{"id", "a"}}); }), "2: too late");
  EXPECT_THAT(coordinator.asked, ElementsAre(R"(cancel {"id":"a"})"));
}

TEST(Session, SilenceSaysWhereAndWhetherKeysMayBeMissing) {
  MadeUpCoordinator coordinator;
  Session without = coordinator.Connect(), with = coordinator.Connect(true);
  const std::string silence = "5: no coordinator has answered at host:7405 for 15 s";
  EXPECT_EQ(FailureOf([&] { without.Ask("list", {}); }),
            silence +
                "; a coordinator with keys answers only clients with keys (--keys), one without keys only "
                "clients of its own user");
  EXPECT_EQ(FailureOf([&] { with.Ask("list", {}); }), silence);
  EXPECT_FALSE(with.Try("list", {}));
}

TEST(Launching, UploadsWhatTheCoordinatorLacksFromWhereItIs) {
  MadeUpCoordinator coordinator;
  for (const char* state : {"unknown", "checked", "waiting"})
    coordinator.Answers("launch", {{"state", state}});
  coordinator.Answers("upload", {{"received", 4}});
  coordinator.Answers("upload", {{"received", 10}});
  Campaign campaign;
  campaign.id = "i";
  campaign.flight_id = "f";
  campaign.canonical_yaml = "0123456789";
  Session session = coordinator.Connect();
  EXPECT_EQ(LaunchCampaign(session, campaign, 3), "waiting");
  const std::string launch = R"(launch {"id":"i","flight_id":"f","priority":3})";
  EXPECT_THAT(coordinator.asked, ElementsAre(launch, R"(upload {"id":"i","size":10,"offset":0})",
                                             R"(upload {"id":"i","size":10,"offset":4})", launch, launch));
}

Json Listed(int done, const Json& code) {
  return {{"campaigns",
           {{{"name", "smoke"},
             {"done", done},
             {"total", 12},
             {"state", code.is_null() ? "flying" : "done"},
             {"code", code}}}}};
}

TEST(Following, EndsWithTheCampaignsCodeAndWaitsForACoordinatorThatIsAway) {
  MadeUpCoordinator coordinator;
  coordinator.Answers("list", Listed(4, nullptr));
  coordinator.IsSilent("list");
  coordinator.Answers("list", Listed(12, 3));
  Session session = coordinator.Connect();
  Watcher watcher;
  EXPECT_EQ(FollowCampaign(session, "i", watcher), kExitRequirementFailed);
  EXPECT_THAT(watcher.shown, ElementsAre("smoke 4/12 flying", "smoke 12/12 done", "end"));
}

TEST(Following, StopsWhenItsWatcherWants) {
  MadeUpCoordinator coordinator;
  Session session = coordinator.Connect();
  Watcher watcher;
  watcher.stops = true;
  EXPECT_THROW(FollowCampaign(session, "i", watcher), Interrupted);
}

class Fetching : public testing::Test {
 protected:
  Fetching() { fs::create_directories(folder_ / "in"); }

  fs::path Target() const { return folder_ / "in" / "out"; }
  /// Of a coordinator that says that it has such a file.
  std::string FetchOf(const std::string& path) {
    MadeUpCoordinator coordinator;
    coordinator.Answers("files", {{"id", "i"}, {"files", {{{"path", path}, {"size", 4}}}}});
    coordinator.Answers("read", Json::object(), "evil");
    Session session = coordinator.Connect();
    return FailureOf([&] { FetchCampaign(session, "i", Target()); });
  }

  TemporaryFolder folder_;
};

TEST_F(Fetching, NothingIsWrittenOutsideOfTheFolder) {
  for (const std::string path : {"../evil", "../../evil", "a/../../evil", "/tmp/../tmp/dispersa-evil", "..",
                                 ".", "", "a/../b", "./a"}) {
    EXPECT_EQ(FetchOf(path), "1: the coordinator names a file outside of the result folder") << path;
    EXPECT_FALSE(fs::exists(Target())) << path;
    EXPECT_FALSE(fs::exists(folder_ / "in" / "evil")) << path;
    EXPECT_FALSE(fs::exists(folder_ / "evil")) << path;
  }
  EXPECT_EQ(FetchOf((folder_ / "absolute").string()),
            "1: the coordinator names a file outside of the result folder");
  EXPECT_FALSE(fs::exists(folder_ / "absolute"));
  EXPECT_EQ(FetchOf("a/b..c"), "none") << "two dots in a name are two dots";
  EXPECT_EQ(TextOfFile(Target() / "a" / "b..c"), "evil");
}

TEST_F(Fetching, AFileThatBecomesShorterIsAnErrorAndLeavesNoFolder) {
  MadeUpCoordinator coordinator;
  coordinator.Answers("files", {{"id", "i"}, {"files", {{{"path", "a"}, {"size", 9}}}}});
  coordinator.Answers("read", Json::object(), "12345");
  coordinator.Answers("read", Json::object(), "");
  Session session = coordinator.Connect();
  EXPECT_EQ(FailureOf([&] { FetchCampaign(session, "i", Target()); }),
            "1: a: it became shorter while it was fetched");
  EXPECT_FALSE(fs::exists(Target()));
}

TEST_F(Fetching, FewerCasesThanTheCampaignHasAreRefusedAndLeaveNoFolder) {
  const std::string id(64, 'a');
  const ResultFolder made =
      ResultFolder::Create(folder_ / "made", LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml"));
  for (const bool has_database : {false, true}) {
    MadeUpCoordinator coordinator;
    Json files = Json::array();
    if (has_database) {
      const std::string database = TextOfFile(made.directory() / "results.sqlite");
      files.push_back({{"path", "results.sqlite"}, {"size", database.size()}});
      coordinator.Answers("read", Json::object(), database);
    }
    coordinator.Answers("files", {{"id", id}, {"done", 3}, {"files", files}});
    Session session = coordinator.Connect();
    EXPECT_EQ(FailureOf([&] { FetchCampaign(session, id, Target()); }),
              "5: campaign aaaaaaaa has 3 cases and 0 of them arrived: nothing was written; fetch it again");
    EXPECT_FALSE(fs::exists(Target()));
    EXPECT_TRUE(fs::is_empty(folder_ / "in"));
  }
}

TEST_F(Fetching, WaitsWhileTheCoordinatorCopies) {
  MadeUpCoordinator coordinator;
  coordinator.Answers("files", {{"id", "i"}, {"state", "copying"}});
  coordinator.Answers("files", {{"id", "i"}, {"done", 0}, {"files", Json::array()}});
  Session session = coordinator.Connect();
  EXPECT_EQ(FailureOf([&] { FetchCampaign(session, "i", Target()); }), "none");
  EXPECT_TRUE(fs::is_directory(Target()));
}

TEST_F(Fetching, OnlyIntoANewOrAnEmptyFolder) {
  fs::create_directories(Target());
  std::ofstream(Target() / "mine") << "x";
  MadeUpCoordinator coordinator;
  Session session = coordinator.Connect();
  EXPECT_EQ(FailureOf([&] { FetchCampaign(session, "i", Target()); }),
            "2: " + Target().string() + ": not an empty folder, allowed: a new or an empty folder");
  EXPECT_TRUE(coordinator.asked.empty());
}

TEST_F(Fetching, FilesOfAKilledFetchAreNoPartOfTheNext) {
  const fs::path left = Target().string() + ".dispersa-fetch";
  fs::create_directories(left);
  std::ofstream(left / "old") << "x";
  EXPECT_EQ(FetchOf("new"), "none");
  EXPECT_FALSE(fs::exists(Target() / "old"));
  EXPECT_TRUE(fs::exists(Target() / "new"));
  EXPECT_FALSE(fs::exists(left));
}

// Both ends, without the network between them.
class RemoteCampaign : public ServiceTest {
 protected:
  RemoteCampaign() { StartService(); }

  Session session_{{"here", 1},
                   false,
                   [this](const std::string& method, const std::string& arguments, const std::string& data,
                          std::chrono::milliseconds) {
                     service_->Step();
                     return std::optional(desk_->Answer({"c", ++asked_, method, arguments, data}));
                   }};
  std::uint64_t asked_ = 0;
};

TEST_F(RemoteCampaign, IsLaunchedFollowedAndFetched) {
  const Campaign campaign = Smoke(2);
  EXPECT_EQ(LaunchCampaign(session_, campaign, 1), "waiting");
  EXPECT_EQ(service_->catalogue().TextOf(campaign.id), campaign.canonical_yaml);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  EXPECT_EQ(LaunchCampaign(session_, campaign, 2), "flying") << "again";
  session_.Ask("cancel", {{"id", campaign.id}});
  Watcher watcher;
  EXPECT_EQ(FollowCampaign(session_, campaign.id.substr(0, 9), watcher), kExitIncomplete);
  EXPECT_THAT(watcher.shown, ElementsAre("smoke 0/2 cancelled", "end"));
  // More than one part.
  const fs::path results = service_->catalogue().ResultsOf(campaign.id);
  fs::create_directories(results / "histories");
  std::ofstream(results / "histories" / "large.csv") << std::string(600 << 10, 'a') << "b";
  const FetchedCampaign fetched =
      FetchCampaign(session_, campaign.id.substr(0, 9), (folder_ / "fetched").string());
  EXPECT_EQ(fetched.id, campaign.id);
  EXPECT_EQ(fetched.directory, folder_ / "fetched");
  for (const char* file : {"campaign.yaml", "results.sqlite", "histories/large.csv"})
    EXPECT_TRUE(TextOfFile(fetched.directory / file) == TextOfFile(results / file)) << file;
}

// The page is compressed there. A client that fetches it gets it uncompressed; histories are compressed
// everywhere.
TEST_F(RemoteCampaign, ThePageIsStoredPackedAndFetchedPlain) {
  const Campaign campaign = Smoke(2);
  Launch(campaign);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  session_.Ask("cancel", {{"id", campaign.id}});
  const fs::path results = service_->catalogue().ResultsOf(campaign.id), page = results / "report.html";
  fs::create_directories(results / "histories");
  std::string text = "[0\n";
  while (text.size() < 600'000) text += "," + std::to_string(text.size()) + "\n";
  text += "]\n";
  const std::string history = Gzip(text);
  std::ofstream(results / "histories/nominal.csv.gz", std::ios::binary) << history;
  for (const fs::path& file : {page, results / "summary.json"}) std::ofstream(file, std::ios::binary) << text;
  PackReports(results);
  PackReports(results);  // again: nothing
  EXPECT_FALSE(fs::exists(page));
  EXPECT_LT(fs::file_size(results / "report.html.gz"), text.size() / 2);
  EXPECT_EQ(SizeOf(page), text.size());
  EXPECT_EQ(ReadPart(page, text.size(), 10), "");
  EXPECT_EQ(ReadPart(page, 7, 4), text.substr(7, 4));
  const FetchedCampaign fetched = FetchCampaign(session_, campaign.id, (folder_ / "fetched").string());
  for (const char* file : {"report.html", "summary.json"})
    EXPECT_TRUE(TextOfFile(fetched.directory / file) == text) << file;
  EXPECT_TRUE(TextOfFile(fetched.directory / "histories/nominal.csv.gz") == history);
  EXPECT_FALSE(fs::exists(fetched.directory / "report.html.gz"));
  std::ofstream(page, std::ios::binary) << "of a process that was killed";
  const FetchedCampaign again = FetchCampaign(session_, campaign.id, (folder_ / "again").string());
  EXPECT_EQ(TextOfFile(again.directory / "report.html"), "of a process that was killed");
  fs::remove(page);
  BackUp(session_, (folder_ / "backup").string());
  const fs::path backup = folder_ / "backup" / campaign.id / "results";
  EXPECT_TRUE(TextOfFile(backup / "histories/nominal.csv.gz") == history);
  EXPECT_EQ(SizeOf(backup / "report.html"), text.size());
}

// As long as a reader has it open, SQLite leaves the last transactions beside the database.
TEST_F(RemoteCampaign, HasAllItsCasesAlsoWhileSomebodyReadsThem) {
  const Campaign campaign = Smoke(5);
  Launch(campaign);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  const fs::path results = service_->catalogue().ResultsOf(campaign.id);
  const ResultFolder reader = ResultFolder::Open(results);
  workforce_.Join("w");
  for (const std::uint64_t i : {0, 1, 3})
    workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(i));
  session_.Ask("cancel", {{"id", campaign.id}});
  ASSERT_GT(fs::file_size(results / "results.sqlite-wal"), 0u);
  const FetchedCampaign first = FetchCampaign(session_, campaign.id, (folder_ / "first").string());
  EXPECT_THAT(ResultFolder::Open(first.directory).PresentCases(), ElementsAre(0, 1, 3));
  const CaseResult row = ResultFolder::Open(first.directory).Load(3), returned = MadeUpWorkforce::ResultOf(3);
  EXPECT_EQ(row.inputs, returned.inputs);
  for (const std::size_t metric : MeasuredMetrics(campaign))
    EXPECT_EQ(row.metrics[metric], returned.metrics[metric]) << metric;

  // The copy for the first client is not used when there are more results.
  service_->Relaunch(campaign.id, 0);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(2));
  session_.Ask("cancel", {{"id", campaign.id}});
  const FetchedCampaign second = FetchCampaign(session_, campaign.id, (folder_ / "second").string());
  EXPECT_THAT(ResultFolder::Open(second.directory).PresentCases(), ElementsAre(0, 1, 2, 3));

  const fs::path copy = results.parent_path() / "fetched.sqlite";
  EXPECT_TRUE(fs::exists(copy));
  workforce_.time_s += 61.0;
  session_.Ask("health", Json::object());
  EXPECT_FALSE(fs::exists(copy)) << "nobody has read it for a minute";
}

TEST_F(RemoteCampaign, AFolderThatNobodyReadsAnyMoreIsNotFetchedFromItsCopy) {
  const Campaign campaign = Smoke(5);
  Launch(campaign);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  workforce_.Join("w");
  {
    const ResultFolder reader = ResultFolder::Open(service_->catalogue().ResultsOf(campaign.id));
    workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(0));
    session_.Ask("cancel", {{"id", campaign.id}});
    FetchCampaign(session_, campaign.id, (folder_ / "first").string());
  }
  LaunchCampaign(session_, campaign, 0);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(1));
  session_.Ask("cancel", {{"id", campaign.id}});
  const FetchedCampaign second = FetchCampaign(session_, campaign.id, (folder_ / "second").string());
  EXPECT_THAT(ResultFolder::Open(second.directory).PresentCases(), ElementsAre(0, 1));
}

// Another host takes over: it starts on a backup, and what came after the backup is flown again.
TEST_F(RemoteCampaign, ABackupIsADataFolderFromWhichAnotherCoordinatorGoesOn) {
  NextEpoch(folder_ / "data");
  const Campaign ended = Smoke(2, 5), flying = Smoke(4, 6), deleted = Smoke(2, 7);
  for (const Campaign& campaign : {ended, deleted}) {
    Launch(campaign);
    ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
    workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(1));
    session_.Ask("cancel", {{"id", campaign.id}});
  }
  session_.Ask("delete", {{"id", deleted.id}});
  workforce_.Expel({{"node1", {"case 4 gives other bits"}}});
  workforce_.time_s += 2.0;
  Launch(flying);
  ASSERT_TRUE(Reaches(flying.id, CampaignState::kFlying));
  workforce_.Return("w", flying.flight_id, MadeUpWorkforce::ResultOf(0));
  service_->Flush();
  const fs::path backup = folder_ / "backup";
  EXPECT_EQ(BackUp(session_, backup.string()), 2u);
  workforce_.Return("w", flying.flight_id, MadeUpWorkforce::ResultOf(1));
  service_->Flush();
  EXPECT_FALSE(fs::exists(backup.string() + ".dispersa-backup"));
  for (const char* file : {"deleted.jsonl", "expelled.json", "epoch"})
    EXPECT_EQ(TextOfFile(backup / file), TextOfFile(folder_ / "data" / file)) << file;
  EXPECT_GT(NextEpoch(backup), ReadEpoch(folder_ / "data" / "epoch"));

  MadeUpWorkforce others;
  Service there(ServiceOptions{backup}, others);
  EXPECT_THAT(others.expelled(), ElementsAre(Pair("node1", Expulsion{"case 4 gives other bits"})));
  const auto& entries = there.catalogue().entries();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries.at(ended.id).state, CampaignState::kCancelled);
  EXPECT_EQ(entries.at(ended.id).done, 1u);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (entries.at(flying.id).state != CampaignState::kFlying && std::chrono::steady_clock::now() < deadline)
    there.Step();
  EXPECT_EQ(there.View(flying.id).progress.done, 1u);
  EXPECT_EQ(there.View(flying.id).progress.waiting, 3u);
  EXPECT_THAT(ResultFolder::Open(there.catalogue().ResultsOf(flying.id)).PresentCases(), ElementsAre(0));
  EXPECT_EQ(there.catalogue().TextOf(ended.id), ended.canonical_yaml);
}

// Of what was deleted while it was copied, nothing is left.
TEST_F(Fetching, ABackupLeavesOutWhatIsDeletedMeanwhileAndEndsForAnythingElse) {
  const std::string id(64, 'a');
  for (const bool is_deleted : {true, false}) {
    MadeUpCoordinator coordinator;
    coordinator.Answers("ids", {{"ids", {id}}, {"more", false}});
    coordinator.Answers("files",
                        {{"id", id}, {"state_json", "{}"}, {"text_size", 9}, {"files", Json::array()}});
    if (is_deleted) coordinator.Answers("files", {{"id", ""}, {"files", Json::array()}});
    coordinator.Refuses("read", 2, "no such campaign");
    if (is_deleted) {
      coordinator.Refuses("list", 2, "no campaign, or more than one, has the id");
    } else {
      coordinator.Answers("list", Listed(4, nullptr));
    }
    Session session = coordinator.Connect();
    std::uint64_t campaigns = 9;
    const std::string failure = FailureOf([&] { campaigns = BackUp(session, Target().string()); });
    EXPECT_EQ(failure, is_deleted ? "none" : "2: no such campaign");
    if (is_deleted) {
      EXPECT_EQ(campaigns, 0u);
      EXPECT_TRUE(fs::is_empty(Target()));
      fs::remove_all(Target());
    }
  }
}

// Rows that somebody removed by hand are missed before they are handed out.
TEST_F(RemoteCampaign, ThatLacksCasesOfItsStateIsNotHandedOut) {
  const Campaign campaign = Smoke(4);
  Launch(campaign);
  ASSERT_TRUE(Reaches(campaign.id, CampaignState::kFlying));
  workforce_.Join("w");
  for (const std::uint64_t i : {0, 1})
    workforce_.Return("w", campaign.flight_id, MadeUpWorkforce::ResultOf(i));
  session_.Ask("cancel", {{"id", campaign.id}});
  const fs::path database = service_->catalogue().ResultsOf(campaign.id) / "results.sqlite";
  Database(database, Database::Mode::kExisting).Execute("DELETE FROM cases WHERE case_index = 1");
  const std::string target = (folder_ / "fetched").string();
  EXPECT_EQ(FailureOf([&] { FetchCampaign(session_, campaign.id, target); }),
            "5: campaign " + campaign.id.substr(0, 8) +
                " has 2 cases and 1 of them arrived: nothing was written; fetch it again");
  const ResultFolder reader = ResultFolder::Open(database.parent_path());
  Database writer(database, Database::Mode::kExisting);
  writer.Execute("DELETE FROM cases");
  EXPECT_EQ(FailureOf([&] { FetchCampaign(session_, campaign.id, target); }),
            "5: " + database.string() + ": it has 0 of the 2 cases that the campaign's state promises");
}

}  // namespace dispersa::remote_campaign_test
