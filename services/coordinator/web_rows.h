// The campaigns of a service as its web application shows them.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "services/coordinator/service.h"
#include "services/web/campaign_row.h"

namespace dispersa {

/// Rows of campaigns that have ended are made once, so that thousands of them cost nothing each second.
class WebRows {
 public:
  std::shared_ptr<const CampaignIndex> Make(const Service& service, const Workforce& workforce);

 private:
  std::map<std::string, CampaignIndex::Row> ended_;  ///< by id
};

}  // namespace dispersa
