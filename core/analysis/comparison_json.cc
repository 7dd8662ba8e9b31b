#include <nlohmann/json.hpp>

#include "core/analysis/comparison.h"
#include "core/results/json_number.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

Json IntervalJson(const Interval& interval) { return {Number(interval.lower), Number(interval.upper)}; }

Json SideJson(const Comparison::Side& side) {
  return {{"directory", side.folder},
          {"name", side.name},
          {"id", side.id},
          {"flight_id", side.flight_id},
          {"engine", side.engine},
          {"vehicle", side.vehicle},
          {"reference", side.reference},
          {"autopilot", side.autopilot},
          {"sampling", side.sampling},
          {"seed", side.seed},
          {"cases", side.cases},
          {"flown", side.flown},
          {"completed", side.completed},
          {"nominal_loss", TextOrNull(side.nominal_loss)}};
}

Json PairingJson(const Pairing& pairing) {
  const Json changed = ListOf(pairing.changed, [](const Pairing::ChangedInput& input) -> Json {
    return {{"input", input.input}, {"key", input.key}, {"cases", input.cases}};
  });
  return {{"paired", pairing.paired},       {"pairs", pairing.paired ? pairing.shared : 0},
          {"shared_cases", pairing.shared}, {"only_a", pairing.only_a},
          {"only_b", pairing.only_b},       {"same_inputs", pairing.same},
          {"changed_inputs", changed},      {"sentence", pairing.sentence}};
}

Json ReplayJson(const Comparison::Side& side, std::uint64_t case_index) {
  return TextOrNull(ReplayCommand(side, case_index));
}

Json PairsJson(const std::vector<MetricComparison::Pair>& pairs, const Comparison& comparison) {
  return ListOf(pairs, [&](const MetricComparison::Pair& pair) -> Json {
    return {{"case_index", pair.case_index},
            {"a", Number(pair.a)},
            {"b", Number(pair.b)},
            {"replay_a", ReplayJson(comparison.a, pair.case_index)},
            {"replay_b", ReplayJson(comparison.b, pair.case_index)}};
  });
}

Json MetricJson(const MetricComparison& metric, const Comparison& comparison) {
  const bool paired = comparison.pairing.paired;
  Json json = {{"metric", metric.metric},
               {"unit", metric.info.unit},
               {"worse", WorseName(metric.info.worse)},
               {"pairing", paired ? "paired" : "unpaired"},
               {"n_a", metric.n_a},
               {"n_b", metric.n_b},
               {"lost_a", metric.lost_a},
               {"lost_b", metric.lost_b},
               {"undefined", metric.undefined}};
  json["median"] = {{"a", Number(metric.median_a)},
                    {"b", Number(metric.median_b)},
                    {"statistic", paired ? "median_of_differences" : "difference_of_medians"},
                    {"difference", Number(metric.difference)},
                    {"interval", IntervalJson(metric.interval)},
                    {"method", paired ? "order_statistics_of_differences" : "mover_of_order_statistics"},
                    {"test", paired ? "sign_test" : "rank_sum"},
                    {"p", Number(metric.p)},
                    {"p_holm", Number(metric.p_holm)}};
  if (!paired) json["median"]["tendency"] = Number(metric.tendency);
  json["least"] = {{"difference", Number(comparison.practical_share * metric.scale)},
                   {"of", metric.scale_of}};
  json["effect"] = {{"share", Number(metric.effect)}, {"in", TextOrNull(metric.effect_in)}};
  json["tails"] = Json::array();
  for (const PercentileComparison& tail : metric.tails) {
    json["tails"].push_back(
        {{"percentile", tail.name},
         {"probability", tail.probability},
         {"a", Number(tail.a)},
         {"b", Number(tail.b)},
         {"difference", Number(tail.difference)},
         {"interval", IntervalJson(tail.interval)},
         {"method", "mover_of_order_statistics"},
         {"test", paired ? "mcnemar_at_pooled_percentile" : "fisher_at_pooled_percentile"},
         {"p", Number(tail.p)},
         {"p_holm", Number(tail.p_holm)}});
  }
  json["ratio"] = {{"median", Number(metric.ratio)}, {"interval", IntervalJson(metric.ratio_interval)}};
  const char* fewer = metric.info.worse == Worse::kNeither ? "b_smaller" : "b_better";
  const char* more = metric.info.worse == Worse::kNeither ? "b_larger" : "a_better";
  json["pairs"] = !paired ? Json(nullptr)
                          : Json{{fewer, metric.b_better}, {more, metric.a_better}, {"equal", metric.equal}};
  json["finding"] = metric.finding;
  json["largest_gains"] = PairsJson(metric.gains, comparison);
  json["largest_losses"] = PairsJson(metric.losses, comparison);
  return json;
}

Json RequirementJson(const RequirementComparison& requirement, bool paired) {
  Json json = {{"metric", requirement.metric},
               {"requirement", requirement.words},
               {"in_a", requirement.in_a},
               {"in_b", requirement.in_b},
               {"n_a", requirement.n_a},
               {"n_b", requirement.n_b},
               {"failures_a", requirement.failures_a},
               {"failures_b", requirement.failures_b}};
  json["mcnemar"] = !paired ? Json(nullptr)
                            : Json{{"both_meet", requirement.both_meet},
                                   {"only_a_fails", requirement.only_a_fails},
                                   {"only_b_fails", requirement.only_b_fails},
                                   {"both_fail", requirement.both_fail}};
  json["difference"] = Number(requirement.difference);
  json["interval"] = IntervalJson(requirement.interval);
  json["method"] = "mover_of_clopper_pearson";
  json["test"] = paired ? "mcnemar_exact" : "fisher_exact";
  json["p"] = Number(requirement.p);
  json["p_holm"] = Number(requirement.p_holm);
  json["finding"] = requirement.finding;
  return json;
}

Json CasesJson(const std::vector<ChangedCase>& cases, const Comparison& comparison) {
  const auto reason = [](const ChangedCase::Reason& one) -> Json {
    return {{"requirement", one.requirement}, {"a", Number(one.a)}, {"b", Number(one.b)}};
  };
  return ListOf(cases, [&](const ChangedCase& one) -> Json {
    return {{"case_index", one.case_index},
            {"outcome_a", OutcomeName(one.outcome_a)},
            {"outcome_b", OutcomeName(one.outcome_b)},
            {"requirements", ListOf(one.reasons, reason)},
            {"replay_a", ReplayJson(comparison.a, one.case_index)},
            {"replay_b", ReplayJson(comparison.b, one.case_index)}};
  });
}

}  // namespace

std::string ComparisonJson(const Comparison& comparison) {
  Json json;
  json["schema"] = "dispersa/compare/1";
  json["a"] = SideJson(comparison.a);
  json["b"] = SideJson(comparison.b);
  json["incomplete"] = IncompleteSides(comparison);
  json["finding"] = comparison.finding;
  json["sentence"] = comparison.sentence;
  json["confidence"] = kComparisonConfidence;
  json["independent"] = comparison.independent;
  json["practical_share"] = comparison.practical_share;
  json["differs_in"] = comparison.differs;
  json["pairing"] = PairingJson(comparison.pairing);
  json["changes"] = ListOf(comparison.changes, [](const CampaignChange& change) -> Json {
    return {{"path", change.path}, {"a", TextOrNull(change.a)}, {"b", TextOrNull(change.b)}};
  });
  json["metrics"] = ListOf(comparison.metrics,
                           [&](const MetricComparison& metric) { return MetricJson(metric, comparison); });
  json["requirements"] = ListOf(comparison.requirements, [&](const RequirementComparison& requirement) {
    return RequirementJson(requirement, comparison.pairing.paired);
  });
  json["load_checks"] = ListOf(comparison.load_checks, [](const Comparison::LoadCheck& check) -> Json {
    return {{"metric", check.metric}, {"failures_a", check.failures_a}, {"failures_b", check.failures_b}};
  });
  json["harmed"] = CasesJson(comparison.harmed, comparison);
  json["rescued"] = CasesJson(comparison.rescued, comparison);
  return json.dump(2) + "\n";
}

}  // namespace dispersa
