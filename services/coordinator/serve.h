// What dispersa-coordinator does, once it knows what is wanted. Each returns the exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/coordinator/open_campaign.h"
#include "services/transport/network.h"

namespace dispersa {

/// One campaign: serves it, writes its reports, ends. Gives up after `patience_s` without a worker.
int ServeCampaign(const NetworkOptions& network, const CampaignRequest& request,
                  std::optional<double> patience_s);

/// The campaigns that clients launch, kept in the folder `data`, until a signal to stop. Metrics on this port
/// of 127.0.0.1.
int ServeClients(const NetworkOptions& network, const std::string& data,
                 std::optional<std::uint16_t> metrics_port);

/// Whether a coordinator answers in this domain.
int AskHealth(const NetworkOptions& network);

}  // namespace dispersa
