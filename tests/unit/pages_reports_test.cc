// A whole report from flights of the engine: the same bytes for any worker and any order.
#include "core/pages/reports.h"

#include <nlohmann/json.hpp>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "core/pages/histories.h"
#include "core/results/database.h"
#include "core/results/fingerprint.h"
#include "core/results/gzip.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::pages_reports_test {
namespace {

using namespace report_test;

constexpr std::uint64_t kCases = 4;

/// The shipped vehicle, reference and autopilot under some of Table 3's dispersions.
const Campaign& TheCampaign() {
  static const Campaign campaign = [] {
    TemporaryFolder temporary;
    const std::string shipped = DISPERSA_CAMPAIGNS;
    std::ofstream(temporary / "campaign.yaml")
        << "schema: dispersa/campaign/1\nname: report_test\n"
        << "vehicle: " << shipped << "/vehicles/slv4.yaml\n"
        << "reference: " << shipped << "/references/slv4_500km.yaml\n"
        << "autopilot: " << shipped << "/autopilots/adaptive_fuzzy.yaml\n"
        << "sampling: {method: monte_carlo, cases: " << kCases << ", seed: 5}\n"
        << "dispersions:\n"
        << "  drag_coefficient: {distribution: normal, three_sigma_percent: 6.7}\n"
        << "  wind: {max_speed_m_s: 60.96, azimuth: uniform}\n"
        << "requirements:\n"
        << "  - {metric: pitch_error_rms_deg, below: 0.2, probability: 0.5, consumer_risk: 0.1}\n";
    return LoadCampaign((temporary / "campaign.yaml").string());
  }();
  return campaign;
}

const std::vector<CaseResult>& TheResults() {
  static const std::vector<CaseResult> results = [] {
    const CampaignFlights flights(TheCampaign());
    std::vector<CaseResult> flown;
    for (std::uint64_t k = 0; k < kCases; ++k) flown.push_back(flights.FlyCase(k));
    return flown;
  }();
  return results;
}

/// Every file of a folder but the database, by its path in the folder.
std::map<std::string, std::string> Files(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !name.starts_with("results.sqlite"))
      files[name] = TextOfFile(entry.path());
  }
  return files;
}

TEST(Reports, AreTheSameBytesForAnyOrderAndNumberOfThreads) {
  TemporaryFolder temporary;
  ResultFolder one = ResultFolder::Create(temporary / "one", TheCampaign());
  one.Append(TheResults());
  const CampaignSummary summary =
      WriteReports(one, TheCampaign(), {.history_cases = 3, .threads = 1, .progress = {}});

  ResultFolder other = ResultFolder::Create(temporary / "other", TheCampaign());
  std::vector<CaseResult> reversed(TheResults().rbegin(), TheResults().rend());
  for (const CaseResult& result : reversed) other.Append({{result}});
  other.Store({},
              {{{.case_index = 0, .worker = "w", .host = "somewhere", .started_utc = "", .seconds = 1.0}}});
  WriteReports(other, TheCampaign(), {.history_cases = 3, .threads = 3, .progress = {}});

  const std::map<std::string, std::string> files = Files(temporary / "one");
  const std::map<std::string, std::string> others = Files(temporary / "other");
  ASSERT_EQ(files.size(), others.size());
  for (const auto& [name, bytes] : files) EXPECT_TRUE(others.at(name) == bytes) << name;
  for (const char* name : {"campaign.yaml", "cases.csv", "summary.json", "report.html", "nominal.json",
                           "histories/nominal.csv.gz", "histories/bands.csv.gz"}) {
    EXPECT_EQ(files.count(name), 1u) << name;
  }
  const std::uint64_t worst = summary.worst_cases.at(0).cases.at(0).case_index;
  EXPECT_EQ(files.count("histories/case_" + std::to_string(worst) + ".csv.gz"), 1u);
  EXPECT_EQ(nlohmann::json::parse(files.at("summary.json"))["nominal"]["outcome"], "completed");
  EXPECT_EQ(summary.flown, kCases);
  EXPECT_EQ(summary.verdict, CampaignVerdict::kPass);
}

TEST(Reports, CanBeWrittenAgain) {
  TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", TheCampaign());
  folder.Append({TheResults().data(), 1});
  EXPECT_EQ(WriteReports(folder, TheCampaign(), {.history_cases = 0, .threads = 1, .progress = {}}).verdict,
            CampaignVerdict::kIncomplete);
  const std::map<std::string, std::string> first = Files(temporary / "out");
  std::ofstream(temporary / "out" / "histories" / "case_99.csv.gz") << "of an earlier worst case";
  WriteReports(ResultFolder::Open(temporary / "out"), TheCampaign(),
               {.history_cases = 0, .threads = 1, .progress = {}});
  EXPECT_TRUE(Files(temporary / "out") == first);
}

// Flights are flown again only where their histories are not those of an earlier report.
TEST(Reports, KeepHistoriesOfTheSameFlights) {
  TemporaryFolder temporary;
  const auto out = temporary / "out";
  ResultFolder folder = ResultFolder::Create(out, TheCampaign());
  folder.Append(TheResults());
  const auto flown = [&](std::uint64_t history_cases) {
    std::uint64_t flights = 0;
    WriteReports(folder, TheCampaign(),
                 {.history_cases = history_cases,
                  .threads = 1,
                  .progress = [&](const std::string& what, std::uint64_t done, std::uint64_t) {
                    if (what == "time histories") flights = done;
                  }});
    return flights;
  };
  const std::uint64_t all = flown(3);  // those of the files a second time, with every tick
  EXPECT_GT(all, kCases);
  const std::map<std::string, std::string> reports = Files(out);
  EXPECT_EQ(flown(3), 0u);
  EXPECT_TRUE(Files(out) == reports);

  const auto change = [&](const char* name, const std::string& text) {
    std::ofstream(out / "histories" / name) << text;
    EXPECT_EQ(flown(3), all) << name;
    EXPECT_TRUE(Files(out) == reports) << name;
    EXPECT_EQ(flown(3), 0u) << name;
  };
  std::string bands = Gunzip(reports.at("histories/bands.csv.gz")).value();
  bands[bands.size() - 2] = bands[bands.size() - 2] == '1' ? '2' : '1';
  change("bands.csv.gz", Gzip(bands));
  change("bands.csv.gz", reports.at("histories/bands.csv.gz") + "more");
  change("nominal.csv.gz", "");
  change("made_of.json", "[]");
  change("made_of.json", "{\"key\": 1, \"files\": 2}");
  EXPECT_EQ(flown(2), all) << "another sample";
  Database(out / "results.sqlite", Database::Mode::kExisting)
      .Execute("UPDATE cases SET reason = 'as another engine says' WHERE case_index = 1");
  EXPECT_THROW(flown(2), ResultError) << "a damaged row";
}

// Ticks of 0.1 s; every third is kept, the event between ticks, that on a tick with the tick's own row, the
// extremes, and the end.
TEST(Histories, HaveRowsOfAStepAndOfEventsAndExtremes) {
  History ticks;
  const auto add = [&](double time_s, double value) {
    ticks.values.resize(ticks.values.size() + HistoryColumns().size(), std::nan(""));
    double* const row = &ticks.values[ticks.values.size() - HistoryColumns().size()];
    row[0] = time_s;
    row[5] = value;
  };
  add(0.0, 1.0);
  add(0.1, 2.0);
  add(0.2, 9.0);  // the largest
  add(0.1 + 0.2, 3.0);
  add(0.35, 3.0);  // an event
  add(0.4, 3.0);
  add(0.5, 3.0);
  add(0.5, 4.0);   // an event on a tick
  add(0.7, -1.0);  // the least
  add(0.8, 3.0);
  add(1.0, 3.0);
  const History kept = Thinned(ticks, 0.1, 0.3);
  std::vector<double> times;
  for (std::size_t row = 0; row < kept.rows(); ++row) times.push_back(kept.at(row, 0));
  EXPECT_EQ(times, (std::vector<double>{0.0, 0.2, 0.1 + 0.2, 0.35, 0.5, 0.5, 0.7, 1.0}));
  EXPECT_EQ(kept.at(1, 5), 9.0);
}

TEST(Gzip, GivesTheSameTextAgainAndRefusesDamage) {
  for (const std::string& text : {std::string(), std::string("a"), std::string(1'000'000, 'x')}) {
    const std::string bytes = Gzip(text);
    EXPECT_EQ(Gzip(text), bytes);
    EXPECT_EQ(Gunzip(bytes), text);
    EXPECT_EQ(Gunzip(bytes.substr(0, bytes.size() - 1)), std::nullopt);
    EXPECT_EQ(Gunzip(bytes + "x"), std::nullopt);
  }
  EXPECT_EQ(Gunzip(""), std::nullopt);
  EXPECT_EQ(Gunzip("time_s\n0\n"), std::nullopt);
}

// A folder whose rows got lost: the table that was made of all of them is the last that there is.
TEST(Reports, LeaveATableOfMoreCasesAsItIs) {
  TemporaryFolder temporary;
  const auto out = temporary / "out";
  const ReportOptions options = {.history_cases = 0, .threads = 1, .progress = {}};
  ResultFolder folder = ResultFolder::Create(out, TheCampaign());
  folder.Append({TheResults().data(), 3});
  WriteReports(folder, TheCampaign(), options);
  const std::map<std::string, std::string> reports = Files(out);
  Database(out / "results.sqlite", Database::Mode::kExisting)
      .Execute("DELETE FROM cases WHERE case_index > 0");
  try {
    WriteReports(folder, TheCampaign(), options);
    FAIL() << "three cases were replaced by one";
  } catch (const ResultError& error) {
    EXPECT_EQ(error.kind(), ResultError::Kind::kFewer);
    EXPECT_EQ(error.what(),
              (out / "cases.csv").string() +
                  ": it has 3 cases and results.sqlite has 1: the reports stay as they are; remove "
                  "cases.csv to have reports of 1");
  }
  EXPECT_TRUE(Files(out) == reports);
  std::filesystem::remove(out / "cases.csv");
  WriteReports(folder, TheCampaign(), options);
  EXPECT_NE(Files(out), reports);
}

TEST(Reports, RefuseAResultThatDoesNotComeOutAgain) {
  TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", TheCampaign());
  CaseResult forged = TheResults()[0];
  forged.digest = {1, 2};
  folder.Append({{forged}});
  try {
    WriteReports(folder, TheCampaign(), {.history_cases = 1, .threads = 1, .progress = {}});
    FAIL() << "written";
  } catch (const ResultError& error) {
    EXPECT_EQ(error.kind(), ResultError::Kind::kConflict);
    EXPECT_EQ(
        error.what(),
        "case 0 does not reproduce its stored result: digest 00000000000000010000000000000002 is stored, " +
            TheResults()[0].digest.Hex() + " was flown now");
  }
}

// Nothing of another engine can be flown again: what it stored is drawn, whatever the option asks for.
TEST(Reports, OfAnotherEngineDrawItsHistoriesAndFlyNothing) {
  TemporaryFolder temporary;
  const auto out = temporary / "out";
  ReportOptions options = {.history_cases = 3, .threads = 1, .progress = {}};
  {
    ResultFolder folder = ResultFolder::Create(out, TheCampaign());
    folder.Append(TheResults());
    WriteReports(folder, TheCampaign(), options);
  }
  const auto histories = [&] { return Files(out / "histories"); };
  const auto before = histories();
  const std::string page = TextOfFile(out / "report.html");
  Database(out / "results.sqlite", Database::Mode::kExisting)
      .Execute("UPDATE provenance SET value = '0.0.0+older' WHERE key = 'engine'");
  options.history_cases = 1;
  options.progress = [](const std::string&, std::uint64_t, std::uint64_t) { FAIL() << "a flight"; };
  const ResultFolder folder = ResultFolder::Open(out);
  const CampaignSummary summary = WriteReports(folder, TheCampaign(), options);
  EXPECT_EQ(summary.engine, "0.0.0+older");
  ASSERT_TRUE(summary.envelope);
  EXPECT_EQ(summary.envelope->flights, 3u) << "as they were made";
  EXPECT_EQ(summary.envelope->extreme_flights, 1u);
  EXPECT_TRUE(histories() == before);
  const std::string again = TextOfFile(out / "report.html");
  EXPECT_THAT(again, HasSubstr(", page by engine <code>" + EngineVersion().substr(0, 12) +
                               "</code>, which flew nothing"));
  const auto figures = [](const std::string& html) {
    std::size_t count = 0;
    for (std::size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(figures(again), figures(page));
  options.histories = false;
  EXPECT_FALSE(WriteReports(folder, TheCampaign(), options).envelope);
  EXPECT_TRUE(histories() == before) << "nobody could make them again";
  options.histories = true;
  for (const char* name : {"bands.csv.gz", "nominal.csv.gz"}) {
    std::ofstream(out / "histories" / name) << "changed";
    EXPECT_FALSE(WriteReports(folder, TheCampaign(), options).envelope) << name;
    std::ofstream(out / "histories" / name) << before.at(name);
  }
  EXPECT_TRUE(WriteReports(folder, TheCampaign(), options).envelope);

  // As release 0.1.0 left them: without compression.
  nlohmann::json made_of = {{"schema", "dispersa/histories/1"}, {"key", ""}};
  for (const auto& [name, bytes] : before) {
    std::filesystem::remove(out / "histories" / name);
    if (!name.ends_with(".gz")) continue;
    const std::string plain = name.substr(0, name.size() - 3), text = *Gunzip(bytes);
    std::ofstream(out / "histories" / plain) << text;
    made_of["files"][plain] = Fingerprint(text).Hex();
  }
  std::ofstream(out / "histories" / "made_of.json") << made_of;
  ASSERT_TRUE(WriteReports(folder, TheCampaign(), options).envelope);
  EXPECT_EQ(figures(TextOfFile(out / "report.html")), figures(page));
  std::ofstream(out / "histories" / "nominal.csv", std::ios::app) << "1";
  EXPECT_FALSE(WriteReports(folder, TheCampaign(), options).envelope);
}

TEST(Reports, TellTheirProgressAndStopWhenAsked) {
  TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", TheCampaign());
  folder.Append(TheResults());
  struct Stop {};
  std::uint64_t last = 0;
  const auto progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (what != "time histories") return;
    EXPECT_EQ(total, kCases + 4) << "the worst of each key metric a second time, with every tick";
    last = done;
    if (done == 2) throw Stop();
  };
  EXPECT_THROW(
      WriteReports(folder, TheCampaign(), {.history_cases = kCases, .threads = 1, .progress = progress}),
      Stop);
  EXPECT_EQ(last, 2u);
}

}  // namespace
}  // namespace dispersa::pages_reports_test
