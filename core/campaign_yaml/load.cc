#include "core/campaign_yaml/load.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <tuple>

#include "core/campaign_yaml/campaign_ids.h"
#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_campaign.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/campaign_yaml/standard_input.h"
#include "core/input/map_reader.h"

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

// In the order of the text, file by file as they were met first.
void SortByPlace(ProblemList& problems) {
  std::vector<std::string> files;
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

void ThrowIfAny(ProblemList problems) {
  if (problems.empty()) return;
  SortByPlace(problems);
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
  OverrideAutopilot(root, overrides, problems);
  InlineCampaignFiles(root, names, problems);
  Override(root, overrides);
  DecodedCampaign decoded = DecodeCampaign(root, use, problems, warnings);
  ThrowIfAny(std::move(problems));
  Campaign& campaign = decoded.campaign;
  campaign.canonical_yaml = CanonicalText(root);
  campaign.id = Sha256Hex(campaign.canonical_yaml);
  campaign.flight_id = FlightId(root, campaign.sampling.method);
  campaign.requirements_id = RequirementsId(root);
  return std::move(campaign);
}

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
  InlineCampaignFiles(root, FileNames::kAllowed, problems);
  DecodedCampaign decoded = DecodeCampaign(root, CampaignUse::kOptimize, problems, warnings);
  ThrowIfAny(std::move(problems));
  OptimizationInput input;
  input.name = decoded.campaign.name;
  input.vehicle = std::move(decoded.campaign.vehicle);
  input.vehicle_sha256 = VehicleSha256(*root.Find("vehicle"));
  input.problem = decoded.optimize.value_or(decoded.campaign.reference.problem);
  if (seed) input.problem.seed = *seed;
  input.tick_s = decoded.campaign.autopilot.tick_s;
  if (root.Find("autopilot") != nullptr) input.autopilot = std::move(decoded.campaign.autopilot);
  return input;
}

Vehicle LoadVehicle(const std::string& path, std::vector<InputProblem>* warnings) {
  ProblemList problems;
  InputNode root = ReadYamlFile(path, problems);
  InlineVehicleFiles(root, FileNames::kAllowed, problems);
  Vehicle vehicle = DecodeVehicle(root, "", problems, warnings);
  ThrowIfAny(std::move(problems));
  return vehicle;
}

AutopilotConfig LoadAutopilot(const std::string& path) {
  ProblemList problems;
  InputNode root = ReadYamlFile(path, problems);
  InlineAutopilotFiles(root, "", FileNames::kAllowed, problems);
  AutopilotConfig autopilot = DecodeAutopilot(root, "", 0, problems);
  ThrowIfAny(std::move(problems));
  return autopilot;
}

Reference LoadReference(const std::string& path) {
  ProblemList problems;
  const InputNode root = ReadYamlFile(path, problems);
  Reference reference = DecodeReference(root, "", problems);
  ThrowIfAny(std::move(problems));
  return reference;
}

Scenario LoadScenario(const std::string& path) {
  ProblemList problems;
  InputNode root = ReadYamlFile(path, problems);
  InlineScenarioFiles(root, FileNames::kAllowed, problems);
  Scenario scenario = DecodeScenario(root, "", problems);
  ThrowIfAny(std::move(problems));
  return scenario;
}

bool IsScenarioFile(const std::string& path) {
  ProblemList ignored;
  const InputNode root = ReadYamlFile(path, ignored);
  const InputNode* schema = root.Find("schema");
  return schema != nullptr && schema->text == kScenarioSchema;
}

Reference ReadReference(const std::string& yaml_text, const std::string& display_name) {
  ProblemList problems;
  const InputNode root = ParseYaml(yaml_text, display_name, problems);
  Reference reference = DecodeReference(root, "", problems);
  ThrowIfAny(std::move(problems));
  return reference;
}

AutopilotConfig ReadAutopilot(const std::string& yaml_text, const std::string& display_name) {
  ProblemList problems;
  const InputNode root = ParseYaml(yaml_text, display_name, problems);
  AutopilotConfig autopilot = DecodeAutopilot(root, "", 0, problems);
  ThrowIfAny(std::move(problems));
  return autopilot;
}

FileCheck CheckFile(const InputSource& source) {
  FileCheck check;
  ProblemList& problems = check.errors;
  InputNode root = Read(source, problems);
  const InputNode* schema = root.Find("schema");
  if (root.file == nullptr) {
    // Unreadable or not YAML: reported.
  } else if (schema == nullptr) {
    AddProblem(problems, root, "", "missing key 'schema'", SchemaNames());
  } else if (schema->text == kCampaignSchema) {
    InlineCampaignFiles(root, FileNames::kAllowed, problems);
    check.vehicle = DecodeCampaign(root, CampaignUse::kCheck, problems, &check.warnings).campaign.vehicle;
  } else if (schema->text == kVehicleSchema) {
    InlineVehicleFiles(root, FileNames::kAllowed, problems);
    check.vehicle = DecodeVehicle(root, "", problems, &check.warnings);
    check.is_vehicle = true;
  } else if (schema->text == kAutopilotSchema) {
    InlineAutopilotFiles(root, "", FileNames::kAllowed, problems);
    DecodeAutopilot(root, "", 0, problems);
  } else if (schema->text == kReferenceSchema) {
    DecodeReference(root, "", problems);
  } else if (schema->text == kScenarioSchema) {
    InlineScenarioFiles(root, FileNames::kAllowed, problems);
    DecodeScenario(root, "", problems);
  } else {
    AddProblem(problems, *schema, "schema", schema->Describe() + " is not a schema", SchemaNames());
  }
  if (!problems.empty()) {
    check.vehicle.reset();
    check.warnings.clear();
  }
  SortByPlace(problems);
  SortByPlace(check.warnings);
  return check;
}

}  // namespace dispersa
