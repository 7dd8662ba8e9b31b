#include "core/analysis/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/analysis/campaign_summary.h"
#include "core/flight/engine_version.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"
#include "core/results/requirement_text.h"
#include "core/results/text.h"
#include "core/statistics/attempts.h"

namespace dispersa {
namespace {

using StandingJson = nlohmann::ordered_json;

/// What was required of these cases before the first of them was flown.
struct Registered {
  std::vector<std::pair<std::string, std::string>> lines;  ///< RequirementLine() and the verdict that it had
  bool is_known = false;
  bool is_judged_otherwise = false;  ///< the same requirements, but verdicts' rules differ
};

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool Holds(const std::vector<std::pair<std::string, std::string>>& lines, const std::string& line) {
  return std::any_of(lines.begin(), lines.end(), [&](const auto& one) { return one.first == line; });
}

bool IsRequired(const Campaign& campaign, const std::string& line) {
  return std::any_of(campaign.requirements.begin(), campaign.requirements.end(),
                     [&](const Requirement& requirement) { return RequirementLine(requirement) == line; });
}

/// Earlier attempts that count: from the last one on that started anew.
std::vector<AttemptRecord> Counted(std::vector<AttemptRecord> earlier) {
  const auto fresh = std::find_if(earlier.rbegin(), earlier.rend(),
                                  [](const AttemptRecord& record) { return !record.fresh.empty(); });
  if (fresh != earlier.rend()) earlier.erase(earlier.begin(), fresh.base() - 1);
  return earlier;
}

Registered RegisteredIn(const ResultFolder& folder, const Campaign& campaign,
                        const std::vector<LookRecord>& looks, const std::vector<AttemptRecord>& earlier) {
  Registered registered;
  const std::string id = folder.Provenance("requirements_id");
  for (const std::string& line : LinesOf(folder.Provenance("requirements"))) {
    std::string verdict;
    for (const LookRecord& look : looks)
      if (look.requirement == line) verdict = look.verdict;
    registered.lines.emplace_back(line, verdict);
  }
  registered.is_known = true;
  const auto is_required = [&](const auto& one) { return IsRequired(campaign, one.first); };
  // Earlier engines required the vehicle's limits by themselves. Where the file requires what it did then,
  // such a line is the only one that it does not give.
  if (id == campaign.requirements_id) std::erase_if(registered.lines, std::not_fn(is_required));
  const bool same = registered.lines.size() == campaign.requirements.size() &&
                    std::all_of(registered.lines.begin(), registered.lines.end(), is_required);
  registered.is_judged_otherwise = same && id != campaign.requirements_id;
  if (!same || registered.is_judged_otherwise) return registered;
  // The folder is as it began: were its cases flown before, under other requirements?
  const auto first = std::find_if(earlier.begin(), earlier.end(), [&](const AttemptRecord& record) {
    return record.seed == campaign.sampling.seed && record.cases > 0;
  });
  if (first == earlier.end()) return registered;
  registered.lines.clear();
  for (const RequirementRecord& one : first->requirements)
    registered.lines.emplace_back(one.line, one.verdict);
  return registered;
}

/// The attempts as one requirement sees them, the campaign's own last.
std::vector<Attempt> AttemptsAt(const Requirement& requirement, const RequirementSummary& shown,
                                const CampaignSummary& summary, const std::vector<LookRecord>& looks,
                                std::int64_t planned_first, const std::vector<AttemptRecord>& earlier) {
  std::vector<Attempt> attempts;
  const std::string limit = LimitText(requirement);
  for (const AttemptRecord& record : earlier) {
    for (const RequirementRecord& one : record.requirements) {
      if (one.limit != limit) continue;
      const bool as_strict =
          one.probability >= requirement.probability && one.consumer_risk <= requirement.consumer_risk;
      attempts.push_back({record.seed, record.planned, record.cases, one.failures, one.plan,
                          as_strict && one.verdict == "pass", record.engine == summary.engine});
      break;
    }
  }
  const Attempt own = {summary.seed,
                       static_cast<std::int64_t>(summary.max_cases),
                       static_cast<std::int64_t>(summary.cases),
                       shown.failures + static_cast<std::int64_t>(summary.cases) - shown.n,
                       requirement.plan,
                       shown.verdict == "pass"};
  // Of this folder, before its number of cases was changed: known without a ledger, too.
  if (own.planned != planned_first) {
    std::map<std::int64_t, Attempt> here;
    here[planned_first] = {own.seed, planned_first, std::min(planned_first, own.cases), 0, requirement.plan};
    for (const LookRecord& look : looks)
      if (look.requirement == RequirementLine(requirement) && look.n < own.cases)
        here[look.n] = {own.seed, look.n, look.n, look.failures, requirement.plan, look.verdict == "pass"};
    for (const auto& [planned, attempt] : here)
      if (std::none_of(attempts.begin(), attempts.end(), [&](const Attempt& other) {
            return other.seed == own.seed && other.planned == attempt.planned;
          }))
        attempts.push_back(attempt);
  }
  std::erase_if(attempts, [&](const Attempt& attempt) {
    return attempt.seed == own.seed && attempt.planned == own.planned;
  });
  attempts.push_back(own);
  return attempts;
}

std::string FlightsText(std::int64_t count) {
  return fmt::format("{} flight{}", count, count == 1 ? "" : "s");
}

std::string SpentReason(const RequirementSummary& shown, const AttemptsVerdict& verdict) {
  std::string text = fmt::format(
      "Earlier campaigns of this design have used up the risk of {}. All {} together show {} "
      "failure{}",
      PercentText(shown.consumer_risk), FlightsText(verdict.pool_cases), verdict.pool_failures,
      verdict.pool_failures == 1 ? "" : "s");
  if (!verdict.pool_needed) return text + "; no number of flights can decide.";
  return text + fmt::format("; under the any-time rule {} flights with no further failure would decide.",
                            *verdict.pool_needed);
}

std::string TogetherReason(const AttemptsVerdict& verdict) {
  return fmt::format("All attempts together decide: {} show {} failure{}.", FlightsText(verdict.pool_cases),
                     verdict.pool_failures, verdict.pool_failures == 1 ? "" : "s");
}

std::string SeenReason(const std::vector<Attempt>& attempts, const AttemptsVerdict& verdict) {
  const bool of_one_seed = std::all_of(attempts.begin(), attempts.end(), [&](const Attempt& attempt) {
    return attempt.seed == attempts.back().seed;
  });
  return fmt::format("{}; the stricter any-time rule now applies: {} flights with {} failure{} are needed.",
                     of_one_seed ? "Flights were added after results had been seen"
                                 : "Earlier attempts with other seeds count too",
                     verdict.pool_needed.value_or(0), verdict.pool_failures,
                     verdict.pool_failures == 1 ? "" : "s");
}

void Judge(const Requirement& requirement, const RequirementSummary& shown, const CampaignSummary& summary,
           const std::vector<Attempt>& attempts, std::uint64_t reserved, Standing::Requirement& standing) {
  if (!IsIndependent(summary.sampling)) {
    standing.verdict = shown.failures > 0 ? "fail" : requirement.every_case ? "pass" : "not_evidence";
    if (standing.verdict == "not_evidence")
      standing.reason =
          "The points of a design study are chosen, so they show no probability; require every_case: true.";
    return;
  }
  standing.verdict = shown.verdict.empty() ? "inconclusive" : shown.verdict;
  if (shown.n == 0 || standing.verdict == "not_evidence") return;
  const AttemptsVerdict verdict =
      JudgeAttempts(requirement.probability, requirement.consumer_risk, reserved, attempts);
  standing.pool_cases = verdict.pool_cases;
  standing.pool_failures = verdict.pool_failures;
  if (standing.verdict == "fail") return;
  if (standing.verdict == "pass") {
    if (verdict.passed && !verdict.by_plan && verdict.pool_cases > shown.n)
      standing.reason = TogetherReason(verdict);  // the plan's risk is spent
    else if (!verdict.passed && verdict.passed_before)
      standing.reason = "An earlier attempt at this design passed, and that stands.";
    if (verdict.passed || verdict.passed_before) return;
    standing.verdict = verdict.is_spent ? "not_evidence" : "inconclusive";
    standing.reason =
        verdict.is_spent ? SpentReason(shown, verdict)
        : reserved > 1 && attempts.size() == 1
            ? fmt::format("{} attempts share the risk of {}: this one has {}.", reserved,
                          PercentText(requirement.consumer_risk),
                          PercentText(requirement.consumer_risk / static_cast<double>(reserved)))
            : SeenReason(attempts, verdict);
    return;
  }
  if (verdict.passed && !shown.contradicted) {
    standing.verdict = "pass";
    standing.reason = TogetherReason(verdict);
  } else if (attempts.size() > 1 && verdict.pool_needed) {
    standing.reason = SeenReason(attempts, verdict);
  }
}

StandingVerdict Together(const CampaignSummary& summary, const Standing& standing) {
  if (summary.verdict == CampaignVerdict::kIncomplete) return StandingVerdict::kIncomplete;
  bool open = false, not_evidence = standing.is_post_hoc;
  for (const LoadCheck& check : summary.load_checks)
    if (check.failures > 0) return StandingVerdict::kFail;
  for (const Standing::Requirement& one : standing.requirements) {
    if (one.verdict == "fail") return StandingVerdict::kFail;
    open = open || one.verdict == "inconclusive";
    not_evidence = not_evidence || one.verdict == "not_evidence";
  }
  if (not_evidence) return StandingVerdict::kNotEvidence;
  if (open) return StandingVerdict::kInconclusive;
  return standing.requirements.empty() ? StandingVerdict::kNothingJudged : StandingVerdict::kPass;
}

StandingJson ExecutionOf(const ResultFolder& folder) {
  std::ifstream stream(folder.directory() / "execution.json");
  StandingJson json = StandingJson::parse(stream, nullptr, false);
  return json.is_object() ? json : StandingJson::object();
}

RunInfo RunOf(const ResultFolder& folder) {
  const StandingJson json = ExecutionOf(folder);
  const auto text = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  RunInfo run{text("started_utc"), text("user"), text("host"), text("vehicle_file"), 0.0};
  if (const auto found = json.find("flying_s"); found != json.end() && found->is_number())
    run.flying_s = found->get<double>();
  return run;
}

std::string AttemptsNote(const Standing& standing) {
  if (standing.attempts.size() < 2) return "";
  constexpr std::size_t kNamed = 5;
  const std::size_t earlier = standing.attempts.size() - 1;
  std::string list = earlier > kNamed ? fmt::format("{} more", earlier - kNamed) : "";
  for (std::size_t i = earlier > kNamed ? earlier - kNamed : 0; i < earlier; ++i) {
    const Standing::AttemptLine& one = standing.attempts[i];
    std::string verdict = one.verdict.empty() ? "not ended" : one.verdict;
    std::replace(verdict.begin(), verdict.end(), '_', ' ');
    list += fmt::format("{}seed {}, {}: {}{}", list.empty() ? "" : "; ", one.seed, FlightsText(one.cases),
                        verdict, one.is_evidence ? "" : " (flown by another engine: no evidence)");
  }
  return fmt::format("Attempt {} at this design. Earlier ones here: {}.", standing.attempts.size(), list);
}

}  // namespace

const char* StandingVerdictName(StandingVerdict verdict) {
  switch (verdict) {
    case StandingVerdict::kPass:
      return "pass";
    case StandingVerdict::kNothingJudged:
      return "nothing_judged";
    case StandingVerdict::kInconclusive:
      return "inconclusive";
    case StandingVerdict::kNotEvidence:
      return "not_evidence";
    case StandingVerdict::kFail:
      return "fail";
    case StandingVerdict::kIncomplete:
      return "incomplete";
  }
  return "";
}

std::string StandingBadge(const Standing& standing) {
  if (standing.verdict == StandingVerdict::kNotEvidence && standing.is_post_hoc) return "post hoc";
  std::string name = StandingVerdictName(standing.verdict);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Standing StandingOf(const ResultFolder& folder, const Campaign& campaign, const CampaignSummary& summary) {
  Standing standing;
  standing.run = RunOf(folder);
  std::vector<AttemptRecord> all = AttemptLedger(folder.directory() / kFolderLedgerName).Read();
  const auto own =
      std::find_if(all.begin(), all.end(), [&](const AttemptRecord& one) { return one.id == campaign.id; });
  if (own != all.end()) {
    standing.fresh = own->fresh;
    standing.earlier_designs = own->earlier_designs;
    standing.earlier_designs_of_seed = own->earlier_designs_of_seed;
  }
  std::vector<AttemptRecord> earlier;
  for (auto one = all.begin(); one != own; ++one)
    if (one->design_id == campaign.design_id) earlier.push_back(*one);
  for (const AttemptRecord& one : earlier)
    standing.attempts.push_back(
        {one.id, one.seed, one.cases, one.verdict, one.begun_utc, one.fresh, one.engine == summary.engine});
  const std::vector<AttemptRecord> counted =
      standing.fresh.empty() ? Counted(earlier) : std::vector<AttemptRecord>();

  const std::vector<LookRecord> looks = folder.Looks();
  const Registered registered = RegisteredIn(folder, campaign, looks, counted);
  for (const auto& [line, verdict] : registered.lines) {
    if (!IsRequired(campaign, line)) standing.dropped.push_back({line, LineWords(line), verdict});
  }
  standing.is_post_hoc = !standing.dropped.empty() || registered.is_judged_otherwise;
  const std::int64_t planned_first = folder.PlannedCases();
  for (std::size_t i = 0; i < campaign.requirements.size(); ++i) {
    const Requirement& requirement = campaign.requirements[i];
    const RequirementSummary& shown = summary.requirements[i];
    Standing::Requirement& one = standing.requirements.emplace_back();
    Judge(requirement, shown, summary, AttemptsAt(requirement, shown, summary, looks, planned_first, counted),
          campaign.verdicts.attempts, one);
    if (Holds(registered.lines, RequirementLine(requirement))) continue;
    one.post_hoc = standing.is_post_hoc = true;
    if (one.verdict == "fail") continue;
    one.verdict = "not_evidence";
    one.reason = "It was stated after its flights were flown. Flights with another seed can show it.";
  }
  standing.verdict = Together(summary, standing);
  standing.attempts.push_back({campaign.id, campaign.sampling.seed, static_cast<std::int64_t>(summary.cases),
                               StandingVerdictName(standing.verdict),
                               own == all.end() ? std::string() : own->begun_utc, standing.fresh});
  return standing;
}

std::string JudgedSentence(const RequirementSummary& requirement, const Standing::Requirement& standing) {
  return (standing.reason.empty() || standing.post_hoc ? "" : standing.reason + " ") + requirement.sentence;
}

std::vector<std::string> StandingNotes(const Standing& standing, const CampaignSummary& summary) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < standing.requirements.size(); ++i) {
    const Standing::Requirement& one = standing.requirements[i];
    if (one.post_hoc)
      notes.push_back(fmt::format("Post hoc: {} was not required before the first case was flown.",
                                  RequirementWords(summary.requirements[i])));
  }
  for (const Standing::Dropped& one : standing.dropped)
    notes.push_back(
        fmt::format("Post hoc: {} was required, and was changed or left out after the first case was flown. "
                    "Its last verdict: {}.",
                    one.words, one.verdict.empty() ? "none" : one.verdict));
  for (std::string& note : CampaignNotes(standing)) notes.push_back(std::move(note));
  return notes;
}

std::vector<std::string> CampaignNotes(const Standing& standing) {
  std::vector<std::string> notes;
  if (standing.is_post_hoc && standing.dropped.empty() &&
      std::none_of(standing.requirements.begin(), standing.requirements.end(),
                   [](const Standing::Requirement& one) { return one.post_hoc; }))
    notes.push_back(
        "Post hoc: the way the requirements are judged together was changed after the first case was flown.");
  if (!standing.fresh.empty())
    notes.push_back(
        fmt::format("Started anew, so that earlier attempts do not count: \"{}\".", standing.fresh));
  if (std::string attempts = AttemptsNote(standing); !attempts.empty()) notes.push_back(std::move(attempts));
  if (standing.earlier_designs > 0)
    notes.push_back(
        fmt::format("Earlier designs in this folder, of any vehicle: {}, of which {} with this seed.",
                    standing.earlier_designs, standing.earlier_designs_of_seed));
  return notes;
}

AttemptRecord AttemptOf(const Campaign& campaign, const CampaignSummary& summary, AttemptRecord begun) {
  AttemptRecord record = RecordOf(campaign);
  record.engine = summary.engine;
  record.begun_utc = begun.begun_utc;
  record.fresh = begun.fresh;
  record.earlier_designs = begun.earlier_designs;
  record.earlier_designs_of_seed = begun.earlier_designs_of_seed;
  record.cases = static_cast<std::int64_t>(summary.reached);
  record.verdict = StandingVerdictName(summary.standing.verdict);
  for (std::size_t i = 0; i < record.requirements.size(); ++i) {
    const RequirementSummary& shown = summary.requirements[i];
    record.requirements[i].failures = shown.failures + record.cases - shown.n;
    record.requirements[i].verdict =
        shown.verdict == "study" ? (shown.failures > 0 ? "fail" : "study") : shown.verdict;
  }
  return record;
}

void WriteStanding(const ResultFolder& folder, const CampaignSummary& summary) {
  const std::filesystem::path file = folder.directory() / "execution.json";
  StandingJson json = ExecutionOf(folder);
  if (!json.contains("schema")) json = {{"schema", "dispersa/execution/1"}, {"engine", EngineVersion()}};
  const Standing& standing = summary.standing;
  json["standing_verdict"] = StandingVerdictName(standing.verdict);
  json["attempts"] = StandingJson::array();
  for (const Standing::AttemptLine& one : standing.attempts) {
    StandingJson line = {{"id", one.id}, {"seed", one.seed}, {"cases", one.cases}};
    line["verdict"] = TextOrNull(one.verdict);
    if (!one.fresh.empty()) line["fresh"] = one.fresh;
    json["attempts"].push_back(std::move(line));
  }
  json["standing"] = {{"requirements", StandingJson::array()},
                      {"dropped", StandingJson::array()},
                      {"post_hoc", standing.is_post_hoc},
                      {"notes", StandingNotes(standing, summary)}};
  for (std::size_t i = 0; i < standing.requirements.size(); ++i) {
    const Standing::Requirement& one = standing.requirements[i];
    json["standing"]["requirements"].push_back({{"metric", summary.requirements[i].metric},
                                                {"verdict", one.verdict},
                                                {"post_hoc", one.post_hoc},
                                                {"reason", one.reason},
                                                {"cases_of_all_attempts", one.pool_cases},
                                                {"failures_of_all_attempts", one.pool_failures}});
  }
  for (const Standing::Dropped& one : standing.dropped)
    json["standing"]["dropped"].push_back(
        {{"requirement", one.line}, {"words", one.words}, {"verdict", one.verdict}});
  WriteFile(file, json.dump(2) + "\n");
}

std::optional<std::string> RecordAttempt(const std::filesystem::path& root, const ResultFolder& folder,
                                         const Campaign& campaign, const CampaignSummary& summary) {
  AttemptRecord begun;
  for (const AttemptRecord& one : AttemptLedger(folder.directory() / kFolderLedgerName).Read())
    if (one.id == campaign.id) begun = one;
  return NoteAttempt(root, folder.directory(), AttemptOf(campaign, summary, std::move(begun)));
}

}  // namespace dispersa
