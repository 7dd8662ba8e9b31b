// The cases of a campaign: draw one, fly it. A result depends on nothing but the flight id and the index.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/cases/flight_orders.h"
#include "core/cases/flights_here.h"

namespace dispersa {

class ForeignFlights;

/// A case of a list, and whether its history is wanted.
struct CaseOrder {
  std::uint64_t case_index = 0;
  double history_step_s = 0.0;  ///< 0: no history
};
/// A flown case: its position in the list, its result, and its history (empty if none was wanted).
using CaseObserver = std::function<void(std::size_t order, CaseResult result, const History& history)>;

/// Flies the cases of a campaign in this process. If the control law is a plug-in, they are flown by
/// processes of dispersa-foreign (foreign_flights.h). Flying is const and thread-safe. Throws PluginError if
/// the plug-in cannot be used. Throws ContainedEnd if the plug-in ends the process of a flight outside a
/// queue.
class CampaignFlights {
 public:
  /// With a plug-in, `campaign` is as it was loaded: the text that it keeps is what is flown.
  explicit CampaignFlights(const Campaign& campaign);
  ~CampaignFlights();

  const FlightModel& model() const { return here_.model(); }
  /// Which inputs a result has.
  const RowInputs& rows() const { return here_.rows(); }
  /// The inputs of a case, as its flight applies them.
  FlightInputs Draw(std::uint64_t case_index) const { return here_.Draw(case_index); }
  CaseResult FlyCase(std::uint64_t case_index, History* history = nullptr) const;
  /// The flight without dispersions. Its case_index is 0 and has no meaning.
  CaseResult FlyNominal(History* history = nullptr) const;
  /// Any inputs, with any integrator: `case_index` keys the sensors' noise.
  CaseResult Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                 Scheme scheme = Scheme::kSimpson) const;

  /// Flies the queue's cases side by side on this thread until it has none. Results are those of FlyCase.
  void FlyCases(CaseQueue& queue) const;
  /// Flies a list side by side on up to `threads` threads, including this one. `done` is called by one thread
  /// at a time, in the order in which flights end. Throws the exceptions of `done`.
  void FlyCases(const std::vector<CaseOrder>& orders, int threads, const CaseObserver& done) const;
  /// Flies an order (flight_orders.h), where those flights are flown.
  std::vector<FlownOnce> FlyOrdered(const std::string& order, const StopCheck& should_stop = nullptr) const;

 private:
  FlightsHere here_;
  std::unique_ptr<const ForeignFlights> foreign_;  ///< none: flown here
};

/// The nominal flight of a campaign whose cases were flown by the engine `engine`; none if that is not this
/// one, or if a plug-in decides it.
std::optional<CaseResult> NominalOf(const Campaign& campaign, const std::string& engine);

}  // namespace dispersa
