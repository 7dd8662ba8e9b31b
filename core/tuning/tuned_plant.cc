#include "core/tuning/tuned_plant.h"

#include "core/tuning/stage_design.h"

namespace dispersa {

AutopilotModel TunedPlant::ModelOf(const AutopilotConfig& autopilot) const {
  return BuildAutopilot(autopilot, untuned.autopilot().stages,
                        campaign.vehicle.reaction_control.minimum_on_time_s);
}

std::vector<double> TunedPlant::TimesOf(int stage) const { return ScheduledTimes(campaign.autopilot, stage); }

double TunedPlant::FirstMode(int stage, double at_s) const {
  const LauncherStack& stack = untuned.nominal_plant().stacks[static_cast<std::size_t>(stage)];
  if (!stack.bending || stack.bending->modes == 0) return 0.0;
  const double propellant_kg =
      TimesOf(stage).size() > 1 ? stack.burn.Propellant(at_s) : 0.5 * stack.burn.propellant_mass_kg;
  return stack.bending->At(0, 0, BendingTable::kFrequency, propellant_kg);
}

}  // namespace dispersa
