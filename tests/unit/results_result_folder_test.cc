// The result folder keeps every result exactly once, for any order of arrival.
#include "core/results/result_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/flight/engine_version.h"
#include "core/results/database.h"
#include "core/results/fingerprint.h"
#include "core/results/nominal_json.h"
#include "core/results/output_file.h"
#include "tests/small_disk.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::results_result_folder_test {

using namespace report_test;

std::string Query(const std::filesystem::path& folder, const std::string& sql) {
  Database database(folder / "results.sqlite", Database::Mode::kExisting);
  Statement statement = database.Prepare(sql);
  return statement.Step() ? statement.Text(0) : "no row";
}

struct ResultFolders : testing::Test {
  const TemporaryFolder temporary;
};

TEST_F(ResultFolders, HoldsTheCampaignAndWhereItComesFrom) {
  const ResultFolder folder = ResultFolder::Create(temporary / "a" / "b", MakeLimitedCampaign(3));
  EXPECT_EQ(TextOfFile(temporary / "a" / "b" / "campaign.yaml"), "name: made_up\n");
  EXPECT_EQ(folder.Provenance("campaign_id"), std::string(64, '1'));
  EXPECT_EQ(folder.Provenance("flight_id"), std::string(64, '2'));
  EXPECT_EQ(folder.Provenance("engine"), EngineVersion());
  EXPECT_EQ(folder.Provenance("seed"), "7");
  EXPECT_EQ(folder.Provenance("sampling"), "monte_carlo");
}

TEST(RowVersions, TheVersionOfTodayKnowsTheLastInput) {
  int last = 0;
  for (const InputColumn& column : InputColumns()) last = std::max(last, column.number);
  EXPECT_EQ(LastInputOf(kRowVersion), last)
      << "a new input needs a new kRowVersion: without it all stored rows are damaged";
}

TEST_F(ResultFolders, ReturnsAResultToTheLastBit) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  CaseResult stored = MakeCase(2);
  stored.outcome = Outcome::kLostControl;
  stored.reason = "it's \"gone\", or so";
  stored.metrics[0] = 0.1 + 0.2;
  stored.metrics[1] = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(folder.Append({{stored}}), 1u);
  EXPECT_THAT(ResultFolder::Open(temporary / "out").Load(2),
              FieldsAre(2, Outcome::kLostControl, 569.25, 4, stored.reason, stored.inputs,
                        stored.inputs_digest, stored.metrics, stored.digest, stored.events));
}

TEST_F(ResultFolders, EachCaseHasItsEventsAndNoOther) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(4));
  CaseResult silent = MakeCase(1), undefined = MakeCase(3);
  silent.events.clear();
  undefined.events[1].qbar_pa = kNaN;
  folder.Append({{undefined, MakeCase(2), MakeCase(0), silent}});
  const auto of = [&](std::uint64_t index) { return folder.Load(index).events; };
  EXPECT_EQ(of(0), MakeCase(0).events);
  EXPECT_THAT(of(1), IsEmpty());
  EXPECT_EQ(of(2), MakeCase(2).events);
  EXPECT_TRUE(std::isnan(of(3)[1].qbar_pa));
  EXPECT_EQ(of(3)[1].mass_kg, 5000.0);
  std::vector<std::size_t> in_order;
  folder.ForEach([&](const CaseResult& result) { in_order.push_back(result.events.size()); });
  EXPECT_THAT(in_order, ElementsAre(2, 0, 2, 2));
  EXPECT_EQ(Query(temporary / "out", "SELECT group_concat(event) FROM events WHERE case_index = 2"),
            "lift_off,stage_1_burnout");
  EXPECT_EQ(Query(temporary / "out", "SELECT typeof(qbar_pa) FROM events WHERE case_index = 3 AND place = 1"),
            "null");
}

TEST_F(ResultFolders, StoresUndefinedAsNullAndNoNegativeZero) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(1));
  CaseResult result = MakeCase(0);
  result.metrics[0] = kNaN;
  result.metrics[1] = std::numeric_limits<double>::infinity();
  result.metrics[2] = -0.0;
  ApplyEverywhere(RowInputs(MakeLimitedCampaign(1)), -0.0, result);
  folder.Append({{result}});
  const CaseResult loaded = folder.Load(0);
  EXPECT_TRUE(std::isnan(loaded.metrics[0]));
  EXPECT_TRUE(std::isnan(loaded.metrics[1]));
  EXPECT_EQ(loaded.metrics[2], 0.0);
  EXPECT_FALSE(std::signbit(loaded.metrics[2]));
  EXPECT_FALSE(std::signbit(loaded.inputs[0]));
  EXPECT_EQ(Query(temporary / "out", "SELECT typeof(metric_" + MetricNames()[0] + ") FROM cases"), "null");
  EXPECT_EQ(Query(temporary / "out", "SELECT typeof(metric_" + MetricNames()[1] + ") FROM cases"), "null");
  EXPECT_EQ(Query(temporary / "out", "SELECT typeof(metric_" + MetricNames()[2] + ") FROM cases"), "real");
}

TEST_F(ResultFolders, AcceptsARepeatedResultOnce) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  EXPECT_EQ(folder.Append({{MakeCase(1), MakeCase(0)}}), 2u);
  EXPECT_EQ(folder.Append({{MakeCase(1), MakeCase(2), MakeCase(2)}}), 1u);
  EXPECT_THAT(folder.PresentCases(), ElementsAre(0, 1, 2));
}

TEST_F(ResultFolders, RefusesADifferentResultOfACaseWithItsWholeBatch) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  folder.Append({{MakeCase(1)}});
  CaseResult other = MakeCase(1);
  other.digest.low = 5;
  EXPECT_THAT(
      [&] {
        folder.Append({{MakeCase(0), other}});
      },
      Fails(ResultError::Kind::kConflict,
            "case 1 was flown twice with different digests: 00000000000000020000000000abcdef is "
            "stored, 00000000000000020000000000000005 arrived"));
  EXPECT_THAT(folder.PresentCases(), ElementsAre(1));
  EXPECT_EQ(folder.Load(1).digest.low, 0xabcdefu);
}

Campaign WithOwn(const std::vector<std::string>& names) {
  Campaign campaign = MakeLimitedCampaign(4);
  for (const std::string& name : names) campaign.own_metrics.push_back({name, "max(" + name + ")", "", {}});
  return campaign;
}

CaseResult Measured(std::uint64_t index, const std::vector<double>& own) {
  CaseResult result = MakeCase(index);
  result.metrics.insert(result.metrics.end(), own.begin(), own.end());
  return result;
}

TEST_F(ResultFolders, CasesWaitForMetricsThatTheyLack) {
  ResultFolder::Create(temporary / "out", WithOwn({})).Append({{MakeCase(0), MakeCase(1), MakeCase(2)}});
  {
    ResultFolder folder = ResultFolder::Resume(temporary / "out", WithOwn({"a_m", "b_s"}));
    EXPECT_THAT(folder.PresentCases(), ElementsAre());
    EXPECT_EQ(folder.UnmeasuredCount(), 3u);
    EXPECT_EQ(folder.LastCase(), 2u);
    EXPECT_EQ(folder.Append({{Measured(1, {10.0, kNaN})}}), 1u);
    EXPECT_EQ(folder.UnmeasuredCount(), 2u);
    EXPECT_EQ(folder.PlannedCases(), 4) << "no new plan";
  }
  // Interrupted, and then without the second metric: what has the first stays.
  {
    ResultFolder folder = ResultFolder::Resume(temporary / "out", WithOwn({"a_m"}));
    EXPECT_THAT(folder.PresentCases(), ElementsAre(1));
    EXPECT_EQ(folder.Load(1).metrics.back(), 10.0);
    EXPECT_EQ(folder.metric_list().size(), folder.Load(1).metrics.size());
    EXPECT_EQ(folder.UnmeasuredCount(), 2u);
  }
  // Without any: all that was flown is there again, as it was.
  ResultFolder folder = ResultFolder::Resume(temporary / "out", WithOwn({}));
  EXPECT_THAT(folder.PresentCases(), ElementsAre(0, 1, 2));
  EXPECT_EQ(folder.UnmeasuredCount(), 0u);
  for (const std::uint64_t index : {0, 1, 2}) {
    EXPECT_EQ(folder.Load(index).metrics, MakeCase(index).metrics);
    EXPECT_EQ(folder.Load(index).events, MakeCase(index).events);
  }
}

TEST_F(ResultFolders, AMetricWithAnotherExpressionIsAnother) {
  Campaign campaign = WithOwn({"a_m"});
  ResultFolder::Create(temporary / "out", campaign).Append({{Measured(0, {1.0})}});
  campaign.own_metrics[0].expression = "min(a_m)";
  ResultFolder folder = ResultFolder::Resume(temporary / "out", campaign);
  EXPECT_EQ(folder.UnmeasuredCount(), 1u);
  CaseResult other = Measured(0, {2.0});
  other.digest.low = 5;
  EXPECT_EQ(ErrorOf<ResultError>([&] { folder.Append({{other}}); }),
            "case 0 was flown twice with different digests: 00000000000000010000000000abcdef is stored, "
            "00000000000000010000000000000005 arrived");
  EXPECT_EQ(folder.Append({{Measured(0, {2.0})}}), 1u);
  EXPECT_EQ(folder.UnmeasuredCount(), 0u);
  EXPECT_EQ(folder.Load(0).metrics.back(), 2.0);
}

TEST_F(ResultFolders, AMetricNamedAfterAStageMakesNoVehicleOfManyStages) {
  const Campaign campaign = WithOwn({"q_stage6_pa"});
  ResultFolder::Create(temporary / "out", campaign).Append({{Measured(0, {1.0})}});
  const ResultFolder folder = ResultFolder::Open(temporary / "out");
  EXPECT_EQ(folder.stages(), ColumnClass(campaign.vehicle));
  EXPECT_EQ(folder.Load(0).metrics.back(), 1.0);
}

TEST_F(ResultFolders, ListsInOrderWhatIsThere) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(100));
  folder.Append({{MakeCase(41), MakeCase(3)}});
  folder.Append({{MakeCase(17)}});
  EXPECT_THAT(folder.PresentCases(), ElementsAre(3, 17, 41));
  std::vector<std::uint64_t> visited;
  folder.ForEach([&](const CaseResult& result) { visited.push_back(result.case_index); });
  EXPECT_THAT(visited, ElementsAre(3, 17, 41));
  EXPECT_TRUE(folder.Contains(17));
  EXPECT_FALSE(folder.Contains(18));
  EXPECT_EQ(ErrorOf<InputError>([&] { folder.Load(18); }),
            (temporary / "out").string() + ": has no result of case 18");
}

TEST_F(ResultFolders, KeepsQuarantineUntilThereIsAResult) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(10));
  folder.Quarantine({5, "killed 3 workers"});
  folder.Quarantine({4, "hung 1 worker"});
  folder.Quarantine({4, "hung 3 workers"});
  ASSERT_EQ(folder.QuarantinedCases().size(), 2u);
  EXPECT_EQ(folder.QuarantinedCases()[0].reason, "hung 3 workers");
  folder.Append({{MakeCase(4)}});
  ASSERT_EQ(folder.QuarantinedCases().size(), 1u);
  EXPECT_EQ(folder.QuarantinedCases()[0].case_index, 5u);
}

TEST_F(ResultFolders, KeepsTelemetryApart) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(10));
  folder.Store({}, {{{.case_index = 3,
                      .worker = "w1",
                      .host = "h",
                      .started_utc = "2026-01-01T00:00:00Z",
                      .seconds = 0.25}}});
  EXPECT_EQ(Query(temporary / "out",
                  "SELECT case_index || worker || host || started_utc || seconds FROM execution"),
            "3w1h2026-01-01T00:00:00Z0.25");
  EXPECT_TRUE(folder.PresentCases().empty());
}

TEST_F(ResultFolders, KnowsWhoReturnedWhatAndForgetsAllOfOneWorker) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(10));
  folder.Store({{MakeCase(1), MakeCase(2), MakeCase(3)}},
               {{{1, "liar", "h", "", kNaN}, {2, "honest", "h", "", kNaN}, {3, "liar", "h", "", kNaN}}});
  EXPECT_EQ(folder.WorkerOf(2), "honest");
  EXPECT_EQ(folder.WorkerOf(4), std::nullopt);

  folder.AppendAudits({{{"honest", 2, {}, false}, {"liar", 3, {}, false}}});
  const auto unaudited = [&] {
    std::vector<std::string> found;
    folder.ForEachUnaudited([&](const Claim& claim) {
      EXPECT_EQ(claim.fingerprint, Fingerprint(MakeCase(claim.case_index)));
      found.push_back(claim.worker + std::to_string(claim.case_index));
    });
    return found;
  };
  EXPECT_THAT(unaudited(), ElementsAre("liar1"));

  EXPECT_THAT(folder.Disown("liar"), testing::UnorderedElementsAre(1u, 3u));
  EXPECT_THAT(folder.PresentCases(), ElementsAre(2u));
  EXPECT_EQ(folder.WorkerOf(1), std::nullopt);
  EXPECT_TRUE(folder.Disown("liar").empty());
  folder.Store(
      {{MakeCase(4), MakeCase(5), MakeCase(6)}},
      {{{4, "node1_a", "h", "", kNaN}, {5, "node1_b", "g", "", kNaN}, {6, "node10_c", "h", "", kNaN}}});
  EXPECT_THAT(folder.Disown("node1@h"), ElementsAre(4u));
  EXPECT_THAT(folder.Disown("node1"), ElementsAre(5u));
  EXPECT_THAT(folder.Disown("node10_c"), ElementsAre(6u));
  // That the liar's result of a case was right says nothing of the next one's.
  folder.Store({{MakeCase(3)}}, {{{3, "next", "h", "", kNaN}}});
  EXPECT_THAT(unaudited(), ElementsAre("next3"));
}

TEST_F(ResultFolders, RefusesAFolderThatIsNotEmpty) {
  std::filesystem::create_directories(temporary / "out" / "something");
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Create(temporary / "out", MakeLimitedCampaign(1)); }),
            (temporary / "out").string() +
                ": the folder is not empty, allowed: a new or an empty folder, or --resume to continue a "
                "campaign of the same flight id");
}

TEST_F(ResultFolders, RefusesAFolderThatCannotBeMade) {
  std::ofstream(temporary / "file") << "not a folder";
  EXPECT_EQ(
      ErrorOf<InputError>([&] { ResultFolder::Create(temporary / "file" / "out", MakeLimitedCampaign(1)); }),
      (temporary / "file" / "out").string() +
          ": cannot be made: Not a directory, allowed: a folder that can be written");
}

TEST_F(ResultFolders, RefusesToOpenWhatIsNone) {
  std::filesystem::create_directories(temporary / "empty");
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Open(temporary / "empty"); }),
            (temporary / "empty").string() + ": not a result folder: it has no results.sqlite");
  std::filesystem::create_directories(temporary / "garbage");
  std::ofstream(temporary / "garbage" / "results.sqlite") << std::string(4096, 'x');
  EXPECT_EQ(
      ErrorOf<InputError>([&] { ResultFolder::Open(temporary / "garbage"); }),
      (temporary / "garbage").string() + ": not a result folder: its results.sqlite is no SQLite database");
  std::filesystem::create_directories(temporary / "other");
  Database((temporary / "other") / "results.sqlite", Database::Mode::kCreate).Execute("CREATE TABLE t (x)");
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Open(temporary / "other"); }),
            (temporary / "other").string() + ": not a result folder: " +
                (temporary / "other" / "results.sqlite").string() + ": no such table: provenance");
}

TEST_F(ResultFolders, ResumesAndExtendsTheSameFlights) {
  { ResultFolder::Create(temporary / "out", MakeLimitedCampaign(2)).Append({{MakeCase(0), MakeCase(1)}}); }
  Campaign longer = MakeLimitedCampaign(5);
  longer.id = std::string(64, '3');
  longer.canonical_yaml = "name: made_up\ncases: 5\n";
  const ResultFolder folder = ResultFolder::Resume(temporary / "out", longer);
  EXPECT_THAT(folder.PresentCases(), ElementsAre(0, 1));
  EXPECT_EQ(folder.Provenance("campaign_id"), std::string(64, '3'));
  EXPECT_EQ(folder.Provenance("cases"), "5");
  EXPECT_EQ(TextOfFile(temporary / "out" / "campaign.yaml"), longer.canonical_yaml);
}

TEST_F(ResultFolders, RefusesToMixFlights) {
  { ResultFolder::Create(temporary / "out", MakeLimitedCampaign(2)).Append({{MakeCase(1)}}); }
  const std::string folder = (temporary / "out").string();

  Campaign other = MakeLimitedCampaign(2);
  other.flight_id = std::string(64, '9');
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Resume(folder, other); }),
            folder + ": holds results of flight id " + std::string(64, '2') + ", the campaign's is " +
                std::string(64, '9'));
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Resume(folder, MakeLimitedCampaign(1)); }),
            folder + ": already holds case 1, the campaign has only 1 cases");
  Database(folder + "/results.sqlite", Database::Mode::kExisting)
      .Execute("UPDATE provenance SET value = '0.0.0+older' WHERE key = 'engine'");
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Resume(folder, MakeLimitedCampaign(2)); }),
            folder + ": holds results of engine 0.0.0+older, this one is " + EngineVersion());
}

TEST_F(ResultFolders, RefusesColumnsOfAnotherEngine) {
  { ResultFolder::Create(temporary / "out", MakeLimitedCampaign(2)); }
  Database((temporary / "out") / "results.sqlite", Database::Mode::kExisting)
      .Execute("ALTER TABLE cases DROP COLUMN metric_" + MetricNames()[0]);
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Open(temporary / "out"); }),
            (temporary / "out").string() + ": flown by engine " + EngineVersion() +
                "; its inputs and metrics are not those of this engine, " + EngineVersion());
}

TEST_F(ResultFolders, IsWrittenByOneProcessAtATime) {
  const std::string busy = (temporary / "out").string() +
                           ": another dispersa process is writing this folder, allowed: another folder, or "
                           "to wait for that process to end";
  {
    const ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(2));
    EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Resume(temporary / "out", MakeLimitedCampaign(2)); }),
              busy);
    ResultFolder reader = ResultFolder::Open(temporary / "out");
    EXPECT_EQ(ErrorOf<InputError>([&] { reader.Lock(); }), busy);
  }
  const ResultFolder folder = ResultFolder::Resume(temporary / "out", MakeLimitedCampaign(2));
  EXPECT_EQ(ErrorOf<InputError>([&] { FolderLock again(temporary / "out"); }), busy);
}

std::string NamesOfInputs(const std::filesystem::path& folder, const std::string& sql) {
  return Query(folder, "SELECT group_concat(" + sql);
}

TEST_F(ResultFolders, RowsHoldTheInputsThatTheCampaignSetsAndATableTheOthersOnce) {
  Campaign campaign = MakeLimitedCampaign(3);
  campaign.vehicle.stages.resize(2);
  campaign.derived.push_back({"cg_factor", "drag_factor", FindInput("cg_factor"), {}});
  ScalarDistribution constant;
  constant.values = {1.0};
  campaign.dispersions.push_back({"density", constant, {FindInput("density_factor")}});
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  EXPECT_EQ(
      NamesOfInputs(temporary / "out", "name) FROM pragma_table_info('cases') WHERE name LIKE 'input%'"),
      "input_drag_factor,input_cg_factor,input_density_factor");
  EXPECT_EQ(Query(temporary / "out", "SELECT count(*) FROM nominal"),
            std::to_string(InputsOf(campaign.vehicle).size() - 3));
  EXPECT_EQ(Query(temporary / "out", "SELECT value FROM nominal WHERE input = 'wind_altitude_m'"), "12000.0");
  CaseResult result = MakeCase(1);
  ApplyEverywhere(folder.inputs(), 0.5, result);
  folder.Append({{result}});
  const ResultFolder opened = ResultFolder::Open(temporary / "out");
  EXPECT_THAT(opened.Load(1).inputs, ElementsAre(0.5, 0.5, 0.5));
  EXPECT_EQ(opened.Load(1).inputs_digest, result.inputs_digest);
  const auto nominal = nlohmann::json::parse(NominalJson(opened.inputs()));
  EXPECT_EQ(nominal["schema"], "dispersa/nominal/1");
  EXPECT_EQ(nominal["inputs"].size(), InputsOf(campaign.vehicle).size() - 3);
  EXPECT_EQ(nominal["inputs"]["wind_altitude_m"],
            (nlohmann::json{{"value", 12000.0}, {"unit", "m"}, {"key", "wind.altitude"}}));
  EXPECT_FALSE(nominal["inputs"].contains("density_factor"));
  EXPECT_TRUE(nominal["inputs"].contains("thrust_factor_stage2"));
  EXPECT_FALSE(nominal["inputs"].contains("thrust_factor_stage3")) << "the vehicle has no such stage";
}

// Nothing in the row would show it.
TEST_F(ResultFolders, RefusesAFlightThatAppliedOtherConstants) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  CaseResult result = MakeCase(1);
  std::vector<double> all = folder.inputs().AllOf(result.inputs);
  all[static_cast<std::size_t>(FindInput("cg_factor"))] = 1.01;
  SetInputs(folder.inputs(), all, result);
  EXPECT_EQ(ErrorOf<ResultError>([&] {
              folder.Append({{MakeCase(0), result}});
            }),
            "case 1: its flight applied other constants than its campaign's");
  EXPECT_THAT(folder.PresentCases(), ElementsAre()) << "all or none";
}

TEST_F(ResultFolders, AFolderOfALaterVersionIsLeftAlone) {
  ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  Database(temporary / "out" / "results.sqlite", Database::Mode::kExisting)
      .Execute("PRAGMA user_version = 7");
  const std::string error =
      (temporary / "out").string() +
      ": written by a newer dispersa: its results.sqlite has version 7, this one reads 6";
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Open(temporary / "out"); }), error);
  EXPECT_EQ(ErrorOf<InputError>([&] { ResultFolder::Resume(temporary / "out", MakeLimitedCampaign(3)); }),
            error);
}

TEST_F(ResultFolders, TellsADamagedRowAndRemovesItToBeFlownAgain) {
  const std::string metric = "metric_" + MetricNames()[0];
  for (const std::string& damage :
       {"UPDATE cases SET " + metric + " = " + metric + " + 1e-9",
        std::string("UPDATE cases SET outcome = 'impact'"), std::string("UPDATE cases SET reason = 'x'"),
        std::string("UPDATE cases SET end_stage = end_stage + 1"),
        std::string("UPDATE cases SET end_time_s = NULL"),
        std::string("UPDATE cases SET digest = '0' || substr(digest, 2, 30) || 'e'"),
        std::string("UPDATE cases SET row_digest = ''"),
        std::string("UPDATE cases SET input_drag_factor = 1.5"),
        std::string("UPDATE events SET mass_kg = mass_kg + 1e-9"), std::string("DELETE FROM events"),
        std::string("UPDATE events SET event = event || '0'")}) {
    TemporaryFolder own;
    {
      ResultFolder folder = ResultFolder::Create(own / "out", MakeLimitedCampaign(3));
      folder.Append({{MakeCase(0), MakeCase(1), MakeCase(2)}});
    }
    Database((own / "out") / "results.sqlite", Database::Mode::kExisting)
        .Execute(damage + " WHERE case_index = 1");
    {
      const ResultFolder folder = ResultFolder::Open(own / "out");
      const std::string error =
          (own / "out").string() + "/results.sqlite: the row of case 1 is damaged; --resume flies it again";
      EXPECT_EQ(ErrorOf<ResultError>([&] { folder.Load(1); }), error) << damage;
      EXPECT_EQ(ErrorOf<ResultError>([&] { folder.ForEach([](const CaseResult&) {}); }), error) << damage;
    }
    const ResultFolder folder = ResultFolder::Resume(own / "out", MakeLimitedCampaign(3));
    EXPECT_THAT(folder.damaged(), ElementsAre(1)) << damage;
    EXPECT_THAT(folder.PresentCases(), ElementsAre(0, 2)) << damage;
    EXPECT_EQ(Query(own / "out", "SELECT count(*) FROM events WHERE case_index = 1"), "0") << damage;
  }
}

TEST_F(ResultFolders, KeepsTheFingerprintOfEachRow) {
  ResultFolder folder = ResultFolder::Create(temporary / "out", MakeLimitedCampaign(3));
  folder.Append({{MakeCase(2), MakeCase(1)}});
  EXPECT_THAT(folder.Fingerprints(),
              ElementsAre(Pair(1, Fingerprint(MakeCase(1))), Pair(2, Fingerprint(MakeCase(2)))));
}

// Somebody else's, or an archive's.
TEST_F(ResultFolders, IsReadByWhoMayNotWriteIt) {
  const std::filesystem::path out = temporary / "100%# out?";
  ResultFolder::Create(out, MakeLimitedCampaign(3)).Append({{MakeCase(1)}});
  using std::filesystem::perms;
  std::filesystem::permissions(out.parent_path(), perms(0755));
  for (const auto& file : std::filesystem::directory_iterator(out))
    std::filesystem::permissions(file, perms(0444));
  std::filesystem::permissions(out, perms(0555));
  const pid_t child = fork();
  if (child == 0) {
    const bool is_another = geteuid() != 0 || setuid(65534) == 0;
    try {
      _exit(is_another && access(out.c_str(), W_OK) != 0 &&
                    Fingerprint(ResultFolder::Open(out).Load(1)) == Fingerprint(MakeCase(1))
                ? 0
                : 1);
    } catch (const std::exception&) {
      _exit(2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  std::filesystem::permissions(out, perms(0755));
  EXPECT_EQ(status, 0);
}

using OutputFiles = ResultFolders;

TEST_F(OutputFiles, DoesNotFollowALinkInItsPlace) {
  std::ofstream(temporary / "precious") << "kept";
  std::filesystem::create_symlink(temporary / "precious", temporary / "cases.csv.tmp");
  WriteFile(temporary / "cases.csv", "new");
  EXPECT_EQ(TextOfFile(temporary / "precious"), "kept");
  EXPECT_EQ(TextOfFile(temporary / "cases.csv"), "new");
  EXPECT_FALSE(std::filesystem::exists(temporary / "cases.csv.tmp"));
}

TEST(Database, TellsAFullDiskFromOtherErrors) {
  TemporaryFolder temporary;
  Database database(temporary / "small.sqlite", Database::Mode::kCreate);
  database.Execute("CREATE TABLE t (x TEXT)");
  database.Execute("PRAGMA max_page_count = 4");  // SQLite's own full disk
  const auto fill = [&] {
    for (int i = 0; i < 100; ++i) database.Execute("INSERT INTO t VALUES ('" + std::string(1000, 'x') + "')");
  };
  const std::string file = (temporary / "small.sqlite").string();
  EXPECT_THAT(fill, Fails(ResultError::Kind::kDiskFull, file + ": no space left on the disk"));
  EXPECT_THAT([&] { database.Execute("SELECT y FROM t"); },
              Fails(ResultError::Kind::kFile, file + ": no such column: y"));
}

TEST_F(OutputFiles, ReplacesAsAWholeOrNotAtAll) {
  WriteFile(temporary / "file", "old");
  {
    OutputFile abandoned(temporary / "file");
    abandoned.Write("new");
  }
  EXPECT_EQ(TextOfFile(temporary / "file"), "old");
  EXPECT_FALSE(std::filesystem::exists(temporary / "file.tmp"));
  WriteFile(temporary / "file", "new");
  EXPECT_EQ(TextOfFile(temporary / "file"), "new");
  EXPECT_FALSE(std::filesystem::exists(temporary / "file.tmp"));
}

TEST_F(OutputFiles, ReportsAFullDisk) {
  const std::filesystem::path folder = (temporary / "file").parent_path();
  const std::string message = OnASmallDisk(folder, "64k", [&folder]() -> std::string {
    WriteFile(folder / "file", "old");
    std::string said = "written";
    try {
      WriteFile(folder / "file", std::string(1 << 20, 'x'));
    } catch (const ResultError& error) {
      said = error.kind() == ResultError::Kind::kDiskFull ? error.what() : "not the full disk";
    }
    return TextOfFile(folder / "file") == "old" ? said : said + ", and the old file is gone";
  });
  EXPECT_EQ(message, (folder / "file").string() + ": no space left on the disk");
}

TEST_F(OutputFiles, ADatabaseWithoutAnInodeIsOnAFullDisk) {
  const std::filesystem::path folder = (temporary / "file").parent_path();
  const std::string message = OnASmallDisk(folder, "1m,nr_inodes=3", [&folder]() -> std::string {
    std::ofstream(folder / "a") << "the last but the root";
    std::ofstream(folder / "b") << "";
    try {
      const Database database(folder / "results.sqlite", Database::Mode::kCreate);
      return "created";
    } catch (const ResultError& error) {
      return error.kind() == ResultError::Kind::kDiskFull ? error.what()
                                                          : std::string("not full: ") + error.what();
    }
  });
  EXPECT_EQ(message, (folder / "results.sqlite").string() + ": no space left on the disk");
}

TEST_F(OutputFiles, KeepsLinksAndPermissions) {
  const mode_t mask = umask(022);
  std::ofstream(temporary / "file") << "old";
  std::filesystem::permissions(temporary / "file", std::filesystem::perms(0600));
  std::filesystem::create_symlink("file", temporary / "link");
  std::filesystem::create_symlink("not yet", temporary / "dangling");
  WriteFile(temporary / "link", "new");
  WriteFile(temporary / "dangling", "made");
  EXPECT_TRUE(std::filesystem::is_symlink(temporary / "link"));
  EXPECT_EQ(TextOfFile(temporary / "file"), "new");
  EXPECT_EQ(std::filesystem::status(temporary / "file").permissions(), std::filesystem::perms(0600));
  EXPECT_TRUE(std::filesystem::is_symlink(temporary / "dangling"));
  EXPECT_EQ(TextOfFile(temporary / "not yet"), "made");
  AppendLine(temporary / "lines", "first");
  for (const char* made : {"not yet", "lines"})
    EXPECT_EQ(std::filesystem::status(temporary / made).permissions(), std::filesystem::perms(0644)) << made;
  umask(mask);
}

TEST_F(OutputFiles, WritesToAPipeThatIsThere) {
  const std::filesystem::path pipe = temporary / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  WriteFile(pipe, "told");
  char told[8] = "";
  EXPECT_EQ(read(reader, told, sizeof told), 4);
  close(reader);
  EXPECT_EQ(std::string(told), "told");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(OutputFiles, SaysWhyAFileCannotBeWritten) {
  EXPECT_EQ(ErrorOf<ResultError>([&] { WriteFile(temporary / "no" / "file", "x"); }),
            (temporary / "no" / "file").string() + ": cannot be written: No such file or directory");
}

}  // namespace dispersa::results_result_folder_test
