// The cases of a campaign: draw one, fly it. A result depends on nothing but the flight id and the index.
#pragma once

#include <cstdint>
#include <memory>

#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign/case_result.h"
#include "core/dynamics/integrator.h"
#include "core/flight/history.h"

namespace dispersa {

class FlightModel;

/// Holds what all flights of a campaign share (tables, schedules, design); flying is const and thread-safe.
class CampaignFlights {
 public:
  explicit CampaignFlights(const Campaign& campaign);
  ~CampaignFlights();

  const FlightModel& model() const { return *model_; }
  /// The inputs of a case, as its flight applies them.
  FlightInputs Draw(std::uint64_t case_index) const { return design_.Draw(case_index); }
  CaseResult FlyCase(std::uint64_t case_index, History* history = nullptr) const;
  /// The flight without dispersions; its case_index is 0 and means nothing.
  CaseResult FlyNominal(History* history = nullptr) const;
  /// Any inputs, with any integrator: `case_index` keys the sensors' noise.
  CaseResult Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                 Scheme scheme = Scheme::kRungeKutta4) const;

 private:
  CaseDesign design_;
  std::unique_ptr<FlightModel> model_;
};

}  // namespace dispersa
