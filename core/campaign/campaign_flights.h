// The cases of a campaign: draw one, fly it. A result depends on nothing but the flight id and the index.
#pragma once

#include <cstdint>
#include <memory>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/flight/history.h"

namespace dispersa {

/// Draws the inputs of case `case_index`. Pure.
FlightInputs DrawCase(const Campaign& campaign, std::uint64_t case_index);

class FlightModel;

/// Holds what all flights of a campaign share (tables, schedules); flying is const and thread-safe.
class CampaignFlights {
 public:
  explicit CampaignFlights(const Campaign& campaign);
  ~CampaignFlights();

  CaseResult FlyCase(std::uint64_t case_index, History* history = nullptr) const;
  /// The flight without dispersions; its case_index is 0 and means nothing.
  CaseResult FlyNominal(History* history = nullptr) const;
  CaseResult Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history) const;

 private:
  Campaign campaign_;
  std::unique_ptr<FlightModel> model_;
};

}  // namespace dispersa
