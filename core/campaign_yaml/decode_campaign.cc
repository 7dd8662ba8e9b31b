#include "core/campaign_yaml/decode_campaign.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/input/number_text.h"
#include "core/input/struct_problems.h"
#include "core/input/map_reader.h"
#include "core/flight/engine_version.h"
#include "core/flight/metrics.h"
#include "core/flight/sensor_model.h"
#include "core/flight/step_limits.h"
#include "core/flight/structural_limits.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

// A stream's index is 32 bits wide.
constexpr std::uint64_t kMaxCases = 4294967295;
constexpr std::uint64_t kMaxReplicates = 10000;
// A workstation has so much for each process that flies.
constexpr double kMaxDesignBytes = 4e9;
// More looks than these are better served by an anytime plan.
constexpr std::uint64_t kMaxLooks = 100;

// A tree that was read from a file of its own has paths of its own.
std::string PathOfPart(const InputNode& part, const InputNode& root, const std::string& key) {
  return part.file == root.file ? key : "";
}

Sampling DecodeSampling(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Sampling sampling;
  sampling.method =
      map.Choice<SamplingMethod>("method", {{"monte_carlo", SamplingMethod::kMonteCarlo},
                                            {"latin_hypercube", SamplingMethod::kLatinHypercube},
                                            {"sobol", SamplingMethod::kSobol},
                                            {"corners", SamplingMethod::kCorners},
                                            {"one_at_a_time", SamplingMethod::kOneAtATime},
                                            {"grid", SamplingMethod::kGrid},
                                            {"list", SamplingMethod::kList}});
  sampling.cases = map.Integer("cases", 1, kMaxCases);
  sampling.seed = map.Integer("seed", 0, UINT64_MAX);
  sampling.replicates = map.Integer("replicates", 1, kMaxReplicates, 1);
  const bool designed =
      sampling.method == SamplingMethod::kLatinHypercube || sampling.method == SamplingMethod::kSobol;
  if (sampling.replicates > 1 && !designed) {
    AddProblem(problems, *node.Find("replicates"), map.PathOf("replicates"),
               "only a Latin hypercube or Sobol design has replicates", "method: latin_hypercube or sobol");
  } else if (sampling.replicates > 1 && sampling.cases % sampling.replicates != 0) {
    AddProblem(problems, *node.Find("replicates"), map.PathOf("replicates"),
               std::to_string(sampling.cases) + " cases are not divisible into " +
                   std::to_string(sampling.replicates) + " designs of one size",
               "a divisor of the number of cases");
  }
  if (map.Optional("table") != nullptr && sampling.method != SamplingMethod::kList) {
    AddProblem(problems, *node.Find("table"), map.PathOf("table"), "only a list is read from a table",
               "method: list");
  }
  return sampling;
}

// The columns of a list's table, each an input by its name in cases.csv without the prefix.
void DecodeListTable(const InputNode& table, const std::string& path, Campaign& campaign,
                     ProblemList& problems) {
  if (table.file == nullptr) return;  // already reported
  SayExpects(path, {.kind = Expectation::Kind::kColumns});
  std::vector<std::string> names;
  const std::size_t count = InputCount(campaign.vehicle.stages.size());
  for (std::size_t i = 0; i < count; ++i) names.push_back(InputColumns()[i].name);
  MapReader map(table, path, problems);
  std::size_t length = 0;
  for (const InputMember& member : table.members) {
    const int input = FindInput(member.key);
    if (input < 0 || static_cast<std::size_t>(input) >= count) {
      map.Ignore(member.key);
      InputNode at = MapAt(member.value);
      AddProblem(problems, at, map.PathOf(member.key),
                 "'" + member.key + "' is not an input" + DidYouMean(member.key, names),
                 "a column of cases.csv without its prefix 'input_'");
      continue;
    }
    ScalarDistribution values;
    values.kind = Distribution::kValues;
    values.values = map.Numbers(member.key, kAnyNumber, 1);
    for (double& value : values.values) value *= InputColumns()[static_cast<std::size_t>(input)].unit;
    length = std::max(length, values.values.size());
    campaign.dispersions.push_back({"list/" + member.key, std::move(values), {input}, false, {}});
  }
}

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

// One group of normal dispersions that are drawn together.
void DecodeCorrelation(const InputNode& node, const std::string& path, Campaign& campaign,
                       ProblemList& problems) {
  const std::size_t before = problems.size();
  std::vector<std::size_t> members;
  std::vector<std::vector<double>> matrix;
  const InputNode* rows = nullptr;
  {
    MapReader map(node, path, problems);
    map.Each("of", 2, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      const std::string name = ReadText(item, item_path, problems);
      std::vector<std::string> names;
      for (const Dispersion& dispersion : campaign.dispersions) names.push_back(dispersion.name);
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        AddProblem(problems, item, item_path, "'" + name + "' is not a dispersion" + DidYouMean(name, names),
                   names.empty() ? "a campaign with dispersions" : "one of " + JoinWords(names));
        return;
      }
      const auto position = static_cast<std::size_t>(found - names.begin());
      const Dispersion& dispersion = campaign.dispersions[position];
      if (dispersion.distribution.kind != Distribution::kNormal) {
        AddProblem(problems, item, item_path, "'" + name + "' is not normal", "distribution: normal");
      } else if (!dispersion.mix.empty() ||
                 std::find(members.begin(), members.end(), position) != members.end()) {
        AddProblem(problems, item, item_path, "'" + name + "' is correlated twice", "once, in one group");
      }
      members.push_back(position);
    });
    const bool covariance = map.Peek("covariance") != nullptr;
    const std::string key = covariance ? "covariance" : "matrix";
    rows = node.Find(key);
    map.Each(key, 2, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      std::vector<double> row;
      SayExpects(item_path, {.kind = Expectation::Kind::kList, .low_count = 2});
      SayExpects(item_path + "[]", {.kind = Expectation::Kind::kNumber});
      for (const InputNode& cell : item.items) row.push_back(ReadNumber(cell, item_path, problems));
      matrix.push_back(std::move(row));
    });
    if (problems.size() > before || rows == nullptr) return;
    const std::size_t size = members.size();
    const bool square =
        matrix.size() == size &&
        std::all_of(matrix.begin(), matrix.end(), [size](const auto& row) { return row.size() == size; });
    if (!square) {
      AddProblem(problems, *rows, map.PathOf(key),
                 "the matrix does not fit its " + std::to_string(size) + " names",
                 std::to_string(size) + " rows of " + std::to_string(size) + " numbers");
      return;
    }
    if (covariance) {
      // In the squares of the internal units; the standard deviations are the dispersions' own.
      std::vector<double> sigma;
      for (std::size_t i = 0; i < size; ++i) sigma.push_back(Sqrt(std::max(matrix[i][i], 0.0)));
      for (std::size_t i = 0; i < size; ++i) {
        const Dispersion& dispersion = campaign.dispersions[members[i]];
        const double unit = InputColumns()[static_cast<std::size_t>(dispersion.inputs.front())].unit;
        const double stated = dispersion.distribution.sigma / unit;
        if (!(std::fabs(sigma[i] - stated) <= 1e-6 * stated)) {
          AddProblem(problems, *rows, map.PathOf(key),
                     "the variance of '" + dispersion.name + "' is not that of its distribution",
                     "the square of sigma in the unit of the column " +
                         InputColumns()[static_cast<std::size_t>(dispersion.inputs.front())].name);
          return;
        }
      }
      for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) matrix[i][j] /= sigma[i] * sigma[j];
      }
      for (std::size_t i = 0; i < size; ++i) matrix[i][i] = 1.0;
    }
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        if (matrix[i][j] == (i == j ? 1.0 : matrix[j][i])) continue;
        AddProblem(problems, *rows, map.PathOf(key),
                   i == j ? "the diagonal is not 1" : "the matrix is not symmetric",
                   i == j ? "correlations, or covariance: in place of matrix:"
                          : "equal numbers across the diagonal");
        return;
      }
    }
    const std::vector<std::vector<double>> factor = Cholesky(matrix);
    if (factor.empty()) {
      AddProblem(problems, *rows, map.PathOf(key), "the matrix is not positive definite",
                 "correlations that can hold together");
      return;
    }
    for (std::size_t i = 0; i < size; ++i) {
      auto& mix = campaign.dispersions[members[i]].mix;
      for (std::size_t j = 0; j <= i; ++j) mix.emplace_back(members[j], factor[i][j]);
    }
  }
}

// looks, spending and anytime of a requirement, or of all in `verdicts`.
VerdictPlan ReadPlan(MapReader& map, const VerdictPlan& absent) {
  VerdictPlan plan = absent;
  const InputNode* looks = map.Optional("looks");
  const InputNode* anytime = map.Optional("anytime");
  const InputNode* spending = map.Optional("spending");
  if (looks != nullptr && anytime != nullptr) {
    AddProblem(map.problems(), *anytime, map.PathOf("anytime"), "'looks' and 'anytime' are both given",
               "either looks: K or anytime: true");
  }
  if (anytime != nullptr) plan.kind = map.Flag("anytime", false) ? PlanKind::kAnytime : PlanKind::kFixed;
  if (looks != nullptr) {
    plan.looks = static_cast<std::int64_t>(map.Integer("looks", 1, kMaxLooks));
    plan.kind = plan.looks > 1 ? PlanKind::kGroupSequential : PlanKind::kFixed;
  }
  if (plan.kind != PlanKind::kGroupSequential) plan.looks = 1;
  if (spending != nullptr) {
    plan.spending = map.Choice<Spending>(
        "spending", {{"obrien_fleming", Spending::kOBrienFleming}, {"pocock", Spending::kPocock}});
    if (plan.kind != PlanKind::kGroupSequential) {
      AddProblem(map.problems(), *spending, map.PathOf("spending"), "one look has nothing to share",
                 "looks: 2 or more");
    }
  }
  return plan;
}

Verdicts DecodeVerdicts(const InputNode& node, const std::string& path, VerdictPlan& plan, Sampling& sampling,
                        ProblemList& problems) {
  MapReader map(node, path, problems);
  Verdicts verdicts;
  plan = ReadPlan(map, {});
  verdicts.holm = map.Choice<bool>("joint", {{"each", false}, {"holm", true}}, false);
  verdicts.stop_when_decided =
      map.Choice<bool>("stop", {{"when_all_flown", false}, {"when_decided", true}}, false);
  const InputNode* max_cases = map.Optional("max_cases");
  if (max_cases == nullptr) return verdicts;
  const std::uint64_t most = map.Integer("max_cases", 1, kMaxCases);
  if (!verdicts.stop_when_decided) {
    AddProblem(problems, *max_cases, map.PathOf("max_cases"), "every case is flown", "stop: when_decided");
  }
  sampling.cases = most;
  return verdicts;
}

// A design needs dispersions that it can set.
void CheckDesign(const Campaign& campaign, const InputNode& sampling, ProblemList& problems) {
  const auto count = [&](Distribution kind) {
    return std::count_if(campaign.dispersions.begin(), campaign.dispersions.end(),
                         [&](const Dispersion& dispersion) { return dispersion.distribution.kind == kind; });
  };
  const InputNode* method = sampling.Find("method");
  const auto add = [&](const std::string& message, const std::string& allowed) {
    AddProblem(problems, *method, "sampling.method", message, allowed);
  };
  constexpr int kMaxCornerFactors = 20;
  switch (campaign.sampling.method) {
    case SamplingMethod::kCorners:
      if (count(Distribution::kTwoPoint) > kMaxCornerFactors) {
        add("the design has 2^" + std::to_string(count(Distribution::kTwoPoint)) + " corners",
            "at most " + std::to_string(kMaxCornerFactors) + " dispersions with distribution: two_point");
        break;
      }
      [[fallthrough]];
    case SamplingMethod::kOneAtATime:
      if (count(Distribution::kTwoPoint) == 0) {
        add("the design has nothing to vary", "one dispersion or more with distribution: two_point");
      }
      break;
    case SamplingMethod::kLatinHypercube: {
      // Each process that flies holds the whole design.
      const double bytes = 4.0 * static_cast<double>(campaign.sampling.cases) *
                           static_cast<double>(campaign.dispersions.size());
      if (bytes > kMaxDesignBytes) {
        const auto most = static_cast<std::uint64_t>(kMaxDesignBytes / 4.0 /
                                                     static_cast<double>(campaign.dispersions.size()));
        AddProblem(problems, *sampling.Find("cases"), "sampling.cases",
                   "a Latin hypercube of " + std::to_string(campaign.sampling.cases) + " cases and " +
                       std::to_string(campaign.dispersions.size()) + " dispersions takes " +
                       std::to_string(static_cast<std::uint64_t>(bytes / 1e9)) +
                       " GB of memory in each process",
                   "up to " + std::to_string(most) +
                       " cases (4 GB), or method: monte_carlo or sobol, which take none");
      }
      break;
    }
    case SamplingMethod::kGrid:
    case SamplingMethod::kList: {
      if (count(Distribution::kValues) == 0) {
        add("the design has nothing to vary", "one dispersion or more with distribution: values");
        break;
      }
      if (campaign.sampling.method == SamplingMethod::kGrid) break;
      std::size_t length = 0;
      for (const Dispersion& dispersion : campaign.dispersions) {
        if (dispersion.distribution.kind != Distribution::kValues) continue;
        if (length == 0) length = dispersion.distribution.values.size();
        if (length == dispersion.distribution.values.size()) continue;
        add("the lists of values have different lengths", "one value a run in every list");
        break;
      }
      break;
    }
    case SamplingMethod::kMonteCarlo:
    case SamplingMethod::kSobol:
      break;
  }
}

// To the digits that people write: 1 - 0.95 is 0.05.
double ShortShare(double value) { return std::round(value * 1e9) / 1e9; }

// A number that was written as its counterpart: a share in percent, a risk as the confidence that it leaves.
void HintAt(MapReader& map, const std::string& key, const Range& mistaken, const char* what,
            double (*meant)(double), std::size_t problems_before) {
  ProblemList& problems = map.problems();
  const InputNode* node = map.node().Find(key);
  if (node == nullptr || node->kind != InputNode::Kind::kScalar || problems.size() == problems_before) return;
  const std::optional<double> value = ParseNumber(node->text);
  if (value && mistaken.Contains(*value))
    problems.back().message +=
        std::string(", it is ") + what + " (did you mean " + FormatNumber(meant(*value)) + "?)";
}

Requirement DecodeRequirement(const InputNode& node, const std::string& path, const VerdictPlan& plan,
                              std::size_t stages, ProblemList& problems) {
  MapReader map(node, path, problems);
  Requirement requirement;
  const InputNode& metric = map.Required("metric", "the name of a metric");
  requirement.metric = ReadText(metric, map.PathOf("metric"), problems);
  const auto last = MetricNames().begin() + static_cast<std::ptrdiff_t>(MetricCount(stages));
  const std::vector<std::string> names(MetricNames().begin(), last);
  if (Listener() != nullptr)
    SayExpects(map.PathOf("metric"), {.kind = Expectation::Kind::kWords, .words = MetricNames()});
  if (metric.kind == InputNode::Kind::kScalar &&
      std::find(names.begin(), names.end(), metric.text) == names.end()) {
    AddProblem(problems, metric, map.PathOf("metric"),
               metric.Describe() + " is not a metric" + DidYouMean(metric.text, names),
               "one of " + JoinWords(names));
  }
  if (map.Optional("below") != nullptr) requirement.below = map.Number("below", kAnyNumber);
  if (map.Optional("above") != nullptr) requirement.above = map.Number("above", kAnyNumber);
  if (map.Optional("within") != nullptr) {
    const std::vector<double> ends = map.Numbers("within", kAnyNumber, 2, 2);
    if (ends.size() == 2) {
      requirement.within = {ends[0], ends[1]};
      if (!(ends[0] < ends[1])) {
        AddProblem(problems, *node.Find("within"), map.PathOf("within"),
                   "the first limit is not below the second", "[low, high]");
      }
    }
  }
  const int limits =
      (node.Find("below") != nullptr) + (node.Find("above") != nullptr) + (node.Find("within") != nullptr);
  if (limits == 0) map.NoteMissing({"below", "above", "within"});
  if (limits != 1 && node.kind == InputNode::Kind::kMap) {
    const bool pair = limits == 2 && node.Find("within") == nullptr;
    AddProblem(problems, node, path,
               limits == 0 ? "the limit is missing"
               : pair      ? "'below' and 'above' are both given"
                           : "more than one limit is given",
               "either below: x, above: x or within: [low, high]");
  }
  std::size_t before = problems.size();
  requirement.probability = map.Number("probability", Inside(0.0, 1.0));
  HintAt(
      map, "probability", Inside(1.0, 100.0), "in percent", [](double x) { return ShortShare(x / 100.0); },
      before);
  before = problems.size();
  requirement.consumer_risk = map.Number("consumer_risk", Inside(0.0, 0.5));
  HintAt(
      map, "consumer_risk", Inside(0.5, 1.0), "a confidence", [](double x) { return ShortShare(1.0 - x); },
      before);
  requirement.plan = ReadPlan(map, plan);
  return requirement;
}

// Limits of a structure that nobody judges are none. A campaign that means something else by them states its
// own requirement on the metric.
void RequireLimitsKept(const VerdictPlan& plan, std::vector<Requirement>& requirements) {
  constexpr char kMetric[] = "structural_limit_exceeded";
  if (std::any_of(requirements.begin(), requirements.end(),
                  [&](const Requirement& requirement) { return requirement.metric == kMetric; }))
    return;
  Requirement kept;
  kept.metric = kMetric;
  kept.below = 1.0;
  kept.probability = 0.9973;  // what "3 sigma" of a normal variable means, both sides
  kept.consumer_risk = 0.10;  // usual of such verdicts (NASA/TP-2010-216447)
  kept.plan = plan;
  kept.by_default = true;
  requirements.push_back(std::move(kept));
}

bool Restarts(const Vehicle& vehicle) {
  return std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                     [](const Stage& stage) { return stage.restarts; });
}

GuidanceConfig DecodeGuidance(const InputNode& node, const Vehicle& vehicle, ProblemList& problems) {
  MapReader map(node, "guidance", problems);
  GuidanceConfig guidance;
  guidance.closed_loop = map.Choice<bool>("mode", {{"open_loop", false}, {"closed_loop", true}});
  guidance.steers_last_burn =
      map.Choice<bool>("last_burn", {{"steered", true}, {"as_planned", false}}, guidance.steers_last_burn);
  guidance.period_s = map.Quantity("period", kTime, Between(0.1, 10.0), guidance.period_s);
  // Attitude loops of a launcher follow some degrees a second; more would be a loss of control.
  const Range rate = {0.0, 20.0 * kRadPerDeg, true, false};
  guidance.turn_rate_rad_s = map.Quantity("turn_rate", kAngularRate, rate, guidance.turn_rate_rad_s);
  guidance.turn_acceleration_rad_s2 =
      map.Quantity("turn_acceleration", kAngularAcceleration, rate, guidance.turn_acceleration_rad_s2);
  guidance.coast_rate_rad_s = map.Quantity("coast_rate", kAngularRate, rate, guidance.coast_rate_rad_s);
  guidance.coast_acceleration_rad_s2 =
      map.Quantity("coast_acceleration", kAngularAcceleration, rate, guidance.coast_acceleration_rad_s2);
  guidance.settled_angle_rad = map.Quantity("settled", kAngle, rate, guidance.settled_angle_rad);
  guidance.settled_rate_rad_s = map.Quantity("settled_rate", kAngularRate, rate, guidance.settled_rate_rad_s);
  if (guidance.closed_loop && !vehicle.stages.empty() &&
      (vehicle.stages.size() < 2 || vehicle.stages.back().ignition != IgnitionTrigger::kTimer)) {
    const InputNode* mode = node.Find("mode");
    AddProblem(problems, mode != nullptr ? *mode : node, map.PathOf("mode"),
               "the vehicle '" + vehicle.name + "' has no last stage whose ignition guidance could move",
               "open_loop, or a vehicle whose last of two stages or more has ignition: {trigger: timer}");
  } else if (guidance.closed_loop && (CutsOffAtVelocity(vehicle) || Restarts(vehicle))) {
    const InputNode* mode = node.Find("mode");
    AddProblem(problems, mode != nullptr ? *mode : node, map.PathOf("mode"),
               "guidance knows burns that end by themselves, and an engine of '" + vehicle.name +
                   "' is cut off at a velocity or burns again",
               "open_loop, or engines that end by time or depletion");
  } else if (guidance.closed_loop && vehicle.boosters.count > 0 && vehicle.stages.size() < 3) {
    const InputNode* mode = node.Find("mode");
    AddProblem(problems, mode != nullptr ? *mode : node, map.PathOf("mode"),
               "guidance would steer the stage of '" + vehicle.name + "' that has boosters, whose thrust it does not know",
               "open_loop, or a vehicle of three stages or more");
  }
  return guidance;
}

// Only stages that there are, above the first, are steered.
template <class T>
void CheckSteering(const Vehicle& vehicle, const std::array<T, kMaxStages>& steering, const InputNode& node,
                   const std::string& path, ProblemList& problems) {
  for (std::size_t stage = vehicle.stages.size(); stage < kMaxStages; ++stage)
    if (!steering[stage].empty())
      AddProblem(problems, node, path,
                 "stage" + std::to_string(stage + 1) + "_incidence_* is given, and the vehicle has " +
                     std::to_string(vehicle.stages.size()) + " stages",
                 "incidence of stages that there are");
}

// Stages before the last that a timer ignites, and only they, have a coast of their own.
void CheckTimers(const Vehicle& vehicle, const InputNode& node, const std::string& path,
                 const std::string& key, const std::function<bool(std::size_t)>& has, ProblemList& problems) {
  for (std::size_t stage = 1; stage < kMaxStages; ++stage) {
    const bool wants =
        stage + 1 < vehicle.stages.size() && vehicle.stages[stage].ignition == IgnitionTrigger::kTimer;
    if (wants == has(stage)) continue;
    const std::string name = "stage" + std::to_string(stage + 1);
    const std::string number = "stage " + std::to_string(stage + 1);
    AddProblem(problems, node, path,
               wants ? number + " of the vehicle ignites on a timer, and " + name + "_" + key + " is missing"
                     : name + "_" + key + " is given, and " + number +
                           " of the vehicle is not one before the last that ignites on a timer",
               wants ? name + "_" + key : "no coast of that stage");
  }
}

// The name becomes part of a folder's name.
void CheckName(const std::string& name, const InputNode& root, ProblemList& problems) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() ||
      (std::all_of(name.begin(), name.end(), is_allowed) && name[0] != '.' && name.size() <= 64))
    return;
  AddProblem(problems, *root.Find("name"), "name", "'" + name + "' cannot name a folder",
             "up to 64 letters, digits, '_', '-' and '.', the first not '.'");
}

}  // namespace

DecodedCampaign DecodeCampaign(const InputNode& root, CampaignUse use, std::vector<InputProblem>& problems,
                               std::vector<InputProblem>* warnings) {
  DecodedCampaign decoded;
  Campaign& campaign = decoded.campaign;
  if (!CheckSchema(root, kCampaignSchema, false, "", problems)) return decoded;
  MapReader map(root, "", problems);
  map.Allow("schema");
  campaign.name = map.Text("name");
  CheckName(campaign.name, root, problems);
  map.Text("description", "");

  const InputNode& vehicle = map.Required("vehicle", "a vehicle file");
  campaign.vehicle = DecodeVehicle(vehicle, PathOfPart(vehicle, root, "vehicle"), problems, warnings);
  const int stages = static_cast<int>(campaign.vehicle.stages.size());

  const InputNode* reference = map.Optional("reference");
  const InputNode* optimize = map.Optional("optimize");
  if (reference == nullptr && optimize == nullptr) map.NoteMissing({"reference", "optimize"});
  if (root.kind == InputNode::Kind::kMap && (reference == nullptr) == (optimize == nullptr)) {
    AddProblem(problems, root, "",
               reference == nullptr ? "there is neither 'reference' nor 'optimize'"
                                    : "'reference' and 'optimize' are both given",
               "one of the two");
  } else if (optimize != nullptr && (use == CampaignUse::kFly || use == CampaignUse::kRead)) {
    AddProblem(problems, *optimize, "optimize", "the campaign has no trajectory to fly yet",
               "run `dispersa optimize " + (root.file ? *root.file : std::string("CAMPAIGN")) +
                   " -o REFERENCE.yaml`, then write `reference: REFERENCE.yaml` in place of `optimize:`");
  }
  if (reference != nullptr) {
    campaign.reference = DecodeReference(*reference, PathOfPart(*reference, root, "reference"), problems);
  }
  if (optimize != nullptr) decoded.optimize = DecodeTrajectoryProblem(*optimize, "optimize", problems);

  if (problems.empty() && optimize != nullptr)
    CheckTimers(
        campaign.vehicle, *optimize, "optimize.bounds", "coast_s: [low, high]",
        [&](std::size_t stage) { return decoded.optimize->earlier_coast_s[stage].high > 0.0; }, problems);
  else if (problems.empty() && reference != nullptr)
    CheckTimers(
        campaign.vehicle, *reference, PathOfPart(*reference, root, "reference"), "ignition_s",
        [&](std::size_t stage) { return campaign.reference.earlier_ignition_s[stage] > 0.0; }, problems);

  if (problems.empty() && optimize != nullptr)
    CheckSteering(campaign.vehicle, decoded.optimize->steering, *optimize, "optimize.bounds", problems);
  else if (problems.empty() && reference != nullptr)
    CheckSteering(campaign.vehicle, campaign.reference.program.steering, *reference,
                  PathOfPart(*reference, root, "reference"), problems);

  const bool flies = use != CampaignUse::kOptimize && optimize == nullptr;
  if (const InputNode* autopilot =
          flies ? &map.Required("autopilot", "an autopilot file") : map.Optional("autopilot")) {
    campaign.autopilot =
        DecodeAutopilot(*autopilot, PathOfPart(*autopilot, root, "autopilot"), stages, problems,
                        use == CampaignUse::kRead ? PythonLaws::kMayBeAbsent : PythonLaws::kMustBeHere);
    if (problems.empty())
      AddStructProblems(GyroProblems(campaign.vehicle, campaign.autopilot), *autopilot,
                        PathOfPart(*autopilot, root, "autopilot"), problems);
    if (problems.empty())
      AddStructProblems(StepProblems(campaign.vehicle, campaign.autopilot.tick_s), vehicle,
                        PathOfPart(vehicle, root, "vehicle"), problems);
  }
  if (const InputNode* guidance = map.Optional("guidance"))
    campaign.guidance = DecodeGuidance(*guidance, campaign.vehicle, problems);
  const InputNode* sampling = flies ? &map.Required("sampling", "a map") : map.Optional("sampling");
  if (sampling != nullptr) campaign.sampling = DecodeSampling(*sampling, "sampling", problems);
  const std::size_t before = problems.size();
  if (const InputNode* dispersions = map.Optional("dispersions")) {
    DecodeDispersions(*dispersions, "dispersions", campaign, problems);
  }
  if (const InputNode* table = sampling == nullptr ? nullptr : sampling->Find("table")) {
    DecodeListTable(*table, table->file == root.file ? "sampling.table" : "", campaign, problems);
  }
  map.Each("correlations", 0, SIZE_MAX, [&](const InputNode& item, const std::string& path) {
    DecodeCorrelation(item, path, campaign, problems);
  });
  if (problems.size() == before && sampling != nullptr && sampling->Find("method") != nullptr) {
    CheckDesign(campaign, *sampling, problems);
  }
  VerdictPlan plan;
  if (const InputNode* verdicts = map.Optional("verdicts")) {
    campaign.verdicts = DecodeVerdicts(*verdicts, "verdicts", plan, campaign.sampling, problems);
    if (campaign.verdicts.stop_when_decided && campaign.sampling.method != SamplingMethod::kMonteCarlo) {
      AddProblem(problems, *verdicts->Find("stop"), "verdicts.stop", "a design study decides nothing",
                 "method: monte_carlo");
    }
  }
  if (map.Optional("requirements") != nullptr)
    map.Each("requirements", 1, SIZE_MAX, [&](const InputNode& item, const std::string& path) {
      campaign.requirements.push_back(
          DecodeRequirement(item, path, plan, campaign.vehicle.stages.size(), problems));
    });

  if (HasLimits(campaign.vehicle.limits)) RequireLimitsKept(plan, campaign.requirements);

  const double on_time_s = campaign.vehicle.reaction_control.minimum_on_time_s;
  if (warnings != nullptr && problems.empty() && flies && on_time_s > 0.0 &&
      campaign.autopilot.tick_s > on_time_s * (1.0 + 1e-9)) {
    std::string path;
    const InputNode& at = FindField(vehicle, "reaction_control.minimum_on_time_s", &path);
    const std::string part = PathOfPart(vehicle, root, "vehicle");
    AddProblem(*warnings, at, part.empty() ? path : part + "." + path,
               "thrusters fire for whole ticks of " + FormatRounded(campaign.autopilot.tick_s) +
                   " s, which is longer than they have to",
               "at least a tick of the autopilot");
  }
  if (warnings != nullptr && problems.empty() && !campaign.reference.target_missed.empty()) {
    AddProblem(
        *warnings, *reference->Find("target_missed"),
        PathOfPart(*reference, root, "reference").empty() ? "target_missed" : "reference.target_missed",
        "the reference misses its own target: " + campaign.reference.target_missed,
        "a reference that reaches it");
  }
  if (warnings != nullptr && problems.empty() && reference != nullptr &&
      campaign.reference.vehicle_sha256 != VehicleSha256(vehicle)) {
    AddProblem(*warnings, *reference, PathOfPart(*reference, root, "reference"),
               "the reference was found for another vehicle; flights will miss its orbit",
               "a reference that `dispersa optimize` wrote for this vehicle");
  }
  return decoded;
}

std::string VehicleSha256(const InputNode& vehicle) {
  InputNode rigid = vehicle;
  std::erase_if(rigid.members, [](const InputMember& member) {
    return member.key == "structure_beam" || member.key == "sensors" || member.key == "nozzles" ||
           member.key == "limits";
  });
  // Nor does a point mass know what its actuators lack, or what its structure bears.
  if (InputNode* stages = rigid.Find("stages"))
    for (InputNode& stage : stages->items)
      if (InputNode* gimbal = stage.Find("gimbal"))
        std::erase_if(gimbal->members, [](const InputMember& member) {
          return member.key.starts_with("dead_zone_") || member.key.starts_with("friction_") ||
                 member.key.starts_with("resolution_");
        });
  return Sha256Hex(CanonicalText(rigid));
}

std::string RequirementsId(const InputNode& campaign) {
  InputNode judged = MapAt(campaign);
  for (const char* key : {"requirements", "verdicts"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(judged, key, *value);
  }
  return Sha256Hex(CanonicalText(judged));
}

std::string FlightId(const InputNode& campaign, SamplingMethod method) {
  InputNode deciding = MapAt(campaign);
  for (const char* key : {"vehicle", "reference", "autopilot", "guidance", "dispersions", "correlations"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(deciding, key, *value);
  }
  InputNode sampling = MapAt(campaign);
  SetMember(sampling, "method", *campaign.Find("sampling")->Find("method"));
  SetMember(sampling, "seed", *campaign.Find("sampling")->Find("seed"));
  for (const char* key : {"replicates", "table"}) {
    if (const InputNode* value = campaign.Find("sampling")->Find(key)) SetMember(sampling, key, *value);
  }
  // The strata of a Latin hypercube and the bounds of replicates depend on the number of cases; every other
  // case stands for itself.
  if (method == SamplingMethod::kLatinHypercube || campaign.Find("sampling")->Find("replicates") != nullptr) {
    SetMember(sampling, "cases", *campaign.Find("sampling")->Find("cases"));
  }
  SetMember(deciding, "sampling", std::move(sampling));
  InputNode engine = ScalarAt(campaign, EngineVersion());
  engine.quoted = true;
  SetMember(deciding, "engine", std::move(engine));
  return Sha256Hex(CanonicalText(deciding));
}

}  // namespace dispersa
