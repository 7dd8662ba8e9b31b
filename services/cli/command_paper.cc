// dispersa paper: every table and figure of the paper, computed here and now, on one page, and the reports
// of the campaigns behind them.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/input/input_error.h"
#include "core/paper/paper_page.h"
#include "core/paper/paper_study.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/margins_text.h"
#include "services/cli/terminal_observer.h"
#include "services/client/campaign_run.h"
#include "services/client/folder_comparison.h"
#include "services/client/margins_of.h"
#include "services/client/reference_search.h"
#include "services/client/stored_campaign.h"
#include "services/client/writable.h"
#include "services/program/option_values.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

struct PaperCommandOptions {
  std::string out;
  std::string campaigns;
  std::uint64_t cases = 200;
  int threads = 0;  ///< 0: the processor's
  ReflownFlights reflown;
};

/// The campaigns shipped with this program: of the repository that it was built in, or beside its
/// installation.
fs::path ShippedCampaigns() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  for (fs::path folder = program.parent_path(); folder != folder.parent_path();
       folder = folder.parent_path()) {
    for (const char* place : {"campaigns", "share/dispersa/campaigns"}) {
      if (fs::exists(folder / place / "table3.yaml")) return folder / place;
    }
  }
  throw InputError("the shipped campaigns are not near " + program.string(), "--campaigns DIR");
}

void CheckEmpty(const fs::path& directory) {
  std::error_code error;
  if (fs::exists(directory, error) &&
      (!fs::is_directory(directory, error) || !fs::is_empty(directory, error)))
    throw InputError("--out: " + directory.string() + " is not an empty folder",
                     "a folder that is empty or new");
}

/// Flies a campaign into its folder, as `dispersa run` does without workers, and reads it back.
PaperFlights Fly(const std::string& file, const Campaign& campaign, bool over_time, const fs::path& directory,
                 const PaperCommandOptions& options, TerminalObserver& observer) {
  RunRequest request;
  request.campaign = file;
  request.overrides.cases = PaperCases(campaign, options.cases);
  request.out = directory.string();
  RunOptions run;
  run.workers = 0;
  run.threads = options.threads;
  run.reflown = options.reflown;
  run.reflown.none = options.reflown.none || !over_time;
  RunResult result = RunCampaign(PrepareRun(request), run, observer);
  if (result.problem) throw ResultError(ResultError::Kind::kFewer, *result.problem);
  StoredCampaign stored = OpenStored(directory.string());
  CaseColumns columns = AllColumns(stored.folder);
  return {std::move(stored.campaign), campaign.sampling.cases, *std::move(result.summary),
          std::move(columns)};
}

ExitCode MakePaper(const PaperCommandOptions& options, const GlobalOptions& global) {
  const fs::path directory = options.out;
  CheckEmpty(directory);
  RequireWritableFolder("--out", directory);
  const fs::path folder = options.campaigns.empty() ? ShippedCampaigns() : fs::path(options.campaigns);
  const auto file = [&](const std::string& name) { return (folder / (name + ".yaml")).string(); };
  std::vector<Campaign> campaigns;  // all of them, before the first flight
  for (const PaperCampaign& campaign : PaperCampaigns())
    campaigns.push_back(LoadCampaign(file(campaign.name)));

  const int threads = ThreadsOrAll(options.threads);
  TerminalObserver observer(global.quiet);
  PaperStudy study;
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    const auto& [name, shows, over_time] = PaperCampaigns()[i];
    study.campaigns.emplace(name,
                            Fly(file(name), campaigns[i], over_time, directory / name, options, observer));
  }
  for (const std::string& name : PaperBaselines()) {
    FolderComparison compared =
        CompareFolders((directory / kPaperLaw).string(), (directory / name).string(), {});
    WriteComparison(compared, directory / name);
    study.comparisons.emplace(name, std::move(compared.comparison));
  }
  FoundReference found =
      FindReference(LoadOptimization(file(PaperCampaigns().front().name)), threads, observer);
  WriteFoundReference(found, directory / "trajectory.yaml");
  study.optimization = std::move(found.result);
  observer.Show("margins", 0, 1);
  MarginsResult margins = MarginsOf(campaigns.front(), {});
  WriteFile(directory / "margins.txt", MarginsText(margins));
  study.computed_margins = std::move(margins.computed);
  study.measured_margins = std::move(margins.measured);
  FlyBeside(study, threads, [&](std::uint64_t done, std::uint64_t total) {
    observer.Show("flights beside the campaigns", done, total);
  });
  observer.EndPhase();
  WriteFile(directory / "paper.html", PaperPage(study));
  fmt::print("page: {}\n", (directory / "paper.html").string());
  return kExitDone;
}

}  // namespace

void AddPaperCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<PaperCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "paper", "compute every table and figure of the paper on one page, from new campaigns");
  command
      ->add_option("--out", options->out,
                   "folder for paper.html and a result folder of each campaign, empty or new")
      ->required()
      ->type_name(kFolderType);
  command
      ->add_option("--cases", options->cases, "size of a Monte Carlo campaign; designs repeat in proportion")
      ->transform(WholeNumber(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--campaigns", options->campaigns,
                   "folder of the campaign files, instead of the shipped ones")
      ->type_name(kFolderType);
  command->add_option("--threads", options->threads, "threads; the page does not depend on them")
      ->transform(WholeNumber(1, 1024));
  AddReflownOptions(*command, options->reflown);
  command->footer(
      "Example: dispersa paper --out paper\n         dispersa paper --out paper_quick --cases 10");
  Bind(command, invocation, options, MakePaper);
}

}  // namespace dispersa
