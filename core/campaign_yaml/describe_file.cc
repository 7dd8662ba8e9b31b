#include "core/campaign_yaml/describe_file.h"

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_campaign.h"

namespace dispersa {

void DescribeFile(FileKind kind, Fields& fields) {
  switch (kind) {
    case FileKind::kVehicle: {
      Vehicle vehicle;
      DescribeVehicleFile(fields, vehicle);
      break;
    }
    case FileKind::kCampaign:
      DescribeCampaignFile(fields);
      break;
    case FileKind::kReference: {
      Reference reference;
      DescribeReferenceFile(fields, reference);
      break;
    }
    case FileKind::kScenario: {
      Scenario scenario;
      DescribeScenarioFile(fields, scenario);
      break;
    }
    case FileKind::kAutopilot: {
      AutopilotConfig autopilot;
      DescribeAutopilotFile(fields, autopilot, nullptr);
      break;
    }
    default:
      break;
  }
}

}  // namespace dispersa
