// The service of many campaigns without a network: who flies first, who waits, what a restart and a second
// launch do.
#include <nlohmann/json.hpp>

#include "core/campaign/case_design.h"
#include "core/flight/flight_inputs.h"
#include "core/results/database.h"
#include "core/results/result_folder.h"
#include "made_up_service.h"
#include "services/coordinator/expulsions.h"
#include "services/coordinator/sealed_json.h"
#include "services/ledger/open_book.h"
#include "services/program/exit_code.h"
#include "tests/small_disk.h"
#include "tests/test.h"

namespace dispersa::campaign_service_test {

class CampaignServiceTest : public ServiceTest {
 protected:
  void Return(const Campaign& campaign, std::uint64_t case_index) {
    CaseResult result = MadeUpWorkforce::ResultOf(case_index);
    SetInputs(RowInputs(campaign), InputValues(CaseDesign(campaign).Draw(case_index)), result);
    workforce_.Return("w", campaign.flight_id, result);
  }
  /// Three lives of a worker end in this case, the only one that is left to fly.
  void Quarantine(const Campaign& campaign, std::uint64_t case_index) {
    for (int life = 0; life < 3; ++life) {
      const std::string worker = "doomed" + std::to_string(life);
      workforce_.Join(worker);
      const std::vector<FlyOrder> orders = workforce_.Tick();
      ASSERT_EQ(orders.size(), 1u);
      ASSERT_THAT(orders[0].cases, ElementsAre(case_index));
      workforce_.dispatcher.On(
          worker,
          Report{
              worker, MadeUpWorkforce::kEpoch, 1, campaign.flight_id, {}, {{case_index, orders[0].attempt}}},
          workforce_.time_s);
      FallSilent();
    }
  }
  void FallSilent() {
    workforce_.time_s += 10.0;
    workforce_.Tick();
  }
  static std::string RefusalOf(const auto& action) {
    try {
      action();
      return "none";
    } catch (const Refused& refused) {
      return std::to_string(refused.code) + ": " + refused.what();
    }
  }
};

TEST_F(CampaignServiceTest, SoManyFlyAtOnceThoseOfAHigherPriorityFirst) {
  StartService(2);
  const std::string low = Launch(Smoke(2, 1), 0), high = Launch(Smoke(2, 2), 5),
                    older = Launch(Smoke(2, 3), 3), younger = Launch(Smoke(2, 4), 3);
  ASSERT_TRUE(Until(
      [&] { return StateOf(high) == CampaignState::kFlying && StateOf(older) == CampaignState::kFlying; }));
  for (int i = 0; i < 50; ++i) service_->Step();
  EXPECT_EQ(StateOf(low), CampaignState::kWaiting);
  EXPECT_EQ(StateOf(younger), CampaignState::kWaiting) << "an equal priority takes nobody's place";
  service_->Cancel(high);
  ASSERT_TRUE(Reaches(younger, CampaignState::kFlying));
  EXPECT_EQ(StateOf(low), CampaignState::kWaiting);
}

TEST_F(CampaignServiceTest, AHigherPriorityTakesThePlaceOfTheLastAndNothingFlownIsLost) {
  StartService(1);
  const Campaign campaign = Smoke(4, 1);
  const std::string low = Launch(campaign);
  ASSERT_TRUE(Reaches(low, CampaignState::kFlying));
  workforce_.Join("w");
  Return(campaign, 2);
  const std::string high = Launch(Smoke(2, 2), 1);
  ASSERT_TRUE(Reaches(high, CampaignState::kFlying));
  EXPECT_EQ(StateOf(low), CampaignState::kWaiting);
  EXPECT_EQ(service_->View(low).progress.done, 1u);
  EXPECT_EQ(service_->View(low).progress.waiting, 3u);
  EXPECT_THAT(ResultFolder::Open(service_->catalogue().ResultsOf(low)).PresentCases(), ElementsAre(2));
  service_->Cancel(high);
  ASSERT_TRUE(Reaches(low, CampaignState::kFlying));
  EXPECT_EQ(service_->View(low).progress.done, 1u);
}

TEST_F(CampaignServiceTest, CampaignsOfTheSameFlightsFlyOneAfterTheOther) {
  StartService();
  const Campaign few = Smoke(3), more = Smoke(5);
  ASSERT_EQ(few.flight_id, more.flight_id);
  const std::string first = Launch(few), second = Launch(more);
  ASSERT_TRUE(Reaches(first, CampaignState::kFlying));
  // Campaigns are opened one after the other: a younger one of other flights comes before the second.
  ASSERT_TRUE(Reaches(Launch(Smoke(2, 9)), CampaignState::kFlying));
  EXPECT_EQ(StateOf(second), CampaignState::kWaiting);
  workforce_.Join("w");
  Return(few, 1);
  service_->Cancel(first);
  ASSERT_TRUE(Reaches(second, CampaignState::kFlying));
  EXPECT_EQ(service_->View(second).progress.done, 1u) << "taken over";
  EXPECT_EQ(service_->View(second).progress.total, 5u);
}

TEST_F(CampaignServiceTest, ACancelledCampaignGoesOnWhenItIsLaunchedAgain) {
  StartService();
  const Campaign campaign = Smoke(4);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w");
  Return(campaign, 0);
  service_->Cancel(id);
  service_->Cancel(id);  // a client repeats itself
  EXPECT_EQ(StateOf(id), CampaignState::kCancelled);
  EXPECT_EQ(service_->catalogue().entries().at(id).code, kExitIncomplete);
  EXPECT_EQ(service_->catalogue().entries().at(id).done, 1u);
  EXPECT_FALSE(service_->HasWork());
  service_->Relaunch(id, 2);
  EXPECT_TRUE(service_->HasWork());
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(id).progress.done, 1u);
}

TEST_F(CampaignServiceTest, ItsResultsAreAtRestWhenNobodyOpensThem) {
  StartService();
  const std::string id = Launch(Smoke(4));
  service_->Step();  // it is being opened now
  service_->Cancel(id);
  EXPECT_FALSE(service_->IsAtRest(id)) << "another thread writes its folder";
  ASSERT_TRUE(Until([&] { return service_->IsAtRest(id); }));
  EXPECT_EQ(StateOf(id), CampaignState::kCancelled);
}

TEST_F(CampaignServiceTest, ReportsAreWrittenSideBySideAndTheOthersWait) {
  StartService();
  std::vector<std::string> ids;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) ids.push_back(Launch(Smoke(1, seed)));
  const auto all_are = [&](CampaignState state) {
    return std::all_of(ids.begin(), ids.end(), [&](const std::string& id) { return StateOf(id) == state; });
  };
  ASSERT_TRUE(Until([&] { return all_are(CampaignState::kFlying); }));
  workforce_.Join("w");
  for (std::uint64_t seed = 1; seed <= 3; ++seed) Return(Smoke(1, seed), 0);
  EXPECT_EQ(service_->reports_under_way(), 0u);
  service_->Step();
  EXPECT_TRUE(all_are(CampaignState::kReporting));
  EXPECT_EQ(service_->reports_under_way(), 2u);
  EXPECT_EQ(service_->reports_waiting(), 1u);
  workforce_.time_s += 3.0;
  EXPECT_EQ(service_->report_wait_s(), 3.0);
  ASSERT_TRUE(Until([&] {
    return std::all_of(ids.begin(), ids.end(), [&](const std::string& id) { return HasEnded(StateOf(id)); });
  }));
  EXPECT_EQ(service_->reports_under_way() + service_->reports_waiting(), 0u);
  EXPECT_EQ(service_->report_wait_s(), 0.0);
}

TEST_F(CampaignServiceTest, ANewPriorityReachesWhatFlies) {
  StartService();
  const Campaign one = Smoke(200, 1), other = Smoke(200, 2);
  const std::string first = Launch(one, 2), second = Launch(other, 1);
  ASSERT_TRUE(Until(
      [&] { return StateOf(first) == CampaignState::kFlying && StateOf(second) == CampaignState::kFlying; }));
  service_->Relaunch(second, 3);
  workforce_.Join("w");
  for (const FlyOrder& order : workforce_.Tick()) EXPECT_EQ(order.flight_id, other.flight_id);
  EXPECT_GT(service_->View(second).progress.assigned, 0u);
}

TEST_F(CampaignServiceTest, QuarantinedCasesAreTriedAgainWhenItIsLaunchedAgain) {
  StartService();
  const Campaign campaign = Smoke(2);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w");
  Return(campaign, 1);
  FallSilent();
  Quarantine(campaign, 0);
  EXPECT_EQ(service_->View(id).progress.quarantined, 1u);
  // Its report flies the stored case again and finds that the result is made up: it has failed.
  ASSERT_TRUE(Until([&] { return HasEnded(StateOf(id)); }));
  EXPECT_EQ(service_->catalogue().entries().at(id).quarantined, 1u);
  service_->Relaunch(id, 0);
  EXPECT_EQ(StateOf(id), CampaignState::kWaiting);
  EXPECT_EQ(service_->catalogue().entries().at(id).quarantined, 0u);
  EXPECT_EQ(service_->catalogue().entries().at(id).problem, "");
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(id).progress.done, 1u);
  EXPECT_EQ(service_->View(id).progress.waiting, 1u);
}

TEST_F(CampaignServiceTest, ADoneCampaignGoesOnIfItHasQuarantinedCases) {
  for (const int quarantined : {0, 1}) {
    StartService();
    const std::string id = Launch(Smoke(2, 10 + quarantined));
    service_.reset();
    const std::filesystem::path file = folder_ / "data" / id / "state.json";
    auto state = nlohmann::ordered_json::parse(TextOfFile(file));
    state["state"] = "done";
    state["quarantined"] = quarantined;
    std::ofstream(file) << Sealed(state);
    StartService();
    EXPECT_EQ(StateOf(id), CampaignState::kDone);
    service_->Relaunch(id, 0);
    EXPECT_EQ(StateOf(id), quarantined == 0 ? CampaignState::kDone : CampaignState::kWaiting);
  }
}

TEST_F(CampaignServiceTest, ACampaignInItsReportIsNotCancelledAndAFailedOneIs) {
  StartService();
  const Campaign campaign = Smoke(1);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w");
  Return(campaign, 0);
  ASSERT_TRUE(Reaches(id, CampaignState::kReporting));
  EXPECT_EQ(RefusalOf([&] { service_->Cancel(id); }),
            "2: campaign " + id.substr(0, 8) + " is reporting and cannot be cancelled");
  ASSERT_TRUE(Reaches(id, CampaignState::kFailed)) << "a result that its flight does not give";
  const std::string problem = service_->View(id).problem;
  EXPECT_NE(problem, "");
  EXPECT_EQ(RefusalOf([&] { service_->Cancel(id); }), "none");
  EXPECT_EQ(StateOf(id), CampaignState::kCancelled);
  EXPECT_EQ(service_->catalogue().entries().at(id).code, kExitIncomplete);
  EXPECT_EQ(service_->View(id).problem, problem) << "why it failed is still known";
}

TEST_F(CampaignServiceTest, ARepairedCampaignFliesAWorkersCasesAgain) {
  StartService();
  const Campaign campaign = Smoke(4);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  CaseResult lie = MadeUpWorkforce::ResultOf(0), truth = lie;
  lie.digest.low ^= 1;
  workforce_.Return("node1_ab", campaign.flight_id, lie);
  workforce_.Return("node2_cd", campaign.flight_id, truth);
  workforce_.Return("node2_cd", campaign.flight_id, MadeUpWorkforce::ResultOf(1));
  workforce_.time_s += 2.0;
  service_->Step();
  EXPECT_EQ(service_->catalogue().entries().at(id).conflicts, 1u) << "exit code 1 for ever";
  service_->Repair(id, "node1");
  EXPECT_EQ(StateOf(id), CampaignState::kWaiting);
  StartService();  // also over a restart
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  EXPECT_EQ(service_->catalogue().entries().at(id).conflicts, 0u);
  EXPECT_THAT(ResultFolder::Open(service_->catalogue().ResultsOf(id)).PresentCases(), ElementsAre(1));
  EXPECT_EQ(service_->View(id).progress.waiting, 3u);
}

TEST_F(CampaignServiceTest, WhoWasExpelledStaysSoWhenTheCoordinatorIsStartedAgain) {
  StartService();
  workforce_.Join("node1_ab");
  workforce_.Expel({{"node1", {"case 4 gives other bits"}}});
  workforce_.time_s += 2.0;
  service_->Step();
  const std::filesystem::path file = folder_ / "data" / "expelled.json";
  EXPECT_EQ(ReadExpulsions(TextOfFile(file)), (ExpulsionMap{{"node1", {"case 4 gives other bits"}}}));
  service_.reset();
  {
    MadeUpWorkforce later;
    Service again({folder_ / "data"}, later);
    EXPECT_THAT(later.expelled(), ElementsAre(Pair("node1", Expulsion{"case 4 gives other bits"})));
    EXPECT_THAT(again.Readmit("node2"), IsEmpty());
    EXPECT_THAT(again.Readmit("node1"), ElementsAre("node1"));
    EXPECT_THAT(ReadExpulsions(TextOfFile(file)), IsEmpty()) << "at once";
  }
  std::ofstream(file) << "{\"node3\": \"of an earlier version\"}";
  MadeUpWorkforce last;
  Service third({folder_ / "data"}, last);
  EXPECT_THAT(last.expelled(), ElementsAre(Pair("node3", Expulsion{"of an earlier version"})));
}

TEST_F(CampaignServiceTest, ADamagedListOfTheExpelledReadmitsNobody) {
  StartService();
  service_.reset();
  const std::filesystem::path file = folder_ / "data" / "expelled.json";
  std::string emptied = SealedText({{"node1", {"a lie"}}});
  const std::string name = "\"node1\": {\n      \"reason\": \"a lie\"\n    }";
  ASSERT_NE(emptied.find(name), std::string::npos) << emptied;
  emptied.erase(emptied.find(name), name.size());
  for (const std::string& damaged : {std::string(), std::string("{\"node1\": {\"reason\": \"a li"),
                                     std::string("{\"node1\": 3}"), std::string("[]"), emptied}) {
    std::ofstream(file) << damaged;
    EXPECT_THAT([&] { Service again({folder_ / "data"}, workforce_); },
                testing::ThrowsMessage<InputError>(
                    AllOf(HasSubstr("expelled.json: is damaged: "),
                          HasSubstr("allowed: the file of a backup; or none, which readmits everybody"))))
        << damaged;
    EXPECT_EQ(TextOfFile(file), damaged);
  }
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);  // no file that can be read
  EXPECT_THROW(Service({folder_ / "data"}, workforce_), InputError);
}

TEST_F(CampaignServiceTest, ACampaignThatHasEndedIsDeletedAndALineIsKept) {
  StartService();
  const Campaign campaign = Smoke(4, 7);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  const auto refusal = [&] { return RefusalOf([&] { service_->Delete(id); }); };
  EXPECT_EQ(
      refusal(),
      "2: campaign " + id.substr(0, 8) +
          " is flying and cannot be deleted, allowed: a campaign that has ended; `dispersa cancel` ends it");
  Return(campaign, 1);
  service_->Cancel(id);
  EXPECT_EQ(refusal(), "none");
  EXPECT_FALSE(service_->catalogue().entries().contains(id));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "data" / id));
  const auto line = nlohmann::json::parse(TextOfFile(folder_ / "data" / "deleted.jsonl"));
  EXPECT_EQ(line.at("id"), id);
  EXPECT_EQ(line.at("flight_id"), campaign.flight_id);
  EXPECT_EQ(line.at("name"), campaign.name);
  EXPECT_EQ(line.at("seed"), 7);
  EXPECT_EQ(line.at("cases"), 1);
  EXPECT_EQ(line.at("state"), "cancelled");
  StartService();
  EXPECT_TRUE(service_->catalogue().entries().empty());
}

TEST(RetentionTest, IsReadAsAUserWritesIt) {
  Retention retention;
  EXPECT_TRUE(ReadRetention("90d", &retention));
  EXPECT_EQ(retention.days, 90.0);
  EXPECT_FALSE(retention.bytes);
  for (const auto& [text, bytes] :
       {std::pair("200GB", 200e9), std::pair("0.5TB", 5e11), std::pair("30MB", 3e7)}) {
    EXPECT_TRUE(ReadRetention(text, &retention));
    EXPECT_EQ(retention.bytes, static_cast<std::uint64_t>(bytes));
  }
  EXPECT_EQ(retention.days, 90.0);
  for (const char* text : {"", "90", "d", "-1d", "0d", "nand", "1e3d", "90 d", "90days", "5gb", "2000000d"})
    EXPECT_FALSE(ReadRetention(text, &retention)) << text;
}

TEST_F(CampaignServiceTest, AnEngineFaultOfTwoWorkersFailsThatCampaignAlone) {
  StartService();
  const Campaign campaign = Smoke(2), other = Smoke(2, 7);
  const std::string id = Launch(campaign), other_id = Launch(other);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  ASSERT_TRUE(Reaches(other_id, CampaignState::kFlying));
  for (const char* worker : {"v", "w"}) {
    workforce_.Join(worker);
    service_->Step();
    EXPECT_EQ(service_->View(id).entry->state, CampaignState::kFlying);
    workforce_.dispatcher.On(worker,
                             CampaignRefusal{worker, MadeUpWorkforce::kEpoch, campaign.flight_id,
                                             "engine fault: core/a.cc:1: x does not hold", true},
                             workforce_.time_s);
  }
  service_->Step();
  const CatalogueEntry& entry = *service_->View(id).entry;
  EXPECT_EQ(
      std::string(CampaignStateName(entry.state)) + " " + std::to_string(entry.code) + ": " + entry.problem,
      "failed 1: engine fault: core/a.cc:1: x does not hold");
  EXPECT_EQ(service_->View(other_id).entry->state, CampaignState::kFlying);
}

TEST_F(CampaignServiceTest, ACampaignThatNoWorkerCanFlySaysWhy) {
  StartService();
  const Campaign campaign = Smoke(2);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(id).problem, "");
  workforce_.Join("w");
  workforce_.dispatcher.On("w", CampaignRefusal{"w", MadeUpWorkforce::kEpoch, campaign.flight_id, "no law"},
                           workforce_.time_s);
  EXPECT_EQ(service_->View(id).problem, "no worker here can fly it: no law");
  // A worker of which the law does not pass the check speaks for those that have no leave to check it.
  for (const char* worker : {"a", "z"}) workforce_.Join(worker);
  workforce_.dispatcher.On("z",
                           CampaignRefusal{"z", MadeUpWorkforce::kEpoch, campaign.flight_id,
                                           "the control law pd is not deterministic"},
                           workforce_.time_s);
  service_->Step();
  EXPECT_EQ(service_->View(id).entry->state, CampaignState::kFlying) << "one may still accept it";
  workforce_.dispatcher.On("a", CampaignRefusal{"a", MadeUpWorkforce::kEpoch, campaign.flight_id, "no leave"},
                           workforce_.time_s);
  service_->Step();
  const CatalogueEntry& entry = *service_->View(id).entry;
  EXPECT_EQ(
      std::string(CampaignStateName(entry.state)) + " " + std::to_string(entry.code) + ": " + entry.problem,
      "refused 2: the control law pd is not deterministic");
  EXPECT_TRUE(HasEnded(entry.state));
  EXPECT_TRUE(IsContinuedByLaunch(entry));
}

// What goes wrong with one campaign is that one's matter: the others fly on.
class ServiceTroubleTest : public CampaignServiceTest {
 protected:
  ServiceTroubleTest() { StartService(30); }

  bool AnotherFlies() { return Reaches(Launch(Smoke(2, 99)), CampaignState::kFlying); }
  std::filesystem::path FolderOf(const std::string& id) const { return folder_ / "data" / id; }
  std::string StoredState(const std::string& id) const {
    const auto state = nlohmann::ordered_json::parse(TextOfFile(FolderOf(id) / "state.json"));
    return state.at("state").get<std::string>() + ": " + state.at("problem").get<std::string>();
  }
  std::string Failure(const std::string& id) const {
    const CatalogueEntry& entry = service_->catalogue().entries().at(id);
    return std::string(CampaignStateName(entry.state)) + " " + std::to_string(entry.code) + ": " +
           service_->View(id).problem;
  }
};

TEST_F(ServiceTroubleTest, ACampaignOfFourBillionCasesIsOpenedAndCancelled) {
  const std::string id = Launch(Smoke(4294967295));
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  EXPECT_EQ(service_->View(id).progress.waiting, 4294967295u);
  EXPECT_EQ(RefusalOf([&] { service_->Cancel(id); }), "none");
  EXPECT_TRUE(AnotherFlies());
}

TEST_F(ServiceTroubleTest, ATextThatCannotBeReadFailsItsCampaignAlone) {
  const std::string id = Launch(Smoke(2));
  std::filesystem::remove(FolderOf(id) / "campaign.yaml");
  ASSERT_TRUE(Reaches(id, CampaignState::kFailed));
  const std::string text = (FolderOf(id) / "campaign.yaml").string();
  EXPECT_EQ(Failure(id), "failed 1: " + text + ": cannot be read");
  EXPECT_EQ(StoredState(id), "failed: " + text + ": cannot be read");
  EXPECT_TRUE(AnotherFlies());
  EXPECT_EQ(RefusalOf([&] { service_->Cancel(id); }), "none");
  StartService();
  EXPECT_EQ(StateOf(id), CampaignState::kCancelled) << "also after a restart";
}

TEST_F(ServiceTroubleTest, AFolderThatCannotBeOpenedFailsItsCampaignAlone) {
  const std::string id = Launch(Smoke(2));
  std::filesystem::create_directories(FolderOf(id) / "results");
  std::ofstream(FolderOf(id) / "results" / "results.sqlite") << "no database";
  ASSERT_TRUE(Reaches(id, CampaignState::kFailed));
  EXPECT_EQ(Failure(id), "failed 2: " + (FolderOf(id) / "results").string() +
                             ": not a result folder: its results.sqlite is no SQLite database");
  EXPECT_TRUE(AnotherFlies());
}

TEST_F(ServiceTroubleTest, ADatabaseThatBreaksFailsItsCampaignAlone) {
  const Campaign campaign = Smoke(4);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  workforce_.Join("w");
  Return(campaign, 1);
  workforce_.time_s += 1.0;
  workforce_.Tick();  // stored
  const std::filesystem::path database = FolderOf(id) / "results" / "results.sqlite";
  Database(database, Database::Mode::kExisting).Execute("DROP TABLE execution");
  Return(campaign, 2);
  workforce_.time_s += 1.0;
  workforce_.Tick();
  service_->Step();
  EXPECT_EQ(Failure(id), "failed 1: " + database.string() + ": no such table: execution");
  EXPECT_EQ(service_->View(id).progress.done, 1u) << "what is stored";
  EXPECT_TRUE(AnotherFlies());
}

TEST_F(ServiceTroubleTest, AStateThatCannotBeStoredIsStoredLater) {
  const Campaign campaign = Smoke(1);
  const std::string id = Launch(campaign);
  ASSERT_TRUE(Reaches(id, CampaignState::kFlying));
  const std::filesystem::path obstacle = FolderOf(id) / "state.json.tmp";
  std::filesystem::create_directories(obstacle / "in its way");
  workforce_.Join("w");
  Return(campaign, 0);
  ASSERT_TRUE(Reaches(id, CampaignState::kFailed)) << "a result that its flight does not give";
  EXPECT_EQ(StoredState(id), "flying: ");
  std::filesystem::remove_all(obstacle);
  workforce_.time_s += 2.0;
  service_->Step();
  EXPECT_EQ(StoredState(id), "failed: " + service_->View(id).problem);
}

// Three descriptors each, of 1024: some hundred campaigns would end the service.
TEST_F(ServiceTroubleTest, CampaignsThatWaitForTheirReportHaveNoFilesOpen) {
  constexpr std::uint64_t kCampaigns = 6;
  workforce_.Join("w");
  std::vector<Campaign> campaigns;
  for (std::uint64_t i = 0; i < kCampaigns; ++i) campaigns.push_back(Smoke(1, 100 + i));
  for (const Campaign& campaign : campaigns) ASSERT_TRUE(Reaches(Launch(campaign), CampaignState::kFlying));
  for (const Campaign& campaign : campaigns) Return(campaign, 0);
  service_->Step();
  for (const Campaign& campaign : campaigns) ASSERT_EQ(StateOf(campaign.id), CampaignState::kReporting);
  std::set<std::string> open;
  for (const auto& descriptor : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    const std::string file = std::filesystem::read_symlink(descriptor, error).string();
    const std::size_t results = file.find("/results");
    if (file.starts_with(folder_.path().string()) && results != std::string::npos)
      open.insert(file.substr(0, results));
  }
  EXPECT_LE(open.size(), 1u) << "that whose report is written";
}

// The same steps on a disk that becomes full while a campaign flies, while one is opened and while one is
// launched.
TEST_F(ServiceTroubleTest, AFullDiskPausesCampaignsAndTheyGoOnByThemselves) {
  service_.reset();
  const Campaign flying = Smoke(200, 1), opening = Smoke(2, 2), launching = Smoke(2, 3);
  const auto steps = [&]() -> std::string {
    StartService();
    std::string said;
    const auto note = [&](const std::string& what) { said += what + "\n"; };
    Launch(flying);
    if (!Reaches(flying.id, CampaignState::kFlying)) return "does not fly";
    Launch(opening);
    workforce_.Join("w");
    FillDisk(folder_ / "filler");
    for (std::uint64_t i = 0; i < 150; ++i) Return(flying, i);
    workforce_.time_s += 1.0;
    workforce_.Tick();
    if (!Until([&] { return !service_->View(opening.id).problem.empty(); }))
      return "the opening is not delayed";
    note(Failure(flying.id));
    note(Failure(opening.id));
    note(service_->WhyPaused());
    workforce_.Join("another");
    note(std::to_string(MadeUpWorkforce::CasesIn(workforce_.Tick())) + " assigned");
    try {
      Launch(launching);
      note("launched");
    } catch (const ResultError& error) {
      note(error.what());
    }
    std::filesystem::remove(folder_ / "filler");
    workforce_.time_s += 11.0;
    workforce_.Join("w");
    note(std::to_string(MadeUpWorkforce::CasesIn(workforce_.Tick()) > 0) + " assigned again");
    note(Failure(flying.id));
    note(service_->WhyPaused());
    if (!Reaches(opening.id, CampaignState::kFlying)) return "the opening is not tried again";
    note(service_->WhyPaused());
    note(Failure(opening.id));
    if (!Reaches(Launch(launching), CampaignState::kFlying)) return "does not fly when launched again";
    note(std::to_string(ResultFolder::Open(service_->catalogue().ResultsOf(flying.id)).CaseCount()) +
         " stored");
    return said;
  };
  const std::string data = (folder_ / "data").string(),
                    later = ": no space left on the disk; it continues by itself\n";
  EXPECT_EQ(OnASmallDisk(folder_.path(), "3m", steps),
            "flying 0: " + data + "/" + flying.id + "/results/results.sqlite" + later +  //
                "waiting 0: " + data + "/" + opening.id + "/results/campaign.yaml" + later + data + "/" +
                flying.id + "/results/results.sqlite: no space left on the disk\n0 assigned\n" +  //
                data + "/" + launching.id + "/campaign.yaml: no space left on the disk\n" +
                "1 assigned again\nflying 0: \n" + data + "/" + opening.id +
                "/results/campaign.yaml: no space left on the disk\n\nflying 0: \n150 stored\n");
}

// A campaign takes over results of the same flights.
class OpeningTest : public ServiceTest {
 protected:
  static CaseResult Drawn(const Campaign& campaign, std::uint64_t case_index) {
    CaseResult result = MadeUpWorkforce::ResultOf(case_index);
    SetInputs(RowInputs(campaign), InputValues(CaseDesign(campaign).Draw(case_index)), result);
    return result;
  }
  static std::vector<std::string> WorkersOf(const ResultFolder& folder) {
    std::vector<std::string> workers;
    for (const std::uint64_t i : folder.PresentCases())
      workers.push_back(folder.WorkerOf(i).value_or("nobody"));
    return workers;
  }
  std::filesystem::path Flown(const std::string& name, const Campaign& campaign,
                              const std::vector<std::uint64_t>& cases) {
    ResultFolder folder = ResultFolder::Create(folder_ / name, campaign);
    std::vector<CaseResult> results;
    std::vector<ExecutionRecord> records;
    for (const std::uint64_t i : cases) {
      results.push_back(Drawn(campaign, i));
      records.push_back({i, flier_, "host", "", 1.0});
    }
    folder.Store(results, records);
    return folder_ / name;
  }
  std::unique_ptr<CampaignBook> Open(const Campaign& campaign, std::vector<std::filesystem::path> others,
                                     std::uint64_t number = 1, std::vector<std::string> distrusted = {},
                                     const AuditOptions& audit = {}) {
    return OpenBook({campaign.canonical_yaml, campaign.name, folder_ / "results", folder_.path(),
                     std::move(others), number, audit, std::move(distrusted)});
  }
  std::string flier_ = "node1_ab";
};

TEST_F(OpeningTest, TakesOverCasesOfTheCampaignAlone) {
  const auto more = Flown("more", Smoke(9), {1, 8});
  const auto book = Open(Smoke(4), {more, folder_ / "nothing"});
  EXPECT_THAT(book->folder().PresentCases(), ElementsAre(1));
  EXPECT_EQ(book->ledger().Progress().done, 1u);
  EXPECT_EQ(book->tally().n(), 1);
}

TEST_F(OpeningTest, TakesNothingOverOfOtherFlights) {
  const auto other = Flown("other", Smoke(4, 2), {0, 1});
  EXPECT_THAT(Open(Smoke(4, 1), {other})->folder().PresentCases(), ElementsAre());
  // Also of those that draw the same inputs.
  const Campaign all = Smoke(4, 1);
  std::string text = all.canonical_yaml;
  const std::string before = "spread_1_s: 60", after = "spread_1_s: 61";
  text.replace(text.find(before), before.size(), after);
  const auto alike = Flown("alike", ParseCampaign(text, "alike"), {0, 1});
  EXPECT_THAT(Open(all, {alike})->folder().PresentCases(), ElementsAre());
}

TEST_F(OpeningTest, ACampaignThatStopsByItselfTakesNothingOver) {
  const Campaign all = Smoke(40);
  const Campaign stops = ParseCampaign(
      all.canonical_yaml + "verdicts: {looks: 2, spending: pocock, stop: when_decided}\n", "stops");
  ASSERT_EQ(stops.flight_id, all.flight_id);
  const auto flown = Flown("flown", all, {0, 39});
  EXPECT_THAT(Open(stops, {flown})->folder().PresentCases(), ElementsAre());
}

TEST_F(OpeningTest, WhoFlewACaseIsTakenOverWithIt) {
  const auto flown = Flown("flown", Smoke(4), {0, 2});
  const auto book = Open(Smoke(4), {flown});
  EXPECT_THAT(WorkersOf(book->folder()), ElementsAre("node1_ab", "node1_ab"));
}

// A forgery that was taken over: it is found out, its worker is named, and the campaign ends well.
TEST_F(OpeningTest, WhatIsTakenOverIsAuditedAndRemovedWithItsWorker) {
  const auto flown = Flown("flown", Smoke(4), {0, 2});
  const auto book = Open(Smoke(4), {flown}, 1, {}, {1.0, 7});
  const std::vector<Claim> claims = book->TakeClaims();
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[0].worker, "node1_ab");
  EXPECT_FALSE(book->Settle(claims[0], {1, 2}));
  book->Disown("node1");
  EXPECT_THAT(book->folder().PresentCases(), ElementsAre());
  EXPECT_EQ(book->ledger().Progress().waiting, 4u);
  EXPECT_EQ(book->ledger().Progress().conflicts, 0u);
}

TEST_F(OpeningTest, WhoseInputsTheCampaignDoesNotDrawIsNotTakenOver) {
  ResultFolder forged = ResultFolder::Create(folder_ / "forged", Smoke(4));
  forged.Append(std::vector{Drawn(Smoke(4), 0), MadeUpWorkforce::ResultOf(1)});
  EXPECT_THAT(Open(Smoke(4), {folder_ / "forged"})->folder().PresentCases(), ElementsAre(0));
}

TEST_F(OpeningTest, ADistrustedWorkersResultsAreRemovedAndTakenOverFromNowhere) {
  const auto first = Flown("first", Smoke(4), {0, 1});
  Open(Smoke(4), {first});
  flier_ = "node2_cd";
  const auto second = Flown("second", Smoke(4), {1, 2});
  const auto book = Open(Smoke(4), {first, second}, 2, {"node1"});
  EXPECT_THAT(book->folder().PresentCases(), ElementsAre(1, 2));
  EXPECT_THAT(WorkersOf(book->folder()), ElementsAre("node2_cd", "node2_cd"));
}

TEST_F(OpeningTest, AttemptsOfTwoOpeningsDiffer) {
  std::set<std::uint64_t> attempts;
  for (const std::uint64_t number : {1, 2}) {
    const auto book = Open(Smoke(4), {}, number);
    book->ledger().Join("w", {EngineVersion(), 1, 2}, 0.0);
    for (const Assignment& assignment : book->ledger().Assign(0.0))
      EXPECT_TRUE(attempts.insert(assignment.attempt).second);
  }
}

}  // namespace dispersa::campaign_service_test
