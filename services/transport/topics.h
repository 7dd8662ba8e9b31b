// Names of the topics: idl/dispersion.idl. Internal to this folder.
#pragma once

#include <string>

#include <dispersionPubSubTypes.h>

namespace dispersa {

inline const std::string kStatusTopic = "dispersa/WorkerStatusV1";
inline const std::string kCampaignTopic = "dispersa/CampaignV1";
inline const std::string kAssignmentTopic = "dispersa/AssignmentV1";
inline const std::string kReportTopic = "dispersa/ReportV1";
inline const std::string kRefusalTopic = "dispersa/RefusalV1";
inline const std::string kCampaignRefusalTopic = "dispersa/CampaignRefusalV1";

/// Of what is meant for one worker only.
inline std::string PartitionOf(const std::string& worker) { return "w" + worker; }

}  // namespace dispersa
