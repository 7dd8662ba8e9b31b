// The model that all flights of a campaign share, and the plant of one flight.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/control/autopilot.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/launcher.h"
#include "core/environment/turbulence.h"
#include "core/environment/wind_statistics.h"
#include "core/flight/attitude_program.h"
#include "core/flight/flight_course.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/launch_frame.h"
#include "core/flight/own_metrics.h"
#include "core/flight/sensor_model.h"
#include "core/flight/sequence.h"
#include "core/guidance/mission.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// The intended end of the flight.
struct InjectionTarget {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;  ///< of the reference's orbit
  /// An ellipse that is not just a state at its perigee. Of one that may be entered anywhere, the values
  /// above are those of the reference.
  std::optional<TargetOrbit> orbit = {};
  std::optional<double> node_rad = {};  ///< from I's x axis, if the target names a node
};

/// Everything that decides a flight, except its inputs.
struct FlightDefinition {
  Vehicle vehicle;
  AutopilotConfig autopilot;
  AttitudeProgram program;
  double last_ignition_s = 0.0;
  std::array<double, kMaxStages> earlier_ignition_s{};  ///< timers of stages before the last
  double kick_start_s = 0.0;                            ///< t1 and t2 of the flight program: the pitch-over
  double kick_end_s = 0.0;
  InjectionTarget target;
  std::optional<WeatherTable> wind_table;
  std::vector<WeatherTable> soundings = {};  ///< by FlightInputs' number; flights without one meet wind_table
  std::optional<WindStatistics> wind_statistics;  ///< flights whose inputs have no profile meet its means
  std::uint64_t noise_seed = 0;                   ///< of the sensors and of turbulence
  /// Along which turbulence is laid. Null: no flight meets any, whatever its inputs ask.
  std::shared_ptr<const TurbulencePath> turbulence_path = {};
  GuidanceConfig guidance;
  double velocity_reserve_m_s = 0.0;  ///< by which the program arrives faster than the target
  /// Times of the jettisons in the reference's ascent, s since lift-off. Autopilot and guidance know them
  /// before lift-off. Infinite, or missing: never.
  std::vector<double> jettison_s = {};
  /// Burning times of the reference's engines that are cut off at a velocity, by stage, s. They are known
  /// before lift-off too. Infinite: to depletion.
  std::array<double, kMaxStages> cut_off_s = AllStages(HUGE_VAL);
  std::vector<OwnMetric> own_metrics = {};  ///< they do not change a flight
  FlightCourse course = {};
};

/// Commands the end of a stage's burn. The remaining propellant belongs to the next stage if that stage
/// restarts the same engine.
void CommandCutOffOf(const Vehicle& vehicle, int stage, double since_ignition_s, LauncherPlant& plant);

/// The reference attitude at the autopilot's ticks, for flights that are flown side by side. A row has 8
/// doubles: q_IR (w, x, y, z), w_LR_R (x, y, z), unused. The last row holds for all later ticks.
struct ReferenceRows {
  static constexpr int kRowSize = 8;

  AlignedRows rows;
  double last_tick = 0.0;
};

/// Angular acceleration that the flight program asks of each axis with feed-forward, rad/s²: the mean over
/// the tick that begins an axis' lead later. About the reference's x, y, z; 4 doubles a row, the last unused.
/// An axis without feed-forward has 0. Empty if no axis feeds forward. The rows are those of ReferenceRows.
struct FeedForwardRows {
  static constexpr int kRowSize = 4;

  AlignedRows rows;
};

class FlightModel {
 public:
  explicit FlightModel(FlightDefinition definition);
  /// The same with another autopilot on the same ticks, at a fraction of what a new model costs.
  FlightModel WithAutopilot(const AutopilotConfig& autopilot) const;

  const FlightDefinition& definition() const { return definition_; }
  const LaunchFrame& frame() const { return frame_; }
  const AutopilotModel& autopilot() const { return autopilot_; }
  const LauncherPlant& nominal_plant() const { return nominal_; }
  const SensorModel& sensors() const { return sensors_; }
  /// Whether a stage has no gimbal.
  bool has_free_stage() const { return has_free_stage_; }
  const ReferenceRows& reference_rows() const { return reference_rows_; }
  const FeedForwardRows& feed_forward_rows() const { return feed_forward_rows_; }
  /// Null: the campaign has no metrics of its own.
  const OwnMetricsPlan* own_metrics() const { return own_metrics_.get(); }
  /// The knowledge of closed-loop guidance before lift-off; empty for open-loop flights.
  const std::optional<GuidanceMission>& guidance_mission() const { return guidance_mission_; }

  /// The inputs as a flight applies them: those of the nominal flight have the campaign's mean wind.
  FlightInputs AsApplied(FlightInputs inputs) const;
  /// The nominal plant with a flight's factors, winds and misalignments. With a case index the plant also has
  /// the turbulence that this case draws.
  LauncherPlant PlantFor(const FlightInputs& inputs, std::optional<std::uint64_t> case_index = {}) const;

 private:
  FlightDefinition definition_;
  std::vector<std::shared_ptr<const AirTable>> airs_;  ///< of the soundings; null: the standard's
  LaunchFrame frame_;
  LauncherPlant nominal_;
  AutopilotModel autopilot_;
  SensorModel sensors_;
  bool has_free_stage_ = false, has_fins_ = false;
  ReferenceRows reference_rows_;
  FeedForwardRows feed_forward_rows_;
  std::optional<GuidanceMission> guidance_mission_;
  std::shared_ptr<const OwnMetricsPlan> own_metrics_;
};

/// The vehicle without dispersions: aerodynamics built up where the file gives no tables.
LauncherPlant BuildNominalPlant(const Vehicle& vehicle);
/// Gives every stack the masses of a vehicle with the same stages. Section loads follow, and for a bending
/// vehicle as many modes as before.
void SetMasses(const std::shared_ptr<const Vehicle>& vehicle, LauncherPlant& plant);
/// Gives a vehicle the modes that its sources have (core/modes): those that stay below half the sampling
/// frequency all the burn.
void AddBending(const Vehicle& vehicle, double tick_s, LauncherPlant& plant);
/// Angular acceleration per radian of deflection, over the time since ignition, of a nominal stack that
/// ignites at `ignition_s`. `jettison_s`: as FlightDefinition's.
StageControl BuildStageControl(const LauncherPlant& plant, int stack, double ignition_s = 0.0,
                               const std::vector<double>& jettison_s = {});

}  // namespace dispersa
