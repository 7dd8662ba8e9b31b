// Stability margins of an autopilot along its nominal flight: computed from a linearisation, and measured in
// flights whose loop is changed until it fails.
//
// A bending vehicle is linearised with its modes, and its margins are the least over sets of their
// frequencies (FrequencySets). A vehicle without a beam has rigid-body margins. There is no slosh. The path
// is held unless a MarginModel says that it drifts.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/flight/flight.h"
#include "core/flight/flight_model.h"
#include "core/flight/tick_sample.h"
#include "core/margins/linear_axis.h"
#include "core/margins/loop_margins.h"

namespace dispersa {

/// Gates of every powered phase.
inline constexpr double kGainMarginGate_db = 6.0;  ///< both ways
inline constexpr double kPhaseMarginGate_deg = 30.0;
inline constexpr double kDelayMarginGate_s = 0.020;
/// Wherever the bending is not attenuated by the gain margin's gate it must keep the phase margin's from -1.
inline constexpr double kFrequencyBand = 0.15;
/// Gates of every powered phase of a dispersed flight.
inline constexpr double kDispersedGainGate_db = 3.0;
inline constexpr double kDispersedPhaseGate_deg = 20.0;

/// In a measured margin control counts as lost if the flight does not complete, if the nozzles' commands
/// ripple by more than this, or if pitch or yaw are off by more.
inline constexpr double kLostRipple_deg = 0.2, kLostError_deg = 5.0;

/// The linear model from which margins are computed.
struct MarginModel {
  double frequency_band = kFrequencyBand;  ///< fraction by which the modes' frequencies are also lowered and
                                           ///< raised, together and each alone (0: as they are)
  LateralPath path = LateralPath::kHeld;
};

/// Factors on the frequencies of the modes.
struct FrequencySet {
  std::string name;  ///< "as they are", "all 15 % lower", "mode 2 15 % higher", ...
  std::array<double, kModes> factor;
};
/// The sets of frequencies over which margins are the least: unchanged, all lowered and all raised by the
/// band, and, for several modes, each of them alone. With a band of 0: unchanged only.
std::vector<FrequencySet> FrequencySets(int modes, double band);

/// The margins with one set of frequencies.
struct SetMargins {
  std::string frequencies;
  LoopMargins margins;
};

/// One axis at one instant of the nominal flight.
struct ComputedMargins {
  std::string place;  ///< "lift-off", "max q", "stage 2 ignition + 1 s", ... or "" in between
  int stage = 0;      ///< 0-based
  double time_s = 0.0;
  Axis axis = kPitch;
  LoopMargins frozen;    ///< gains held
  LoopMargins adapting;  ///< with the adaptation, linearised about zero error (without adaptation: as frozen)
  /// Like `adapting`, with the values learnt by then: the least margins on any side of zero error and zero
  /// rate. None if the law does not learn.
  std::optional<LoopMargins> learnt;
  bool is_augmented = false;            ///< the learnt value is an augmentation's gain
  std::vector<SetMargins> by_set = {};  ///< as adapting, where there are several FrequencySets
};

/// One powered phase, all axes at once. Resolutions: kMeasuredGainStep_db, kMeasuredDelayStep_s. At its
/// ceiling a value is a lower bound: control was never lost.
struct MeasuredMargins {
  int stage = 0;  ///< 0-based
  double gain_up_db = 0.0;
  double gain_down_db = 0.0;
  double delay_s = 0.0;
};
inline constexpr double kMeasuredGainStep_db = 0.1;
inline constexpr double kMeasuredGainCeiling_db = 24.0;
inline constexpr double kMeasuredDelayStep_s = 0.001;
inline constexpr double kMeasuredDelayCeiling_s = 0.25;

/// The least of each margin, and the greatest crossover and response of the bending.
LoopMargins Least(const LoopMargins& a, const LoopMargins& b);

/// The least of margins over axes and instants.
struct LeastMargins {
  double gain_db = std::numeric_limits<double>::infinity();  ///< either way
  double phase_deg = std::numeric_limits<double>::infinity();
  double delay_s = std::numeric_limits<double>::infinity();

  void Take(const LoopMargins& m);
};

/// An instant of the nominal flight at which margins are computed.
struct MarginInstant {
  std::string place;  ///< as in ComputedMargins
  TickSample sample;
};

/// Lift-off, max q, each ignition + 1 s and burnout, and every `every_s` of powered flight between, in the
/// order of time. Instants with less than kLeastThrustFraction of full thrust are left out (SkippedInstants).
/// If that leaves out a burnout, the last instant before it with enough thrust replaces it: "stage 1
/// tail-off".
std::vector<MarginInstant> MarginInstants(const FlightModel& model, double every_s = 5.0,
                                          const FlightInputs& inputs = {});
/// An instant that MarginInstants leaves out.
struct SkippedInstant {
  std::string place;
  int stage = 0;  ///< 0-based
  double time_s = 0.0;
  double thrust_fraction = 0.0;  ///< of full thrust
};
std::vector<SkippedInstant> SkippedInstants(const FlightModel& model, double every_s = 5.0,
                                            const FlightInputs& inputs = {});
/// The margins of an autopilot at an instant, be it of another autopilot's flight of the same plant.
LoopMargins MarginsAt(const LauncherPlant& plant, const SensorModel& sensors, const AutopilotModel& autopilot,
                      const TickSample& sample, Axis axis, bool adapting, const MarginModel& of = {});

/// Margins at each of MarginInstants, in all axes, of the plant and along the flight that `inputs` give. The
/// autopilot knows only the nominal plant. Learnt values come from a flight that also has the misalignment of
/// MeasureMargins. A further delay of the loop (`inputs`) is left out.
std::vector<ComputedMargins> ComputeMargins(const FlightModel& model, double every_s = 5.0,
                                            const FlightInputs& inputs = {}, const MarginModel& of = {});

/// The same of a dispersed flight, with what was learnt in itself and the modes' frequencies as they are.
struct DispersedMargins {
  Outcome outcome = Outcome::kCompleted;  ///< the margins end with the flight
  std::vector<ComputedMargins> margins;
};
DispersedMargins ComputeDispersedMargins(const FlightModel& model, const FlightOrder& order,
                                         double every_s = 5.0, LateralPath path = LateralPath::kHeld);

/// Measures by bisection over flights in which the gain or the delay of one stage's loop is changed. A steady
/// thrust misalignment of 0.25° in every stage keeps the adaptation at work. A loop counts as lost in three
/// cases: the flight loses control, a deflection oscillates by more than 0.2° peak to peak over any second
/// after the start-up transient, or pitch or yaw leave the rules' range of 5°. The flights have `inputs`,
/// except for the misalignment and the loop's gain and delay. They follow the reference: deflections of
/// guidance's turns would count as oscillation.
std::vector<MeasuredMargins> MeasureMargins(const FlightModel& model, const FlightInputs& inputs = {});

/// Whether a margin set passes the gates.
bool PassesGates(const LoopMargins& margins);
bool PassesGates(const ComputedMargins& margins);
/// Whether the margins with learnt values suffice. Rules must have the nominal flight's margins. An
/// augmentation takes its gain from them until its spectral damper gives it back: it must leave those of a
/// dispersed flight.
bool LearntPasses(const ComputedMargins& margins);
bool PassesGates(const MeasuredMargins& margins);
/// Whether a margin set of a dispersed flight does.
bool PassesDispersedGates(const LoopMargins& margins);
bool PassesDispersedGates(const ComputedMargins& margins);

}  // namespace dispersa
