// The pages of the web application as texts: functions of the campaigns, without a network.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "services/web/campaign_row.h"

namespace dispersa {

/// The text of a file of a campaign ("campaign.yaml", "summary.json", "report.html"); none if there is none.
using CampaignFile =
    std::function<std::optional<std::string>(const std::string& id, const std::string& file)>;

inline constexpr std::size_t kRowsOfPage = 50;

/// `page` from 1.
std::string ListPage(const CampaignIndex& index, const std::string& search, std::size_t page);

/// What of a campaign's page changes while it flies. A script replaces it.
std::string CampaignPart(const CampaignIndex& index, const CampaignRow& row, bool has_report);
std::string CampaignPage(const CampaignIndex& index, const CampaignRow& row, bool has_report);

/// What differs between two campaigns: inputs, engine, requirements, verdict, drivers.
std::string DifferencePage(const CampaignRow& a, const CampaignRow& b, const CampaignFile& file);

/// Without a metric: all metrics that are required.
std::string TrendPage(const CampaignIndex& index, const std::string& metric, const std::string& search);

/// `next`: where to go on.
std::string LoginPage(const std::string& next, bool was_wrong);
std::string ErrorPage(const std::string& title, const std::string& text);

std::string WebStyleSheet();
std::string_view WebScript();

}  // namespace dispersa
