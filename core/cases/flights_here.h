// The cases of a campaign flown in this process, with any control law.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign/case_result.h"
#include "core/dynamics/integrator.h"
#include "core/flight/history.h"

namespace dispersa {

class FlightModel;

/// Source of a thread's cases and destination of their results.
class CaseQueue {
 public:
  virtual ~CaseQueue() = default;

  /// The next case, or none now. `idle`: nothing else is in flight on this thread, so none ends FlyCases.
  virtual std::optional<std::uint64_t> Next(bool idle) = 0;
  virtual void Done(CaseResult result) = 0;
  /// A case that ended every process that flew it, alone too: it has no result.
  virtual void Quarantined(std::uint64_t case_index, const std::string& reason) = 0;
};

/// Tables, schedules and design that all flights of a campaign share. Flying is const and thread-safe.
class FlightsHere {
 public:
  explicit FlightsHere(const Campaign& campaign);
  ~FlightsHere();

  const FlightModel& model() const { return *model_; }
  /// Which inputs a result has.
  const RowInputs& rows() const { return rows_; }
  /// The inputs of a case, as its flight applies them.
  FlightInputs Draw(std::uint64_t case_index) const { return design_.Draw(case_index); }
  /// Any inputs, with any integrator: `case_index` keys the sensors' noise.
  CaseResult Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history, Scheme scheme) const;
  /// Flies the queue's cases side by side on this thread until it has none.
  void FlyCases(CaseQueue& queue) const;
  /// Whether a result has the form of these flights' results, whoever made it.
  bool IsResult(const CaseResult& result) const;

 private:
  CaseDesign design_;
  RowInputs rows_;
  std::unique_ptr<FlightModel> model_;
  std::size_t metrics_;
};

}  // namespace dispersa
