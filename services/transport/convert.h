// Between the plain messages and the generated types.
#pragma once

#include <optional>
#include <variant>

#include <dispersion.h>

#include "services/transport/messages.h"

namespace dispersa {

idl::WorkerStatusV1 ToIdl(const WorkerStatus& status);
idl::CampaignV1 ToIdl(const CampaignDefinition& campaign);
idl::AssignmentV1 ToIdl(const FlyOrder& order);
idl::AssignmentV1 ToIdl(const LeaveOrder& order);
idl::ReportV1 ToIdl(const Report& report);
idl::RefusalV1 ToIdl(const Refusal& refusal);
idl::CampaignRefusalV1 ToIdl(const CampaignRefusal& refusal);

WorkerStatus FromIdl(const idl::WorkerStatusV1& status);
CampaignDefinition FromIdl(const idl::CampaignV1& campaign);
std::variant<FlyOrder, LeaveOrder> FromIdl(const idl::AssignmentV1& assignment);
/// None if a result has an outcome that this version does not know.
std::optional<Report> FromIdl(const idl::ReportV1& report);
Refusal FromIdl(const idl::RefusalV1& refusal);
CampaignRefusal FromIdl(const idl::CampaignRefusalV1& refusal);

}  // namespace dispersa
