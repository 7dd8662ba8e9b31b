#include "core/results/attempt_ledger.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/flight/engine_version.h"
#include "core/results/output_file.h"
#include "core/results/requirement_text.h"
#include "core/results/result_error.h"

namespace dispersa {
namespace {

using AttemptJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

const char* PlanWord(const VerdictPlan& plan) {
  if (plan.kind == PlanKind::kAnytime) return "anytime";
  return plan.spending == Spending::kPocock ? "pocock" : "obrien_fleming";
}

VerdictPlan PlanOf(const AttemptJson& json) {
  VerdictPlan plan;
  plan.looks = std::clamp<std::int64_t>(json.at("looks").get<std::int64_t>(), 1, 1000);
  plan.kind = json.at("plan") == "anytime" ? PlanKind::kAnytime
              : plan.looks > 1             ? PlanKind::kGroupSequential
                                           : PlanKind::kFixed;
  plan.spending = json.at("plan") == "pocock" ? Spending::kPocock : Spending::kOBrienFleming;
  return plan;
}

AttemptJson ToJson(const AttemptRecord& record) {
  AttemptJson json = {{"schema", "dispersa/attempt/1"},
                      {"id", record.id},
                      {"design_id", record.design_id},
                      {"name", record.name},
                      {"engine", record.engine},
                      {"seed", record.seed},
                      {"planned", record.planned},
                      {"cases", record.cases},
                      {"begun_utc", record.begun_utc},
                      {"fresh", record.fresh},
                      {"verdict", record.verdict},
                      {"earlier_designs", record.earlier_designs},
                      {"earlier_designs_of_seed", record.earlier_designs_of_seed},
                      {"requirements", AttemptJson::array()}};
  for (const RequirementRecord& one : record.requirements)
    json["requirements"].push_back({{"limit", one.limit},
                                    {"line", one.line},
                                    {"probability", one.probability},
                                    {"consumer_risk", one.consumer_risk},
                                    {"looks", one.plan.looks},
                                    {"plan", PlanWord(one.plan)},
                                    {"failures", one.failures},
                                    {"verdict", one.verdict}});
  return json;
}

AttemptRecord ToRecord(const AttemptJson& json) {
  AttemptRecord record;
  record.id = json.at("id");
  record.design_id = json.at("design_id");
  record.name = json.at("name");
  record.engine = json.at("engine");
  record.seed = json.at("seed");
  record.planned = json.at("planned");
  record.cases = json.at("cases");
  record.begun_utc = json.at("begun_utc");
  record.fresh = json.at("fresh");
  record.verdict = json.at("verdict");
  record.earlier_designs = json.at("earlier_designs");
  record.earlier_designs_of_seed = json.at("earlier_designs_of_seed");
  for (const AttemptJson& one : json.at("requirements")) {
    // Earlier engines required the vehicle's limits by themselves. Now they are a check, and no requirement.
    if (one.value("by_default", false)) continue;
    record.requirements.push_back({one.at("limit"), one.at("line"), one.at("probability"),
                                   one.at("consumer_risk"), PlanOf(one), one.at("failures"),
                                   one.at("verdict")});
  }
  return record;
}

/// In a folder where everybody may make files, such as /tmp, a file of another user tells of other flights,
/// or lies.
void RefuseNeighbours(const fs::path& file) {
  struct stat ledger {
  }, folder{};
  const fs::path parent = file.has_parent_path() ? file.parent_path() : ".";
  if (lstat(file.c_str(), &ledger) != 0 || stat(parent.c_str(), &folder) != 0) return;
  if (ledger.st_uid == geteuid() || (folder.st_mode & S_IWOTH) == 0) return;
  throw ResultError(
      ResultError::Kind::kFile,
      fmt::format("{}: belongs to another user (number {}), and everybody may write its folder, allowed: "
                  "a result folder in a folder of your own",
                  file.string(), ledger.st_uid));
}

template <typename Action>
std::optional<std::string> ReasonOf(Action action) {
  try {
    action();
  } catch (const ResultError& error) {
    if (error.kind() == ResultError::Kind::kDiskFull) throw;
    return error.what();
  }
  return std::nullopt;
}

}  // namespace

AttemptRecord RecordOf(const Campaign& campaign) {
  AttemptRecord record;
  record.id = campaign.id;
  record.design_id = campaign.design_id;
  record.name = campaign.name;
  record.engine = EngineVersion();
  record.seed = campaign.sampling.seed;
  record.planned = static_cast<std::int64_t>(campaign.sampling.cases);
  for (const Requirement& requirement : campaign.requirements)
    record.requirements.push_back({LimitText(requirement), RequirementLine(requirement),
                                   requirement.probability, requirement.consumer_risk, requirement.plan, 0,
                                   ""});
  return record;
}

std::vector<AttemptRecord> AttemptLedger::Read() const {
  RefuseNeighbours(file_);
  std::istringstream stream(ReadLines(file_));
  std::vector<AttemptRecord> records;
  for (std::string line; std::getline(stream, line);) {
    try {
      AttemptRecord record = ToRecord(AttemptJson::parse(line));
      const auto same = std::find_if(records.begin(), records.end(),
                                     [&](const AttemptRecord& other) { return other.id == record.id; });
      if (same == records.end())
        records.push_back(std::move(record));
      else
        *same = std::move(record);
    } catch (const nlohmann::json::exception&) {
      continue;  // of a process that was killed while it wrote
    }
  }
  return records;
}

void AttemptLedger::Write(const AttemptRecord& record) const {
  RefuseNeighbours(file_);
  AppendLine(file_, ToJson(record).dump());
}

std::optional<std::string> BeginAttempt(const fs::path& root, const fs::path& results,
                                        const Campaign& campaign, const std::string& begun_utc,
                                        const std::string& fresh) {
  const AttemptLedger here(results / kFolderLedgerName);
  const AttemptLedger all(root / kLedgerName);
  std::vector<AttemptRecord> known;
  AttemptRecord own = RecordOf(campaign);
  own.begun_utc = begun_utc;
  own.fresh = fresh;
  const auto begin_in_root = [&] {
    known = all.Read();
    const auto same =
        std::find_if(known.begin(), known.end(), [&](const AttemptRecord& one) { return one.id == own.id; });
    if (same != known.end()) {
      const std::string reason = fresh.empty() ? same->fresh : fresh;
      own = *same;
      own.fresh = reason;
      known.erase(same, known.end());
    } else {
      std::vector<std::string> designs, of_seed;
      for (const AttemptRecord& one : known) {
        if (one.design_id == own.design_id) continue;
        designs.push_back(one.design_id);
        if (one.seed == own.seed) of_seed.push_back(one.design_id);
      }
      for (auto [list, count] :
           {std::pair{&designs, &own.earlier_designs}, std::pair{&of_seed, &own.earlier_designs_of_seed}}) {
        std::sort(list->begin(), list->end());
        *count = std::unique(list->begin(), list->end()) - list->begin();
      }
      all.Write(own);
    }
  };
  std::optional<std::string> problem = ReasonOf(begin_in_root);
  const std::vector<AttemptRecord> kept = here.Read();
  const auto is_kept = [&](const AttemptRecord& one) {
    return std::any_of(kept.begin(), kept.end(),
                       [&](const AttemptRecord& other) { return other.id == one.id; });
  };
  for (const AttemptRecord& one : known)
    if (one.design_id == own.design_id && !is_kept(one)) here.Write(one);
  if (!is_kept(own)) here.Write(own);
  return problem;
}

std::optional<std::string> NoteAttempt(const fs::path& root, const fs::path& results,
                                       const AttemptRecord& record) {
  AttemptLedger(results / kFolderLedgerName).Write(record);
  return ReasonOf([&] { AttemptLedger(root / kLedgerName).Write(record); });
}

}  // namespace dispersa
