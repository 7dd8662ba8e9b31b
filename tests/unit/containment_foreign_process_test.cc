#include "core/containment/foreign_process.h"

#include <fcntl.h>
#include <unistd.h>

#include "core/campaign_yaml/load.h"
#include "core/cases/plugin_check.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::containment_foreign_process_test {
namespace {

namespace fs = std::filesystem;

// A PD whose flight takes a minute (tests/plugins/law.c).
Campaign SlowCampaign() {
  std::string text = TextOfFile(DISPERSA_CAMPAIGNS "/autopilots/pd.yaml");
  for (std::size_t at = 0; (at = text.find("law: pd", at)) != std::string::npos;)
    text.replace(at, 7, "law: plugin");
  text.insert(text.find("tick_s:"), "plugin: {library: " DISPERSA_SLOW_LAW "}\n");
  const std::string file = ::testing::TempDir() + "slow_law.yaml";
  std::ofstream(file) << text;
  CampaignOverrides overrides;
  overrides.autopilot = file;
  return LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml", overrides);
}

double SecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(ForeignProcess, HasNothingOfItsParent) {
  setenv("DISPERSA_TEST_SECRET", "of the parent", 1);
  const int first = open("/etc/passwd", O_RDONLY),
            file = fcntl(first, F_DUPFD, 20);  // which a program inherits
  ForeignProcess process;
  EXPECT_THROW(process.Ask(std::string(1, kDescribeOrder) + "no library", [](const std::string&) {}),
               PluginError);
  EXPECT_TRUE(process.is_usable());
  const fs::path foreign = "/proc/" + std::to_string(process.pid());
  EXPECT_EQ(TextOfFile(foreign / "environ").find("TEST_SECRET"), std::string::npos);
  EXPECT_EQ(fs::read_symlink(foreign / "cwd"), "/");
  std::set<std::string> files;
  for (const auto& each : fs::directory_iterator(foreign / "fd")) files.insert(each.path().filename());
  EXPECT_EQ(files, (std::set<std::string>{"0", "1", "2", "3"}));
  EXPECT_EQ(fs::read_symlink(foreign / "fd/0"), "/dev/null");
  close(file);
  close(first);
}

TEST(ForeignProcess, EndsWithItsParent) {
  pid_t pid = 0;
  {
    ForeignProcess process;
    pid = process.pid();
    EXPECT_TRUE(fs::exists("/proc/" + std::to_string(pid)));
  }
  EXPECT_FALSE(fs::exists("/proc/" + std::to_string(pid)));
}

TEST(PluginCheck, HasALimit) {
  const Campaign campaign = SlowCampaign();
  const CampaignFlights flights(campaign);
  std::string text;
  const double seconds = SecondsOf([&] {
    try {
      CheckPluginIsDeterministic(flights, 4, nullptr, std::chrono::seconds(1));
    } catch (const InputError& error) {
      text = error.what();
    }
  });
  EXPECT_EQ(text, "the control law pd_test is too slow: its check flights took more than 1 s");
  EXPECT_TRUE(IsOfTheLaw(text));
  EXPECT_GT(seconds, 1.0);
  EXPECT_LT(seconds, 4.0);
}

TEST(ForeignProcess, AnEndingProcessWaitsForNoLaw) {
  const auto end = [] {
    const Campaign campaign = SlowCampaign();
    const CampaignFlights flights(campaign);
    std::thread stop([] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      EndForeignProcesses();
    });
    bool is_interrupted = false;
    const double seconds = SecondsOf([&] {
      try {
        flights.FlyNominal();
      } catch (const Interrupted&) {
        is_interrupted = true;
      }
    });
    stop.join();
    std::_Exit(is_interrupted && seconds < 2.0 ? 0 : 1);
  };
  EXPECT_EXIT(end(), ::testing::ExitedWithCode(0), "");  // it holds for the rest of a process
}

}  // namespace
}  // namespace dispersa::containment_foreign_process_test
