#include "core/campaign_yaml/file_kind.h"

#include <cstddef>

#include "core/campaign_yaml/named_files.h"

namespace dispersa {

std::string NameOf(FileKind kind) {
  constexpr const char* kNames[] = {"campaign", "vehicle", "reference", "autopilot", "scenario"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string SchemaOf(FileKind kind) {
  constexpr const char* kSchemas[] = {kCampaignSchema, kVehicleSchema, kReferenceSchema, kAutopilotSchema,
                                      kScenarioSchema};
  return kSchemas[static_cast<std::size_t>(kind)];
}

}  // namespace dispersa
