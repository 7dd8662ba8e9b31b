#include "core/flight/flight.h"

#include <memory>

#include "core/flight/flight_queue.h"
#include "core/flight/lane_engine.h"
#include "core/flight/launch_frame.h"
#include "core/math/assertion.h"

namespace dispersa {

namespace {

class OrderQueue : public FlightQueue {
 public:
  OrderQueue(const FlightModel& model, const std::vector<FlightOrder>& orders)
      : model_(model), orders_(orders), records_(orders.size()), results_(orders.size()) {}

  FlightRecord* Next(bool) override {
    if (next_ == orders_.size()) return nullptr;
    records_[next_] = std::make_unique<FlightRecord>(model_, orders_[next_]);
    return records_[next_++].get();
  }
  void Done(FlightRecord* record) override {
    std::size_t i = 0;
    while (i < next_ && records_[i].get() != record) ++i;
    DISPERSA_ASSERT(i < next_, next_);
    results_[i] = record->Result();
    records_[i].reset();
  }
  std::vector<FlightResult> Take() { return std::move(results_); }

 private:
  const FlightModel& model_;
  const std::vector<FlightOrder>& orders_;
  std::vector<std::unique_ptr<FlightRecord>> records_;
  std::vector<FlightResult> results_;
  std::size_t next_ = 0;
};

// About the vertical of the launch site: z of the launch-inertial frame is down.
Quaternion TurnedClockwise(double angle_rad) { return FromRotationVector(Vector3(0.0, 0.0, angle_rad)); }

}  // namespace

FlightResult Fly(const FlightModel& model, const FlightInputs& inputs, const FlightOptions& options) {
  const std::vector<FlightOrder> order = {{inputs, options}};
  OrderQueue queue(model, order);
  OneLaneEngine().fly(model, queue);
  return std::move(queue.Take().front());
}

std::vector<FlightResult> FlyAll(const FlightModel& model, const std::vector<FlightOrder>& orders) {
  OrderQueue queue(model, orders);
  EngineFor(orders.size()).fly(model, queue);
  return queue.Take();
}

RigidBodyState LiftOffState(const FlightModel& model, const FlightInputs& in) {
  const LaunchFrame& frame = model.frame();
  RigidBodyState s;
  s.p_EoC_I = frame.p_EoL_I;
  s.v_IC_I = frame.v_IL_I;
  s.q_IB = frame.q_IL * model.definition().program.At(0.0).q_LR;
  if (in.launch_azimuth_error_rad != 0.0)
    s.q_IB = frame.q_IL * TurnedClockwise(in.launch_azimuth_error_rad) * Inverse(frame.q_IL) * s.q_IB;
  const Vector3 aside(in.initial_roll_error_rad, in.initial_pitch_error_rad, in.initial_yaw_error_rad);
  if (aside != Vector3::Zero()) s.q_IB = s.q_IB * FromRotationVector(aside);
  const Vector3 earth_rate_I(0.0, 0.0, model.nominal_plant().environment.earth.rotation_rate_rad_s);
  s.w_IB_B = Rotate(Inverse(s.q_IB), earth_rate_I);
  return s;
}

Quaternion BelievedAttitude(const FlightModel& model, const FlightInputs& in, const Quaternion& q_IB) {
  if (in.launch_azimuth_error_rad == 0.0) return q_IB;
  const Quaternion& q_IL = model.frame().q_IL;
  return q_IL * TurnedClockwise(-in.launch_azimuth_error_rad) * Inverse(q_IL) * q_IB;
}

AttitudeError ErrorAt(const FlightModel& model, const ReferenceAttitude& reference,
                      const RigidBodyState& state) {
  const Quaternion q_IR = model.frame().q_IL * reference.q_LR;
  const Quaternion q_BR = Inverse(state.q_IB) * q_IR;
  AttitudeError error;
  error.angle_rad = RotationVector(q_BR);
  error.rate_rad_s = Rotate(q_BR, reference.w_LR_R) - state.w_IB_B;
  return error;
}

}  // namespace dispersa
