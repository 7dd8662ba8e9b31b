// The cases of a campaign: draw one, fly it. A result depends on nothing but the flight id and the index.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign/case_result.h"
#include "core/dynamics/integrator.h"
#include "core/flight/history.h"

namespace dispersa {

class FlightModel;

/// Where a thread takes its cases from and puts their results.
class CaseQueue {
 public:
  virtual ~CaseQueue() = default;

  /// The next case, or none now. `idle`: nothing else is in flight on this thread; none then ends FlyCases.
  virtual std::optional<std::uint64_t> Next(bool idle) = 0;
  virtual void Done(CaseResult result) = 0;
  /// A case that ended every process that flew it, alone too: it has no result.
  virtual void GivenUp(std::uint64_t case_index, const std::string& reason) = 0;
};

/// A case of a list, and whether its history is wanted.
struct CaseOrder {
  std::uint64_t case_index = 0;
  double history_step_s = 0.0;  ///< 0: no history
};
/// What becomes of it: its position in the list, its result, and its history (empty where none was wanted).
using CaseObserver = std::function<void(std::size_t order, CaseResult result, const History& history)>;

/// Holds what all flights of a campaign share (tables, schedules, design); flying is const and thread-safe. A
/// campaign whose control law is a plug-in is flown in child processes (contained_flights.h); flying it
/// throws PluginError where the plug-in cannot be used, and ContainedEnd where it ends the process of a
/// flight that is not of a queue.
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
                 Scheme scheme = Scheme::kSimpson) const;

  /// Flies the queue's cases side by side on this thread until it has none. Results are those of FlyCase.
  void FlyCases(CaseQueue& queue) const;
  /// Flies a list side by side on up to `threads` threads, this one among them. `done` is called by one
  /// thread at a time, in the order in which flights end. Throws what it throws.
  void FlyCases(const std::vector<CaseOrder>& orders, int threads, const CaseObserver& done) const;

 private:
  bool NeedsChild() const;

  CaseDesign design_;
  std::unique_ptr<FlightModel> model_;
};

}  // namespace dispersa
