#include "core/campaign_yaml/load.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>

#include "core/campaign/free_flight.h"
#include "core/campaign_yaml/campaign_ids.h"
#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_campaign.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/campaign_yaml/named_files.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/campaign_yaml/plan_warnings.h"
#include "core/campaign_yaml/sha256.h"
#include "core/campaign_yaml/standard_input.h"
#include "core/input/base_file.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

std::string SchemaNames() {
  return "one of " +
         JoinWords({kCampaignSchema, kVehicleSchema, kAutopilotSchema, kReferenceSchema, kScenarioSchema});
}

InputNode Read(const InputSource& source, ProblemList& problems) {
  return source.text ? ParseYaml(*source.text, source.name, problems) : ReadYamlFile(source.name, problems);
}

// In the order of the text, file by file: the tree's own, then those that it names as they were met first.
void SortByPlace(ProblemList& problems, const InputNode& root) {
  std::vector<std::string> files;
  if (root.file != nullptr) files.push_back(*root.file);
  for (const InputProblem& problem : problems) {
    if (std::find(files.begin(), files.end(), problem.file) == files.end()) files.push_back(problem.file);
  }
  const auto place = [&](const InputProblem& problem) {
    return std::tuple(std::find(files.begin(), files.end(), problem.file) - files.begin(), problem.line,
                      problem.column);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const InputProblem& a, const InputProblem& b) { return place(a) < place(b); });
}

void ThrowIfAny(ProblemList problems, const InputNode& root) {
  if (problems.empty()) return;
  SortByPlace(problems, root);
  throw InputError(std::move(problems));
}

// The command line's values replace the file's; a campaign without a sampling block is reported later.
void Override(InputNode& root, const CampaignOverrides& overrides) {
  InputNode* sampling = root.Find("sampling");
  if (sampling == nullptr || sampling->kind != InputNode::Kind::kMap) return;
  if (overrides.cases) {
    const std::string cases = std::to_string(*overrides.cases);
    SetMember(*sampling, "cases", ScalarAt(*sampling, cases));
    InputNode* verdicts = root.Find("verdicts");
    if (verdicts != nullptr && verdicts->Find("max_cases") != nullptr)
      SetMember(*verdicts, "max_cases", ScalarAt(*verdicts, cases));
  }
  if (overrides.seed) SetMember(*sampling, "seed", ScalarAt(*sampling, std::to_string(*overrides.seed)));
}

// A name in a file is relative to that file; one of the command line is not.
void OverrideAutopilot(InputNode& root, const CampaignOverrides& overrides, ProblemList& problems) {
  if (!overrides.autopilot || root.kind != InputNode::Kind::kMap) return;
  if (*overrides.autopilot == kStandardInput) {
    SetMember(root, "autopilot", ReadYamlFile(kStandardInput, problems));
    return;
  }
  SetMember(root, "autopilot", ScalarAt(root, std::filesystem::absolute(*overrides.autopilot).string()));
}

Campaign FinishCampaign(InputNode root, FileNames names, const CampaignOverrides& overrides, CampaignUse use,
                        ProblemList problems, std::vector<InputProblem>* warnings) {
  NamedFiles files(names);
  WriteOut(root, CampaignBase(), "", problems, &files);
  OverrideAutopilot(root, overrides, problems);
  std::string vehicle_file;
  if (const InputNode* vehicle = root.Find("vehicle");
      vehicle != nullptr && vehicle->kind == InputNode::Kind::kScalar)
    vehicle_file = std::filesystem::path(vehicle->text).filename().string();
  Override(root, overrides);
  DecodedCampaign decoded = DecodeCampaign(root, use, problems, &files, warnings);
  ThrowIfAny(std::move(problems), root);
  Campaign& campaign = decoded.campaign;
  campaign.vehicle_file = std::move(vehicle_file);
  campaign.canonical_yaml = CanonicalText(root);
  campaign.id = Sha256Hex(campaign.canonical_yaml);
  campaign.flight_id = FlightId(root, campaign.sampling.method);
  campaign.requirements_id = RequirementsId(root);
  campaign.own_metrics_id = OwnMetricsId(campaign.flight_id, campaign.own_metrics);
  campaign.design_id = DesignId(root);
  return std::move(campaign);
}

// decode(tree, problems, files) of a text.
template <class F>
auto Decode(const InputSource& source, F decode) {
  ProblemList problems;
  InputNode root = Read(source, problems);
  NamedFiles files(source.text ? FileNames::kRefused : FileNames::kAllowed);
  auto value = decode(root, problems, &files);
  ThrowIfAny(std::move(problems), root);
  return value;
}

// Of a campaign that flies nothing but its nominal flight.
constexpr char kCheckFlight[] =
    "schema: dispersa/campaign/1\nsampling: {method: monte_carlo, cases: 1, seed: 1}\n";

}  // namespace

Campaign LoadCampaign(const InputSource& source, const CampaignOverrides& overrides,
                      std::vector<InputProblem>* warnings) {
  ProblemList problems;
  InputNode root = Read(source, problems);
  return FinishCampaign(std::move(root), FileNames::kAllowed, overrides, CampaignUse::kFly,
                        std::move(problems), warnings);
}

Campaign ReadFlownCampaign(const InputSource& source) {
  ProblemList problems;
  InputNode root = Read(source, problems);
  return FinishCampaign(std::move(root), FileNames::kAllowed, {}, CampaignUse::kRead, std::move(problems),
                        nullptr);
}

Campaign ParseCampaign(const std::string& yaml_text, const std::string& display_name) {
  ProblemList problems;
  InputNode root = ParseYaml(yaml_text, display_name, problems);
  return FinishCampaign(std::move(root), FileNames::kRefused, {}, CampaignUse::kFly, std::move(problems),
                        nullptr);
}

OptimizationInput LoadOptimization(const InputSource& source, std::optional<std::uint64_t> seed,
                                   std::vector<InputProblem>* warnings) {
  ProblemList problems;
  InputNode root = Read(source, problems);
  NamedFiles files;
  DecodedCampaign decoded = DecodeCampaign(root, CampaignUse::kOptimize, problems, &files, warnings);
  ThrowIfAny(std::move(problems), root);
  RequireControl(decoded.campaign, "a trajectory");
  OptimizationInput input;
  input.name = decoded.campaign.name;
  input.vehicle = std::move(decoded.campaign.vehicle);
  input.vehicle_sha256 = VehicleSha256(*root.Find("vehicle"));
  input.problem = decoded.optimize.value_or(decoded.campaign.reference.problem);
  if (seed) input.problem.seed = *seed;
  input.tick_s = decoded.campaign.autopilot.tick_s;
  if (root.Find("autopilot") == nullptr) return input;
  InputNode flown = ParseYaml(kCheckFlight, source.name, problems);
  for (const char* key : {"name", "vehicle", "autopilot"}) SetMember(flown, key, *root.Find(key));
  input.canonical_yaml = CanonicalText(flown);
  return input;
}

std::optional<Campaign> CampaignOf(const OptimizationInput& input, const Reference& reference) {
  if (input.canonical_yaml.empty()) return std::nullopt;
  ProblemList problems;
  InputNode root = ParseYaml(input.canonical_yaml, input.name, problems);
  SetMember(root, "reference", ParseYaml(WriteReference(reference), input.name, problems));
  return FinishCampaign(std::move(root), FileNames::kRefused, {}, CampaignUse::kFly, std::move(problems),
                        nullptr);
}

Vehicle LoadVehicle(const InputSource& source, std::vector<InputProblem>* warnings) {
  return Decode(source, [&](InputNode& root, ProblemList& problems, FileSource* files) {
    return DecodeVehicle(root, "", problems, files, warnings);
  });
}

Scenario LoadScenario(const InputSource& source) {
  return Decode(source, [](InputNode& root, ProblemList& problems, FileSource* files) {
    return DecodeFile<Scenario>(root, "", problems, files, DescribeScenarioFile);
  });
}

AutopilotConfig LoadAutopilot(const InputSource& source) {
  return Decode(source, [](InputNode& root, ProblemList& problems, FileSource* files) {
    return DecodeAutopilot(root, "", 0, problems, files);
  });
}

Reference LoadReference(const InputSource& source) {
  return Decode(source, [](InputNode& root, ProblemList& problems, FileSource* files) {
    return DecodeFile<Reference>(root, "", problems, files, DescribeReferenceFile);
  });
}

bool IsScenarioFile(const std::string& path) {
  ProblemList ignored;
  const InputNode root = ReadYamlFile(path, ignored);
  const InputNode* schema = root.Find("schema");
  return schema != nullptr && schema->text == kScenarioSchema;
}

FileCheck CheckFile(const InputSource& source) {
  FileCheck check;
  ProblemList& problems = check.errors;
  InputNode root = Read(source, problems);
  NamedFiles files;
  const InputNode* schema = root.Find("schema");
  if (root.file == nullptr) {
    // Unreadable or not YAML: reported.
  } else if (schema == nullptr) {
    AddProblem(problems, root, "", "missing key 'schema'", SchemaNames());
  } else if (schema->text == kCampaignSchema) {
    const Campaign campaign =
        DecodeCampaign(root, CampaignUse::kCheck, problems, &files, &check.warnings).campaign;
    if (problems.empty())
      for (InputProblem& warning : PlanWarnings(campaign, root)) check.warnings.push_back(std::move(warning));
    check.vehicle = campaign.vehicle;
  } else if (schema->text == kVehicleSchema) {
    check.vehicle = DecodeVehicle(root, "", problems, &files, &check.warnings);
    check.is_vehicle = true;
  } else if (schema->text == kAutopilotSchema) {
    DecodeAutopilot(root, "", 0, problems, &files);
  } else if (schema->text == kReferenceSchema) {
    DecodeFile<Reference>(root, "", problems, &files, DescribeReferenceFile);
  } else if (schema->text == kScenarioSchema) {
    DecodeFile<Scenario>(root, "", problems, &files, DescribeScenarioFile);
  } else {
    AddProblem(problems, *schema, "schema", schema->Describe() + " is not a schema", SchemaNames());
  }
  if (!problems.empty()) {
    check.vehicle.reset();
    check.warnings.clear();
  }
  SortByPlace(problems, root);
  SortByPlace(check.warnings, root);
  return check;
}

}  // namespace dispersa
