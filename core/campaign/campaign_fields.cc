#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/campaign/campaign.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

// A stream's index is 32 bits wide.
constexpr std::uint64_t kMaxCases = 4294967295;
constexpr std::uint64_t kMaxReplicates = 10000;
// A workstation has so much for each process that flies.
constexpr double kMaxDesignBytes = 4e9;
// More looks than these are better served by an anytime plan.
constexpr std::uint64_t kMaxLooks = 100;
// Each of more would have next to no risk to spend.
constexpr std::uint64_t kMaxAttempts = 100;
constexpr std::int64_t kMaxCornerFactors = 20;

// How often one requirement, or all of them, may be looked at. `plan` is what holds without these keys.
void DescribeLooks(Fields& fields, VerdictPlan& plan) {
  fields.Either({{Has("looks"),
                  [&] {
                    fields.Misplaced("anytime", {}, "'looks' and 'anytime' are both given",
                                     "either looks: K or anytime: true");
                    fields.Integer("looks", 1, kMaxLooks, plan.looks,
                                   "at the counts, evenly spaced; the last at all cases");
                    plan.kind = plan.looks > 1 ? PlanKind::kGroupSequential : PlanKind::kFixed;
                  }},
                 {Has("anytime"), [&] {
                    bool anytime = false;
                    fields.Flag("anytime", anytime, false, "looks whenever, as often as one likes");
                    plan.kind = anytime ? PlanKind::kAnytime : PlanKind::kFixed;
                  }}});
  if (plan.kind != PlanKind::kGroupSequential) plan.looks = 1;
  fields.When(Has("spending"), [&] {
    fields.Choice<Spending>("spending",
                            {{"obrien_fleming", Spending::kOBrienFleming}, {"pocock", Spending::kPocock}},
                            plan.spending, "how several looks share the risk: little early, or evenly");
    if (plan.kind != PlanKind::kGroupSequential)
      fields.Refuse("spending", "looks is 1: no other analysis shares the risk", "looks: 2 or more");
  });
}

void DescribePlan(Fields& fields, VerdictPlan& plan) {
  fields.Group("plan", "verdict", [&](Fields& group) { DescribeLooks(group, plan); });
}

// To the digits that people write: 1 - 0.95 is 0.05.
double ShortShare(double value) { return std::round(value * 1e9) / 1e9; }

// The rows of L with L L^T = the correlations; empty unless they are positive definite.
std::vector<std::vector<double>> Cholesky(const std::vector<std::vector<double>>& matrix) {
  std::vector<std::vector<double>> factor(matrix.size());
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      if (i == j && !(rest > 1e-12)) return {};
      factor[i].push_back(i == j ? Sqrt(rest) : rest / factor[j][j]);
    }
  }
  return factor;
}

// Which correlation contradicts the others most, and what of all would be possible. The direction of the
// smallest eigenvalue is a sum of the quantities with a negative variance.
std::string WhyImpossible(const std::vector<std::string>& names,
                          const std::vector<std::vector<double>>& matrix) {
  const auto size = static_cast<Eigen::Index>(matrix.size());
  Eigen::MatrixXd correlations(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      correlations(i, j) = matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlations);
  const Eigen::VectorXd sum = solver.eigenvectors().col(0);
  Eigen::Index first = 1, second = 0;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (const double part = sum(i) * sum(j) * correlations(i, j); part < worst) {
        worst = part;
        first = i;
        second = j;
      }
  // All of them times this have the smallest eigenvalue 0; a little less holds.
  const double factor = std::floor(99.0 / (1.0 - solver.eigenvalues()(0))) / 100.0;
  return "'" + names[static_cast<std::size_t>(second)] + "' with '" + names[static_cast<std::size_t>(first)] +
         "' contributes most; all correlations times " + FormatNumber(factor) + " can hold";
}

// The positions of the dispersions with these names; those that cannot be correlated are refused.
std::vector<std::size_t> CorrelatedDispersions(Fields& fields, const std::vector<std::string>& names,
                                               const std::vector<Dispersion>& dispersions) {
  std::vector<std::string> all;
  for (const Dispersion& dispersion : dispersions) all.push_back(dispersion.name);
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string key = "of[" + std::to_string(i) + "]";
    const auto found = std::find(all.begin(), all.end(), names[i]);
    if (found == all.end()) {
      fields.Refuse(key, "'" + names[i] + "' is not a dispersion" + DidYouMean(names[i], all),
                    all.empty() ? "a campaign with dispersions" : "one of " + JoinWords(all));
      continue;
    }
    const auto position = static_cast<std::size_t>(found - all.begin());
    const Dispersion& dispersion = dispersions[position];
    if (dispersion.distribution.kind != Distribution::kNormal)
      fields.Refuse(key, "'" + names[i] + "' is not normal", "distribution: normal");
    else if (!dispersion.mix.empty() || std::find(members.begin(), members.end(), position) != members.end())
      fields.Refuse(key, "'" + names[i] + "' is correlated twice", "once, in one group");
    members.push_back(position);
  }
  return members;
}

// Covariances in the squares of the columns' units to correlations: the standard deviations are the
// dispersions' own. False if they are not.
bool Normalise(Fields& fields, const std::vector<std::size_t>& members,
               const std::vector<Dispersion>& dispersions, std::vector<std::vector<double>>& matrix) {
  std::vector<double> sigma;
  for (std::size_t i = 0; i < matrix.size(); ++i) sigma.push_back(Sqrt(std::max(matrix[i][i], 0.0)));
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Dispersion& dispersion = dispersions[members[i]];
    const InputColumn& column = InputColumns()[static_cast<std::size_t>(dispersion.inputs.front())];
    const double stated = dispersion.distribution.sigma / column.unit;
    if (std::fabs(sigma[i] - stated) <= 1e-6 * stated) continue;
    fields.Refuse("covariance", "the variance of '" + dispersion.name + "' is not that of its distribution",
                  "the square of sigma in the unit of the column " + std::string(column.name));
    return false;
  }
  for (std::size_t i = 0; i < matrix.size(); ++i)
    for (std::size_t j = 0; j < matrix.size(); ++j) matrix[i][j] /= sigma[i] * sigma[j];
  for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i][i] = 1.0;
  return true;
}

void Correlate(Fields& fields, const Correlation& correlation, const std::vector<std::size_t>& members,
               std::vector<Dispersion>& dispersions) {
  const char* key = correlation.is_covariance ? "covariance" : "matrix";
  std::vector<std::vector<double>> matrix = correlation.matrix;
  const std::size_t size = members.size();
  if (matrix.size() != size ||
      std::any_of(matrix.begin(), matrix.end(), [size](const auto& row) { return row.size() != size; }))
    return fields.Refuse(key, "the matrix does not fit its " + std::to_string(size) + " names",
                         std::to_string(size) + " rows of " + std::to_string(size) + " numbers");
  if (correlation.is_covariance && !Normalise(fields, members, dispersions, matrix)) return;
  for (std::size_t i = 0; i < size; ++i) {
    if (matrix[i][i] != 1.0)
      return fields.Refuse(key, "the diagonal is not 1", "correlations, or covariance: in place of matrix:");
    for (std::size_t j = 0; j < size; ++j)
      if (matrix[i][j] != matrix[j][i])
        return fields.Refuse(key, "the matrix is not symmetric", "equal numbers across the diagonal");
  }
  const std::vector<std::vector<double>> factor = Cholesky(matrix);
  if (factor.empty())
    return fields.Refuse(key,
                         "the matrix is not positive definite: " + WhyImpossible(correlation.names, matrix),
                         "correlations that can hold together");
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j <= i; ++j) dispersions[members[i]].mix.emplace_back(members[j], factor[i][j]);
}

// What share of flights must keep the limit, and how that is judged.
void DescribeShare(Fields& fields, Requirement& requirement) {
  fields.Number("probability", Inside(0.0, 1.0), requirement.probability,
                "share of flights that must keep the limit");
  fields.Hint("probability", Inside(1.0, 100.0), "in percent",
              [](double x) { return ShortShare(x / 100.0); });
  fields.Number("consumer_risk", Inside(0.0, 0.5), requirement.consumer_risk,
                "largest chance to pass a vehicle whose share is smaller");
  fields.Hint("consumer_risk", Inside(0.5, 1.0), "a confidence",
              [](double x) { return ShortShare(1.0 - x); });
  DescribePlan(fields, requirement.plan);
}

std::int64_t Count(const std::vector<Dispersion>& dispersions, Distribution kind) {
  return std::count_if(dispersions.begin(), dispersions.end(),
                       [&](const Dispersion& dispersion) { return dispersion.distribution.kind == kind; });
}

// A column of SQLite, whose names know no capitals.
bool CanNameMetric(const std::string& name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return name.size() <= 60 && is_letter(name.front()) && std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
         });
}

std::string WithSingleSpaces(const std::string& text) {
  std::string single;
  std::istringstream words(text);
  for (std::string word; words >> word;) single += (single.empty() ? "" : " ") + word;
  return single;
}

bool HaveOneLength(const std::vector<Dispersion>& dispersions) {
  std::size_t length = 0;
  for (const Dispersion& dispersion : dispersions) {
    const ScalarDistribution& distribution = dispersion.distribution;
    if (distribution.kind != Distribution::kValues) continue;
    if (length != 0 && length != distribution.values.size()) return false;
    length = distribution.values.size();
  }
  return true;
}

}  // namespace

void Describe(Fields& fields, Sampling& sampling) {
  fields.Choice<SamplingMethod>("method",
                                {{"monte_carlo", SamplingMethod::kMonteCarlo},
                                 {"latin_hypercube", SamplingMethod::kLatinHypercube},
                                 {"sobol", SamplingMethod::kSobol},
                                 {"corners", SamplingMethod::kCorners},
                                 {"one_at_a_time", SamplingMethod::kOneAtATime},
                                 {"grid", SamplingMethod::kGrid},
                                 {"list", SamplingMethod::kList}},
                                sampling.method, "how cases are drawn");
  fields.Deciding(Decides::kCount, [&] {
    fields.Integer("cases", 1, kMaxCases, sampling.cases,
                   "number of flights, or the largest if it stops when decided");
  });
  fields.Deciding(Decides::kDraws,
                  [&] { fields.Integer("seed", 0, UINT64_MAX, sampling.seed, "of all draws"); });
  fields.Integer("replicates", 1, kMaxReplicates, sampling.replicates,
                 "independent Latin hypercube or Sobol designs of cases / replicates points each", 1);
  if (sampling.replicates <= 1) return;
  if (sampling.method != SamplingMethod::kLatinHypercube && sampling.method != SamplingMethod::kSobol)
    fields.Refuse("replicates", "only a Latin hypercube or Sobol design has replicates",
                  "method: latin_hypercube or sobol");
  else if (sampling.cases % sampling.replicates != 0)
    fields.Refuse("replicates",
                  std::to_string(sampling.cases) + " cases are not divisible into " +
                      std::to_string(sampling.replicates) + " designs of one size",
                  "a divisor of the number of cases");
}

void Describe(Fields& fields, Verdicts& verdicts, VerdictPlan& plan, Sampling& sampling) {
  DescribePlan(fields, plan);
  fields.Choice<bool>("joint", {{"each", false}, {"holm", true}}, verdicts.holm,
                      "each verdict keeps its own consumer risk, or all together the largest (S. Holm, 1979)",
                      false);
  fields.Choice<bool>("stop", {{"when_all_flown", false}, {"when_decided", true}}, verdicts.stop_when_decided,
                      "at a look at which every requirement is decided, or after all cases", false);
  if (verdicts.stop_when_decided && sampling.method != SamplingMethod::kMonteCarlo)
    fields.Refuse("stop", "a design study decides nothing", "method: monte_carlo");
  fields.Integer("attempts", 1, kMaxAttempts, verdicts.attempts,
                 "campaigns of one design that share each risk; later ones are judged by all cases "
                 "together",
                 1);
  fields.When(Has("max_cases"), [&] {
    fields.Integer("max_cases", 1, kMaxCases, sampling.cases,
                   "of a campaign that stops when decided, in place of cases");
    if (!verdicts.stop_when_decided) fields.Refuse("max_cases", "every case is flown", "stop: when_decided");
  });
}

void Describe(Fields& fields, OwnMetric& metric, const std::vector<std::string>& others) {
  fields.Text("name", metric.name, "of the metric, with its unit at the end");
  if (!metric.name.empty() && !CanNameMetric(metric.name))
    fields.Refuse("name", "'" + metric.name + "' cannot name a metric",
                  "a small letter, then small letters, digits and '_', 60 at most");
  else if (std::find(others.begin(), others.end(), metric.name) != others.end())
    fields.Refuse("name", "'" + metric.name + "' is a metric already", "another name");
  fields.Text("expression", metric.expression, "from columns of histories, at every tick");
  metric.expression = WithSingleSpaces(metric.expression);
  fields.Text("description", metric.meaning, "for the report", "");
}

void Describe(Fields& fields, Requirement& requirement, const std::vector<std::string>& metrics) {
  fields.Deciding(Decides::kNothing, [&] {
    fields.Text("id", requirement.id, "the project's own number of it", "");
    fields.Text("rationale", requirement.rationale, "why it is required", "");
    fields.Text("source", requirement.source, "the document that requires it", "");
  });
  constexpr const char* kOneLimit = "either below: x, above: x or within: [low, high]";
  fields.Name("metric", metrics, "a metric", requirement.metric, "of cases.csv, without its prefix");
  fields.OptionalNumber("below", kAnyNumber, requirement.below, "the metric must stay below");
  fields.OptionalNumber("above", kAnyNumber, requirement.above, "the metric must stay above");
  bool has_band = false;
  fields.When(Has("within"), [&] {
    has_band = true;
    std::vector<double> ends;
    fields.Numbers("within", kAnyNumber, 2, 2, ends, "the two limits that it must stay between");
    if (ends.size() != 2) return;
    requirement.within = {ends[0], ends[1]};
    if (!(ends[0] < ends[1]))
      fields.Refuse("within", "the first limit is not below the second", "[low, high]");
  });
  fields.ExactlyOne({"below", "above", "within"});
  const int limits = requirement.below.has_value() + requirement.above.has_value() + has_band;
  if (limits != 1)
    fields.Refuse("",
                  limits == 0                ? "the limit is missing"
                  : limits == 2 && !has_band ? "'below' and 'above' are both given"
                                             : "more than one limit is given",
                  kOneLimit);
  fields.Either({{Has("every_case"),
                  [&] {
                    fields.Flag("every_case", requirement.every_case, false,
                                "no point of a design study may violate it, in place of a probability");
                    if (!requirement.every_case)
                      fields.Refuse("every_case", "'every_case: false' requires nothing",
                                    "every_case: true, or probability and consumer_risk");
                    for (const char* key : {"probability", "consumer_risk", "looks", "anytime"})
                      fields.Misplaced(key, {}, "'{}' and 'every_case' are both given",
                                       "either every_case: true or probability and consumer_risk");
                  }},
                 {Else(), [&] { DescribeShare(fields, requirement); }}});
}

void Describe(Fields& fields, Correlation& correlation, std::vector<Dispersion>& dispersions) {
  fields.Texts("of", 2, SIZE_MAX, correlation.names, "names of normal dispersions");
  const std::vector<std::size_t> members = CorrelatedDispersions(fields, correlation.names, dispersions);
  fields.Either({{Has("covariance"),
                  [&] {
                    correlation.is_covariance = true;
                    fields.Rows("covariance", 2, SIZE_MAX, 0, correlation.matrix, "a list of numbers",
                                "in the squares of the units of cases.csv, in place of the matrix");
                  }},
                 {Else(), [&] {
                    fields.Rows("matrix", 2, SIZE_MAX, 0, correlation.matrix, "a list of numbers",
                                "of correlations, a row a name");
                  }}});
  fields.Check([&fields, &correlation, members, &dispersions] {
    Correlate(fields, correlation, members, dispersions);
  });
}

void CheckDesign(Fields& fields, const Sampling& sampling, const std::vector<Dispersion>& dispersions) {
  const auto refuse = [&](const std::string& message, const std::string& allowed) {
    fields.Refuse("sampling.method", message, allowed);
  };
  const std::int64_t corners = Count(dispersions, Distribution::kTwoPoint);
  switch (sampling.method) {
    case SamplingMethod::kCorners:
      if (corners > kMaxCornerFactors)
        return refuse(
            "the design has 2^" + std::to_string(corners) + " corners",
            "at most " + std::to_string(kMaxCornerFactors) + " dispersions with distribution: two_point");
      [[fallthrough]];
    case SamplingMethod::kOneAtATime:
      if (corners == 0)
        refuse("the design has nothing to vary", "one dispersion or more with distribution: two_point");
      break;
    case SamplingMethod::kLatinHypercube: {
      // Each process that flies holds the whole design.
      const double row = 4.0 * static_cast<double>(dispersions.size());
      const double bytes = row * static_cast<double>(sampling.cases);
      if (bytes <= kMaxDesignBytes) break;
      fields.Refuse("sampling.cases",
                    "a Latin hypercube of " + std::to_string(sampling.cases) + " cases and " +
                        std::to_string(dispersions.size()) + " dispersions takes " +
                        std::to_string(static_cast<std::uint64_t>(bytes / 1e9)) +
                        " GB of memory in each process",
                    "up to " + std::to_string(static_cast<std::uint64_t>(kMaxDesignBytes / row)) +
                        " cases (4 GB), or method: monte_carlo or sobol, which take none");
      break;
    }
    case SamplingMethod::kGrid:
    case SamplingMethod::kList:
      if (Count(dispersions, Distribution::kValues) == 0)
        refuse("the design has nothing to vary", "one dispersion or more with distribution: values");
      else if (sampling.method == SamplingMethod::kList && !HaveOneLength(dispersions))
        refuse("the lists of values have different lengths", "one value a run in every list");
      break;
    case SamplingMethod::kMonteCarlo:
    case SamplingMethod::kSobol:
      break;
  }
}

}  // namespace dispersa
