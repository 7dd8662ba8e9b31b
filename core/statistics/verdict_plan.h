// When a requirement's counts may be looked at for a verdict.
#pragma once

#include <cstdint>

namespace dispersa {

enum class PlanKind {
  kFixed,            ///< one look, at a number of cases fixed beforehand
  kGroupSequential,  ///< several looks at numbers of cases fixed beforehand, which share the risk
  kAnytime,          ///< a look at any time, any number of times
};

/// How a group-sequential plan spends its risk a over the share t of its cases (K. K. G. Lan and D. L.
/// DeMets, Biometrika 70 (1983) 659-663).
enum class Spending {
  kOBrienFleming,  ///< 2 - 2 Phi(z_{a/2} / sqrt t): little early; the last look is nearly that of a fixed
                   ///< plan
  kPocock,         ///< a ln(1 + (e - 1) t): nearly even
};

struct VerdictPlan {
  PlanKind kind = PlanKind::kFixed;
  std::int64_t looks = 1;  ///< of a group-sequential plan, 2 or more
  Spending spending = Spending::kOBrienFleming;

  bool operator==(const VerdictPlan&) const = default;
};

}  // namespace dispersa
