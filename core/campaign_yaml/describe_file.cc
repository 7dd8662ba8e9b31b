#include "core/campaign_yaml/describe_file.h"

#include "core/campaign_yaml/decode_campaign.h"
#include "core/campaign_yaml/named_files.h"

namespace dispersa {
namespace {

template <class T, class F>
void OfOne(F describe) {
  T value;
  describe(value);
}

}  // namespace

const BaseKeys& CampaignBase() {
  static const BaseKeys keys = {kCampaignSchema, "a campaign", {"dispersions"}};
  return keys;
}
const BaseKeys& VehicleBase() {
  static const BaseKeys keys = {kVehicleSchema, "a vehicle"};
  return keys;
}

void DescribeVehicleFile(Fields& fields, Vehicle& vehicle) {
  fields.File(kVehicleSchema, &VehicleBase());
  Describe(fields, vehicle);
}

void DescribeReferenceFile(Fields& fields, Reference& reference) {
  fields.File(kReferenceSchema);
  Describe(fields, reference);
}

void DescribeAutopilotFile(Fields& fields, AutopilotConfig& autopilot, const OpenPlugin& open) {
  fields.File(kAutopilotSchema);
  Describe(fields, autopilot, open);
}

void DescribeScenarioFile(Fields& fields, Scenario& scenario) {
  fields.File(kScenarioSchema);
  Describe(fields, scenario);
}

void DescribeFile(FileKind kind, Fields& fields) {
  switch (kind) {
    case FileKind::kCampaign:
      return DescribeCampaignFile(fields);
    case FileKind::kVehicle:
      return OfOne<Vehicle>([&](Vehicle& vehicle) { DescribeVehicleFile(fields, vehicle); });
    case FileKind::kReference:
      return OfOne<Reference>([&](Reference& reference) { DescribeReferenceFile(fields, reference); });
    case FileKind::kAutopilot:
      return OfOne<AutopilotConfig>(
          [&](AutopilotConfig& autopilot) { DescribeAutopilotFile(fields, autopilot, {}); });
    case FileKind::kScenario:
      return OfOne<Scenario>([&](Scenario& scenario) { DescribeScenarioFile(fields, scenario); });
  }
}

}  // namespace dispersa
