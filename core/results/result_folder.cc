#include "core/results/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/database.h"
#include "core/results/file_system.h"
#include "core/results/fingerprint.h"
#include "core/results/folder_state.h"
#include "core/results/output_file.h"
#include "core/results/requirement_text.h"
#include "core/results/sampling_text.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Kind = ResultError::Kind;

constexpr char kCampaignName[] = "campaign.yaml";
constexpr char kSchema[] = "dispersa/results/1";
/// Rows of cases that were flown before, without all of the campaign's own metrics.
constexpr char kUnmeasured[] = "unmeasured";

/// Columns of `cases` before the inputs; the digests of the flight and of the row follow the metrics.
constexpr int kFirstInput = 5;

using Positions = std::vector<std::size_t>;

std::string CaseColumnList(const RowShape& shape, const char* type) {
  std::string columns;
  for (const std::size_t i : shape.inputs.positions()) {
    const auto former = shape.former_names.find(i);
    columns += fmt::format(
        ", input_{}{}", former == shape.former_names.end() ? InputColumns()[i].name : former->second, type);
  }
  for (const std::size_t i : shape.metrics)
    columns += fmt::format(", metric_{}{}", shape.list.NameAt(i), type);
  return columns;
}

std::string SelectCases(const RowShape& shape, const char* table = "cases") {
  return "SELECT case_index, outcome, end_time_s, end_stage, reason" + CaseColumnList(shape, "") +
         ", digest, row_digest FROM " + table;
}

constexpr char kInOrder[] = " ORDER BY case_index";

bool HasTable(Database& database, const std::string& name) {
  Statement select = database.Prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?");
  return select.Run(name);
}

constexpr char kNominal[] = "nominal", kEvents[] = "events";

/// Events of cases in ascending order, read beside their rows. Folders of older releases have none.
class EventsBeside {
 public:
  EventsBeside(Database& database, const RowShape& shape, std::uint64_t first_case = 0) {
    if (shape.version < 5) return;
    std::string columns;
    for (const char* name : kEventValueNames) columns += fmt::format(", {}", name);
    select_.emplace(database, fmt::format("SELECT case_index, event{} FROM {} WHERE case_index >= ? ORDER BY "
                                          "case_index, place",
                                          columns, kEvents));
    has_row_ = select_->Run(first_case);
  }
  std::vector<SeenEvent> Of(std::uint64_t case_index) {
    std::vector<SeenEvent> events;
    for (; has_row_ && CaseOfRow() <= case_index; has_row_ = select_->Step()) {
      if (CaseOfRow() < case_index) continue;
      SeenEvent& event = events.emplace_back();
      event.name = select_->Text(1);
      int column = 2;
      for (const auto value : SeenEvent::kValues) event.*value = select_->Real(column++);
    }
    return events;
  }

 private:
  std::uint64_t CaseOfRow() const { return static_cast<std::uint64_t>(select_->Integer(0)); }

  std::optional<Statement> select_;
  bool has_row_ = false;
};

/// Vehicles of few stages, and without clusters of engines, have fewer inputs (ColumnClass).
std::size_t ClassOf(const std::vector<std::string>& inputs) {
  std::size_t stages = 0, further = 0;
  for (const std::string& name : inputs) {
    const InputPlace& place = InputColumns()[static_cast<std::size_t>(FindInput(name))].place;
    stages = std::max(stages, static_cast<std::size_t>(place.stage));
    if (place.carrier == Carrier::kFurtherNozzle)
      further = std::max(further, static_cast<std::size_t>(place.item) + 1);
  }
  return further > 0 ? kMaxStages + further : stages;
}

/// By its name, or by the one of release 0.1.0, in which winds of a profile's levels had no unit. Negative:
/// this program does not know it.
int FindStoredInput(const std::string& name) {
  const int input = FindInput(name);
  return input >= 0 ? input : FindInput(name + "_m_s");
}

/// Sets the inputs of which the table has columns. Every other one stands in the table `nominal`, which
/// folders of older releases do not have. InputError for a column that this program does not know; such a
/// constant is left out.
void ReadStoredInputs(Database& database, const fs::path& directory, RowShape& shape) {
  std::vector<std::string> names;
  std::vector<std::size_t> positions;
  shape.former_names.clear();
  Statement columns =
      database.Prepare("SELECT substr(name, 7) FROM pragma_table_info('cases') WHERE name GLOB 'input_*'");
  while (columns.Step()) {
    const std::string name = columns.Text(0);
    const int input = FindStoredInput(name);
    if (input < 0)
      throw InputError(fmt::format("{}: this dispersa does not know its input {}", directory.string(), name));
    positions.push_back(static_cast<std::size_t>(input));
    names.push_back(InputColumns()[positions.back()].name);
    if (names.back() != name) shape.former_names[positions.back()] = name;
  }
  std::vector<std::pair<std::size_t, double>> constants;
  if (HasTable(database, kNominal)) {
    Statement select = database.Prepare(fmt::format("SELECT input, value FROM {}", kNominal));
    while (select.Step()) {
      const int input = FindStoredInput(select.Text(0));
      if (input < 0) continue;
      constants.emplace_back(static_cast<std::size_t>(input), select.Real(1));
      names.push_back(InputColumns()[constants.back().first].name);
    }
  }
  shape.inputs = RowInputs(ClassOf(names), std::move(positions), constants);
}

/// A law's own metrics are there if it was flown. Those that a kind of flight has are there together, or none
/// of them is. Of all others that its version knows a folder must have a column.
Positions StoredMetrics(Database& database, const MetricList& list, int version) {
  std::set<std::string> columns;
  Statement names = database.Prepare("SELECT name FROM pragma_table_info('cases')");
  while (names.Step()) columns.insert(names.Text(0));
  const auto is_there = [&](std::size_t i) { return columns.count("metric_" + list.NameAt(i)) > 0; };
  const std::size_t of_vehicle = MetricCount(list.stages());
  std::set<MetricNeeds> met = {MetricNeeds::kNothing};
  for (std::size_t i = 0; i < of_vehicle; ++i)
    if (is_there(i)) met.insert(Metrics()[i].needs);
  Positions metrics;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool must = i >= of_vehicle || (Metrics()[i].since <= version && Metrics()[i].of_law == nullptr &&
                                          met.count(Metrics()[i].needs) > 0);
    if (must || is_there(i)) metrics.push_back(i);
  }
  return metrics;
}

/// Without the metrics of a campaign's own.
RowShape OfVehicle(RowShape shape) {
  std::erase_if(shape.metrics, [&](std::size_t i) { return i >= MetricCount(shape.list.stages()); });
  return shape;
}

RowShape ShapeOf(const Campaign& campaign) {
  return {RowInputs(campaign), MetricsOf(campaign), MeasuredMetrics(campaign)};
}

constexpr char kOwnMetrics[] = "own_metrics", kShareKey[] = "share";

/// "name = expression" a line, as in the provenance.
std::string OwnMetricLines(const std::vector<OwnMetric>& metrics) {
  std::string lines;
  for (const OwnMetric& metric : metrics) lines += metric.name + " = " + metric.expression + "\n";
  return lines;
}

/// Of an older folder, or one that is none: nothing.
std::vector<OwnMetric> OwnMetricsOf(Database& database) {
  std::vector<OwnMetric> metrics;
  if (!HasTable(database, "provenance")) return metrics;
  Statement select = database.Prepare("SELECT value FROM provenance WHERE key = ?");
  if (!select.Run(kOwnMetrics)) return metrics;
  std::istringstream lines(select.Text(0));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t sign = line.find(" = ");
    if (sign != std::string::npos) metrics.push_back({line.substr(0, sign), line.substr(sign + 3), "", {}});
  }
  return metrics;
}

int VersionOf(const Database& database) {
  Statement select(database, "PRAGMA user_version");
  return select.Step() ? std::max(1, static_cast<int>(select.Integer(0))) : 1;
}

void RefuseNewer(const Database& database, const fs::path& directory) {
  const int version = VersionOf(database);
  if (version <= kRowVersion) return;
  throw InputError(fmt::format("{}: written by a newer dispersa: its {} has version {}, this one reads {}",
                               directory.string(), kDatabaseName, version, kRowVersion));
}

void CreateCases(Database& database, const std::string& table, const RowShape& shape) {
  database.Execute("CREATE TABLE " + table +
                   " (case_index INTEGER PRIMARY KEY, outcome TEXT NOT NULL, end_time_s REAL, end_stage "
                   "INTEGER NOT NULL, reason TEXT NOT NULL" +
                   CaseColumnList(shape, " REAL") + ", digest TEXT NOT NULL, row_digest BLOB NOT NULL)");
}

void CreateTables(Database& database, const Campaign& campaign) {
  const RowShape shape = ShapeOf(campaign);
  CreateCases(database, "cases", shape);
  database.Execute(
      fmt::format("CREATE TABLE {} (input TEXT PRIMARY KEY, value REAL) WITHOUT ROWID", kNominal));
  Statement constant = database.Prepare(fmt::format("INSERT INTO {} VALUES (?, ?)", kNominal));
  for (const std::size_t input : shape.inputs.constants())
    constant.Run(InputColumns()[input].name, shape.inputs.constant(input));
  std::string values;
  for (const char* name : kEventValueNames) values += fmt::format(", {} REAL", name);
  database.Execute(fmt::format(
      "CREATE TABLE {} (case_index INTEGER NOT NULL, place INTEGER NOT NULL, event TEXT NOT NULL{}, "
      "PRIMARY KEY (case_index, place)) WITHOUT ROWID",
      kEvents, values));
  database.Execute("CREATE TABLE quarantined (case_index INTEGER PRIMARY KEY, reason TEXT NOT NULL)");
  database.Execute("CREATE TABLE provenance (key TEXT PRIMARY KEY, value TEXT NOT NULL)");
  database.Execute(
      "CREATE TABLE execution (case_index INTEGER NOT NULL, worker TEXT NOT NULL, host TEXT NOT NULL, "
      "started_utc TEXT NOT NULL, seconds REAL)");
  database.Execute(
      "CREATE TABLE looks (requirements_id TEXT NOT NULL, requirement TEXT NOT NULL, n INTEGER NOT NULL, "
      "failures INTEGER NOT NULL, verdict TEXT NOT NULL, PRIMARY KEY (requirements_id, requirement, n))");
  database.Execute(
      "CREATE TABLE audits (case_index INTEGER NOT NULL, worker TEXT NOT NULL, PRIMARY KEY (case_index, "
      "worker))");
  database.Execute(fmt::format("PRAGMA user_version = {}", kRowVersion));
}

void WriteProvenance(Database& database, const char* key, const std::string& value) {
  database.Prepare("INSERT OR REPLACE INTO provenance VALUES (?, ?)").Run(key, value);
}

void WriteOwnMetrics(Database& database, const Campaign& campaign) {
  WriteProvenance(database, kOwnMetrics, OwnMetricLines(campaign.own_metrics));
}

/// `register_plan`: no case has been flown, so that the requirements and the number of cases are the plan.
void WriteProvenance(Database& database, const Campaign& campaign, bool register_plan) {
  const auto put = [&](const char* key, const std::string& value) { WriteProvenance(database, key, value); };
  put("schema", kSchema);
  put("campaign_id", campaign.id);
  put("flight_id", campaign.flight_id);
  put("engine", EngineVersion());
  put("name", campaign.name);
  put("seed", std::to_string(campaign.sampling.seed));
  put("cases", std::to_string(campaign.sampling.cases));
  put("sampling", SamplingMethodName(campaign.sampling.method));
  if (!register_plan) return;
  std::string lines;
  for (const Requirement& requirement : campaign.requirements) lines += RequirementLine(requirement) + "\n";
  put("planned_cases", std::to_string(campaign.sampling.cases));
  put("requirements_id", campaign.requirements_id);
  put("requirements", lines);
}

std::optional<Digest> ParseDigest(const std::string& hex) {
  Digest digest;
  if (hex.size() != 32) return std::nullopt;
  const char* text = hex.data();
  const auto high = std::from_chars(text, text + 16, digest.high, 16);
  const auto low = std::from_chars(text + 16, text + 32, digest.low, 16);
  if (high.ptr != text + 16 || low.ptr != text + 32) return std::nullopt;
  return digest;
}

/// The inputs that rows of this version know.
std::vector<double> InputsAsOf(const RowShape& shape, std::vector<double> all) {
  if (shape.version == kRowVersion) return all;
  std::size_t i = 0;
  std::erase_if(all, [&](double) { return InputColumns()[i++].number > LastInputOf(shape.version); });
  return all;
}

/// With the metrics that rows of this version know.
CaseResult AsOf(const RowShape& shape, CaseResult result) {
  const std::size_t of_vehicle = MetricCount(shape.list.stages());
  std::size_t i = 0;
  std::erase_if(result.metrics, [&](double) {
    const std::size_t metric = i++;
    return metric < of_vehicle && Metrics()[metric].since > shape.version;
  });
  return result;
}

/// Bytes, or in rows that hold all inputs their digits.
std::string RowDigestText(const CaseResult& result, const RowShape& shape) {
  const bool holds_all_inputs = shape.version < 3;
  const Digest digest = shape.version == kRowVersion ? Fingerprint(result)
                                                     : Fingerprint(AsOf(shape, result), !holds_all_inputs);
  if (holds_all_inputs) return digest.Hex();
  std::string bytes(sizeof digest.high + sizeof digest.low, '\0');
  std::memcpy(bytes.data(), &digest.high, sizeof digest.high);
  std::memcpy(bytes.data() + sizeof digest.high, &digest.low, sizeof digest.low);
  return bytes;
}

Digest RowDigestIn(const std::string& text) {
  Digest digest;
  if (text.size() != sizeof digest.high + sizeof digest.low) return ParseDigest(text).value_or(Digest{});
  std::memcpy(&digest.high, text.data(), sizeof digest.high);
  std::memcpy(&digest.low, text.data() + sizeof digest.high, sizeof digest.low);
  return digest;
}

/// None if the row is damaged.
std::optional<CaseResult> ReadRow(const Statement& row, const RowShape& shape, EventsBeside& events) {
  CaseResult result;
  result.case_index = static_cast<std::uint64_t>(row.Integer(0));
  result.end_time_s = row.Real(2);
  result.end_stage = static_cast<int>(row.Integer(3));
  result.reason = row.Text(4);
  int column = kFirstInput;
  result.inputs.reserve(shape.inputs.positions().size());
  for (std::size_t i = 0; i < shape.inputs.positions().size(); ++i)
    result.inputs.push_back(row.Real(column++));
  result.inputs_digest = InputsDigest(InputsAsOf(shape, shape.inputs.AllOf(result.inputs)));
  result.metrics.assign(shape.list.size(), kUndefined);
  for (const std::size_t i : shape.metrics) result.metrics[i] = row.Real(column++);
  const std::optional<Digest> digest = ParseDigest(row.Text(column));
  if (!ParseOutcome(row.Text(1), &result.outcome) || !digest) return std::nullopt;
  result.digest = *digest;
  result.events = events.Of(result.case_index);
  // Whatever a disk, a copy or an editor changed: no number of it reaches a table or a verdict.
  if (RowDigestText(result, shape) != row.Text(column + 1)) return std::nullopt;
  return result;
}

CaseResult ReadCase(const Statement& row, const RowShape& shape, EventsBeside& events,
                    const fs::path& directory) {
  if (auto result = ReadRow(row, shape, events)) return *std::move(result);
  throw ResultError(Kind::kFile, fmt::format("{}: the row of case {} is damaged; --resume flies it again",
                                             (directory / kDatabaseName).string(), row.Integer(0)));
}

/// What is stored of a result: of other metrics nothing.
CaseResult WithMetrics(CaseResult result, const Positions& metrics) {
  std::vector<double> kept(result.metrics.size(), kUndefined);
  for (const std::size_t i : metrics)
    if (i < kept.size()) kept[i] = result.metrics[i];
  result.metrics = std::move(kept);
  return result;
}

std::string InsertInto(const std::string& table, const RowShape& shape) {
  std::string parameters = "?, ?, ?, ?, ?, ?, ?";
  for (std::size_t i = 0; i < shape.inputs.positions().size() + shape.metrics.size(); ++i)
    parameters += ", ?";
  return "INSERT INTO " + table + " VALUES (" + parameters + ")";
}

/// One row. `insert` is InsertInto() of a table of this shape.
void InsertRow(Statement& insert, const CaseResult& result, const RowShape& shape) {
  insert.Reset();
  int parameter = 0;
  insert.BindInteger(++parameter, static_cast<std::int64_t>(result.case_index));
  insert.BindText(++parameter, OutcomeName(result.outcome));
  insert.BindReal(++parameter, result.end_time_s);
  insert.BindInteger(++parameter, result.end_stage);
  insert.BindText(++parameter, result.reason);
  for (const double value : result.inputs) insert.BindReal(++parameter, value);
  for (const std::size_t i : shape.metrics) insert.BindReal(++parameter, result.metrics[i]);
  insert.BindText(++parameter, result.digest.Hex());
  insert.BindBytes(++parameter, RowDigestText(result, shape));
  insert.Step();
}

void RequireSame(std::int64_t case_index, const std::string& stored, const std::string& arrived) {
  if (stored == arrived) return;
  throw ResultError(Kind::kConflict, fmt::format("case {} was flown twice with different digests: {} is "
                                                 "stored, {} arrived",
                                                 case_index, stored, arrived));
}

/// What a row does not hold stands once for all cases. So a flight that applied anything else is not stored.
void RequireFits(const CaseResult& result, const RowShape& shape) {
  const std::size_t inputs = shape.inputs.positions().size();
  if (result.inputs.size() != inputs || result.metrics.size() != shape.list.size()) {
    throw ResultError(Kind::kConflict,
                      fmt::format("case {} has {} inputs and {} metrics, a row of its campaign has {} and {}",
                                  result.case_index, result.inputs.size(), result.metrics.size(), inputs,
                                  shape.list.size()));
  }
  if (result.inputs_digest == InputsDigest(shape.inputs.AllOf(result.inputs))) return;
  throw ResultError(
      Kind::kConflict,
      fmt::format("case {}: its flight applied other constants than its campaign's", result.case_index));
}

/// The row of a case that was flown again goes, and who flew it before.
void TakeTheUnmeasured(Database& database, std::int64_t case_index, const std::string& digest) {
  Statement stored = database.Prepare(fmt::format("SELECT digest FROM {} WHERE case_index = ?", kUnmeasured));
  if (!stored.Run(case_index)) return;
  RequireSame(case_index, stored.Text(0), digest);
  for (const char* table : {kUnmeasured, "execution", "audits", kEvents})
    database.Prepare(fmt::format("DELETE FROM {} WHERE case_index = ?", table)).Run(case_index);
}

}  // namespace

ResultFolder::ResultFolder(fs::path directory, std::unique_ptr<Database> database)
    : directory_(std::move(directory)), database_(std::move(database)) {
  ReadColumnsOfTable();
}

void ResultFolder::ReadColumnsOfTable() {
  own_metrics_ = OwnMetricsOf(*database_);
  std::vector<std::string> names;
  for (const OwnMetric& metric : own_metrics_) names.push_back(metric.name);
  ReadStoredInputs(*database_, directory_, shape_);
  shape_.list = MetricList(shape_.inputs.column_class(), std::move(names));
  shape_.version = VersionOf(*database_);
  shape_.metrics = StoredMetrics(*database_, shape_.list, shape_.version);
  has_unmeasured_ = HasTable(*database_, kUnmeasured);
}

ResultFolder::ResultFolder(ResultFolder&&) noexcept = default;
ResultFolder& ResultFolder::operator=(ResultFolder&&) noexcept = default;
ResultFolder::~ResultFolder() = default;

ResultFolder ResultFolder::Create(const fs::path& directory, const Campaign& campaign,
                                  std::optional<FolderLock> lock, std::optional<CaseShare> share) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) FailFolder(directory.string(), error);
  if (!lock) lock.emplace(directory);
  const bool empty = fs::is_empty(directory, error);
  if (error) FailFolder(directory.string(), error);
  if (!empty) {
    throw InputError(fmt::format("{}: the folder is not empty", directory.string()),
                     "a new or an empty folder, or --resume to continue a campaign of the same flight id");
  }
  try {
    WriteFile(directory / kCampaignName, campaign.canonical_yaml);
  } catch (const ResultError& unwritable) {
    // The first file in the folder: that it cannot be written is the user's choice of folder.
    if (unwritable.kind() == Kind::kFile) throw InputError(unwritable.what(), "a folder that can be written");
    throw;
  }
  // Whoever finds the database finds it whole: a start that is killed leaves none.
  const fs::path database = directory / kDatabaseName;
  const fs::path temporary = database.string() + ".tmp";
  {
    Database fresh(temporary, Database::Mode::kCreate);
    Transaction transaction(fresh);
    CreateTables(fresh, campaign);
    WriteProvenance(fresh, campaign, true);
    WriteOwnMetrics(fresh, campaign);
    if (share)
      WriteProvenance(fresh, kShareKey,
                      fmt::format("{} {} {}", share->cases.first, share->cases.end, share->round_end));
    transaction.Commit();
  }
  fs::rename(temporary, database, error);
  if (error) FailFolder(database.string(), error);
  ResultFolder folder(directory, std::make_unique<Database>(database, Database::Mode::kExisting));
  folder.lock_ = std::move(lock);
  return folder;
}

ResultFolder ResultFolder::Open(const fs::path& directory) {
  auto database = OpenResultDatabase(directory);
  RefuseNewer(*database, directory);
  ResultFolder folder(directory, std::move(database));
  std::string schema;
  try {
    schema = folder.Provenance("schema");
    folder.database_->Prepare(SelectCases(folder.shape_));
  } catch (const ResultError& unreadable) {
    if (schema != kSchema) {
      throw InputError(fmt::format("{}: not a result folder: {}", directory.string(), unreadable.what()));
    }
    throw InputError(
        fmt::format("{}: flown by engine {}; its inputs and metrics are not those of this engine, {}",
                    directory.string(), folder.Provenance("engine"), EngineVersion()));
  }
  return folder;
}

ResultFolder ResultFolder::Resume(const fs::path& directory, const Campaign& campaign,
                                  std::optional<FolderLock> lock) {
  ResultFolder folder = Open(directory);
  folder.lock_ = std::move(lock);
  folder.Lock();
  const std::string flight_id = folder.Provenance("flight_id");
  if (flight_id != campaign.flight_id) {
    throw InputError(fmt::format("{}: holds results of flight id {}, the campaign's is {}",
                                 directory.string(), flight_id, campaign.flight_id));
  }
  const std::string engine = folder.Provenance("engine");
  if (engine != EngineVersion()) {
    throw InputError(fmt::format("{}: holds results of engine {}, this one is {}", directory.string(), engine,
                                 EngineVersion()));
  }
  const std::optional<std::uint64_t> last = folder.LastCase();
  if (last && *last >= campaign.sampling.cases) {
    throw InputError(fmt::format("{}: already holds case {}, the campaign has only {} cases",
                                 directory.string(), *last, campaign.sampling.cases));
  }
  WriteFile(directory / kCampaignName, campaign.canonical_yaml);
  Transaction transaction(*folder.database_);
  folder.damaged_ = folder.DamagedRows();
  folder.Remove(folder.damaged_);
  folder.MeasureOwn(campaign);
  WriteProvenance(*folder.database_, campaign, !last);
  transaction.Commit();
  return folder;
}

void ResultFolder::Lock() {
  if (!lock_) lock_.emplace(directory_);
}

// The table `cases` becomes one with the campaign's own metrics. Rows that have all of them stay. All others
// wait in a table of their own, without any, until their flights are repeated.
void ResultFolder::MeasureOwn(const Campaign& campaign) {
  if (OwnMetricLines(own_metrics_) == OwnMetricLines(campaign.own_metrics)) return;
  const std::optional<Positions> places = FindOwn(campaign.own_metrics, own_metrics_);
  const RowShape then = shape_;
  const std::size_t of_vehicle = MetricCount(then.list.stages());
  database_->Execute("ALTER TABLE cases RENAME TO cases_then");
  CreateCases(*database_, "cases", ShapeOf(campaign));
  if (!places && !has_unmeasured_) CreateCases(*database_, kUnmeasured, OfVehicle(then));
  {
    const RowShape to = places ? ShapeOf(campaign) : OfVehicle(then);
    Statement select = database_->Prepare(SelectCases(then, "cases_then") + kInOrder);
    EventsBeside events(*database_, then);
    Statement insert = database_->Prepare(InsertInto(places ? "cases" : kUnmeasured, to));
    while (select.Step()) {
      CaseResult result = ReadCase(select, then, events, directory_);
      std::vector<double> own;
      for (const std::size_t place : places.value_or(Positions()))
        own.push_back(result.metrics[of_vehicle + place]);
      result.metrics.resize(of_vehicle);
      result.metrics.insert(result.metrics.end(), own.begin(), own.end());
      InsertRow(insert, result, to);
    }
  }
  database_->Execute("DROP TABLE cases_then");
  if (has_unmeasured_ && campaign.own_metrics.empty()) {
    database_->Execute(fmt::format("INSERT INTO cases SELECT * FROM {}", kUnmeasured));
    database_->Execute(fmt::format("DROP TABLE {}", kUnmeasured));
  }
  WriteOwnMetrics(*database_, campaign);
  ReadColumnsOfTable();
}

std::vector<std::uint64_t> ResultFolder::DamagedRows() const {
  std::vector<std::uint64_t> damaged;
  Statement select = database_->Prepare(SelectCases(shape_) + kInOrder);
  EventsBeside events(*database_, shape_);
  while (select.Step())
    if (!ReadRow(select, shape_, events)) damaged.push_back(static_cast<std::uint64_t>(select.Integer(0)));
  return damaged;
}

void ResultFolder::Remove(const std::vector<std::uint64_t>& cases) {
  for (const char* table : {"cases", "execution", kEvents, kUnmeasured}) {
    if (table == kUnmeasured && !has_unmeasured_) continue;
    Statement remove = database_->Prepare(fmt::format("DELETE FROM {} WHERE case_index = ?", table));
    for (const std::uint64_t case_index : cases) remove.Run(case_index);
  }
}

std::string ResultFolder::Provenance(const std::string& key) const {
  Statement select = database_->Prepare("SELECT value FROM provenance WHERE key = ?");
  if (!select.Run(key)) {
    throw ResultError(Kind::kFile,
                      fmt::format("{}: no {} in the provenance", (directory_ / kDatabaseName).string(), key));
  }
  return select.Text(0);
}

void ResultFolder::RecordLook(const LookRecord& look) const {
  database_->Prepare("INSERT OR REPLACE INTO looks VALUES (?, ?, ?, ?, ?)")
      .Run(look.requirements_id, look.requirement, look.n, look.failures, look.verdict);
}

void ResultFolder::TakePlanOf(const ResultFolder& from, const Campaign& campaign) {
  for (const LookRecord& look : from.Looks()) RecordLook(look);
  if (from.Provenance("requirements_id") == campaign.requirements_id &&
      from.PlannedCases() == static_cast<std::int64_t>(campaign.sampling.cases))
    return;
  for (const char* key : {"planned_cases", "requirements_id", "requirements"})
    WriteProvenance(*database_, key, from.Provenance(key));
}

std::vector<LookRecord> ResultFolder::Looks() const {
  std::vector<LookRecord> looks;
  Statement select =
      database_->Prepare("SELECT requirements_id, requirement, n, failures, verdict FROM looks ORDER BY n");
  while (select.Step())
    looks.push_back({select.Text(0), select.Text(1), select.Integer(2), select.Integer(3), select.Text(4)});
  return looks;
}

std::int64_t ResultFolder::PlannedCases() const { return std::stoll(Provenance("planned_cases")); }

std::optional<CaseShare> ResultFolder::ItsShare() const {
  Statement select = database_->Prepare("SELECT value FROM provenance WHERE key = ?");
  if (!select.Run(kShareKey)) return std::nullopt;
  CaseShare share;
  std::istringstream(select.Text(0)) >> share.cases.first >> share.cases.end >> share.round_end;
  return share;
}

std::vector<std::int64_t> ResultFolder::PastLooks() const {
  std::vector<std::int64_t> looks;
  Statement select = database_->Prepare("SELECT DISTINCT n FROM looks ORDER BY n");
  while (select.Step()) looks.push_back(select.Integer(0));
  return looks;
}

std::size_t ResultFolder::Append(std::span<const CaseResult> results) {
  Transaction transaction(*database_);
  const std::size_t added = Insert(results);
  transaction.Commit();
  return added;
}

void ResultFolder::Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) {
  Transaction transaction(*database_);
  Insert(results);
  Insert(records);
  transaction.Commit();
}

std::size_t ResultFolder::Insert(std::span<const CaseResult> results) {
  Statement stored = database_->Prepare("SELECT digest FROM cases WHERE case_index = ?");
  Statement insert = database_->Prepare(InsertInto("cases", shape_));
  Statement event =
      database_->Prepare(fmt::format("INSERT INTO {} VALUES (?, ?, ?, ?, ?, ?, ?, ?)", kEvents));
  Statement lift = database_->Prepare("DELETE FROM quarantined WHERE case_index = ?");
  std::size_t added = 0;
  // In order, so that fewer pages are split.
  std::vector<const CaseResult*> ordered;
  for (const CaseResult& flown : results) ordered.push_back(&flown);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const CaseResult* a, const CaseResult* b) { return a->case_index < b->case_index; });
  for (const CaseResult* flown : ordered) {
    const auto index = static_cast<std::int64_t>(flown->case_index);
    const CaseResult result = WithMetrics(*flown, shape_.metrics);
    if (stored.Run(index)) {
      RequireSame(index, stored.Text(0), result.digest.Hex());
      continue;
    }
    RequireFits(result, shape_);
    if (has_unmeasured_) TakeTheUnmeasured(*database_, index, result.digest.Hex());
    InsertRow(insert, result, shape_);
    std::int64_t place = 0;
    for (const SeenEvent& seen : result.events)
      event.Run(index, place++, seen.name, seen.time_s, seen.altitude_m, seen.speed_m_s, seen.qbar_pa,
                seen.mass_kg);
    lift.Run(index);
    ++added;
  }
  return added;
}

void ResultFolder::Insert(std::span<const ExecutionRecord> records) {
  Statement insert = database_->Prepare("INSERT INTO execution VALUES (?, ?, ?, ?, ?)");
  for (const ExecutionRecord& record : records)
    insert.Run(record.case_index, record.worker, record.host, record.started_utc, record.seconds);
}

void ResultFolder::Quarantine(const QuarantinedCase& quarantined) {
  database_->Prepare("INSERT OR REPLACE INTO quarantined VALUES (?, ?)")
      .Run(quarantined.case_index, quarantined.reason);
}

std::uint64_t ResultFolder::CaseCount() const { return database_->Count("cases"); }

std::vector<std::uint64_t> ResultFolder::PresentCases() const {
  std::vector<std::uint64_t> present;
  Statement select = database_->Prepare("SELECT case_index FROM cases ORDER BY case_index");
  while (select.Step()) present.push_back(static_cast<std::uint64_t>(select.Integer(0)));
  return present;
}

std::optional<std::uint64_t> ResultFolder::LastCase() const {
  std::optional<std::uint64_t> last;
  for (const char* table : {"cases", kUnmeasured}) {
    if (table == kUnmeasured && !has_unmeasured_) continue;
    Statement select =
        database_->Prepare(fmt::format("SELECT case_index FROM {} ORDER BY case_index DESC LIMIT 1", table));
    if (select.Step()) last = std::max(last.value_or(0), static_cast<std::uint64_t>(select.Integer(0)));
  }
  return last;
}

std::uint64_t ResultFolder::UnmeasuredCount() const {
  return has_unmeasured_ ? database_->Count(kUnmeasured) : 0;
}

std::vector<std::pair<std::uint64_t, Digest>> ResultFolder::Fingerprints() const {
  std::vector<std::pair<std::uint64_t, Digest>> present;
  Statement select = database_->Prepare("SELECT case_index, row_digest FROM cases ORDER BY case_index");
  while (select.Step()) {
    present.emplace_back(static_cast<std::uint64_t>(select.Integer(0)), RowDigestIn(select.Text(1)));
  }
  return present;
}

std::optional<std::string> ResultFolder::WorkerOf(std::uint64_t case_index) const {
  Statement select =
      database_->Prepare("SELECT worker FROM execution WHERE case_index = ? ORDER BY rowid DESC");
  return select.Run(case_index) ? std::optional(select.Text(0)) : std::nullopt;
}

void ResultFolder::ForEachFlier(
    const std::function<void(const std::string&, const std::string&, std::uint64_t)>& callback) const {
  Statement select = database_->Prepare("SELECT worker, host, case_index FROM execution");
  while (select.Step())
    callback(select.Text(0), select.Text(1), static_cast<std::uint64_t>(select.Integer(2)));
}

void ResultFolder::AppendAudits(std::span<const Claim> claims) {
  Transaction transaction(*database_);
  Statement insert = database_->Prepare("INSERT OR IGNORE INTO audits VALUES (?, ?)");
  for (const Claim& claim : claims) insert.Run(claim.case_index, claim.worker);
  transaction.Commit();
}

void ResultFolder::ForEachUnaudited(const std::function<void(const Claim&)>& callback) const {
  Statement select = database_->Prepare(
      "SELECT e.worker, c.case_index, c.row_digest, e.host FROM execution e JOIN cases c USING (case_index) "
      "LEFT JOIN audits a USING (case_index, worker) WHERE a.worker IS NULL");
  while (select.Step()) {
    callback({select.Text(0), static_cast<std::uint64_t>(select.Integer(1)), RowDigestIn(select.Text(2)),
              false, select.Text(3)});
  }
}

std::vector<std::uint64_t> ResultFolder::Disown(const std::string& worker) {
  Transaction transaction(*database_);
  std::vector<std::uint64_t> cases;
  {
    Statement select = database_->Prepare("SELECT DISTINCT case_index, worker, host FROM execution");
    while (select.Step()) {
      if (IsMeantBy(worker, select.Text(1), select.Text(2)))
        cases.push_back(static_cast<std::uint64_t>(select.Integer(0)));
    }
  }
  std::sort(cases.begin(), cases.end());
  cases.erase(std::unique(cases.begin(), cases.end()), cases.end());
  Remove(cases);
  transaction.Commit();
  return cases;
}

std::vector<QuarantinedCase> ResultFolder::QuarantinedCases() const {
  std::vector<QuarantinedCase> quarantined;
  Statement select = database_->Prepare("SELECT case_index, reason FROM quarantined ORDER BY case_index");
  while (select.Step())
    quarantined.push_back({static_cast<std::uint64_t>(select.Integer(0)), select.Text(1)});
  return quarantined;
}

bool ResultFolder::Contains(std::uint64_t case_index) const {
  Statement select = database_->Prepare("SELECT 1 FROM cases WHERE case_index = ?");
  return select.Run(case_index);
}

CaseResult ResultFolder::Load(std::uint64_t case_index) const {
  Statement select = database_->Prepare(SelectCases(shape_) + " WHERE case_index = ?");
  if (!select.Run(case_index)) {
    throw InputError(fmt::format("{}: has no result of case {}", directory_.string(), case_index));
  }
  EventsBeside events(*database_, shape_, case_index);
  return ReadCase(select, shape_, events, directory_);
}

void ResultFolder::ForEach(const std::function<void(const CaseResult&)>& callback) const {
  Statement select = database_->Prepare(SelectCases(shape_) + kInOrder);
  EventsBeside events(*database_, shape_);
  while (select.Step()) callback(ReadCase(select, shape_, events, directory_));
}

}  // namespace dispersa
