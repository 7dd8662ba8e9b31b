#include "core/tuning/held_plants.h"

#include <fmt/format.h>

#include <cmath>

#include "core/margins/linear_axis.h"
#include "core/tuning/nominal_margins.h"
#include "core/tuning/tuning_options.h"

namespace dispersa {
namespace {

// LoopTable's surplus of an unstable loop is at most this.
constexpr double kUnstableSurplus = -2.0;

}  // namespace

HeldPlants::HeldPlants(const TunedPlant& plant, const std::vector<MarginInstant>& instants,
                       const CampaignFlights& rigid, int draws)
    : plant_(plant) {
  held_.resize(static_cast<std::size_t>(plant_.StageCount()));
  for (const MarginInstant& instant : instants)
    Hold(plant_.untuned.nominal_plant(), "nominal plant", instant.sample, kFrequencyBand,
         {kGainMarginGate_db + kHeldGainReserve_db, kPhaseMarginGate_deg + kHeldPhaseReserve_deg,
          kDelayMarginGate_s + kHeldDelayReserve_s});
  for (int i = 0; i < draws; ++i) {
    // Draws go beyond the flown cases if there are more draws than cases.
    const std::uint64_t draw = static_cast<std::uint64_t>(i);
    const FlightInputs inputs = rigid.Draw(draw);
    const LauncherPlant dispersed = plant_.untuned.PlantFor(inputs, draw);
    for (const MarginInstant& instant : MarginInstants(rigid.model(), 5.0, inputs))
      Hold(dispersed, fmt::format("plant of draw {}", i), instant.sample, 0.0,
           {kDispersedGainGate_db + kHeldGainReserve_db, kDispersedPhaseGate_deg + kHeldPhaseReserve_deg,
            0.0});
  }
}

void HeldPlants::Hold(LauncherPlant plant, const std::string& name, const TickSample& sample,
                      double frequency_band, const LoopGates& gates) {
  const std::size_t stage = static_cast<std::size_t>(sample.stack);
  SensorModel all = plant_.untuned.sensors();
  all.stages[stage].unit = 1.0;
  for (std::size_t g = 0; g < all.gyros.size(); ++g) all.stages[stage].gyro[g] = 1.0;
  const std::array<double, kModes> nominal = plant.bending.frequency_factor;
  const auto& bending = plant.stacks[stage].bending;
  const std::vector<FrequencySet> sets = FrequencySets(bending ? bending->modes : 0, frequency_band);
  for (const FrequencySet& set : sets) {
    for (std::size_t k = 0; k < kModes; ++k) plant.bending.frequency_factor[k] = set.factor[k] * nominal[k];
    // Roll has no bending and no aerodynamic instability, so it is checked for the nominal plant only.
    const std::vector<Axis> axes = frequency_band > 0.0 && &set == &sets.front()
                                       ? std::vector{kPitch, kYaw, kRoll}
                                       : std::vector{kPitch, kYaw};
    for (const Axis axis : axes) {
      if (axis == kRoll && !plant.LayoutOf(sample.stack, sample.boosting).rolls)
        continue;  // thrusters hold it
      held_[stage].push_back(
          {&set == &sets.front() ? name : fmt::format("{}, {}", name, set.name), sample.since_ignition_s,
           axis, gates,
           LoopTable(LineariseAxis(plant, sample, axis, all), plant_.campaign.autopilot.tick_s,
                     plant.stacks[stage].gimbal.delay_ticks)});
    }
  }
}

std::vector<double> HeldPlants::SharesOf(const AutopilotConfig& autopilot, int stage) const {
  const SensorModel sensors = BuildSensors(plant_.campaign.vehicle, autopilot);
  const SensorModel::Weights& weights = sensors.stages[static_cast<std::size_t>(stage)];
  std::vector<double> shares = {weights.unit};
  for (std::size_t g = 0; g < sensors.gyros.size(); ++g) shares.push_back(weights.gyro[g]);
  return shares;
}

double HeldPlants::SurplusOf(const AutopilotConfig& autopilot, int stage, std::size_t* last, double enough,
                             std::optional<std::size_t> about) const {
  const AutopilotModel model = plant_.ModelOf(autopilot);
  const std::vector<double> shares = SharesOf(autopilot, stage);
  const std::vector<double> times = plant_.TimesOf(stage);
  const auto nearest = [&](double at_s) {
    std::size_t found = 0;
    for (std::size_t k = 1; k < times.size(); ++k)
      if (std::fabs(at_s - times[k]) < std::fabs(at_s - times[found])) found = k;
    return found;
  };
  const std::vector<Held>& held = held_[static_cast<std::size_t>(stage)];
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < held.size() && least > enough; ++k) {
    // The plant that failed last comes first, then all others.
    const std::size_t i = (*last + k) % held.size();
    const Held& each = held[i];
    if (about && nearest(each.since_ignition_s) != *about) continue;
    for (const bool adapting : {true, false}) {
      const LinearLaw law = LineariseLaw(model, stage, each.since_ignition_s, each.axis, adapting);
      const double surplus = each.table.Surplus(law, shares, each.gates);
      if (surplus < least) {
        least = surplus;
        if (least <= enough) *last = i;
      }
      if (!InfoOf(model.laws[static_cast<std::size_t>(each.axis)].config.law).adaptation) break;
    }
  }
  return least;
}

std::string HeldPlants::Missed(int stage) const {
  const AutopilotModel model = plant_.ModelOf(plant_.campaign.autopilot);
  const std::vector<double> shares = SharesOf(plant_.campaign.autopilot, stage);
  const Held* worst = nullptr;
  bool worst_adapts = false;
  double least = HUGE_VAL;
  for (const Held& each : held_[static_cast<std::size_t>(stage)]) {
    for (const bool adapting : {true, false}) {
      const double surplus = each.table.Surplus(
          LineariseLaw(model, stage, each.since_ignition_s, each.axis, adapting), shares, each.gates);
      if (!(surplus < least)) continue;
      worst = &each;
      worst_adapts = adapting;
      least = surplus;
    }
  }
  const LinearLaw law = LineariseLaw(model, stage, worst->since_ignition_s, worst->axis, worst_adapts);
  // One gate at a time, the others close to zero. The bending modes set a gain and a phase gate together.
  constexpr double kHardly = 1e-9;
  const LoopGates alone[] = {{worst->gates.gain_db, kHardly, 0.0},
                             {kHardly, worst->gates.phase_deg, 0.0},
                             {kHardly, kHardly, worst->gates.delay_s}};
  std::string gate = "gain and phase margin of bending";
  for (std::size_t kind = 0; kind < 3; ++kind)
    if (worst->table.Surplus(law, shares, alone[kind]) == least)
      gate = fmt::format("{} margin", kGateNames[kind]);
  return fmt::format("{}: {}, {}, {} {:.1f} s after ignition",
                     least <= kUnstableSurplus
                         ? std::string("the loop is unstable")
                         : fmt::format("{} {:.0f} % below its gate with reserve", gate, -100.0 * least),
                     worst->plant, worst_adapts ? "adapting" : "gains held", kAxisNames[worst->axis],
                     worst->since_ignition_s);
}

}  // namespace dispersa
