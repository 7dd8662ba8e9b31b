#include "core/campaign/distribution_fields.h"

#include <algorithm>

#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

// Keys of one distribution, in the units of one scalar, and what they set.
class DistributionFields {
 public:
  DistributionFields(Fields& fields, const DispersedScalar& scalar, ScalarDistribution& distribution)
      : fields_(fields),
        scalar_(scalar),
        spreads_(scalar.IsFactor() ? Dimension(kShare) : scalar.dimension),
        positions_(scalar.IsFactor() ? Dimension(kFactor) : scalar.dimension),
        distribution_(distribution) {}

  void Describe() {
    distribution_.nominal = scalar_.Nominal();
    std::vector<std::string> units;
    for (const Unit& unit : positions_) units.emplace_back(unit.suffix);
    fields_.Unclear(units, "'{}' alone does not say what it means (3 sigma, bound, corner, ...)",
                    Explanation(), [this] { DescribeKinds(); });
  }

 private:
  struct Kind {
    const char* word;
    Distribution kind;
    void (DistributionFields::*describe)();
  };

  void DescribeKinds() {
    using D = DistributionFields;
    constexpr Kind kKinds[] = {{"normal", Distribution::kNormal, &D::Normal},
                               {"uniform", Distribution::kUniform, &D::UniformOne},
                               {"two_point", Distribution::kTwoPoint, &D::TwoPoint},
                               {"values", Distribution::kValues, &D::Values},
                               {"constant", Distribution::kConstant, &D::ConstantOne},
                               {"truncated_normal", Distribution::kTruncatedNormal, &D::TruncatedNormal},
                               {"triangular", Distribution::kTriangular, &D::Triangular},
                               {"lognormal", Distribution::kLogNormal, &D::LogNormal},
                               {"rayleigh", Distribution::kRayleigh, &D::Sigma},
                               {"empirical", Distribution::kEmpirical, &D::Empirical}};
    std::vector<std::pair<std::string, Distribution>> choices;
    std::vector<Fields::Alternative> alternatives;
    std::vector<std::string> offered, refused;
    for (const Kind& kind : kKinds) {
      if (!Offers(kind.kind)) {
        refused.emplace_back(kind.word);
        continue;
      }
      offered.emplace_back(kind.word);
      choices.emplace_back(kind.word, kind.kind);
      alternatives.push_back(
          {Is("distribution", {kind.word}), [this, describe = kind.describe] { (this->*describe)(); }});
    }
    for (const std::string& word : refused)
      if (scalar_.IsFactor())
        fields_.NoChoice("distribution", word, "a factor is no magnitude",
                         "rayleigh for an angle, a length, a speed or a rate");
      else
        fields_.NoChoice("distribution", word, "'" + word + "' is not among those of this quantity",
                         "one of " + JoinWords(offered));
    fields_.Choice("distribution", choices, distribution_.kind, "kind of distribution");
    fields_.Either(alternatives);
    fields_.Check([&fields = fields_, scalar = scalar_, distribution = distribution_] {
      CheckRange(fields, scalar, distribution);
    });
  }
  bool Offers(Distribution kind) const {
    if (scalar_.kinds.empty()) return !(scalar_.IsFactor() && kind == Distribution::kRayleigh);
    return std::find(scalar_.kinds.begin(), scalar_.kinds.end(), kind) != scalar_.kinds.end();
  }

  // A value that can be drawn.
  void Position(const char* stem, double& value, const char* meaning) {
    fields_.Quantity(stem, positions_, kAnyNumber, value, meaning);
  }

  void Sigma() {
    std::size_t which = 0;
    double deviation = 0.0;
    fields_.OneOf({{"three_sigma", spreads_, kPositive, "three standard deviations"},
                   {"sigma", spreads_, kPositive, "the standard deviation"}},
                  which, deviation);
    distribution_.sigma = which == 0 ? deviation / 3.0 : deviation;
  }
  void Mean() {
    std::optional<double> mean;
    fields_.OptionalQuantity("mean", positions_, kAnyNumber, mean, "default: the nominal value");
    distribution_.nominal = mean.value_or(scalar_.Nominal());
  }
  // Both ends, of which neither has a default.
  void Ends() {
    Position("low", distribution_.low, "lower value");
    Position("high", distribution_.high, "upper value");
  }

  void Normal() {
    Sigma();
    Mean();
  }
  void TruncatedNormal() {
    Normal();
    Ends();
    // Beyond 6 sigma there is next to nothing to draw from.
    fields_.Check([&fields = fields_, d = distribution_] {
      if (!(d.low < d.nominal + 6.0 * d.sigma && d.high > d.nominal - 6.0 * d.sigma))
        fields.Refuse("", "the limits leave nothing of the normal",
                      "limits that reach into 6 sigma about the mean");
    });
  }
  void Triangular() {
    Ends();
    Position("mode", distribution_.nominal, "the most likely value");
    fields_.Check([&fields = fields_, d = distribution_] {
      if (!(d.low <= d.nominal && d.nominal <= d.high))
        fields.Refuse("", "the mode is not between the low and the high value", "low <= mode <= high");
    });
  }
  void LogNormal() {
    std::optional<double> median;
    if (scalar_.IsFactor())
      fields_.OptionalQuantity("median", positions_, kPositive, median, "default: 1");
    else
      fields_.Quantity("median", positions_, kPositive, median.emplace(), "half of the cases exceed it");
    distribution_.nominal = median.value_or(scalar_.Nominal());
    fields_.Number("sigma_log", kPositive, distribution_.sigma,
                   "standard deviation of the natural logarithm");
  }
  void Empirical() {
    fields_.Column("samples", positions_, kAnyNumber, 2, distribution_.values,
                   "to draw from; linear between the sorted samples");
    std::sort(distribution_.values.begin(), distribution_.values.end());
  }
  void UniformOne() { SpreadOrEnds("bound", "± about the nominal value"); }
  void TwoPoint() {
    SpreadOrEnds("plus_minus", "± about the nominal value: design corners, else equally likely");
  }
  void SpreadOrEnds(const char* stem, const char* meaning) {
    const std::string allowed = Join(Keys(stem, spreads_)) + ", or both " + Join(Keys("low", positions_)) +
                                " and " + Join(Keys("high", positions_));
    const auto ends = [&] {
      Ends();
      fields_.Misplaced(stem, spreads_, "the distribution is given twice", allowed.c_str());
    };
    const auto spread = [&](std::optional<double>& value) {
      fields_.OptionalQuantity(stem, spreads_, kPositive, value, meaning);
      distribution_.low = scalar_.Nominal() - value.value_or(0.0);
      distribution_.high = scalar_.Nominal() + value.value_or(0.0);
    };
    std::optional<double> value, unit_only;
    fields_.Either({{Has("low", positions_), ends},
                    {Has("high", positions_), ends},
                    {Has(stem, spreads_), [&] { spread(value); }},
                    {Else(), [&] {
                       spread(value);
                       fields_.OptionalQuantity("low", positions_, kAnyNumber, unit_only, "lower value");
                       fields_.OptionalQuantity("high", positions_, kAnyNumber, unit_only, "upper value");
                       fields_.Missing(Keys(stem, spreads_), allowed.c_str());
                     }}});
  }
  void Values() {
    fields_.Quantities("values", positions_, kAnyNumber, 1, SIZE_MAX, distribution_.values,
                       "of a grid or list, else drawn at random");
    fields_.Numbers("weights", kPositive, 0, SIZE_MAX, distribution_.weights,
                    "one per value; default: all equal");
    fields_.Check(
        [&fields = fields_, values = distribution_.values.size(), weights = distribution_.weights.size()] {
          if (weights != 0 && weights != values)
            fields.Refuse(
                "weights",
                "there are " + std::to_string(weights) + " weights for " + std::to_string(values) + " values",
                "one weight a value");
        });
  }
  void ConstantOne() {
    double value = scalar_.Nominal();
    Position("value", value, "the same in every case");
    distribution_ = Constant(value);
  }

  // ---- texts ----

  // three_sigma_deg, three_sigma_rad
  static std::vector<std::string> Keys(const std::string& stem, Dimension units) {
    std::vector<std::string> keys;
    for (const Unit& unit : units) keys.push_back(stem + "_" + std::string(unit.suffix));
    return keys;
  }
  static std::string Join(const std::vector<std::string>& keys) {
    std::string text;
    for (const std::string& key : keys) text += (text.empty() ? "" : " or ") + key;
    return text;
  }
  std::string Explanation() const {
    return "distribution: normal with " + Join(Keys("three_sigma", spreads_)) + " or " +
           Join(Keys("sigma", spreads_)) + "; uniform with " + Join(Keys("bound", spreads_)) +
           "; two_point with " + Join(Keys("plus_minus", spreads_)) + "; values with " +
           Join(Keys("values", positions_)) + "; constant with " + Join(Keys("value", positions_)) +
           "; truncated_normal, triangular, lognormal, rayleigh or empirical with theirs";
  }

  static void CheckRange(Fields& fields, const DispersedScalar& scalar, const ScalarDistribution& d) {
    std::vector<double> extremes = d.values;
    bool is_unlimited = false;  // what is drawn
    switch (d.kind) {
      case Distribution::kNormal:
        extremes = {d.nominal - 6.0 * d.sigma, d.nominal + 6.0 * d.sigma};
        is_unlimited = true;
        break;
      case Distribution::kLogNormal:
        extremes = {d.nominal * Exp(-6.0 * d.sigma), d.nominal * Exp(6.0 * d.sigma)};
        is_unlimited = true;
        break;
      case Distribution::kRayleigh:
        extremes = {0.0, 6.0 * d.sigma};
        is_unlimited = true;
        break;
      case Distribution::kUniform:
      case Distribution::kTwoPoint:
      case Distribution::kTriangular:
      case Distribution::kTruncatedNormal:
        extremes = {d.low, d.high};
        if (!(d.low < d.high)) fields.Refuse("", "the low value is not below the high value", "low < high");
        break;
      case Distribution::kValues:
      case Distribution::kConstant:
      case Distribution::kEmpirical:
        break;
    }
    const Unit unit = scalar.IsFactor() ? Unit{"factor", 1.0} : scalar.dimension.front();
    const auto found = std::find_if(extremes.begin(), extremes.end(),
                                    [&](double value) { return !scalar.range.Contains(value); });
    if (found == extremes.end()) return;
    fields.Refuse("",
                  (is_unlimited ? "a draw at 6 sigma is " : "a draw can be ") +
                      FormatRounded(*found / unit.scale) + " (" + std::string(unit.suffix) + ")",
                  scalar.range.Text(unit.scale));
  }

  Fields& fields_;
  const DispersedScalar& scalar_;
  const Dimension spreads_, positions_;  // units of deviations and of values
  ScalarDistribution& distribution_;
};

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

void DescribeDistribution(Fields& fields, const DispersedScalar& scalar, ScalarDistribution& distribution) {
  const std::string of = scalar.IsFactor() ? "factor" : std::string(scalar.dimension.front().suffix);
  fields.Group("distribution", of,
               [&](Fields& group) { DistributionFields(group, scalar, distribution).Describe(); });
}

void DescribeDirection(Fields& fields, const char* key, ScalarDistribution& direction, const char* meaning) {
  // A distribution about any direction may reach beyond a turn: angles wrap.
  constexpr Range kTurns = Between(-kTwoPi, kTwoPi), kDrawn = Between(-5.0 * kTwoPi, 5.0 * kTwoPi);
  bool is_uniform = true;
  fields.WordOrMap(key, "uniform", "a direction", "uniform, {fixed_deg: x} or a distribution", is_uniform,
                   meaning, [&](Fields& map) {
                     map.Either({{Has("distribution"),
                                  [&] {
                                    DescribeDistribution(map, {kAngle, kDrawn}, direction);
                                  }},
                                 {Else(), [&] {
                                    double angle_rad = 0.0;
                                    map.Quantity("fixed", kAngle, kTurns, angle_rad,
                                                 "the same in every case");
                                    direction = Constant(angle_rad);
                                  }}});
                   });
  if (is_uniform) direction = Uniform(0.0, kTwoPi);
}

bool DescribeFixedOrDrawn(Fields& fields, const char* stem, const DispersedScalar& scalar, bool needed,
                          ScalarDistribution& distribution, const char* meaning) {
  bool is_drawn = false;
  std::optional<double> fixed;
  fields.Either({{HasMap(stem),
                  [&] {
                    is_drawn = true;
                    fields.Map(stem, meaning,
                               [&](Fields& map) { DescribeDistribution(map, scalar, distribution); });
                  }},
                 {Else(), [&] {
                    if (needed)
                      fields.Quantity(stem, scalar.dimension, scalar.range, fixed.emplace(), meaning);
                    else
                      fields.OptionalQuantity(stem, scalar.dimension, scalar.range, fixed, meaning);
                  }}});
  if (fixed && !is_drawn) distribution = Constant(*fixed);
  return is_drawn || fixed;
}

}  // namespace dispersa
