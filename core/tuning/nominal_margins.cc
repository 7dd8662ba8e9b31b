#include "core/tuning/nominal_margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/tuning/tuning_options.h"

namespace dispersa {
namespace {

bool Suffices(const LeastMargins& m) {
  return m.gain_db >= kGainMarginGate_db + kGainReserve_db &&
         m.phase_deg >= kPhaseMarginGate_deg + kPhaseReserve_deg &&
         m.delay_s >= kDelayMarginGate_s + kDelayReserve_s;
}

}  // namespace

void AddViolations(const LeastMargins& m, std::vector<double>& violations) {
  const auto below = [&](double value, double limit) {
    violations.push_back(std::max(0.0, (limit - value) / limit));
  };
  below(m.gain_db, kGainMarginGate_db + kGainReserve_db);
  below(m.phase_deg, kPhaseMarginGate_deg + kPhaseReserve_deg);
  below(m.delay_s, kDelayMarginGate_s + kDelayReserve_s);
}

LeastMargins NominalMargins::LeastOf(const AutopilotConfig& autopilot, int stage, bool adapting) const {
  const AutopilotModel model = plant_.ModelOf(autopilot);
  const SensorModel sensors = BuildSensors(plant_.campaign.vehicle, autopilot);
  LeastMargins least;
  for (const MarginInstant& instant : instants_) {
    if (instant.sample.stack != stage) continue;
    for (const Axis axis : {kPitch, kYaw, kRoll})
      least.Take(MarginsAt(plant_.untuned.nominal_plant(), sensors, model, instant.sample, axis, adapting));
  }
  return least;
}

bool NominalMargins::Suffice(const AutopilotConfig& autopilot, int stage, std::size_t* failed_last) const {
  const AutopilotModel model = plant_.ModelOf(autopilot);
  const SensorModel sensors = BuildSensors(plant_.campaign.vehicle, autopilot);
  const std::size_t sets = instants_.size() * kAxes * 2;
  for (std::size_t k = 0; k < sets; ++k) {
    const std::size_t set = (*failed_last + k) % sets;
    const MarginInstant& instant = instants_[set / (kAxes * 2)];
    if (instant.sample.stack != stage) continue;
    const Axis axis = static_cast<Axis>(set / 2 % kAxes);
    LeastMargins least;
    least.Take(MarginsAt(plant_.untuned.nominal_plant(), sensors, model, instant.sample, axis, set % 2 == 0));
    if (Suffices(least)) continue;
    *failed_last = set;
    return false;
  }
  return true;
}

std::string NominalMargins::Missed(std::size_t kind, bool adapting, int stage) const {
  constexpr const char* kUnits[] = {"dB", "deg", "ms"};
  constexpr double kNeeded[] = {kGainMarginGate_db + kGainReserve_db,
                                kPhaseMarginGate_deg + kPhaseReserve_deg,
                                1e3 * (kDelayMarginGate_s + kDelayReserve_s)};
  const AutopilotModel model = plant_.ModelOf(plant_.campaign.autopilot);
  const SensorModel sensors = BuildSensors(plant_.campaign.vehicle, plant_.campaign.autopilot);
  const LauncherPlant& plant = plant_.untuned.nominal_plant();
  const MotorBurn& burn = plant.stacks[static_cast<std::size_t>(stage)].burn;
  std::string where;
  double least = std::numeric_limits<double>::infinity();
  for (const MarginInstant& instant : instants_) {
    if (instant.sample.stack != stage) continue;
    for (const Axis axis : {kPitch, kYaw, kRoll}) {
      LeastMargins m;
      m.Take(MarginsAt(plant, sensors, model, instant.sample, axis, adapting));
      const double value = kind == 0 ? m.gain_db : kind == 1 ? m.phase_deg : 1e3 * m.delay_s;
      if (!(value < least)) continue;
      least = value;
      const double thrust = burn.Fraction(std::min(instant.sample.since_ignition_s, burn.duration_s));
      where =
          fmt::format("{} at {:.2f} s{}, {:.0f} % of full thrust", kAxisNames[axis], instant.sample.time_s,
                      instant.place.empty() ? "" : " (" + instant.place + ")", 100.0 * thrust);
    }
  }
  return fmt::format("{} margin {:.1f} {}, {:.1f} are needed: {}, {}", kGateNames[kind], least, kUnits[kind],
                     kNeeded[kind], adapting ? "adapting" : "gains held", where);
}

}  // namespace dispersa
