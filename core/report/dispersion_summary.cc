#include "core/report/dispersion_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/flight/flight_inputs.h"
#include "core/report/metric_catalogue.h"
#include "core/report/sampling_text.h"
#include "core/report/text.h"

namespace dispersa {
namespace {

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

/// Of the magnitude of a normal: the folded normal distribution.
Moments FoldedNormal(double mean, double sigma) {
  using std::numbers::pi;
  const double ratio = mean / sigma;
  const double folded = sigma * std::sqrt(2.0 / pi) * std::exp(-0.5 * ratio * ratio) +
                        mean * std::erf(ratio / std::numbers::sqrt2);
  const double variance = mean * mean + sigma * sigma - folded * folded;
  // Kurtosis of the half-normal, the heaviest tail of the family.
  return {folded, std::sqrt(variance), 3.87};
}

/// None where the magnitude of the draw makes it another distribution than the catalogue below knows.
std::optional<Moments> Of(const Dispersion& dispersion) {
  const ScalarDistribution& d = dispersion.distribution;
  switch (d.kind) {
    case Distribution::kConstant:
      return Moments{dispersion.absolute ? std::fabs(d.nominal) : d.nominal, 0.0, 1.0};
    case Distribution::kValues: {
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
    case Distribution::kValues:
      words = "one of";
      for (const double value : d.values) words += " " + text(value);
      words += suffix;
      break;
  }
  return dispersion.absolute ? "magnitude of " + words : words;
}

/// 5 standard errors: of the mean, and of the standard deviation by its delta-method approximation
/// sigma sqrt((kurtosis - 1) / 4n), with a little for what rounding does to values without any spread.
bool Agrees(const Moments& expected, const Summary& drawn) {
  const auto n = static_cast<double>(drawn.n);
  const double slack = 1e-9 * (std::fabs(expected.mean) + expected.std);
  const double mean_error = expected.std / std::sqrt(n);
  const double std_error = expected.std * (std::sqrt((expected.kurtosis - 1.0) / (4.0 * n)) + 1.0 / n);
  return std::fabs(drawn.mean - expected.mean) <= 5.0 * mean_error + slack &&
         std::fabs(drawn.std - expected.std) <= 5.0 * std_error + slack;
}

}  // namespace

std::vector<int> DispersedInputs(const Campaign& campaign) {
  std::vector<int> inputs;
  for (const Dispersion& dispersion : campaign.dispersions) {
    inputs.insert(inputs.end(), dispersion.inputs.begin(), dispersion.inputs.end());
  }
  std::sort(inputs.begin(), inputs.end());
  inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
  return inputs;
}

std::vector<DispersionSummary> SummarizeDispersions(const Campaign& campaign, const CaseColumns& cases) {
  std::vector<int> feeders(InputColumns().size(), 0);
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) ++feeders[static_cast<std::size_t>(input)];
  }
  std::vector<DispersionSummary> summaries;
  for (const Dispersion& dispersion : campaign.dispersions) {
    for (const int input : dispersion.inputs) {
      const InputColumn& column = InputColumns()[static_cast<std::size_t>(input)];
      DispersionSummary summary;
      summary.dispersion = dispersion.name;
      summary.input = column.name;
      summary.declared = Words(dispersion, column.unit, SplitUnit(column.name).unit);
      summary.drawn = Summarize(cases.inputs[static_cast<std::size_t>(input)]);
      std::optional<Moments> expected = Of(dispersion);
      const bool alone = feeders[static_cast<std::size_t>(input)] == 1;
      if (expected && alone && !IsEnumerated(campaign.sampling.method)) {
        expected->mean /= column.unit;
        expected->std /= column.unit;
        summary.expected_mean = expected->mean;
        summary.expected_std = expected->std;
        if (summary.drawn.n >= 10) summary.consistent = Agrees(*expected, summary.drawn);
      }
      summaries.push_back(std::move(summary));
    }
  }
  return summaries;
}

}  // namespace dispersa
