#include "core/flight/outcome.h"

namespace dispersa {

namespace {
constexpr const char* kOutcomeNames[kOutcomeCount] = {"completed", "lost_control",      "structural_limit",
                                                      "impact",    "numerical_failure", "timeout"};
}

const char* OutcomeName(Outcome outcome) { return kOutcomeNames[static_cast<int>(outcome)]; }

bool ParseOutcome(const std::string& name, Outcome* outcome) {
  for (int i = 0; i < kOutcomeCount; ++i) {
    if (name != kOutcomeNames[i]) continue;
    *outcome = static_cast<Outcome>(i);
    return true;
  }
  return false;
}

}  // namespace dispersa
