// The rules of a run on this machine, with made-up time and the smallest processes.
#include <nlohmann/json.hpp>

#include "services/client/execution_file.h"
#include "services/fleet/local_workers.h"
#include "services/program/exit_code.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::local_rules_test {

using Json = nlohmann::ordered_json;

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

TEST_F(EndingWorkers, AreWaitedForSinceOneHadJoined) {
  workers_.Poll(3.0, 0);
  workers_.NoteJoined(0, 10.0);
  EXPECT_EQ(workers_.NobodyJoined_s(10.0), 7.0) << "since the first was started";
  workers_.NoteJoined(1, 12.0);
  workers_.Poll(14.0, 0);
  EXPECT_EQ(workers_.NobodyJoined_s(20.0), 8.0);
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

}  // namespace dispersa::local_rules_test
