#include "core/campaign_yaml/decode_distribution.h"

#include <algorithm>
#include <cmath>

#include "core/input/number_text.h"

namespace dispersa {
namespace {

constexpr Unit kFactorSpread[] = {{"percent", 0.01}};
constexpr Unit kFactorPosition[] = {{"percent", 0.01}, {"factor", 1.0}};

// Keys of one distribution, in the units of one scalar.
class ParameterReader {
 public:
  ParameterReader(MapReader& map, const DispersedScalar& scalar) : map_(map), scalar_(scalar) {}

  // A deviation: sigma, bound.
  std::optional<double> Spread(const std::string& stem) {
    return map_.OptionalQuantity(stem, scalar_.IsFactor() ? Dimension(kFactorSpread) : scalar_.dimension,
                                 kPositive);
  }

  // A value that can be drawn.
  std::optional<double> Position(const std::string& stem) {
    std::string key;
    const auto value = map_.OptionalQuantity(stem, PositionUnits(), kAnyNumber, &key);
    if (!value) return std::nullopt;
    return *value + Offset(key);
  }

  std::vector<double> Positions(const std::string& stem) {
    std::string key;
    std::vector<double> values = map_.Quantities(stem, PositionUnits(), kAnyNumber, 1, SIZE_MAX, &key);
    for (double& value : values) value += Offset(key);
    return values;
  }

  // three_sigma_deg, three_sigma_rad
  std::vector<std::string> KeyList(const std::string& stem, bool spread) const {
    std::vector<std::string> keys;
    const Dimension factor = spread ? Dimension(kFactorSpread) : Dimension(kFactorPosition);
    for (const Unit& unit : scalar_.IsFactor() ? factor : scalar_.dimension) {
      keys.push_back(stem + "_" + std::string(unit.suffix));
    }
    return keys;
  }

  // "three_sigma_deg or three_sigma_rad"
  std::string Keys(const std::string& stem, bool spread) const {
    std::string text;
    for (const std::string& key : KeyList(stem, spread)) text += (text.empty() ? "" : " or ") + key;
    return text;
  }

 private:
  Dimension PositionUnits() const {
    return scalar_.IsFactor() ? Dimension(kFactorPosition) : scalar_.dimension;
  }
  double Offset(const std::string& key) const {
    return scalar_.IsFactor() && key.ends_with("_percent") ? 1.0 : 0.0;
  }

  MapReader& map_;
  const DispersedScalar& scalar_;
};

// Some distribution has a parameter of this name.
bool IsParameter(const std::string& key) {
  constexpr const char* kStems[] = {"three_sigma", "sigma", "mean", "bound",  "plus_minus", "low",
                                    "high",        "value", "mode", "median", "weights",    "samples"};
  return std::any_of(std::begin(kStems), std::end(kStems),
                     [&](const char* stem) { return key.starts_with(stem); });
}

// The parameters that each distribution takes, in words.
std::string Explain(const ParameterReader& keys) {
  return "distribution: normal with " + keys.Keys("three_sigma", true) + " or " + keys.Keys("sigma", true) +
         "; uniform with " + keys.Keys("bound", true) + "; two_point with " + keys.Keys("plus_minus", true) +
         "; values with " + keys.Keys("values", false) + "; constant with " + keys.Keys("value", false) +
         "; truncated_normal, triangular, lognormal, rayleigh or empirical with theirs";
}

void CheckRange(const MapReader& map, const DispersedScalar& scalar, const ScalarDistribution& distribution) {
  std::vector<double> extremes;
  switch (distribution.kind) {
    case Distribution::kNormal:
      extremes = {distribution.nominal - 6.0 * distribution.sigma,
                  distribution.nominal + 6.0 * distribution.sigma};
      break;
    case Distribution::kLogNormal:
      extremes = {distribution.nominal * std::exp(-6.0 * distribution.sigma),
                  distribution.nominal * std::exp(6.0 * distribution.sigma)};
      break;
    case Distribution::kRayleigh:
      extremes = {0.0, 6.0 * distribution.sigma};
      break;
    case Distribution::kUniform:
    case Distribution::kTwoPoint:
    case Distribution::kTriangular:
    case Distribution::kTruncatedNormal:
      extremes = {distribution.low, distribution.high};
      if (!(distribution.low < distribution.high)) {
        AddProblem(map.problems(), map.node(), map.path(), "the low value is not below the high value",
                   "low < high");
      }
      break;
    case Distribution::kValues:
    case Distribution::kConstant:
    case Distribution::kEmpirical:
      extremes = distribution.values;
      break;
  }
  const double scale = scalar.IsFactor() ? 1.0 : scalar.dimension.front().scale;
  const std::string unit = scalar.IsFactor() ? "factor" : std::string(scalar.dimension.front().suffix);
  for (const double value : extremes) {
    if (scalar.range.Contains(value)) continue;
    const bool normal = distribution.kind == Distribution::kNormal ||
                        distribution.kind == Distribution::kLogNormal ||
                        distribution.kind == Distribution::kRayleigh;
    AddProblem(map.problems(), map.node(), map.path(),
               std::string(normal ? "a draw at 6 sigma is " : "a draw can be ") +
                   FormatRounded(value / scale) + " (" + unit + ")",
               scalar.range.Text(scale));
    return;
  }
}

}  // namespace

ScalarDistribution Constant(double value) {
  ScalarDistribution constant;
  constant.nominal = value;
  constant.values = {value};
  return constant;
}

ScalarDistribution Uniform(double low, double high) {
  ScalarDistribution uniform;
  uniform.kind = Distribution::kUniform;
  uniform.nominal = 0.5 * (low + high);
  uniform.low = low;
  uniform.high = high;
  return uniform;
}

ScalarDistribution ReadDistribution(MapReader& map, const DispersedScalar& scalar) {
  ParameterReader keys(map, scalar);
  ScalarDistribution distribution;
  distribution.nominal = scalar.Nominal();
  const std::size_t before = map.problems().size();

  for (const InputMember& member : map.node().members) {
    const Dimension units = scalar.IsFactor() ? Dimension(kFactorPosition) : scalar.dimension;
    const bool bare =
        std::any_of(units.begin(), units.end(), [&](const Unit& u) { return u.suffix == member.key; });
    if (!bare) continue;
    map.Ignore(member.key);
    map.Ignore("distribution");
    InputNode at = MapAt(member.value);
    at.line = member.line;
    at.column = member.column;
    AddProblem(map.problems(), at, map.PathOf(member.key),
               "'" + member.key + "' alone does not say what it means (3 sigma, bound, corner, ...)",
               Explain(keys));
  }
  if (map.problems().size() > before) return distribution;

  distribution.kind =
      map.Choice<Distribution>("distribution", {{"normal", Distribution::kNormal},
                                                {"uniform", Distribution::kUniform},
                                                {"two_point", Distribution::kTwoPoint},
                                                {"values", Distribution::kValues},
                                                {"constant", Distribution::kConstant},
                                                {"truncated_normal", Distribution::kTruncatedNormal},
                                                {"triangular", Distribution::kTriangular},
                                                {"lognormal", Distribution::kLogNormal},
                                                {"rayleigh", Distribution::kRayleigh},
                                                {"empirical", Distribution::kEmpirical}});
  const bool known = map.node().Find("distribution") != nullptr && map.problems().size() == before;
  if (!known) {
    // Which parameters belong here is unknown too.
    for (const InputMember& member : map.node().members) {
      if (IsParameter(member.key)) map.Ignore(member.key);
    }
    return distribution;
  }

  const auto exactly_one = [&](bool first, bool second, std::vector<std::string> missing,
                               const std::string& allowed) {
    if (!first && !second) {
      map.ReportMissing(std::move(missing), allowed);
    } else if (first && second) {
      AddProblem(map.problems(), map.node(), map.path(), "the distribution is given twice", allowed);
    }
    return first != second;
  };
  bool complete = false;
  const auto read_sigma = [&] {
    const auto three_sigma = keys.Spread("three_sigma");
    const auto sigma = keys.Spread("sigma");
    std::vector<std::string> missing = keys.KeyList("three_sigma", true);
    for (std::string& key : keys.KeyList("sigma", true)) missing.push_back(std::move(key));
    complete = exactly_one(three_sigma.has_value(), sigma.has_value(), std::move(missing),
                           "one number above 0, 3 sigma or 1 sigma");
    distribution.sigma = sigma ? *sigma : three_sigma.value_or(0.0) / 3.0;
  };
  // Both ends, of which neither has a default.
  const auto read_ends = [&] {
    const auto low = keys.Position("low");
    const auto high = keys.Position("high");
    if (!low) map.ReportMissing(keys.KeyList("low", false), "a number below the high value");
    if (!high) map.ReportMissing(keys.KeyList("high", false), "a number above the low value");
    distribution.low = low.value_or(0.0);
    distribution.high = high.value_or(0.0);
    return low && high;
  };
  switch (distribution.kind) {
    case Distribution::kNormal:
      read_sigma();
      distribution.nominal = keys.Position("mean").value_or(scalar.Nominal());
      break;
    case Distribution::kTruncatedNormal:
      read_sigma();
      distribution.nominal = keys.Position("mean").value_or(scalar.Nominal());
      complete = read_ends() && complete;
      // Beyond 6 sigma there is next to nothing to draw from.
      if (complete && !(distribution.low < distribution.nominal + 6.0 * distribution.sigma &&
                        distribution.high > distribution.nominal - 6.0 * distribution.sigma)) {
        AddProblem(map.problems(), map.node(), map.path(), "the limits leave nothing of the normal",
                   "limits that reach into 6 sigma about the mean");
      }
      break;
    case Distribution::kTriangular: {
      complete = read_ends();
      const auto mode = keys.Position("mode");
      if (!mode) map.ReportMissing(keys.KeyList("mode", false), "the most likely value");
      distribution.nominal = mode.value_or(scalar.Nominal());
      if (complete && mode && !(distribution.low <= *mode && *mode <= distribution.high)) {
        AddProblem(map.problems(), map.node(), map.path(),
                   "the mode is not between the low and the high value", "low <= mode <= high");
      }
      complete = complete && mode.has_value();
      break;
    }
    case Distribution::kLogNormal: {
      const auto median = keys.Position("median");
      if (!median && !scalar.IsFactor()) map.ReportMissing(keys.KeyList("median", false), "a number above 0");
      distribution.nominal = median.value_or(scalar.Nominal());
      distribution.sigma = map.Number("sigma_log", kPositive);
      complete = distribution.sigma > 0.0 && (median || scalar.IsFactor());
      if (complete && distribution.nominal <= 0.0) {
        AddProblem(map.problems(), map.node(), map.path(), "the median is not above 0", "a median above 0");
      }
      break;
    }
    case Distribution::kRayleigh:
      read_sigma();
      if (scalar.IsFactor()) {
        AddProblem(map.problems(), map.node(), map.path(), "a factor is no magnitude",
                   "rayleigh for an angle, a length, a speed or a rate");
      }
      break;
    case Distribution::kEmpirical:
      distribution.values = keys.Positions("samples");
      std::sort(distribution.values.begin(), distribution.values.end());
      complete = distribution.values.size() >= 2;
      if (distribution.values.size() == 1) {
        AddProblem(map.problems(), map.node(), map.path(), "one sample is no distribution",
                   "two samples or more");
      }
      break;
    case Distribution::kUniform:
    case Distribution::kTwoPoint: {
      const std::string stem = distribution.kind == Distribution::kUniform ? "bound" : "plus_minus";
      const auto spread = keys.Spread(stem);
      const auto low = keys.Position("low");
      const auto high = keys.Position("high");
      complete =
          exactly_one(spread.has_value(), low.has_value() || high.has_value(), keys.KeyList(stem, true),
                      keys.Keys(stem, true) + ", or both " + keys.Keys("low", false) + " and " +
                          keys.Keys("high", false));
      if (complete && !spread && !low)
        map.ReportMissing(keys.KeyList("low", false), "a number below the high value");
      if (complete && !spread && !high)
        map.ReportMissing(keys.KeyList("high", false), "a number above the low value");
      complete = complete && (spread || (low && high));
      distribution.low = spread ? scalar.Nominal() - *spread : low.value_or(0.0);
      distribution.high = spread ? scalar.Nominal() + *spread : high.value_or(0.0);
      break;
    }
    case Distribution::kValues:
      distribution.values = keys.Positions("values");
      complete = !distribution.values.empty();
      if (map.Optional("weights") != nullptr) {
        distribution.weights = map.Numbers("weights", kPositive, 1);
        if (distribution.weights.size() != distribution.values.size() && complete) {
          AddProblem(map.problems(), *map.node().Find("weights"), map.PathOf("weights"),
                     "there are " + std::to_string(distribution.weights.size()) + " weights for " +
                         std::to_string(distribution.values.size()) + " values",
                     "one weight a value");
        }
      }
      break;
    case Distribution::kConstant: {
      const auto value = keys.Position("value");
      complete = exactly_one(value.has_value(), false, keys.KeyList("value", false), "a number");
      distribution = Constant(value.value_or(scalar.Nominal()));
      break;
    }
  }
  if (complete && map.problems().size() == before) CheckRange(map, scalar, distribution);
  return distribution;
}

ScalarDistribution ReadDirection(const InputNode& node, const std::string& path,
                                 std::vector<InputProblem>& problems) {
  const std::string allowed = "uniform, {fixed_deg: x} or a distribution";
  if (node.kind == InputNode::Kind::kScalar) {
    if (node.text != "uniform")
      AddProblem(problems, node, path, node.Describe() + " is not a direction", allowed);
    return Uniform(0.0, kTwoPi);
  }
  MapReader map(node, path, problems);
  SayExpects(path, {.kind = Expectation::Kind::kWords, .words = {"uniform"}});
  if (map.Peek("distribution") != nullptr) return ReadDistribution(map, {kAngle, Between(-kTwoPi, kTwoPi)});
  return Constant(map.Quantity("fixed", kAngle, Between(-kTwoPi, kTwoPi)));
}

}  // namespace dispersa
