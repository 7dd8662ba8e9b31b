// One flight as the engine flies it: prepared values, values kept beside the lanes, and results.
//
// The engine (batch.h) is compiled once for each instruction set and width. Code that runs once a flight,
// once an event or only for watched flights stands here, and is compiled once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot.h"
#include "core/control/plugin.h"
#include "core/environment/weather_profile.h"
#include "core/flight/flight.h"
#include "core/flight/flight_sums.h"
#include "core/flight/guided_flight.h"
#include "core/flight/limit_cycle.h"
#include "core/flight/ripple.h"
#include "core/flight/tick_sample.h"
#include "core/random/draws.h"

namespace dispersa {

class RailSlide;

/// A lane at an event, after it.
struct EventView {
  double time_s, altitude_m, qbar_pa, mass_kg;
};

/// Events at their own times, in the order in which they happen: a stage's own, and those of its parts
/// (part_events.h).
enum class EventKind { kIgnition, kBurnout, kSeparation, kPart };
struct FlightEvent {
  double time_s;
  EventKind kind;
  int stage;
  int part = -1;  ///< place in PartEvents
  int item = -1;  ///< its booster
};

/// The state of a flight outside its lane, as kLauncherSize doubles (launcher.h).
using StateValues = double[kLauncherSize];

/// A lane at a tick or an event, for histories and observers.
struct LaneView {
  double time_s = 0.0;
  StateValues y = {};
  LauncherPhase phase;
  bool coasting = false;
  bool unsteered = false;  ///< nothing controls the attitude
  bool has_error = false;  ///< at ticks the engine's error, at events computed anew
  double error_angle_rad[kAxes] = {};
  double error_rate_rad_s[kAxes] = {};
  double gimbal_rad[kAxes] = {};  ///< commanded about roll, pitch, yaw
  AxisTelemetry axes[kAxes];
  AxisState memories[kAxes];  ///< of the autopilot, after the tick
  int thrusters[kAxes] = {};
};

class FlightRecord {
 public:
  FlightRecord(const FlightModel& model, const FlightOrder& order);
  ~FlightRecord();
  FlightRecord(const FlightRecord&) = delete;
  FlightRecord& operator=(const FlightRecord&) = delete;

  // ---- prepared ----
  const FlightInputs inputs;
  const FlightOptions options;
  LauncherPlant plant;  ///< an engine that is cut off at a velocity changes its burns
  const FlightWeather weather;
  std::vector<FlightEvent> events;  ///< those that have happened stay in their places
  StateValues lift_off;
  const char* lost_attitude;  ///< reasons of a loss of control
  const char* lost_rate;
  const char* refusal = nullptr;  ///< reason why its inputs cannot be flown (null: they can)
  Outcome refused_as = Outcome::kNumericalFailure;
  double believed_attitude[4];  ///< q_IB (w, x, y, z) that the inertial unit is aligned to at lift-off
  bool watched;                 ///< has an observer or a history
  long history_ticks;           ///< ticks between two rows (0: no history)
  bool noisy;                   ///< its gyros are

  // ---- while it flies ----
  GuidedFlight* guided = nullptr;  ///< null: the reference's attitude is flown
  PluginFlight* law = nullptr;     ///< null: no axis' law is a plug-in's
  FlightSums sums;
  RippleMeter ripple;
  LimitCycleMeter limit_cycle;
  std::vector<PartSum> own_sums;  ///< of the parts of its campaign's own metrics

  /// The three gyros' noise of a tick, rad/s.
  void DrawNoise(double* rate_rad_s);
  void AddToDigest(double time_s, const double* y);
  /// The guidance sees the lane. True when events have moved.
  bool Guide(const LaneSight& sight);
  /// A tick, for its observer.
  void Watch(const LaneView& view) const;
  /// A tick's row of its history.
  void AppendRow(const double* row);
  /// An event: a row of the history.
  void WatchEvent(const LaneView& view);
  /// What its result tells of an event (seen_event.h).
  void Note(const FlightEvent& event, const EventView& view, const double* y);
  void NoteJettisons(unsigned due, const EventView& view, const double* y);
  void NoteCutOff(int stage, const EventView& view, const double* y);
  void NoteEnd(Outcome outcome, const EventView& view, const double* y);
  /// Notes the state at which the reaction control hands over to the autopilot.
  void HandOver(double time_s, const double* y);
  /// The injection of a flight that completes.
  void Inject(double altitude_m, const double* y);
  /// Jettisons the bodies that are due and returns them as bits of LauncherPhase::jettisoned. The state moves
  /// to the new centre of gravity.
  unsigned LetGo(int stack, unsigned jettisoned, double time_s, double altitude_m, double density_kg_m3,
                 double propellant_kg, double* y);
  void MassWithout(int stack, unsigned jettisoned, StackMass& mass) const;
  const ModeTable* BendingWithout(int stack, unsigned jettisoned) const;
  /// A stage's engine, if a speed ends its burn; else null.
  const Motor* CutOffEngine(int stage) const;
  /// Its engine gets the command of its cut-off at `time_s`: events from there on are new.
  void CutOff(int stage, double time_s);
  /// The boosters leave, and with them the state of their nozzles.
  void LetGoOfBoosters(unsigned jettisoned, double time_s, double propellant_kg, double* y);
  /// Replaces the state by that of the stack above, with its tip-off rates. `jettisoned`: as in
  /// LauncherPhase.
  void Separate(int stage, unsigned jettisoned, double* y);
  /// Advances the state by one of the judges among the integrators instead of the engine's own step. False
  /// when it fails.
  bool Judge(const LauncherPhase& phase, double from_s, double to_s, double* y);
  bool is_judged() const { return options.scheme != Scheme::kSimpson; }
  /// Whether Judge moves the flight now: it has a judge, or is on its rail.
  bool replaces_steps() const { return is_judged() || rail_ != nullptr; }
  /// Roll moment of a stage's spin motors, N m; 0 without any.
  double SpinTorque(int stage) const;
  /// The vehicle leaves its rail, in this state.
  void LeaveRail(const double* y);
  double ProgramPitch(double time_s) const;
  /// Whether altitude grows.
  bool Climbs(const double* y) const;
  /// The way from here to the flight's stated end, without thrust, as a point mass. `reason`: of an outcome
  /// other than completed.
  Outcome Fall(double time_s, double mass_kg, const double* y, const char** reason);

  /// Ends the flight. `reason` must be a string literal: the pointer is kept.
  void End(Outcome outcome, const char* reason, double time_s, int stack, const double* y);
  FlightResult Result();

 private:
  class JudgedMotion;
  void SetEquations();
  void StandOnRail();
  void Note(std::string name, const EventView& view, const Vector3& p_EoC_I, const Vector3& v_IC_I);
  void NoteMaxQ();
  ReferenceAttitude ReferenceAt(double time_s) const;
  TickSample SampleOf(const LaneView& view) const;

  const FlightModel& model_;
  std::unique_ptr<GuidedFlight> guided_;
  std::unique_ptr<PluginFlight> law_;
  Stream gyro_noise_;
  Digester digester_;
  std::unique_ptr<const LauncherModel> equations_;  ///< of a flight that is watched or judged
  std::unique_ptr<JudgedMotion> judged_;
  double rail_exit_s_ = -1.0;         ///< negative: no rail
  std::unique_ptr<RailSlide> rail_;   ///< until it is left
  std::optional<double> fall_end_s_;  ///< of a flight that ends in a fall
  FlightResult result_;
  std::string refusal_;
};

}  // namespace dispersa
