#include "core/statistics/group_sequential.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/distributions/normal.hpp>

#include "core/math/assertion.h"
#include "core/statistics/bisection.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

/// Terms of the binomial distribution below this share of the largest are left out. A million of them are
/// less than the rounding error.
constexpr double kNegligible = 1e-22;

/// P(X = first + i), where X is the number of failures in n cases. The far tails are left out.
struct BinomialTerms {
  std::int64_t first = 0;
  std::vector<double> terms;
};

BinomialTerms Terms(std::int64_t n, double failure) {
  const auto mode =
      std::min<std::int64_t>(n, static_cast<std::int64_t>((static_cast<double>(n) + 1.0) * failure));
  const auto count = static_cast<double>(n);
  const auto at = static_cast<double>(mode);
  const double log_mode = std::lgamma(count + 1.0) - std::lgamma(at + 1.0) - std::lgamma(count - at + 1.0) +
                          at * std::log(failure) + (count - at) * std::log1p(-failure);
  // Terms follow from the mode by ratios of neighbours. Scaling their sum to 1 then removes the rounding
  // error of lgamma.
  std::vector<double> up = {std::exp(log_mode)};
  const double odds = failure / (1.0 - failure);
  for (std::int64_t k = mode; k < n && up.back() > kNegligible * up.front(); ++k)
    up.push_back(up.back() * odds * static_cast<double>(n - k) / static_cast<double>(k + 1));
  std::vector<double> down;
  double term = up.front();
  std::int64_t first = mode;
  while (first > 0 && term > kNegligible * up.front()) {
    term *= static_cast<double>(first) / (odds * static_cast<double>(n - first + 1));
    down.push_back(term);
    --first;
  }
  BinomialTerms result{first, {down.rbegin(), down.rend()}};
  result.terms.insert(result.terms.end(), up.begin(), up.end());
  double sum = 0.0;
  for (const double each : result.terms) sum += each;
  for (double& each : result.terms) each /= sum;
  return result;
}

/// Distribution of the number of failures over the sequences of cases that no look has decided yet.
class Undecided {
 public:
  explicit Undecided(double probability) : failure_(1.0 - probability) {}

  /// Adds cases, up to n.
  void Advance(std::int64_t n) {
    DISPERSA_ASSERT(n >= n_, n, n_);
    if (n == n_ || mass_.empty()) {
      n_ = std::max(n, n_);
      return;
    }
    const BinomialTerms step = Terms(n - n_, failure_);
    std::vector<double> next(mass_.size() + step.terms.size() - 1, 0.0);
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      if (mass_[i] == 0.0) continue;
      for (std::size_t j = 0; j < step.terms.size(); ++j) next[i + j] += mass_[i] * step.terms[j];
    }
    mass_ = std::move(next);
    first_ += step.first;
    n_ = n;
  }

  /// Takes out the sequences with at most (TakeUpTo) or at least (TakeFrom) this number of failures. Returns
  /// their probability.
  double TakeUpTo(std::int64_t failures) {
    const std::int64_t count = std::clamp<std::int64_t>(failures - first_ + 1, 0, std::ssize(mass_));
    double taken = 0.0;
    for (std::int64_t i = 0; i < count; ++i) taken += mass_[static_cast<std::size_t>(i)];
    mass_.erase(mass_.begin(), mass_.begin() + count);
    first_ += count;
    return taken;
  }
  double TakeFrom(std::int64_t failures) {
    const std::int64_t kept = std::clamp<std::int64_t>(failures - first_, 0, std::ssize(mass_));
    double taken = 0.0;
    for (std::int64_t i = std::ssize(mass_) - 1; i >= kept; --i) taken += mass_[static_cast<std::size_t>(i)];
    mass_.resize(static_cast<std::size_t>(kept));
    return taken;
  }

  /// The largest number for which TakeUpTo, or the smallest for which TakeFrom, would return at most
  /// `allowed`.
  std::int64_t MostUpTo(double allowed) const {
    double sum = 0.0;
    std::int64_t most = first_ - 1;
    for (const double each : mass_) {
      sum += each;
      if (sum > allowed) return most;
      ++most;
    }
    return most;
  }
  std::int64_t FewestFrom(double allowed) const {
    double sum = 0.0;
    std::int64_t fewest = first_ + std::ssize(mass_);
    for (auto each = mass_.rbegin(); each != mass_.rend(); ++each) {
      sum += *each;
      if (sum > allowed) return fewest;
      --fewest;
    }
    return fewest;
  }

 private:
  double failure_;
  std::int64_t n_ = 0;
  std::int64_t first_ = 0;  ///< number of failures that mass_[0] belongs to
  std::vector<double> mass_ = {1.0};
};

double Spent(Spending spending, double risk, double share) {
  if (share >= 1.0) return risk;
  if (spending == Spending::kPocock) return risk * std::log1p((std::numbers::e - 1.0) * share);
  const boost::math::normal normal;
  return 2.0 * cdf(complement(normal, quantile(complement(normal, 0.5 * risk)) / std::sqrt(share)));
}

}  // namespace

std::vector<std::int64_t> LookCounts(const VerdictPlan& plan, std::int64_t planned) {
  if (plan.kind == PlanKind::kAnytime || planned <= 0) return {};
  const std::int64_t looks = plan.kind == PlanKind::kFixed ? 1 : std::min(plan.looks, planned);
  std::vector<std::int64_t> counts;
  // planned / K comes first, so that no product overflows.
  for (std::int64_t i = 1; i <= looks; ++i)
    counts.push_back(planned / looks * i + (planned % looks * i + looks - 1) / looks);
  return counts;
}

std::vector<LookBoundary> Boundaries(const VerdictPlan& plan, double probability, double risk,
                                     std::int64_t planned) {
  std::vector<LookBoundary> looks;
  const std::vector<std::int64_t> counts = LookCounts(plan, planned);
  if (counts.size() == 1) {
    const std::int64_t n = counts.front();
    const std::int64_t accept = MaxFailures(probability, risk, n).value_or(-1);
    return {{n, accept, FirstTrue(accept, n + 1, [&](std::int64_t failures) {
               return ProducerRisk(probability, n, failures) <= risk;
             })}};
  }
  Undecided not_passed(probability);
  Undecided not_failed(probability);
  double passed = 0.0;
  double failed = 0.0;
  for (const std::int64_t n : counts) {
    const double spent = Spent(plan.spending, risk, static_cast<double>(n) / static_cast<double>(planned));
    not_passed.Advance(n);
    not_failed.Advance(n);
    LookBoundary look{n, not_passed.MostUpTo(spent - passed), not_failed.FewestFrom(spent - failed)};
    passed += not_passed.TakeUpTo(look.accept);
    failed += not_failed.TakeFrom(look.reject);
    // Outside the range of undecided sequences there is nothing to decide. Such a number must not become a
    // boundary.
    look.accept = std::clamp<std::int64_t>(look.accept, looks.empty() ? -1 : looks.back().accept, n);
    look.reject = std::clamp<std::int64_t>(look.reject, look.accept + 1, n + 1);
    looks.push_back(look);
  }
  return looks;
}

double PassRisk(double probability, const std::vector<LookBoundary>& looks) {
  Undecided undecided(probability);
  double risk = 0.0;
  for (const LookBoundary& look : looks) {
    undecided.Advance(look.n);
    risk += undecided.TakeUpTo(look.accept);
  }
  return risk;
}

double FailRisk(double probability, const std::vector<LookBoundary>& looks) {
  Undecided undecided(probability);
  double risk = 0.0;
  for (const LookBoundary& look : looks) {
    undecided.Advance(look.n);
    risk += undecided.TakeFrom(look.reject);
  }
  return risk;
}

}  // namespace dispersa
