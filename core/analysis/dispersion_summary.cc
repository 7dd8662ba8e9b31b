#include "core/analysis/dispersion_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/campaign/dispersion_table.h"
#include "core/campaign/plausible_dispersions.h"
#include "core/flight/flight_inputs.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"
#include "core/statistics/normal.h"

namespace dispersa {
namespace {

/// Longer lists of values are told by their number.
constexpr std::size_t kListedValues = 20;

/// Mean, standard deviation and kurtosis (fourth central moment over the squared variance).
struct Moments {
  double mean = 0.0;
  double std = 0.0;
  double kurtosis = 1.0;
};

Moments OfValues(const std::vector<double>& values) {
  Moments moments;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) moments.mean += value / n;
  double second = 0.0;
  double fourth = 0.0;
  for (const double value : values) {
    const double square = (value - moments.mean) * (value - moments.mean);
    second += square / n;
    fourth += square * square / n;
  }
  moments.std = std::sqrt(second);
  if (second > 0.0) moments.kurtosis = fourth / (second * second);
  return moments;
}

Moments OfWeighted(const Dispersion& dispersion) {
  const ScalarDistribution& d = dispersion.distribution;
  double total = 0.0;
  for (const double weight : d.weights) total += weight;
  Moments moments{0.0, 0.0, 1.0};
  const auto value = [&](std::size_t i) {
    return dispersion.absolute ? std::fabs(d.values[i]) : d.values[i];
  };
  for (std::size_t i = 0; i < d.values.size(); ++i) moments.mean += d.weights[i] / total * value(i);
  double second = 0.0, fourth = 0.0;
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    const double square = (value(i) - moments.mean) * (value(i) - moments.mean);
    second += d.weights[i] / total * square;
    fourth += d.weights[i] / total * square * square;
  }
  moments.std = std::sqrt(second);
  if (second > 0.0) moments.kurtosis = fourth / (second * second);
  return moments;
}

/// Moments of the magnitude of a normal: the folded normal distribution.
Moments FoldedNormal(double mean, double sigma) {
  using std::numbers::pi;
  const double ratio = mean / sigma;
  const double folded = sigma * std::sqrt(2.0 / pi) * std::exp(-0.5 * ratio * ratio) +
                        mean * std::erf(ratio / std::numbers::sqrt2);
  const double variance = mean * mean + sigma * sigma - folded * folded;
  // Kurtosis of the half-normal, the heaviest tail of the family.
  return {folded, std::sqrt(variance), 3.87};
}

double QuantileOf(const ScalarDistribution& d, double u) {
  switch (d.kind) {
    case Distribution::kTruncatedNormal: {
      const double from = NormalProbability((d.low - d.nominal) / d.sigma);
      const double to = NormalProbability((d.high - d.nominal) / d.sigma);
      return d.nominal + d.sigma * NormalQuantile(from + (to - from) * u);
    }
    case Distribution::kLogNormal:
      return d.nominal * std::exp(d.sigma * NormalQuantile(u));
    case Distribution::kRayleigh:
      return d.sigma * std::sqrt(-2.0 * std::log1p(-u));
    case Distribution::kTriangular: {
      const double rising = (d.nominal - d.low) / (d.high - d.low);
      return u < rising ? d.low + std::sqrt(u * (d.high - d.low) * (d.nominal - d.low))
                        : d.high - std::sqrt((1.0 - u) * (d.high - d.low) * (d.high - d.nominal));
    }
    default:
      return Quantile(d.values, u);
  }
}

/// From the quantiles in the middle of many equal parts. This is exact enough to tell a draw from another
/// distribution.
Moments ByQuantiles(const Dispersion& dispersion) {
  constexpr int kParts = 20000;
  std::vector<double> values;
  for (int i = 0; i < kParts; ++i) {
    const double value = QuantileOf(dispersion.distribution, (i + 0.5) / kParts);
    values.push_back(dispersion.absolute ? std::fabs(value) : value);
  }
  return OfValues(values);
}

/// None if taking the magnitude of the draw makes it a distribution that the cases below do not cover.
std::optional<Moments> Of(const Dispersion& dispersion) {
  const ScalarDistribution& d = dispersion.distribution;
  switch (d.kind) {
    case Distribution::kConstant:
      return Moments{dispersion.absolute ? std::fabs(d.nominal) : d.nominal, 0.0, 1.0};
    case Distribution::kValues: {
      if (!d.weights.empty()) return OfWeighted(dispersion);
      std::vector<double> values = d.values;
      if (dispersion.absolute) {
        for (double& value : values) value = std::fabs(value);
      }
      return OfValues(values);
    }
    case Distribution::kNormal:
      if (dispersion.absolute && d.sigma > 0.0) return FoldedNormal(d.nominal, d.sigma);
      return Moments{d.nominal, d.sigma, 3.0};
    case Distribution::kUniform:
      if (dispersion.absolute && d.low < 0.0) return std::nullopt;
      return Moments{0.5 * (d.low + d.high), (d.high - d.low) / std::sqrt(12.0), 1.8};
    case Distribution::kTwoPoint:
      if (dispersion.absolute && d.low < 0.0) return std::nullopt;
      return Moments{0.5 * (d.low + d.high), 0.5 * (d.high - d.low), 1.0};
    case Distribution::kTruncatedNormal:
    case Distribution::kLogNormal:
    case Distribution::kRayleigh:
    case Distribution::kTriangular:
    case Distribution::kEmpirical:
      return ByQuantiles(dispersion);
  }
  return std::nullopt;
}

std::string Words(const Dispersion& dispersion, double unit, const std::string& unit_name) {
  const ScalarDistribution& d = dispersion.distribution;
  const auto text = [&](double value) { return ReadableText(value / unit); };
  const std::string suffix = unit_name.empty() ? "" : " " + unit_name;
  std::string words;
  switch (d.kind) {
    case Distribution::kConstant:
      words = "constant " + text(d.nominal) + suffix;
      break;
    case Distribution::kNormal:
      words = fmt::format("normal, mean {}{}, 3σ {}{}", text(d.nominal), suffix, text(3.0 * d.sigma), suffix);
      break;
    case Distribution::kUniform:
      words = fmt::format("uniform, {} to {}{}", text(d.low), text(d.high), suffix);
      break;
    case Distribution::kTwoPoint:
      words = fmt::format("{} or {}{}", text(d.low), text(d.high), suffix);
      break;
    case Distribution::kTruncatedNormal:
      words = fmt::format("normal, mean {}{}, 3σ {}{}, truncated to {} to {}{}", text(d.nominal), suffix,
                          text(3.0 * d.sigma), suffix, text(d.low), text(d.high), suffix);
      break;
    case Distribution::kLogNormal:
      words = fmt::format("lognormal, median {}{}, σ of the logarithm {}", text(d.nominal), suffix,
                          ReadableText(d.sigma));
      break;
    case Distribution::kRayleigh:
      words = fmt::format("Rayleigh, σ {}{}", text(d.sigma), suffix);
      break;
    case Distribution::kTriangular:
      words = fmt::format("triangular, {} to {}{}, mode {}{}", text(d.low), text(d.high), suffix,
                          text(d.nominal), suffix);
      break;
    case Distribution::kEmpirical:
      words = fmt::format("as a sample of {}, {} to {}{}", d.values.size(), text(d.values.front()),
                          text(d.values.back()), suffix);
      break;
    case Distribution::kValues:
      words = "one of";
      if (d.values.size() > kListedValues)
        words += fmt::format(" {} values, {} to {}", d.values.size(), text(d.values.front()),
                             text(d.values.back()));
      else
        for (const double value : d.values) words += " " + text(value);
      words += suffix;
      if (!d.weights.empty() && d.values.size() > kListedValues) {
        words += " by weight";
      } else if (!d.weights.empty()) {
        words += " with weights";
        for (const double weight : d.weights) words += " " + ReadableText(weight);
      }
      break;
  }
  if (!dispersion.mix.empty()) words += ", correlated";
  return dispersion.absolute ? "magnitude of " + words : words;
}

/// Within 5 standard errors of the mean and of the standard deviation. The latter is approximated by the
/// delta method: sigma sqrt((kurtosis - 1) / 4n). A small allowance covers rounding if all values are equal.
bool Agrees(const Moments& expected, const Summary& drawn) {
  const auto n = static_cast<double>(drawn.n);
  const double slack = 1e-9 * (std::fabs(expected.mean) + expected.std);
  const double mean_error = expected.std / std::sqrt(n);
  const double std_error = expected.std * (std::sqrt((expected.kurtosis - 1.0) / (4.0 * n)) + 1.0 / n);
  return std::fabs(drawn.mean - expected.mean) <= 5.0 * mean_error + slack &&
         std::fabs(drawn.std - expected.std) <= 5.0 * std_error + slack;
}

bool IsAnyDirection(const ScalarDistribution& d, const InputColumn& column, const Circle& circle) {
  return circle.is_closed() && d.kind == Distribution::kUniform &&
         (d.high - d.low) / column.unit > circle.turn * (1.0 - 1e-9);
}

/// Directions near to the declared mean. Where they lie all around there is no mean to compare; the check
/// uses the values as they are drawn.
void SetDrawn(const Dispersion& dispersion, const InputColumn& column, const std::optional<Moments>& expected,
              std::vector<double> values, DispersionSummary& summary) {
  const Circle circle = CircleOf(column);
  const bool around =
      IsAnyDirection(dispersion.distribution, column, circle) || LiesAllAround(values, circle);
  if (!around && expected)
    for (double& value : values) value = NearTo(expected->mean, value, circle);
  else
    values = Unwrapped(std::move(values), circle);
  summary.drawn = Summarize(std::move(values));
  if (expected && summary.drawn.n >= 10) summary.consistent = Agrees(*expected, summary.drawn);
  if (around) {
    summary.drawn = {.n = summary.drawn.n, .undefined = summary.drawn.undefined};
  } else if (expected) {
    summary.expected_mean = expected->mean;
    summary.expected_std = expected->std;
  }
}

}  // namespace

std::vector<DispersionSummary> SummarizeDispersions(const Campaign& campaign, const CaseColumns& cases) {
  std::vector<int> feeders(InputColumns().size(), 0);
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) ++feeders[static_cast<std::size_t>(input)];
  }
  const std::vector<SetInput> set = SetInputs(campaign);
  const auto why_unread = [&](int input) {
    const auto found =
        std::find_if(set.begin(), set.end(), [&](const SetInput& one) { return one.column == input; });
    return found == set.end() ? std::string() : found->unread;
  };
  std::vector<DispersionSummary> summaries;
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) {
      const InputColumn& column = InputColumns()[static_cast<std::size_t>(input)];
      DispersionSummary summary;
      summary.dispersion = dispersion.name;
      summary.input = column.name;
      summary.key = InputKey(campaign, input);
      summary.unread = why_unread(input);
      summary.declared = Words(dispersion, column.unit, SplitUnit(column.name).unit);
      std::optional<Moments> expected = Of(dispersion);
      const bool alone = feeders[static_cast<std::size_t>(input)] == 1;
      if (!alone || IsEnumerated(campaign.sampling.method)) expected.reset();
      if (expected) {
        expected->mean /= column.unit;
        expected->std /= column.unit;
      }
      SetDrawn(dispersion, column, expected, cases.inputs[static_cast<std::size_t>(input)], summary);
      summaries.push_back(std::move(summary));
    }
  }
  for (const DerivedInput& derived : campaign.derived) {
    DispersionSummary summary;
    summary.dispersion = "derived";
    summary.input = derived.input;
    summary.key = "derived";
    summary.unread = why_unread(derived.column);
    summary.declared = "= " + derived.text;
    const auto column = static_cast<std::size_t>(derived.column);
    summary.drawn = Summarize(cases.inputs[column], CircleOf(InputColumns()[column]));
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace dispersa
