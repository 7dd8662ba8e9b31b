// The rules of a run on this machine, and its words, with made-up time and the smallest processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "services/cli/campaign_text.h"
#include "services/cli/progress.h"
#include "services/client/execution_file.h"
#include "services/client/local_workers.h"
#include "services/coordinator/attendance.h"
#include "services/transport/exit_code.h"
#include "temporary_folder.h"

namespace dispersa::local_rules_test {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(Attendance, ThePatienceRunsFromTheLastWorker) {
  Attendance attendance(7, 10.0);
  EXPECT_TRUE(attendance.Check(false, 9.0));
  EXPECT_TRUE(attendance.Check(true, 50.0));
  EXPECT_TRUE(attendance.Check(false, 60.0)) << "from the last time that there was one";
  EXPECT_FALSE(attendance.Check(false, 60.1));
  Attendance endless(7, std::nullopt);
  EXPECT_TRUE(endless.Check(false, 1e9));
}

/// A worker process that ends at once, with a code.
class EndingWorkers : public testing::Test {
 protected:
  /// Polled at one time until the worker has ended.
  LocalWorkers::Changes AwaitEnd(double now_s, std::uint64_t progress = 0) {
    for (const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
         std::chrono::steady_clock::now() < deadline;) {
      LocalWorkers::Changes changes = workers_.Poll(now_s, progress);
      if (!changes.ended.empty()) return changes;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }
  LocalWorkers workers_{"/bin/false", {}, 1};
};

TEST_F(EndingWorkers, AreReplacedEverLaterUnlessSomethingGetsDone) {
  EXPECT_THAT(workers_.Poll(0.0, 0).started, SizeIs(1));
  auto changes = AwaitEnd(1.0);
  ASSERT_THAT(changes.ended, SizeIs(1));
  EXPECT_EQ(changes.ended[0].how, "exit code 1");
  EXPECT_EQ(changes.ended[0].end, WorkerEnd::kCrashed);
  EXPECT_THAT(changes.started, SizeIs(1)) << "the first one at once";
  EXPECT_NE(changes.started[0].uuid, changes.ended[0].uuid);
  EXPECT_THAT(AwaitEnd(2.0).started, IsEmpty());
  EXPECT_THAT(workers_.Poll(2.049, 0).started, IsEmpty());
  EXPECT_THAT(workers_.Poll(2.05, 0).started, SizeIs(1));
  EXPECT_THAT(AwaitEnd(3.0).started, IsEmpty());
  EXPECT_THAT(workers_.Poll(3.099, 0).started, IsEmpty()) << "twice as long";
  EXPECT_EQ(workers_.fruitless_ends(), 3);
  EXPECT_THAT(workers_.Poll(3.099, 1).started, SizeIs(1)) << "a case is done";
  EXPECT_EQ(workers_.fruitless_ends(), 0);
  EXPECT_THAT(workers_.history(), SizeIs(4));
}

TEST(ExecutionFile, SaysHowEachWorkerEndedOnceItHas) {
  const TemporaryFolder folder;
  ExecutionFile file;
  file.directory = folder.path();
  file.started_utc = "then";
  file.workers = {{"a", 12, "then", "later", WorkerEnd::kCrashed, "exit code 1"},
                  {"b", 13, "then", std::nullopt, WorkerEnd::kLeft, ""}};
  file.Write();
  const Json json = Json::parse(TextOfFile(folder / "execution.json"));
  EXPECT_EQ(json.at("workers").at(0).at("end"), "exit code 1");
  EXPECT_EQ(json.at("workers").at(0).at("ended_utc"), "later");
  EXPECT_TRUE(json.at("workers").at(1).at("end").is_null());
  EXPECT_TRUE(json.at("workers").at(1).at("ended_utc").is_null());
  EXPECT_EQ(json.at("pids").size(), 3u) << "the run's own too";
  EXPECT_EQ(json.at("pids").at(2), 13);
  for (const char* none : {"domain", "problem", "ended_utc"}) EXPECT_TRUE(json.at(none).is_null()) << none;
}

TEST(CampaignStatusText, IsALineAndOneForEachRequirement) {
  Json campaign = Json::parse(
      R"({"id": "0123456789abcdef", "name": "smoke", "state": "flying", "done": 5, "total": 20, "quarantined": 0,
      "rate_per_s": 2.5, "eta_s": 6.0, "code": null, "problem": null, "requirements": [
      {"metric": "m", "n": 5, "failures": 1, "so_far": "inconclusive"}]})");
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  flying             5/20        smoke  2.5/s  6s left\n"
            "  1 of 5 break m (inconclusive so far)\n");
  campaign.update({{"state", "failed"},
                   {"rate_per_s", 0.0},
                   {"eta_s", nullptr},
                   {"quarantined", 2},
                   {"code", 1},
                   {"problem", "it broke"},
                   {"requirements", Json::array()}});
  EXPECT_EQ(CampaignStatusText(campaign),
            "0123456789ab  failed             5/20        smoke  2 quarantined  exit code 1  it broke\n");
}

TEST(DurationText, IsInTheLargestUnitsThatFit) {
  EXPECT_EQ(DurationText(0.0), "0s");
  EXPECT_EQ(DurationText(59.4), "59s");
  EXPECT_EQ(DurationText(59.5), "1m00s");
  EXPECT_EQ(DurationText(185.0), "3m05s");
  EXPECT_EQ(DurationText(3599.6), "1h00m");
  EXPECT_EQ(DurationText(2.0 * 3600 + 3 * 60), "2h03m");
  EXPECT_EQ(DurationText(100.0 * 3600), "100h00m");
}

TEST(ExitCodes, TheWorstOfTwoIsSaid) {
  const std::vector<ExitCode> worst_first = {
      kExitInterrupted,    kExitBadInput,          kExitInternalError, kExitIncomplete,
      kExitReplayMismatch, kExitRequirementFailed, kExitInconclusive,  kExitDone};
  for (std::size_t i = 0; i < worst_first.size(); ++i) {
    for (std::size_t j = i; j < worst_first.size(); ++j) {
      EXPECT_EQ(WorseOf(worst_first[i], worst_first[j]), worst_first[i]);
      EXPECT_EQ(WorseOf(worst_first[j], worst_first[i]), worst_first[i]);
    }
  }
}

}  // namespace
}  // namespace dispersa::local_rules_test
