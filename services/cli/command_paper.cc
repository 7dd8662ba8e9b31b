// dispersa paper: every table and figure of the paper, computed here and now, on one page.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/paper/paper_page.h"
#include "core/paper/paper_study.h"
#include "services/cli/command.h"
#include "services/cli/progress.h"
#include "services/cli/warn.h"
#include "services/client/writable.h"
#include "services/program/option_values.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

struct PaperCommandOptions {
  std::string out;
  std::string campaigns;
  std::uint64_t cases = PaperOptions{}.cases;
  int threads = 0;  ///< 0: the processor's
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

ExitCode MakePaper(const PaperCommandOptions& options, const GlobalOptions& global) {
  const fs::path directory = options.out;
  CheckEmpty(directory);
  RequireWritableFolder("--out", directory);
  const fs::path folder = options.campaigns.empty() ? ShippedCampaigns() : fs::path(options.campaigns);
  std::vector<Campaign> campaigns;
  for (const PaperCampaign& campaign : PaperCampaigns())
    campaigns.push_back(LoadAndWarn((folder / (campaign.name + ".yaml")).string()));

  std::string phase;
  std::unique_ptr<Progress> progress;
  PaperOptions study;
  study.cases = options.cases;
  study.threads = ThreadsOrAll(options.threads);
  study.progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (!progress || what != phase) {
      progress.reset();
      progress = std::make_unique<Progress>(what, global.quiet);
      phase = what;
    }
    progress->Show(done, total);
  };
  const PaperStudy results = RunPaperStudy(campaigns, study);
  progress.reset();
  WritePaper(results, directory);
  fmt::print("page: {}\n", (directory / "paper.html").string());
  return kExitDone;
}

}  // namespace

void AddPaperCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<PaperCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "paper", "compute every table and figure of the paper on one page, from new flights");
  command->add_option("--out", options->out, "folder for paper.html and its data, empty or new")
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
  command->footer(
      "Example: dispersa paper --out paper\n         dispersa paper --out paper_quick --cases 10");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return MakePaper(*options, global); };
  });
}

}  // namespace dispersa
