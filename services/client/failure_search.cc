#include "services/client/failure_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/analysis/requirement_summary.h"
#include "core/campaign/case_result.h"
#include "core/cases/campaign_flights.h"
#include "core/containment/interrupted.h"
#include "core/flight/flight.h"
#include "core/input/input_error.h"
#include "core/optimization/parallel_for.h"
#include "core/results/json_number.h"
#include "core/results/requirement_text.h"
#include "core/results/text.h"
#include "core/statistics/intervals.h"
#include "services/client/flight_json.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

/// Flights that go side by side on one thread.
constexpr std::size_t kTogether = 8;
/// Of all flights one in so many is a random one.
constexpr std::size_t kRandomShare = 4;
/// Shares of the distance that are printed.
constexpr double kPrintedShare = 0.001;

/// As the campaign draws them, each with its own gusts and noise: what the search must not contradict.
struct RandomFlights {
  std::size_t flown = 0;
  std::size_t failures = 0;
  std::uint64_t first = 0;  ///< case that fails
};

/// A limit of the command line, or the campaign's own.
Requirement WantedRequirement(const FailureSearchRequest& request, const Campaign& campaign) {
  if (!request.metric.empty()) {
    if (const std::string why = WhyNotMeasured(campaign, request.metric); !why.empty())
      throw InputError("--metric: '" + request.metric + "' " + why,
                       "a name in cases.csv without its prefix 'metric_'");
  }
  if (request.below || request.above) {
    if (request.metric.empty()) throw InputError("--below and --above need --metric");
    Requirement requirement;
    requirement.metric = request.metric;
    requirement.below = request.below;
    requirement.above = request.above;
    return requirement;
  }
  for (const Requirement& requirement : campaign.requirements)
    if (request.metric.empty() || requirement.metric == request.metric) return requirement;
  throw InputError(request.metric.empty() ? campaign.name + ": states no requirement"
                                          : campaign.name + ": states no requirement of " + request.metric,
                   "--metric with --below or --above");
}

class Searcher {
 public:
  Searcher(const Campaign& campaign, const Requirement& requirement, std::size_t max_flights,
           Observer& observer)
      : flights_(campaign),
        space_(campaign),
        limits_(LimitsOf(requirement)),
        metric_(MetricsOf(campaign).PositionOf(requirement.metric)),
        max_flights_(max_flights),
        observer_(observer) {}

  const DispersionSpace& space() const { return space_; }

  std::vector<double> Margins(const std::vector<std::vector<double>>& points) {
    const std::vector<FlightInputs> inputs = space_.Inputs(points);
    std::vector<double> margins(points.size());
    const std::size_t groups = (points.size() + kTogether - 1) / kTogether;
    ParallelFor(groups, static_cast<std::size_t>(UsableCores()), [&](std::size_t group) {
      const std::size_t first = group * kTogether;
      std::vector<FlightOrder> orders;
      for (std::size_t i = first; i < std::min(points.size(), first + kTogether); ++i)
        orders.push_back({inputs[i], {}});
      const std::vector<FlightResult> flown = FlyAll(flights_.model(), orders);
      for (std::size_t i = 0; i < flown.size(); ++i) {
        const double value = flown[i].metrics[metric_];
        margins[first + i] = flown[i].outcome == Outcome::kCompleted && std::isfinite(value)
                                 ? limits_.Margin(value)
                                 : std::nan("");
      }
    });
    done_ += points.size();
    observer_.Show("flights", done_, max_flights_);
    if (observer_.ShouldStop()) throw Interrupted();
    return margins;
  }
  /// The flight of a point, with the noise of case 0 as all of the search.
  CaseResult Fly(const std::vector<double>& point) const {
    return flights_.Fly(space_.Inputs({point}).front(), 0, nullptr);
  }

 private:
  CampaignFlights flights_;
  DispersionSpace space_;
  Limits limits_;
  std::size_t metric_;
  std::size_t max_flights_;
  std::size_t done_ = 0;
  Observer& observer_;
};

/// The first cases of a Monte Carlo campaign with this seed.
RandomFlights FlyAtRandom(Campaign campaign, const Requirement& requirement, std::uint64_t seed,
                          std::size_t count) {
  campaign.sampling = {SamplingMethod::kMonteCarlo, count, seed};
  const CampaignFlights flights(campaign);
  const Limits limits = LimitsOf(requirement);
  const std::size_t metric = MetricsOf(campaign).PositionOf(requirement.metric);
  RandomFlights random;
  random.first = count;
  std::vector<CaseOrder> orders(count);
  for (std::size_t i = 0; i < count; ++i) orders[i].case_index = i;
  flights.FlyCases(orders, UsableCores(), [&](std::size_t, const CaseResult& result, const auto&...) {
    ++random.flown;
    if (result.outcome == Outcome::kCompleted && limits.Meets(result.metrics[metric])) return;
    ++random.failures;
    random.first = std::min(random.first, result.case_index);
  });
  return random;
}

/// The share of a coordinate in the squared distance.
double ShareOf(const FailureSearchResult& result, const DispersionSpace& space, std::size_t i) {
  if (space.coordinates()[i].kind != CoordinateKind::kNormal || result.distance == 0.0) return 0.0;
  return result.point[i] * result.point[i] / (result.distance * result.distance);
}

const char* KindName(CoordinateKind kind) {
  return kind == CoordinateKind::kNormal      ? "normal"
         : kind == CoordinateKind::kDirection ? "direction"
                                              : "held";
}

std::string RandomSentence(const RandomFlights& random, std::uint64_t seed) {
  if (random.failures > 0)
    return fmt::format("Of {} random flights (seed {}) {} failed, the first is case {}.", random.flown, seed,
                       random.failures, random.first);
  const double most = 1.0 - ClopperPearsonLower(static_cast<std::int64_t>(random.flown),
                                                static_cast<std::int64_t>(random.flown), 0.9);
  return fmt::format(
      "None of {} random flights (seed {}) failed: with 90 % confidence at most {} of flights do.",
      random.flown, seed, PercentText(most));
}

std::string Sentence(const FailureSearchResult& result, const RandomFlights& random, std::uint64_t seed,
                     const Requirement& requirement, double reach, const std::string& nominal_loss) {
  const std::string told = " " + RandomSentence(random, seed);
  if (!nominal_loss.empty()) return nominal_loss + told;
  if (result.found && result.distance == 0.0)
    return fmt::format("The flight without dispersions fails {}.", LimitText(requirement)) + told;
  if (result.found) {
    return fmt::format(
               "Fails {} at a distance of {} standard deviations from the nominal, the smallest found by a "
               "local "
               "search of {} flights. A smaller one may exist.",
               LimitText(requirement), ReadableText(result.distance), result.flights) +
           told;
  }
  if (random.failures > 0)
    return RandomSentence(random, seed) +
           fmt::format(
               " They fail {} by many dispersions together, or by gusts and noise of their own: a local "
               "search of "
               "{} flights found no few dispersions within {} standard deviations that fail it.",
               LimitText(requirement), result.flights, ReadableText(reach));
  return fmt::format(
             "No flight within {} standard deviations was found to fail {} in a local search of {} flights. "
             "This "
             "does not show that there is none.",
             ReadableText(reach), LimitText(requirement), result.flights) +
         told;
}

}  // namespace

FailureSearch SearchForFailure(const Campaign& campaign, const FailureSearchRequest& request,
                               Observer& observer) {
  const Requirement requirement = WantedRequirement(request, campaign);
  FailureSearchOptions options = request.options;
  options.seed = request.seed.value_or(campaign.sampling.seed);
  const RandomFlights random =
      FlyAtRandom(campaign, requirement, options.seed, options.max_flights / kRandomShare);
  options.max_flights -= random.flown;
  Searcher searcher(campaign, requirement, options.max_flights, observer);
  const DispersionSpace& space = searcher.space();
  const FailureSearchResult result = FindSmallestFailure(
      space.coordinates(), [&](const auto& points) { return searcher.Margins(points); }, options);
  observer.EndPhase();
  const std::string sentence = Sentence(result, random, options.seed, requirement, options.reach,
                                        NominalLoss(CampaignFlights(campaign).FlyNominal()));

  nlohmann::ordered_json json = {
      {"schema", "dispersa/search/1"},
      {"campaign", campaign.name},
      {"flight_id", campaign.flight_id},
      {"requirement", LimitText(requirement)},
      {"metric", requirement.metric},
      {"sentence", sentence},
      {"random_flights", random.flown},
      {"random_failures", random.failures},
      {"first_random_failure", random.failures > 0 ? nlohmann::ordered_json(random.first) : nullptr},
      {"local_search", true},
      {"found", result.found},
      {"flights", result.flights},
      {"max_flights", request.options.max_flights},
      {"reach", request.options.reach},
      {"seed", options.seed},
      {"least_margin", Number(result.least_margin)}};
  std::string text = sentence + "\n";
  if (result.found) {
    const CaseResult flown = searcher.Fly(result.point);
    const double value = flown.metrics[MetricsOf(campaign).PositionOf(requirement.metric)];
    json["distance"] = Number(result.distance);
    json["outcome"] = OutcomeName(flown.outcome);
    json["value"] = Number(value);
    json["dispersions"] = nlohmann::ordered_json::array();
    text += fmt::format(
        "outcome {}, {} {}\n\n{:<44}{:>12}{:>10}\n", OutcomeName(flown.outcome), requirement.metric,
        std::isfinite(value) ? RoundedText(value, Rounding::kNearest, LimitsOf(requirement).Beside(value))
                             : "undefined",
        "dispersion", "std devs", "share");
    std::vector<std::size_t> order(space.coordinates().size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return ShareOf(result, space, a) > ShareOf(result, space, b);
    });
    for (const std::size_t i : order) {
      const Coordinate& coordinate = space.coordinates()[i];
      const double share = ShareOf(result, space, i);
      json["dispersions"].push_back({{"name", coordinate.name},
                                     {"kind", KindName(coordinate.kind)},
                                     {"standard_normal", Number(result.point[i])},
                                     {"share", Number(share)}});
      if (share >= kPrintedShare)
        text += fmt::format("{:<44}{:>12.3f}{:>10}\n", coordinate.name, result.point[i],
                            PercentText(std::round(share * 1e3) / 1e3));
    }
    json["inputs"] = InputsJson(RowInputs(campaign), flown);
    json["digest"] = flown.digest.Hex();
  }
  return {std::move(json), std::move(text)};
}

}  // namespace dispersa
