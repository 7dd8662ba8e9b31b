// Between the plain messages and the generated types. Internal to this folder.
#pragma once

#include <optional>

#include <dispersion.h>

#include "services/transport/messages.h"

namespace dispersa {

idl::WorkerStatusV2 ToIdl(const WorkerStatus& status);
idl::OrdersV1 ToIdl(const Orders& orders);
idl::ReportV3 ToIdl(const Report& report);
idl::TextRequestV1 ToIdl(const TextRequest& request);
idl::TextV1 ToIdl(const TextPart& part);
idl::CampaignRefusalV2 ToIdl(const CampaignRefusal& refusal);
idl::ProgressV1 ToIdl(const CampaignProgress& progress);
idl::ResultV2 ToIdl(const std::string& flight_id, const std::string& worker, const FlownCase& flown);
idl::RequestV1 ToIdl(const Request& request);
idl::ReplyV1 ToIdl(const Reply& reply);

// None if the message has an enumerator or an outcome that this version does not know.
std::optional<WorkerStatus> FromIdl(const idl::WorkerStatusV2& status);
std::optional<Orders> FromIdl(const idl::OrdersV1& orders);
std::optional<Report> FromIdl(const idl::ReportV3& report);
std::optional<TextRequest> FromIdl(const idl::TextRequestV1& request);
std::optional<TextPart> FromIdl(const idl::TextV1& part);
std::optional<CampaignRefusal> FromIdl(const idl::CampaignRefusalV2& refusal);
std::optional<CampaignProgress> FromIdl(const idl::ProgressV1& progress);
std::optional<Request> FromIdl(const idl::RequestV1& request);
std::optional<Reply> FromIdl(const idl::ReplyV1& reply);

}  // namespace dispersa
