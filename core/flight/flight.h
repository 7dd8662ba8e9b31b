// Closed-loop flights from lift-off to injection, or to where they fail.
//
// One engine flies them: lanes side by side (batch.h), of which a single flight is the one-lane instance.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/integrator.h"
#include "core/flight/digest.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/flight_model.h"
#include "core/flight/history.h"
#include "core/flight/metrics.h"
#include "core/flight/seen_event.h"

namespace dispersa {

struct TickSample;

struct FlightOptions {
  Scheme scheme = Scheme::kSimpson;
  int steps_per_tick = 1;
  std::uint64_t case_index = 0;                         ///< keys the sensors' noise
  History* history = nullptr;                           ///< filled if given
  std::function<void(const TickSample&)> observe = {};  ///< called at every tick if given
};

struct FlightResult {
  Outcome outcome = Outcome::kCompleted;
  double end_time_s = 0.0;
  int end_stage = 0;  ///< 1-based
  std::string reason;
  std::vector<double> metrics;    ///< of the vehicle, in the order of MetricNames(), then the campaign's own
  std::vector<SeenEvent> events;  ///< in the order of their times
  Digest digest;
  RigidBodyState end_state;
};

/// Flies one flight: a pure function of its arguments. It keeps no state.
FlightResult Fly(const FlightModel& model, const FlightInputs& inputs, const FlightOptions& options = {});

/// One flight of many.
struct FlightOrder {
  FlightInputs inputs;
  FlightOptions options = {};
};
/// Flies all orders side by side in ChosenLanes() on this thread. The results are in the order of the orders.
/// Each result has the bits that Fly gives.
std::vector<FlightResult> FlyAll(const FlightModel& model, const std::vector<FlightOrder>& orders);

/// State at lift-off: at rest on the site, attitude as the pitch program begins, with the flight's own
/// errors.
RigidBodyState LiftOffState(const FlightModel& model, const FlightInputs& inputs = {});
/// The attitude that the inertial unit measures for a true attitude at rest. The unit does not know its error
/// of the launch azimuth.
Quaternion BelievedAttitude(const FlightModel& model, const FlightInputs& inputs, const Quaternion& q_IB);
/// Attitude error, reference less true, and its rate.
AttitudeError ErrorAt(const FlightModel& model, const ReferenceAttitude& reference,
                      const RigidBodyState& state);

}  // namespace dispersa
