#include "core/margins/flight_margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/flight/flight.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kAfterIgnition_s = 1.0;
constexpr double kMisalignment_rad = 0.25 * kRadPerDeg;

FlightOrder Spoilt(const FlightInputs& unspoilt, int stage, double gain_db, double delay_s) {
  FlightOrder order;
  order.inputs = unspoilt;
  FlightInputs& inputs = order.inputs;
  inputs.loop_stage = stage + 1;
  inputs.loop_gain_factor = Pow(10.0, gain_db / 20.0);
  inputs.loop_delay_s = delay_s;
  // Towards a corner between pitch and yaw, so that both axes work.
  for (StageInputs& each : inputs.stages) each.thrust.misalignment_rad = {kMisalignment_rad, 0.25 * kPi};
  return order;
}

bool Holds(const FlightResult& result) {
  const auto metric = [&](const char* name) { return result.metrics[MetricColumn(name)]; };
  const auto above = [&](const char* name, double limit) { return metric(name) > limit; };
  return result.outcome == Outcome::kCompleted && !above("deflection_ripple_deg", kLostRipple_deg) &&
         !above("pitch_error_peak_deg", kLostError_deg) && !above("yaw_error_peak_deg", kLostError_deg);
}

// Bisects for the largest multiple of a step, up to a ceiling, that holds. Everything above a failing
// multiple must fail too.
class Bisection {
 public:
  Bisection(double step, double ceiling, std::function<FlightOrder(double)> order)
      : step_(step), high_(std::lround(ceiling / step) + 1), order_(std::move(order)) {}

  /// The loop has no margin even without the change: the answer is 0.
  void EndAtZero() { high_ = low_ + 1; }
  bool open() const { return high_ - low_ > 1; }
  FlightOrder Next() const { return order_(static_cast<double>(Middle()) * step_); }
  void Take(bool holds) { (holds ? low_ : high_) = Middle(); }
  double found() const { return static_cast<double>(low_) * step_; }

 private:
  long Middle() const { return (low_ + high_) / 2; }

  double step_;
  long low_ = 0, high_;
  std::function<FlightOrder(double)> order_;
};

}  // namespace

LoopMargins Least(const LoopMargins& a, const LoopMargins& b) {
  return {a.stable && b.stable,
          std::min(a.gain_up_db, b.gain_up_db),
          std::min(a.gain_down_db, b.gain_down_db),
          std::min(a.phase_deg, b.phase_deg),
          std::min(a.delay_s, b.delay_s),
          std::max(a.crossover_rad_s, b.crossover_rad_s),
          std::max(a.bending_peak_db, b.bending_peak_db),
          std::min(a.bending_phase_6db_deg, b.bending_phase_6db_deg),
          std::min(a.bending_phase_3db_deg, b.bending_phase_3db_deg)};
}

void LeastMargins::Take(const LoopMargins& m) {
  gain_db = std::min({gain_db, m.gain_up_db, m.gain_down_db});
  phase_deg = std::min({phase_deg, m.phase_deg, m.bending_phase_6db_deg});
  delay_s = std::min(delay_s, m.delay_s);
}

namespace {

// Whether boosters alone turn the vehicle about an axis, with hardly any thrust: in their tail-off, as a
// stage in its own, they ask for no margins.
bool IsInBoostersTailOff(const LauncherPlant& plant, const TickSample& sample, Axis axis) {
  if (!sample.boosting || !plant.boosters_steer()) return false;
  const NozzleLayout& layout = plant.boosters->layout;
  const int first = plant.stacks[0].layout.banks() * kDrives;
  constexpr double kRounding = 1e-9;  // of places and directions by sines
  for (int drive = 0; drive < first; ++drive)
    if (std::fabs(layout.allocation[drive][axis]) > kRounding) return false;
  for (const EachBooster& one : plant.boosters->each) {
    const double since_s = std::clamp(sample.since_ignition_s, 0.0, one.burn.duration_s);
    if (!one.burn.curve || one.burn.Fraction(since_s) >= kLeastThrustFraction) return false;
  }
  return true;
}

// Roll that thrusters hold has no linear loop.
bool HasLoop(const LauncherPlant& plant, const TickSample& sample, Axis axis) {
  if (axis == kRoll && !plant.LayoutOf(sample.stack, sample.boosting).rolls) return false;
  return !IsInBoostersTailOff(plant, sample, axis);
}

// Whether learning changes the slopes of the control law.
bool Learns(const AutopilotModel& autopilot, Axis axis) {
  const LawInfo& info = InfoOf(autopilot.laws[static_cast<std::size_t>(axis)].config.law);
  return info.adaptation || info.augmentation;
}

LoopMargins LeastOf(const std::vector<SetMargins>& all) {
  LoopMargins least = all.front().margins;
  for (const SetMargins& each : all) least = Least(least, each.margins);
  return least;
}

int ModesOf(const LauncherPlant& plant, int stack) {
  const LauncherStack& of = plant.stacks[static_cast<std::size_t>(stack)];
  return of.bending ? of.bending->modes : 0;
}

// The instants of one flight, those with little thrust, and how the flight ended.
struct FlownInstants {
  std::vector<MarginInstant> instants;
  std::vector<SkippedInstant> skipped;
  Outcome outcome = Outcome::kCompleted;
};
FlownInstants InstantsOf(const FlightModel& model, const FlightOrder& order, double every_s) {
  const LauncherPlant plant = model.PlantFor(order.inputs);
  const auto fraction_of = [&](const TickSample& s) {
    const MotorBurn& burn = plant.stacks[static_cast<std::size_t>(s.stack)].burn;
    // Burnout as good as on a tick is on it.
    return burn.Fraction(std::clamp(s.since_ignition_s, 0.0, burn.duration_s));
  };
  std::vector<MarginInstant> instants;
  MarginInstant max_q, last, last_strong;
  last_strong.sample.stack = -1;  // none yet
  double q_max = 0.0, next_s = 0.0;
  int stage = -1;
  bool ignited = false;
  const auto end_stage = [&] {
    if (last_strong.sample.stack == stage && last_strong.sample.time_s < last.sample.time_s)
      instants.push_back(last_strong);
    instants.push_back(last);
  };
  FlightOptions options = order.options;
  options.observe = [&](const TickSample& s) {
    if (!s.burning || s.unsteered) return;
    const std::string name = "stage " + std::to_string(s.stack + 1);
    if (s.stack != stage) {
      if (stage >= 0) end_stage();
      stage = s.stack;
      ignited = false;
      next_s = every_s;
      if (stage == 0) instants.push_back({"lift-off", s});
    }
    if (!ignited && s.since_ignition_s >= kAfterIgnition_s) {
      ignited = true;
      instants.push_back({name + " ignition + 1 s", s});
    }
    if (s.since_ignition_s >= next_s) {
      next_s += every_s;
      instants.push_back({"", s});
    }
    if (s.instant.air.qbar_pa > q_max) {
      q_max = s.instant.air.qbar_pa;
      max_q = {"max q", s};
    }
    last = {name + " burnout", s};
    if (fraction_of(s) >= kLeastThrustFraction) last_strong = {name + " tail-off", s};
  };
  FlownInstants flown;
  flown.outcome = Fly(model, order.inputs, options).outcome;
  if (stage < 0) return flown;
  if (flown.outcome != Outcome::kCompleted) {
    last.place = "stage " + std::to_string(stage + 1) + " at the loss";
    max_q.place = "largest q before the loss";
  }
  end_stage();
  if (q_max > 0.0) instants.push_back(max_q);
  std::stable_sort(instants.begin(), instants.end(), [](const MarginInstant& a, const MarginInstant& b) {
    return a.sample.time_s < b.sample.time_s;
  });
  for (MarginInstant& instant : instants) {
    const double fraction = fraction_of(instant.sample);
    if (fraction >= kLeastThrustFraction)
      flown.instants.push_back(std::move(instant));
    else
      flown.skipped.push_back({instant.place, instant.sample.stack, instant.sample.time_s, fraction});
  }
  return flown;
}

// One axis at one instant: the plants that a law must hold, each linearised once.
class InstantLoop {
 public:
  InstantLoop(LauncherPlant plant, const SensorModel& sensors, const TickSample& sample, Axis axis,
              double tick_s, const MarginModel& of)
      : tick_s_(tick_s),
        delay_ticks_(plant.stacks[static_cast<std::size_t>(sample.stack)].gimbal.delay_ticks) {
    const std::array<double, kModes> nominal = plant.bending.frequency_factor;
    for (const FrequencySet& set : FrequencySets(ModesOf(plant, sample.stack), of.frequency_band)) {
      for (std::size_t k = 0; k < kModes; ++k) plant.bending.frequency_factor[k] = set.factor[k] * nominal[k];
      plants_.push_back({set.name, LineariseAxis(plant, sample, axis, sensors, of.path)});
      if (plants_.back().plant.lowest_mode_rad_s == 0.0) break;
    }
  }
  std::vector<SetMargins> BySet(const LinearLaw& law) const {
    std::vector<SetMargins> all;
    for (const auto& [frequencies, plant] : plants_)
      all.push_back({frequencies, SampledLoop(plant, law, tick_s_, delay_ticks_).Margins()});
    return all;
  }
  LoopMargins Of(const LinearLaw& law) const { return LeastOf(BySet(law)); }

 private:
  double tick_s_;
  int delay_ticks_;
  struct Plant {
    std::string frequencies;
    AxisPlant plant;
  };
  std::vector<Plant> plants_;
};

// Adds the margins of each axis, for all laws of ComputedMargins. The memories are those of the sample
// `learnt`.
void AddMarginsAt(const LauncherPlant& plant, const FlightModel& model, const FlightInputs& inputs,
                  const MarginInstant& instant, const TickSample& learnt, const MarginModel& of,
                  std::vector<ComputedMargins>& all) {
  const AutopilotModel& autopilot = model.autopilot();
  const TickSample& s = instant.sample;
  for (const Axis axis : {kPitch, kYaw, kRoll}) {
    if (!HasLoop(plant, s, axis)) continue;
    const InstantLoop loop(plant, model.sensors(), s, axis, autopilot.config.tick_s, of);
    const auto flown = [&](LinearLaw law) {
      const bool is_spoilt = inputs.loop_stage == 0.0 || inputs.loop_stage == s.stack + 1;
      if (is_spoilt) law.effectiveness_1_s2 /= inputs.loop_gain_factor;
      if (law.rules > 1) {
        law.drive_error *= inputs.pn_error_factor;
        law.drive_rate *= inputs.pn_rate_factor;
        law.drive_prediction *= inputs.pn_rate_factor;
      }
      return law;
    };
    const auto margins_of = [&](const LinearLaw& law) { return loop.Of(flown(law)); };
    const auto law = [&](bool adapting) {
      return LineariseLaw(autopilot, s.stack, s.since_ignition_s, axis, adapting);
    };
    const std::vector<SetMargins> by_set = loop.BySet(flown(law(Learns(autopilot, axis))));
    const LoopMargins least = LeastOf(by_set);
    ComputedMargins each{instant.place, s.stack, s.time_s, axis, least, least, {}};
    if (by_set.size() > 1) each.by_set = by_set;
    if (Learns(autopilot, axis)) {
      each.frozen = margins_of(law(false));
      each.learnt = each.adapting;
      each.is_augmented = InfoOf(autopilot.laws[static_cast<std::size_t>(axis)].config.law).augmentation;
      for (const int error : {-1, 1}) {
        for (const int rate : {-1, 1})
          each.learnt =
              Least(*each.learnt, margins_of(LineariseLearntLaw(autopilot, learnt, axis, {error, rate})));
      }
    }
    all.push_back(std::move(each));
  }
}

}  // namespace

std::vector<FrequencySet> FrequencySets(int modes, double band) {
  std::array<double, kModes> nominal;
  nominal.fill(1.0);
  std::vector<FrequencySet> sets = {{"as they are", nominal}};
  if (modes == 0 || band == 0.0) return sets;
  const double percent = 100.0 * band;
  for (const double departure : {-band, band}) {
    const char* const way = departure < 0.0 ? "lower" : "higher";
    FrequencySet all{fmt::format("all {:g} % {}", percent, way), nominal};
    all.factor.fill(1.0 + departure);
    sets.push_back(all);
  }
  for (int mode = 0; modes > 1 && mode < modes; ++mode)
    for (const double departure : {-band, band}) {
      sets.push_back(
          {fmt::format("mode {} {:g} % {}", mode + 1, percent, departure < 0.0 ? "lower" : "higher"),
           nominal});
      sets.back().factor[static_cast<std::size_t>(mode)] = 1.0 + departure;
    }
  return sets;
}

std::vector<MarginInstant> MarginInstants(const FlightModel& model, double every_s,
                                          const FlightInputs& inputs) {
  return InstantsOf(model, {inputs, {}}, every_s).instants;
}

std::vector<SkippedInstant> SkippedInstants(const FlightModel& model, double every_s,
                                            const FlightInputs& inputs) {
  return InstantsOf(model, {inputs, {}}, every_s).skipped;
}

std::vector<ComputedMargins> ComputeMargins(const FlightModel& model, double every_s,
                                            const FlightInputs& inputs, const MarginModel& of) {
  const LauncherPlant plant = model.PlantFor(inputs);
  const std::vector<MarginInstant> instants = MarginInstants(model, every_s, inputs);
  // The same ticks of the flight in which something is to be learnt: its stages burn as long.
  std::vector<TickSample> learnt;
  FlightOrder order = Spoilt(inputs, 0, 0.0, 0.0);
  order.options.observe = [&](const TickSample& s) {
    while (s.burning && learnt.size() < instants.size() && instants[learnt.size()].sample.time_s <= s.time_s)
      learnt.push_back(s);
  };
  Fly(model, order.inputs, order.options);
  std::vector<ComputedMargins> all;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    // A flight that ends early learns nothing more.
    const TickSample& sample = i < learnt.size() ? learnt[i] : instants[i].sample;
    AddMarginsAt(plant, model, inputs, instants[i], sample, of, all);
  }
  return all;
}

DispersedMargins ComputeDispersedMargins(const FlightModel& model, const FlightOrder& order, double every_s,
                                         LateralPath path) {
  DispersedMargins found;
  const LauncherPlant plant = model.PlantFor(order.inputs, order.options.case_index);
  const FlownInstants flown = InstantsOf(model, order, every_s);
  found.outcome = flown.outcome;
  for (const MarginInstant& instant : flown.instants)
    AddMarginsAt(plant, model, order.inputs, instant, instant.sample, {0.0, path}, found.margins);
  return found;
}

LoopMargins MarginsAt(const LauncherPlant& plant, const SensorModel& sensors, const AutopilotModel& autopilot,
                      const TickSample& s, Axis axis, bool adapting, const MarginModel& of) {
  if (!HasLoop(plant, s, axis)) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    LoopMargins unlimited;
    unlimited.stable = true;
    unlimited.gain_up_db = unlimited.gain_down_db = unlimited.delay_s = kAny;
    unlimited.phase_deg = 180.0;
    return unlimited;
  }
  return InstantLoop(plant, sensors, s, axis, autopilot.config.tick_s, of)
      .Of(LineariseLaw(autopilot, s.stack, s.since_ignition_s, axis, adapting));
}

std::vector<MeasuredMargins> MeasureMargins(const FlightModel& model, const FlightInputs& inputs) {
  if (model.definition().guidance.closed_loop) {
    FlightDefinition reference = model.definition();
    reference.guidance.closed_loop = false;
    return MeasureMargins(FlightModel(std::move(reference)), inputs);
  }
  const int stages = static_cast<int>(model.definition().vehicle.stages.size());
  std::vector<Bisection> searches;  // three a stage: gain up, gain down, delay
  for (int stage = 0; stage < stages; ++stage) {
    searches.emplace_back(kMeasuredGainStep_db, kMeasuredGainCeiling_db,
                          [&inputs, stage](double db) { return Spoilt(inputs, stage, db, 0.0); });
    searches.emplace_back(kMeasuredGainStep_db, kMeasuredGainCeiling_db,
                          [&inputs, stage](double db) { return Spoilt(inputs, stage, -db, 0.0); });
    searches.emplace_back(kMeasuredDelayStep_s, kMeasuredDelayCeiling_s,
                          [&inputs, stage](double s) { return Spoilt(inputs, stage, 0.0, s); });
  }
  // The undisturbed flight is the same for every stage.
  if (!Holds(Fly(model, Spoilt(inputs, 0, 0.0, 0.0).inputs)))
    for (Bisection& search : searches) search.EndAtZero();
  for (;;) {
    std::vector<Bisection*> open;
    std::vector<FlightOrder> orders;
    for (Bisection& search : searches) {
      if (!search.open()) continue;
      open.push_back(&search);
      orders.push_back(search.Next());
    }
    if (open.empty()) break;
    const std::vector<FlightResult> flown = FlyAll(model, orders);
    for (std::size_t i = 0; i < open.size(); ++i) open[i]->Take(Holds(flown[i]));
  }
  std::vector<MeasuredMargins> all;
  for (int stage = 0; stage < stages; ++stage) {
    const Bisection* search = &searches[static_cast<std::size_t>(3 * stage)];
    all.push_back({stage, search[0].found(), search[1].found(), search[2].found()});
  }
  return all;
}

bool PassesGates(const LoopMargins& m) {
  return m.stable && m.gain_up_db >= kGainMarginGate_db && m.gain_down_db >= kGainMarginGate_db &&
         m.phase_deg >= kPhaseMarginGate_deg && m.delay_s >= kDelayMarginGate_s &&
         m.bending_phase_6db_deg >= kPhaseMarginGate_deg;
}

bool LearntPasses(const ComputedMargins& m) {
  return !m.learnt || (m.is_augmented ? PassesDispersedGates(*m.learnt) : PassesGates(*m.learnt));
}

bool PassesGates(const ComputedMargins& m) {
  return PassesGates(m.frozen) && PassesGates(m.adapting) && LearntPasses(m);
}

bool PassesDispersedGates(const LoopMargins& m) {
  return m.stable && m.gain_up_db >= kDispersedGainGate_db && m.gain_down_db >= kDispersedGainGate_db &&
         m.phase_deg >= kDispersedPhaseGate_deg && m.bending_phase_3db_deg >= kDispersedPhaseGate_deg;
}

bool PassesDispersedGates(const ComputedMargins& m) {
  return PassesDispersedGates(m.frozen) && PassesDispersedGates(m.adapting) &&
         (!m.learnt || PassesDispersedGates(*m.learnt));
}

bool PassesGates(const MeasuredMargins& m) {
  return m.gain_up_db >= kGainMarginGate_db && m.gain_down_db >= kGainMarginGate_db &&
         m.delay_s >= kDelayMarginGate_s;
}

}  // namespace dispersa
