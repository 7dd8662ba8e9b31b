// Runs, result folders, comparisons, margins, references.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/comparison.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"
#include "services/client/autopilot_tuning.h"
#include "services/client/campaign_reports.h"
#include "services/client/campaign_run.h"
#include "services/client/case_replay.h"
#include "services/client/failure_search.h"
#include "services/client/folder_comparison.h"
#include "services/client/margins_of.h"
#include "services/client/reference_search.h"
#include "services/client/stored_campaign.h"
#include "services/client/writable.h"
#include "services/ledger/campaign_book.h"
#include "services/program/threads.h"
#include "services/python/parts.h"
#include "services/python/python_law.h"
#include "services/python/python_observer.h"
#include "services/python/result_columns.h"

namespace py = pybind11;

namespace dispersa {
namespace {

ReflownFlights Reflown(std::optional<std::uint64_t> envelope) {
  return envelope ? ReflownFlights{false, *envelope} : ReflownFlights{true};
}

/// The law of a call, for campaigns that name its hash; nothing where none is given.
class CallsLaw {
 public:
  CallsLaw(const py::object& law, const std::string& sha256, PythonObserver& observer) {
    if (law.is_none()) return;
    law_.emplace(law, observer);
    law_->Offer(sha256);
  }
  /// Under the interpreter's lock more threads would wait for it.
  int Threads(int asked) const { return law_ ? 1 : asked; }

 private:
  std::optional<PythonLaw> law_;
};

/// A campaign flown on this machine: (folder, exit code, why cases are missing or None). `envelope`: as
/// ReflownFlights; None flies nothing again.
py::tuple Run(const std::string& name, const std::string& text, const std::string& out, bool resume,
              int workers, int threads, const std::string& worker_program,
              std::optional<std::uint64_t> envelope, const py::object& progress, const py::object& law,
              const std::string& law_sha256) {
  PythonObserver observer(progress);
  const CallsLaw calls_law(law, law_sha256, observer);
  std::filesystem::path folder;
  const RunOptions options = {workers, calls_law.Threads(threads), WorkersOfProgramAt(worker_program),
                              Reflown(envelope)};
  const RunResult result = observer.Watch([&] {
    WorkersOf(options);
    PreparedRun prepared = PrepareRun({InputSource(name, text), {}, out, resume, {}},
                                      [&observer] { return observer.ShouldStop(); });
    folder = prepared.folder.directory();
    return RunCampaign(std::move(prepared), options, observer);
  });
  return py::make_tuple(folder.string(), static_cast<int>(result.code), result.problem);
}

/// The reports of a folder made again; its exit code.
int MakeAgain(const std::string& directory, std::optional<std::uint64_t> envelope, const py::object& progress,
              const py::object& law, const std::string& law_sha256) {
  PythonObserver observer(progress);
  const CallsLaw calls_law(law, law_sha256, observer);
  return observer.Watch([&] {
    StoredCampaign stored = OpenStored(directory);
    RequireWritableFile("the report", stored.folder.directory() / "report.html");
    stored.folder.Lock();
    const CampaignSummary summary = MakeReports(
        stored.folder, stored.campaign, calls_law.Threads(UsableCores()), Reflown(envelope), observer);
    return static_cast<int>(CampaignExitCode(summary.standing.verdict, 0));
  });
}

/// The columns of cases.csv, the verdict's exit code and summary.json, from what is stored.
py::dict Results(const std::string& directory) {
  std::string engine, summary;
  ExitCode code = kExitDone;
  std::optional<ResultColumns> columns;
  std::map<std::string, double> nominal;
  {
    const py::gil_scoped_release free;
    // A run that flew no case, or one that goes on, has results too.
    const StoredCampaign stored = OpenStored(directory, /*may_be_empty=*/true);
    columns.emplace(stored.folder.inputs().positions(), stored.folder.metric_list(), stored.folder.metrics());
    for (const std::size_t i : stored.folder.inputs().constants())
      nominal[InputColumns()[i].name] = stored.folder.inputs().constant(i);
    stored.folder.ForEach([&](const CaseResult& result) { columns->Add(result); });
    engine = stored.folder.Provenance("engine");
    const CampaignSummary built = BuildSummary(stored.folder, stored.campaign);
    code = CampaignExitCode(built.standing.verdict, 0);
    summary = SummaryJson(built);
  }
  py::dict answer = columns->Take();
  answer["nominal"] = nominal;
  answer["engine"] = engine;
  answer["exit_code"] = static_cast<int>(code);
  answer["summary"] = summary;
  return answer;
}

/// compare.json.
std::string CompareResults(const std::string& a, const std::string& b,
                           const std::vector<std::string>& metrics, const std::string& out) {
  const py::gil_scoped_release free;
  RequireWritableFolder("out", out);
  const FolderComparison compared = CompareFolders(a, b, metrics);
  if (!out.empty()) WriteComparison(compared, out);
  return ComparisonJson(compared.comparison);
}

/// The object that `dispersa margins --json` prints.
std::string Margins(const std::string& name, const std::string& text, std::optional<std::uint64_t> cases,
                    double frequency_band_percent, bool drift) {
  const py::gil_scoped_release free;
  const Campaign campaign = LoadCampaign(InputSource(name, text), {.cases = cases});
  return MarginsJson(MarginsOf(campaign, {cases, frequency_band_percent, drift})).dump(2);
}

/// What `dispersa search --json` prints. `limits`: below, above.
std::string Search(const std::string& name, const std::string& text, const std::string& metric,
                   std::pair<std::optional<double>, std::optional<double>> limits, std::size_t flights,
                   int starts, double reach, std::optional<std::uint64_t> seed, const py::object& progress) {
  PythonObserver observer(progress);
  FailureSearchRequest request = {metric, limits.first, limits.second, {}, seed};
  request.options.max_flights = flights;
  request.options.starts = starts;
  request.options.reach = reach;
  return observer.Watch(
      [&] { return SearchForFailure(LoadCampaign(InputSource(name, text)), request, observer).json.dump(); });
}

/// (what `dispersa tune --json` prints, the autopilot file). `autopilot`: a file, or "".
py::tuple TuneGains(const std::string& name, const std::string& text, const std::string& autopilot,
                    const std::string& out, std::uint64_t seed, int cases, int evaluations, int dispersed,
                    bool regulator, int threads, const py::object& progress) {
  PythonObserver observer(progress);
  const TuningRequest request = {
      name, out, autopilot, {seed, cases, evaluations, ThreadsOrAll(threads), dispersed, regulator}};
  const auto found = observer.Watch([&] {
    if (!out.empty()) RequireWritableFile("out", out);
    const Campaign campaign = LoadCampaign(InputSource(name, text));
    const TunedAutopilot tuned =
        TuneAutopilot(campaign, autopilot.empty() ? campaign.autopilot : LoadAutopilot(autopilot),
                      request.tuning, observer);
    std::pair both = {TuningJson(request, tuned).dump(), TunedFile(request, tuned)};
    if (!out.empty()) WriteFile(out, both.second);
    return both;
  });
  return py::make_tuple(found.first, found.second);
}

/// (what `dispersa optimize --json` prints, the reference as YAML, how far it got if it misses its target).
py::tuple Optimize(const std::string& name, const std::optional<std::string>& text,
                   std::optional<std::uint64_t> seed, int threads, const std::string& out,
                   const py::object& progress) {
  PythonObserver observer(progress);
  std::string json, reference, statement;
  observer.Watch([&] {
    const OptimizationInput input = LoadOptimization(SourceOf(name, text), seed);
    if (!out.empty()) RequireWritableReference("out", out);
    const FoundReference found = FindReference(input, ThreadsOrAll(threads), observer);
    if (!out.empty()) WriteFoundReference(found, out);
    json = FoundReferenceJson(input.vehicle, found, out).dump(2);
    reference = WriteReference(found.result.reference);
    statement = found.Statement();
  });
  return py::make_tuple(json, reference, statement);
}

/// The object that `dispersa replay --json` prints.
std::string Replay(const std::string& directory, std::uint64_t case_index, const py::object& law,
                   const std::string& law_sha256) {
  PythonObserver observer{py::none()};
  const CallsLaw calls_law(law, law_sha256, observer);
  return observer.Watch([&] { return ReplayJson(ReplayCase(OpenStored(directory), case_index)).dump(2); });
}

}  // namespace

void AddResults(py::module_& module) {
  module.def("run", &Run);
  AddService(module);
  module.def("report", &MakeAgain);
  module.def("results", &Results);
  module.def("compare", &CompareResults);
  module.def("margins", &Margins);
  module.def("optimize", &Optimize);
  module.def("search", &Search);
  module.def("tune", &TuneGains);
  module.def("replay", &Replay);
}

}  // namespace dispersa
