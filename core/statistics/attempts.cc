#include "core/statistics/attempts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/math/assertion.h"
#include "core/statistics/anytime.h"

namespace dispersa {
namespace {

/// With less no number of cases that anybody flies would decide.
constexpr double kLeastPoolRisk = 1e-12;

/// Cases by seed, each counted once.
class Pool {
 public:
  void Add(const Attempt& attempt) {
    Count& count = counts_[attempt.seed];
    // A smaller number of cases can have shown more failures, if cases without a result were flown later.
    if (attempt.cases == count.cases) count.failures = std::max(count.failures, attempt.failures);
    if (attempt.cases > count.cases) count = {attempt.cases, std::max(attempt.failures, count.failures)};
  }
  bool Has(std::uint64_t seed) const {
    const auto found = counts_.find(seed);
    return found != counts_.end() && found->second.cases > 0;
  }
  std::int64_t cases() const { return Sum(&Count::cases); }
  std::int64_t failures() const { return Sum(&Count::failures); }

 private:
  struct Count {
    std::int64_t cases = 0;
    std::int64_t failures = 0;
  };
  std::int64_t Sum(std::int64_t Count::*member) const {
    std::int64_t sum = 0;
    for (const auto& [seed, count] : counts_) sum += count.*member;
    return sum;
  }
  std::map<std::uint64_t, Count> counts_;
};

bool AnytimePasses(double probability, double risk, std::int64_t cases, std::int64_t failures) {
  return risk > kLeastPoolRisk && cases > 0 && PassEvidence(probability, cases, failures) >= -std::log(risk);
}

}  // namespace

AttemptsVerdict JudgeAttempts(double probability, double risk, std::uint64_t reserved,
                              const std::vector<Attempt>& attempts) {
  DISPERSA_ASSERT(!attempts.empty() && reserved >= 1);
  const double share = risk / static_cast<double>(reserved);
  // What the plan leaves of its share; none if it could not have passed. An anytime plan leaves all: the pool
  // goes on with the same evidence.
  const auto left_by = [&](const Attempt& attempt) -> std::optional<double> {
    if (attempt.planned < 1) return std::nullopt;
    if (attempt.plan.kind == PlanKind::kAnytime)
      return AnytimePasses(probability, share, attempt.planned, 0) ? std::optional(share) : std::nullopt;
    const std::vector<LookBoundary> looks = Boundaries(attempt.plan, probability, share, attempt.planned);
    if (std::none_of(looks.begin(), looks.end(), [](const LookBoundary& look) { return look.accept >= 0; }))
      return std::nullopt;
    return share - PassRisk(probability, looks);
  };

  AttemptsVerdict verdict;
  Pool seen, evidence, pool;
  bool is_begun = false;
  std::uint64_t kept = 0;
  std::map<std::uint64_t, bool> passed_of;  // by seed
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const Attempt& attempt = attempts[i];
    const bool fresh = !seen.Has(attempt.seed);
    const std::optional<double> left = left_by(attempt);
    verdict.is_spent = is_begun;
    verdict.passed_before = verdict.passed_before || verdict.passed;
    verdict.by_plan = false;
    bool passed = false;
    seen.Add(attempt);
    if (attempt.is_evidence) evidence.Add(attempt);
    if (fresh && left && kept < reserved) {
      ++kept;
      verdict.by_plan = true;
      passed = attempt.passed && attempt.is_evidence;
      if (!is_begun) verdict.risk_left = *left;
      is_begun = true;
      if (attempt.is_evidence) pool.Add(attempt);
    } else if (is_begun) {
      if (attempt.is_evidence) pool.Add(attempt);
      passed =
          attempt.is_evidence && AnytimePasses(probability, verdict.risk_left, pool.cases(), pool.failures());
    } else if (!fresh && AnytimePasses(probability, share, std::max(seen.cases(), attempt.planned), 0)) {
      // Nothing is spent yet and no plan can be kept: evidence that holds at any time, from the first case.
      is_begun = true;
      ++kept;
      verdict.risk_left = share;
      pool = evidence;
      passed = attempt.is_evidence && AnytimePasses(probability, share, pool.cases(), pool.failures());
    }
    passed = passed || passed_of[attempt.seed];
    if (attempt.is_evidence) passed_of[attempt.seed] = passed;
    verdict.passed = passed;
  }
  const Pool& counted = is_begun ? pool : evidence;
  verdict.pool_cases = counted.cases();
  verdict.pool_failures = counted.failures();
  const double left = is_begun ? verdict.risk_left : share;
  if (left > kLeastPoolRisk)
    verdict.pool_needed = AnytimeCasesNeeded(probability, left, verdict.pool_failures);
  return verdict;
}

}  // namespace dispersa
