#include "core/analysis/drivers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/load_check.h"
#include "core/analysis/requirement_summary.h"
#include "core/campaign/dispersion_table.h"
#include "core/campaign/row_inputs.h"
#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "core/results/metric_catalogue.h"
#include "core/statistics/normal.h"
#include "core/statistics/sensitivity.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

constexpr std::size_t kLeastFlights = 30;
constexpr std::size_t kShown = 12;
constexpr std::size_t kCauses = 5;
/// A smaller share of the variance is no cause that anybody acts on.
constexpr double kLeastShare = 0.005;
/// Of ranks: more than chance shows, and enough to take one input for another.
constexpr double kCorrelated = 0.3;
constexpr double kFalseDiscoveryRate = 0.10;

/// Of so many flights indices have a standard error below a hundredth; more would only take time and memory.
constexpr std::size_t kCauseFlights = 50000;

/// A function of the inputs that may act on its own.
struct Feature {
  std::string input;
  std::string key;
  std::string name;
  Ranked values;
  std::vector<std::string> same_as = {};
};

/// Of one number with an order: neither a pair, nor the number of something.
bool HasOrder(const Feature& feature) { return !feature.name.starts_with("m ") && feature.name != "which"; }

/// Equal ranks or mirrored ones.
bool RankAlike(const Ranked& a, const Ranked& b) {
  const double mirror = static_cast<double>(a.size()) + 1.0;
  bool equal = true, mirrored = true;
  for (std::size_t i = 0; i < a.size() && (equal || mirrored); ++i) {
    equal = equal && a.ranks()[i] == b.ranks()[i];
    mirrored = mirrored && a.ranks()[i] + b.ranks()[i] == mirror;
  }
  return equal || mirrored;
}

/// The column of the magnitude that an angle gives a direction to, if there is one.
std::optional<int> MagnitudeOf(const std::string& angle) {
  if (angle.starts_with("wind_azimuth")) return FindInput("wind_max_speed_m_s");
  if (angle.starts_with("gust_azimuth")) return FindInput("gust_speed_m_s");
  const std::size_t clock = angle.find("_clock");
  if (clock == std::string::npos) return std::nullopt;
  std::string magnitude = angle;
  magnitude.erase(clock, std::string("_clock").size());
  int column = FindInput(magnitude);
  if (column < 0) column = FindInput(magnitude.substr(0, magnitude.rfind("_deg")) + "_m");
  if (column < 0) return std::nullopt;
  return column;
}

std::vector<double> Pick(const std::vector<double>& column, const std::vector<std::size_t>& rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::size_t row : rows) values.push_back(column[row]);
  return values;
}

bool Varies(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [&](double value) { return value != values.front(); });
}

/// Everything that the dispersed inputs may act through, over some of the flights. The first feature of an
/// input is its value itself.
std::vector<Feature> Features(const Campaign& campaign, const CaseColumns& cases,
                              const std::vector<std::size_t>& rows) {
  static const std::vector<double> nominal = InputValues(FlightInputs{}, kMaxStages + kFurtherNozzles);
  std::vector<Feature> features;
  const std::vector<int> inputs = DispersedInputs(campaign);
  for (const int input : inputs) {
    const InputColumn& column = InputColumns()[static_cast<std::size_t>(input)];
    const std::string& name = column.name;
    const Circle circle = CircleOf(column);
    const std::string key = InputKey(campaign, input);
    const std::vector<double> x =
        Unwrapped(Pick(cases.inputs[static_cast<std::size_t>(input)], rows), circle);
    if (!Varies(x)) continue;
    Ranked ranked(x);
    if (column.allowed.is_whole) {
      features.push_back({name, key, "which", std::move(ranked)});
      continue;
    }
    const auto same = std::find_if(features.begin(), features.end(), [&](const Feature& other) {
      return other.name == "x" && RankAlike(other.values, ranked);
    });
    if (same != features.end()) {
      same->same_as.push_back(name);
      continue;
    }
    features.push_back({name, key, "x", std::move(ranked)});
    const std::size_t itself = features.size() - 1;
    if (circle.is_closed()) {
      std::vector<double> sine, cosine;
      for (const double angle : x) {
        sine.push_back(std::sin(angle * kRadPerDeg));
        cosine.push_back(std::cos(angle * kRadPerDeg));
      }
      const std::optional<int> magnitude = MagnitudeOf(name);
      if (magnitude && std::find(inputs.begin(), inputs.end(), *magnitude) != inputs.end()) {
        const std::vector<double> m = Pick(cases.inputs[static_cast<std::size_t>(*magnitude)], rows);
        if (Varies(m)) {
          const std::string both =
              InputColumns()[static_cast<std::size_t>(*magnitude)].name + " along " + name;
          const std::string of = InputKey(campaign, *magnitude);
          const std::string keys = of == key ? key : of + " along " + key;
          std::vector<double> along = cosine, across = sine;
          for (std::size_t i = 0; i < m.size(); ++i) {
            along[i] *= m[i];
            across[i] *= m[i];
          }
          features.push_back({both, keys, "m cos x", along});
          features.push_back({both, keys, "m sin x", across});
        }
      }
      features.push_back({name, key, "sin x", sine});
      features.push_back({name, key, "cos x", cosine});
      continue;
    }
    // x squared has the ranks of |x|.
    std::vector<double> size;
    for (const double value : x) size.push_back(std::fabs(value - nominal[static_cast<std::size_t>(input)]));
    Ranked sized(size);
    if (!RankAlike(features[itself].values, sized)) features.push_back({name, key, "|x|", std::move(sized)});
  }
  return features;
}

/// One name for a magnitude, its direction, and both together.
std::string FamilyOf(const std::string& input) {
  const std::string first = input.substr(0, input.find(" along "));
  const std::optional<int> magnitude = MagnitudeOf(first);
  return magnitude ? InputColumns()[static_cast<std::size_t>(*magnitude)].name : first;
}

/// Inputs of other families whose values rank like this one's.
std::vector<std::string> CorrelatedWith(const Feature& feature, const std::vector<Feature>& features) {
  std::vector<std::string> inputs;
  if (feature.name != "x") return inputs;
  for (const Feature& other : features)
    if (other.name == "x" && FamilyOf(other.input) != FamilyOf(feature.input) &&
        std::fabs(RankCorrelation(feature.values, other.values)) > kCorrelated)
      inputs.push_back(other.input);
  return inputs;
}

/// The features of the rows that were asked for last: most metrics are defined for the same flights.
class FeaturesOfRows {
 public:
  FeaturesOfRows(const Campaign& campaign, const CaseColumns& cases) : campaign_(campaign), cases_(cases) {}

  const std::vector<Feature>& Of(const std::vector<std::size_t>& rows) {
    if (rows != rows_) features_.clear();
    if (rows != rows_) features_ = Features(campaign_, cases_, rows);
    rows_ = rows;
    return features_;
  }

 private:
  const Campaign& campaign_;
  const CaseColumns& cases_;
  std::vector<std::size_t> rows_;
  std::vector<Feature> features_;
};

MetricDrivers DriversOf(const std::string& metric, const CaseColumns& cases, FeaturesOfRows& known) {
  MetricDrivers result{metric, {}};
  const std::vector<double> values = CompletedValues(cases, metric);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < values.size() && rows.size() < kCauseFlights; ++i) {
    if (std::isfinite(values[i])) rows.push_back(i);
  }
  if (rows.size() < kLeastFlights) return result;
  const std::vector<double> y = Pick(values, rows);
  if (!Varies(y) || LiesAllAround(y, CircleOf(metric))) return result;
  const Ranked ranked_y(y);
  const std::vector<Feature>& features = known.Of(rows);

  // One driver an input: the index is that of the raw input, which no feature of it exceeds; the feature says
  // how.
  struct Candidate {
    std::size_t indexed = 0;  ///< the feature whose index counts
    std::size_t named = 0;    ///< the feature that correlates most
    double correlation = -1.0;
    double index = 0.0;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const bool pair = features[i].name.starts_with("m ");
    const double correlation = std::fabs(RankCorrelation(features[i].values, ranked_y));
    const auto same = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& other) {
      return !pair && features[other.indexed].input == features[i].input &&
             !features[other.indexed].name.starts_with("m ");
    });
    if (same == candidates.end()) {
      candidates.push_back({i, i, correlation, FirstOrderShare(features[i].values, y)});
    } else if (correlation > same->correlation) {
      same->named = i;
      same->correlation = correlation;
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.index > b.index; });
  std::vector<const Ranked*> named;
  for (const Candidate& candidate : candidates) {
    if (HasOrder(features[candidate.indexed])) named.push_back(&features[candidate.named].values);
  }
  const std::vector<double> partial = PartialRankCorrelations(named, ranked_y);
  std::size_t regressed = 0;
  std::vector<double> correlations;
  for (const Candidate& candidate : candidates)
    correlations.push_back(HasOrder(features[candidate.indexed]) ? partial[regressed++] : kUndefined);
  // What explains most is taken first, and the others only explain what it leaves.
  std::vector<double> rest = y;
  double left = 1.0;
  std::vector<bool> tried(candidates.size());
  std::vector<std::string> families;
  for (;;) {
    std::size_t best = candidates.size();
    double most = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (tried[i]) continue;
      const double share = FirstOrderShare(features[candidates[i].indexed].values, rest);
      if (share <= most) continue;
      most = share;
      best = i;
    }
    if (best == candidates.size() || most * left < kLeastShare) break;
    tried[best] = true;
    const Feature& feature = features[candidates[best].indexed];
    const SensitivityIndex index = FirstOrderIndex(feature.values, rest);
    if (!(index.low > 0.0)) continue;
    const std::string family = FamilyOf(feature.input);
    const auto known_family = std::find(families.begin(), families.end(), family);
    if (known_family == families.end()) {
      if (families.size() == kCauses) break;
      families.push_back(family);
      result.drivers.push_back({feature.input, feature.key, feature.same_as,
                                features[candidates[best].named].name, 0.0, 0.0, 0.0, correlations[best],
                                CorrelatedWith(feature, features)});
    }
    Driver& driver = result.drivers[static_cast<std::size_t>(
        std::find(families.begin(), families.end(), family) - families.begin())];
    driver.index += left * index.index;
    driver.low += left * index.low;
    driver.high = std::min(1.0, driver.high + left * index.high);
    rest = RestOf(feature.values, rest);
    left *= 1.0 - index.index;
  }
  std::stable_sort(result.drivers.begin(), result.drivers.end(),
                   [](const Driver& a, const Driver& b) { return a.index > b.index; });
  return result;
}

/// Normal scores of a feature over the marked rows, or over the others up to as many as tell a correlation.
std::vector<double> ScoresOf(const Ranked& values, const std::vector<bool>& marked, bool inside) {
  constexpr std::size_t kEnough = 5000;
  std::vector<double> scores;
  for (std::size_t i = 0; i < marked.size() && scores.size() < kEnough; ++i)
    if (marked[i] == inside)
      scores.push_back(NormalQuantile(values.ranks()[i] / (static_cast<double>(marked.size()) + 1.0)));
  // Of mean 0 and length 1, so that products sum to the correlation.
  const double mean = std::accumulate(scores.begin(), scores.end(), 0.0) /
                      static_cast<double>(std::max<std::size_t>(1, scores.size()));
  double squares = 0.0;
  for (double& score : scores) {
    score -= mean;
    squares += score * score;
  }
  const double length = std::sqrt(squares);
  if (length > 0.0)
    for (double& score : scores) score /= length;
  return scores;
}

/// Pairs whose correlation among the marked flights differs from that among the others, by R. A. Fisher's
/// transformation (Metron 1 (1921) 3-32). Where two inputs fail a flight each by itself, they stay
/// independent among the failing ones; only a combination relates them.
std::vector<FailurePair> PairsOf(const std::vector<Feature>& features, const std::vector<bool>& marked) {
  std::vector<const Feature*> single;
  std::vector<std::vector<double>> inside, outside;
  for (const Feature& feature : features) {
    if (!HasOrder(feature)) continue;
    single.push_back(&feature);
    inside.push_back(ScoresOf(feature.values, marked, true));
    outside.push_back(ScoresOf(feature.values, marked, false));
  }
  if (single.empty() || outside.front().size() < kLeastFlights) return {};
  const double error = std::sqrt(1.0 / (static_cast<double>(inside.front().size()) - 3.0) +
                                 1.0 / (static_cast<double>(outside.front().size()) - 3.0));
  std::vector<FailurePair> pairs;
  std::vector<double> p;
  for (std::size_t i = 0; i < single.size(); ++i) {
    for (std::size_t j = i + 1; j < single.size(); ++j) {
      if (FamilyOf(single[i]->input) == FamilyOf(single[j]->input)) continue;
      const auto correlation = [&](const std::vector<std::vector<double>>& scores) {
        return std::clamp(std::inner_product(scores[i].begin(), scores[i].end(), scores[j].begin(), 0.0),
                          -0.999999, 0.999999);
      };
      const double failing = correlation(inside);
      const double z = (std::atanh(failing) - std::atanh(correlation(outside))) / error;
      pairs.push_back({single[i]->input, single[j]->input, single[i]->key, single[j]->key, single[i]->name,
                       single[j]->name, failing, 2.0 * NormalProbability(-std::fabs(z)), 1.0});
      p.push_back(pairs.back().p);
    }
  }
  const std::vector<double> rates = FalseDiscoveryRates(p);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].false_discovery_rate = rates[i];
  std::erase_if(pairs,
                [](const FailurePair& pair) { return pair.false_discovery_rate > kFalseDiscoveryRate; });
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const FailurePair& a, const FailurePair& b) { return a.p < b.p; });
  // Two inputs once, by the features that show it most.
  std::vector<FailurePair> shown;
  for (FailurePair& pair : pairs) {
    const bool known = std::any_of(shown.begin(), shown.end(), [&](const FailurePair& other) {
      return other.first == pair.first && other.second == pair.second;
    });
    if (!known && shown.size() < kCauses) shown.push_back(std::move(pair));
  }
  return shown;
}

}  // namespace

std::vector<MetricDrivers> FindDrivers(const Campaign& campaign, const std::vector<std::string>& metrics,
                                       const CaseColumns& cases) {
  std::vector<MetricDrivers> drivers;
  FeaturesOfRows features(campaign, cases);
  for (const std::string& metric : metrics) drivers.push_back(DriversOf(metric, cases, features));
  return drivers;
}

std::vector<FailureDrivers> FindFailureDrivers(const Campaign& campaign, const CaseColumns& cases) {
  constexpr std::size_t kEnoughFailures = 10;
  std::vector<FailureDrivers> all;
  FeaturesOfRows known(campaign, cases);
  std::vector<Requirement> requirements = campaign.requirements;
  const std::size_t required = requirements.size();
  const std::vector<bool> beyond = BeyondCheckedLimits(campaign, cases);
  for (const LoadCheck& check : CheckLoads(campaign, cases))
    if (check.failures > 0)
      requirements.push_back({.metric = check.metric, .below = 1.0, .above = std::nullopt});
  for (std::size_t which = 0; which < requirements.size(); ++which) {
    const Requirement& requirement = requirements[which];
    FailureDrivers result{requirement.metric, false, 0, {}, {}};
    const Limits limits = LimitsOf(requirement);
    const std::vector<double> values = CompletedValues(cases, requirement.metric);
    // The first flights, and of those beyond them the failing: what they are held against stays a fair
    // sample.
    std::vector<std::size_t> rows;
    std::vector<bool> marked;
    for (std::size_t i = 0; i < values.size() && rows.size() < 2 * kCauseFlights; ++i) {
      const bool failed = which < required ? !limits.Meets(values[i]) : beyond[i];
      if (i >= kCauseFlights && !failed) continue;
      rows.push_back(i);
      marked.push_back(failed);
    }
    result.flights = static_cast<std::size_t>(std::count(marked.begin(), marked.end(), true));
    if (which >= required && result.flights < kEnoughFailures) continue;  // 0 or 1: none is nearest
    if (result.flights < kEnoughFailures && rows.size() >= kLeastFlights) {
      std::vector<double> margins;
      for (const std::size_t row : rows)
        margins.push_back(std::isfinite(values[row]) ? limits.Margin(values[row]) : -HUGE_VAL);
      std::vector<double> sorted = margins;
      std::sort(sorted.begin(), sorted.end());
      const double nearest = sorted[rows.size() / 10];
      for (std::size_t i = 0; i < rows.size(); ++i) marked[i] = margins[i] <= nearest;
      result.nearest = true;
      result.flights = static_cast<std::size_t>(std::count(marked.begin(), marked.end(), true));
    }
    static const std::vector<Feature> kNone;
    const std::vector<Feature>& features = rows.size() < kLeastFlights ? kNone : known.Of(rows);
    std::vector<double> p;
    for (const Feature& feature : features)
      p.push_back(feature.name == "which" ? 1.0 : RankSumP(feature.values, marked));
    const std::vector<double> rates = FalseDiscoveryRates(p);
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (rates[i] > kFalseDiscoveryRate) continue;
      double inside = 0.0, outside = 0.0;
      const std::vector<double>& ranks = features[i].values.ranks();
      for (std::size_t k = 0; k < rows.size(); ++k) (marked[k] ? inside : outside) += ranks[k];
      const auto in = static_cast<double>(result.flights);
      const bool larger = inside / in > outside / (static_cast<double>(rows.size()) - in);
      result.drivers.push_back(
          {features[i].input, features[i].key, features[i].name, larger, p[i], rates[i]});
    }
    std::stable_sort(result.drivers.begin(), result.drivers.end(),
                     [](const FailureDriver& a, const FailureDriver& b) { return a.p < b.p; });
    if (result.drivers.size() > kShown) result.drivers.resize(kShown);
    if (!result.nearest && result.flights >= kEnoughFailures) result.pairs = PairsOf(features, marked);
    all.push_back(std::move(result));
  }
  return all;
}

}  // namespace dispersa
