#include "core/campaign_yaml/plan_warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/flight/metrics.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/math/constants.h"
#include "core/statistics/anytime.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

/// With more, one of a few vehicles that just miss passes.
constexpr double kUsualRisk = 0.2;
/// Open-loop flights scatter by more.
constexpr double kOpenLoopOrbit_km = 5.0;

class PlanReader {
 public:
  PlanReader(const Campaign& campaign, const InputNode& root, std::vector<InputProblem>& found)
      : campaign_(campaign), root_(root), found_(found) {}

  void Read() {
    const InputNode* list = root_.Find("requirements");
    for (std::size_t i = 0; list != nullptr && i < list->items.size(); ++i) {
      if (i >= campaign_.requirements.size()) break;
      ReadRequirement(i, list->items[i]);
    }
    ReadSigmas();
  }

 private:
  void Warn(const InputNode& item, const std::string& path, const char* key, const std::string& message,
            const std::string& usual) {
    const InputNode* value = item.Find(key);
    AddProblem(found_, value != nullptr ? *value : item, value != nullptr ? path + "." + key : path, message,
               usual);
  }

  void ReadRequirement(std::size_t index, const InputNode& item) {
    const Requirement& requirement = campaign_.requirements[index];
    const std::string path = "requirements[" + std::to_string(index) + "]";
    for (std::size_t other = 0; other < index; ++other) {
      if (IsSame(requirement, campaign_.requirements[other]))
        Warn(item, path, "metric",
             "the same requirement stands in requirements[" + std::to_string(other) + "]", "each once");
    }
    ReadLimit(requirement, item, path);
    if (requirement.every_case) return;
    if (!IsIndependent(campaign_.sampling.method)) {
      Warn(item, path, "probability",
           "the points of a design study are chosen, so that they show no probability (exit code 7)",
           "every_case: true, or method: monte_carlo");
      return;
    }
    if (requirement.consumer_risk > kUsualRisk)
      Warn(item, path, "consumer_risk",
           "a vehicle that just misses passes with a probability of " +
               FormatRounded(100.0 * requirement.consumer_risk) + " %",
           "up to " + FormatRounded(kUsualRisk) + ", usually 0.1");
    const double risk = requirement.consumer_risk / static_cast<double>(campaign_.verdicts.attempts);
    const std::int64_t needed = requirement.plan.kind == PlanKind::kAnytime
                                    ? AnytimeCasesNeeded(requirement.probability, risk, 0)
                                    : CasesNeeded(requirement.probability, risk, 0);
    if (campaign_.sampling.cases > 0 && static_cast<std::uint64_t>(needed) > campaign_.sampling.cases)
      Warn(item, path, "probability",
           std::to_string(campaign_.sampling.cases) + " cases can never show " +
               FormatRounded(100.0 * requirement.probability) + " % at a risk of " +
               FormatRounded(100.0 * risk) + " %",
           std::to_string(needed) + " cases or more");
  }

  void ReadLimit(const Requirement& requirement, const InputNode& item, const std::string& path) {
    const std::string& metric = requirement.metric;
    // What a metric of the campaign's own may be, its expression alone says.
    const bool is_magnitude =
        requirement.own_expression.empty() && Metrics()[MetricColumn(metric)].worse == Worse::kLarger;
    if (is_magnitude && requirement.below && !(*requirement.below > 0.0))
      Warn(item, path, "below", "a magnitude is never below " + FormatRounded(*requirement.below),
           "a limit above 0");
    if (is_magnitude && requirement.above && *requirement.above < 0.0)
      Warn(item, path, "above", "a magnitude is always above " + FormatRounded(*requirement.above),
           "a limit of 0 or more");
    const Worse worse =
        requirement.own_expression.empty() ? Metrics()[MetricColumn(metric)].worse : Worse::kNeither;
    const bool is_error = worse == Worse::kFartherFromZero;
    if (requirement.above &&
        (is_error ? *requirement.above > 0.0 : is_magnitude && *requirement.above >= 0.0))
      Warn(item, path, "above", "larger values of '" + metric + "' are the worse ones, and these meet it",
           "below, or within");
    if (requirement.below && is_error && *requirement.below < 0.0)
      Warn(item, path, "below", "values farther from 0 are the worse ones, and these meet it",
           "above, or within");
    const bool is_attitude = metric.starts_with("pitch_error_peak_") ||
                             metric.starts_with("pitch_error_rms_") || metric.starts_with("yaw_error_") ||
                             metric.starts_with("roll_error_");
    const LossOfControl& loss = campaign_.vehicle.loss_of_control;
    const double lost_deg = loss.attitude_error_rad * kDegPerRad;
    if (is_attitude && metric.find("_time_") == std::string::npos && requirement.below &&
        *requirement.below > lost_deg)
      Warn(item, path, "below",
           "a flight whose error passes " + FormatRounded(lost_deg) + " deg for " +
               FormatRounded(loss.for_s) + " s has lost control",
           "a limit below " + FormatRounded(lost_deg));
    const bool is_orbit = metric == "injection_altitude_error_km" || metric == "injection_altitude_km" ||
                          metric == "apogee_km" || metric == "perigee_km";
    if (is_orbit && requirement.within && !campaign_.guidance.closed_loop && !campaign_.dispersions.empty() &&
        (*requirement.within)[1] - (*requirement.within)[0] <= 2.0 * kOpenLoopOrbit_km)
      Warn(item, path, "within",
           "guidance is open loop: nothing corrects what dispersed thrust and drag do to the orbit",
           "guidance: {mode: closed_loop}, or wider limits");
  }

  static bool IsSame(const Requirement& a, const Requirement& b) {
    return a.metric == b.metric && a.below == b.below && a.above == b.above && a.within == b.within &&
           a.probability == b.probability && a.every_case == b.every_case;
  }

  // One file that says both is likely to mean one of them.
  void ReadSigmas() {
    const InputNode* dispersions = root_.Find("dispersions");
    if (dispersions == nullptr) return;
    bool has_three = false;
    const auto each = [&](const auto& visit) {
      for (const InputMember& member : dispersions->members) {
        if (member.value.kind == InputNode::Kind::kList) {
          for (std::size_t i = 0; i < member.value.items.size(); ++i)
            for (const InputMember& key : member.value.items[i].members)
              visit(member.key + "[" + std::to_string(i) + "]", key);
        }
        for (const InputMember& key : member.value.members) visit(member.key, key);
      }
    };
    each([&](const std::string&, const InputMember& key) {
      has_three = has_three || key.key.starts_with("three_sigma_");
    });
    if (!has_three) return;
    each([&](const std::string& name, const InputMember& key) {
      if (!key.key.starts_with("sigma_")) return;
      AddProblem(found_, key.value, "dispersions." + name + "." + key.key,
                 "one sigma here, and three_sigma_ in other dispersions of this file", "three_" + key.key);
    });
  }

  const Campaign& campaign_;
  const InputNode& root_;
  std::vector<InputProblem>& found_;
};

}  // namespace

std::vector<InputProblem> PlanWarnings(const Campaign& campaign, const InputNode& root) {
  std::vector<InputProblem> found;
  PlanReader(campaign, root, found).Read();
  return found;
}

}  // namespace dispersa
