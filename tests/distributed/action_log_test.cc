// The log of actions on a disk that fills up.
#include "services/coordinator/action_log.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/results/result_error.h"
#include "tests/small_disk.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::action_log_test {

namespace fs = std::filesystem;

// A line for each action: its name, in order.
std::string ActionsIn(const fs::path& file) {
  std::istringstream stream(TextOfFile(file));
  std::string actions;
  for (std::string line; std::getline(stream, line);)
    actions += nlohmann::json::parse(line).at("action").get<std::string>() + "\n";
  return actions;
}

TEST(ActionLogTest, IsForItsUserAloneAndOnlyGrows) {
  const TemporaryFolder folder;
  const fs::path file = folder / "actions.jsonl";
  ActionLog(file).Note({.what = "launch", .by = "ann\n\"\xff"});
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0600));
  const std::string first = TextOfFile(file);
  EXPECT_THAT(first, EndsWith("\"action\":\"launch\",\"by\":\"ann\\n\\\"\xef\xbf\xbd\"}\n"));
  fs::permissions(file, fs::perms(0644));
  ActionLog(file).Note({.what = "cancel"});
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0600));
  EXPECT_THAT(TextOfFile(file), StartsWith(first));
  EXPECT_EQ(ActionsIn(file), "launch\ncancel\n");
}

TEST(ActionLogTest, AFullDiskDelaysLinesAndWhatWouldFollowThem) {
  const TemporaryFolder folder;
  const std::string file = (folder / "actions.jsonl").string();
  EXPECT_EQ(OnASmallDisk(folder.path(), "64k",
                         [&]() -> std::string {
                           ActionLog log(file);
                           log.Note({.what = "launch"});
                           if (!log.problem().empty()) return "the first line waits";
                           FillDisk(folder / "filler");
                           // The last page of the file still takes some.
                           for (int i = 0; i < 100 && log.problem().empty(); ++i)
                             log.Note({.what = "cancel"});
                           const std::string problem = log.problem();
                           const std::string stored = ActionsIn(file);  // no part of a line
                           std::string said;
                           try {
                             log.RequireWritten();
                           } catch (const ResultError& error) {
                             said = error.what();
                           }
                           log.Note({.what = "delete"});
                           if (ActionsIn(file) != stored) return "a line was stored on the full disk";
                           fs::remove(folder / "filler");
                           log.Retry();
                           if (ActionsIn(file) != stored + "cancel\ndelete\n") return ActionsIn(file);
                           log.RequireWritten();
                           return problem + "\n" + said + "\n" + log.problem();
                         }),
            file + ": no space left on the disk\n" + file + ": no space left on the disk\n");
}

}  // namespace dispersa::action_log_test
