// Names of the topics: idl/dispersion.idl. Internal to this folder.
#pragma once

#include <string>

#include <dispersionPubSubTypes.h>

namespace dispersa {

inline const std::string kStatusTopic = "dispersa/WorkerStatusV2";
inline const std::string kOrdersTopic = "dispersa/OrdersV1";
inline const std::string kReportTopic = "dispersa/ReportV3";
inline const std::string kTextRequestTopic = "dispersa/TextRequestV1";
inline const std::string kTextTopic = "dispersa/TextV1";
inline const std::string kCampaignRefusalTopic = "dispersa/CampaignRefusalV2";
inline const std::string kProgressTopic = "dispersa/ProgressV1";
inline const std::string kResultTopic = "dispersa/ResultV2";
inline const std::string kRequestTopic = "dispersa/RequestV1";
inline const std::string kReplyTopic = "dispersa/ReplyV1";

/// Topics that anybody may read and that no worker or coordinator acts on. They are not sealed, so that
/// programs of others can read them.
inline bool IsForObservers(const std::string& topic) {
  return topic == kProgressTopic || topic == kResultTopic;
}

/// The partition of messages for one worker or client only.
inline std::string PartitionOf(const std::string& who) { return "w" + who; }

}  // namespace dispersa
