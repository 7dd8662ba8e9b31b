// The kinds of input files.
#pragma once

#include <string>

namespace dispersa {

enum class FileKind { kCampaign, kVehicle, kReference, kAutopilot, kScenario };
inline constexpr FileKind kFileKinds[] = {FileKind::kCampaign, FileKind::kVehicle, FileKind::kReference,
                                          FileKind::kAutopilot, FileKind::kScenario};
/// "campaign"
std::string NameOf(FileKind kind);
/// "dispersa/campaign/1"
std::string SchemaOf(FileKind kind);

}  // namespace dispersa
