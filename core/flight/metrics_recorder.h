// Accumulates the metrics of one flight, sample by sample.
#pragma once

#include <array>
#include <vector>

#include "core/flight/flight_inputs.h"
#include "core/flight/flight_model.h"
#include "core/flight/orbit.h"
#include "core/flight/tick_sample.h"

namespace dispersa {

/// Root mean square and peak of a signed angle over samples.
struct ErrorStatistics {
  double squares = 0.0;
  double peak = 0.0;
  double peak_time_s = 0.0;
  long count = 0;

  void Add(double value, double time_s);
  double Rms() const;   ///< NaN without samples
  double Peak() const;  ///< likewise
};

/// Worst peak-to-peak of a signal in windows of one second with the straight line taken out.
class LimitCycleMeter {
 public:
  void Configure(double tick_s);
  void Interrupt() { filled_ = 0; }
  void Add(double value);
  double Worst() const { return worst_; }  ///< negative without a whole window

 private:
  std::vector<double> window_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::size_t since_evaluation_ = 0;
  std::size_t stride_ = 1;
  double worst_ = -1.0;
};

/// Definitions: core/README.md, "Metrics". Angles in rad inside, degrees in the result.
class MetricsRecorder {
 public:
  MetricsRecorder(const FlightModel& model, const FlightInputs& inputs);

  /// At every tick, before the plant moves on.
  void AddTick(const TickSample& sample);
  /// At burnouts, where loads peak between ticks.
  void AddLoads(const LauncherInstant& instant);
  /// At the last stage's ignition: what the reaction control hands over.
  void AddHandover(const AttitudeError& error);
  /// At the end of a completed flight.
  void AddInjection(const Earth& earth, const RigidBodyState& state, double altitude_m);
  void SetExpelledMass(double mass_kg) { expelled_mass_kg_ = mass_kg; }

  bool structural_limit_exceeded() const { return structural_exceeded_; }
  /// In the order of MetricNames().
  std::vector<double> Finish() const;

 private:
  struct Injection {
    bool reached = false;
    double altitude_m = 0.0;
    OrbitElements elements;
  };

  const FlightModel& model_;
  double tick_s_;
  double gust_bottom_m_ = 0.0;
  double gust_top_m_ = 0.0;
  ErrorStatistics pitch_, yaw_, roll_, pitch_coast_;
  std::array<ErrorStatistics, kMaxStages> pitch_stage_;
  double itae_ = 0.0;
  ErrorStatistics deflection_;
  double deflection_rate_peak_ = 0.0;
  long powered_ticks_ = 0;
  long saturated_ticks_ = 0;
  double travel_ = 0.0;
  bool has_previous_nozzles_ = false;
  std::array<double, kNozzles> previous_nozzles_{};
  std::array<LimitCycleMeter, kAxes> limit_cycle_;
  double q_max_ = 0.0, q_alpha_max_ = 0.0, alpha_max_ = 0.0;
  double axial_max_ = 0.0, lateral_max_ = 0.0;
  bool structural_exceeded_ = false;
  bool handed_over_ = false;
  double handover_angle_ = 0.0, handover_rate_ = 0.0;
  long v_outside_ticks_ = 0, v_falling_ticks_ = 0;
  double adaptation_norm_peak_ = 0.0;
  std::uint32_t rules_fired_ = 0;
  double expelled_mass_kg_ = 0.0;
  Injection injection_;
};

}  // namespace dispersa
