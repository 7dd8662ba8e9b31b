#include "core/campaign_yaml/decode_campaign.h"

#include <algorithm>
#include <cmath>

#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/number_text.h"
#include "core/campaign_yaml/yaml_reader.h"
#include "core/engine/version.h"
#include "core/flight/metrics.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

// A stream's index is 32 bits wide.
constexpr std::uint64_t kMaxCases = 4294967295;

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
  return sampling;
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
    case SamplingMethod::kLatinHypercube:
    case SamplingMethod::kSobol:
      break;
  }
}

Requirement DecodeRequirement(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Requirement requirement;
  const InputNode& metric = map.Required("metric", "the name of a metric");
  requirement.metric = ReadText(metric, map.PathOf("metric"), problems);
  const std::vector<std::string>& names = MetricNames();
  if (metric.kind == InputNode::Kind::kScalar &&
      std::find(names.begin(), names.end(), metric.text) == names.end()) {
    AddProblem(problems, metric, map.PathOf("metric"),
               metric.Describe() + " is not a metric" + DidYouMean(metric.text, names),
               "one of " + JoinWords(names));
  }
  if (map.Optional("below") != nullptr) requirement.below = map.Number("below", kAnyNumber);
  if (map.Optional("above") != nullptr) requirement.above = map.Number("above", kAnyNumber);
  if (requirement.below.has_value() == requirement.above.has_value() && node.kind == InputNode::Kind::kMap) {
    AddProblem(problems, node, path,
               requirement.below ? "'below' and 'above' are both given" : "the limit is missing",
               "either below: x or above: x");
  }
  requirement.probability = map.Number("probability", Inside(0.0, 1.0));
  requirement.consumer_risk = map.Number("consumer_risk", Inside(0.0, 1.0));
  return requirement;
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
  map.Ignore("schema");
  campaign.name = map.Text("name");
  CheckName(campaign.name, root, problems);
  map.Text("description", "");

  const InputNode& vehicle = map.Required("vehicle", "a vehicle file");
  campaign.vehicle = DecodeVehicle(vehicle, PathOfPart(vehicle, root, "vehicle"), problems);
  const int stages = static_cast<int>(campaign.vehicle.stages.size());

  const InputNode* reference = map.Optional("reference");
  const InputNode* optimize = map.Optional("optimize");
  if (root.kind == InputNode::Kind::kMap && (reference == nullptr) == (optimize == nullptr)) {
    AddProblem(problems, root, "",
               reference == nullptr ? "there is neither 'reference' nor 'optimize'"
                                    : "'reference' and 'optimize' are both given",
               "one of the two");
  } else if (optimize != nullptr && use == CampaignUse::kFly) {
    AddProblem(problems, *optimize, "optimize", "the campaign has no trajectory to fly yet",
               "run `dispersa optimize " + (root.file ? *root.file : std::string("CAMPAIGN")) +
                   " -o REFERENCE.yaml`, then write `reference: REFERENCE.yaml` in place of `optimize:`");
  }
  if (reference != nullptr) {
    campaign.reference = DecodeReference(*reference, PathOfPart(*reference, root, "reference"), problems);
  }
  if (optimize != nullptr) decoded.optimize = DecodeTrajectoryProblem(*optimize, "optimize", problems);

  const bool flies = use != CampaignUse::kOptimize && optimize == nullptr;
  if (const InputNode* autopilot =
          flies ? &map.Required("autopilot", "an autopilot file") : map.Optional("autopilot")) {
    campaign.autopilot =
        DecodeAutopilot(*autopilot, PathOfPart(*autopilot, root, "autopilot"), stages, problems);
  }
  const InputNode* sampling = flies ? &map.Required("sampling", "a map") : map.Optional("sampling");
  if (sampling != nullptr) campaign.sampling = DecodeSampling(*sampling, "sampling", problems);
  const std::size_t before = problems.size();
  if (const InputNode* dispersions = map.Optional("dispersions")) {
    DecodeDispersions(*dispersions, "dispersions", stages, campaign, problems);
  }
  if (problems.size() == before && sampling != nullptr && sampling->Find("method") != nullptr) {
    CheckDesign(campaign, *sampling, problems);
  }
  map.Each("requirements", map.node().Find("requirements") == nullptr ? 0 : 1, SIZE_MAX,
           [&](const InputNode& item, const std::string& path) {
             campaign.requirements.push_back(DecodeRequirement(item, path, problems));
           });

  if (warnings != nullptr && problems.empty() && reference != nullptr &&
      campaign.reference.vehicle_sha256 != VehicleSha256(vehicle)) {
    AddProblem(*warnings, *reference, PathOfPart(*reference, root, "reference"),
               "the reference was found for another vehicle; flights will miss its orbit",
               "a reference that `dispersa optimize` wrote for this vehicle");
  }
  return decoded;
}

std::string VehicleSha256(const InputNode& vehicle) { return Sha256Hex(CanonicalText(vehicle)); }

std::string FlightId(const InputNode& campaign, SamplingMethod method) {
  InputNode deciding = MapAt(campaign);
  for (const char* key : {"vehicle", "reference", "autopilot", "dispersions"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(deciding, key, *value);
  }
  InputNode sampling = MapAt(campaign);
  SetMember(sampling, "method", *campaign.Find("sampling")->Find("method"));
  SetMember(sampling, "seed", *campaign.Find("sampling")->Find("seed"));
  // The strata of a Latin hypercube depend on their number; every other case stands for itself.
  if (method == SamplingMethod::kLatinHypercube) {
    SetMember(sampling, "cases", *campaign.Find("sampling")->Find("cases"));
  }
  SetMember(deciding, "sampling", std::move(sampling));
  InputNode engine = ScalarAt(campaign, EngineVersion());
  engine.quoted = true;
  SetMember(deciding, "engine", std::move(engine));
  return Sha256Hex(CanonicalText(deciding));
}

}  // namespace dispersa
