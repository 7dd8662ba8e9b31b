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
  const bool is_scheduled = TimesOf(stage).size() > 1;
  const double propellant_kg =
      is_scheduled ? stack.burn.Propellant(at_s) : 0.5 * stack.burn.propellant_mass_kg;
  unsigned gone = 0;
  if (const auto& boosters = untuned.nominal_plant().boosters; stage == 0 && boosters) {
    const double left_s = boosters->burn.duration_s + boosters->separation_delay_s;
    if (propellant_kg < stack.burn.Propellant(left_s)) gone = kBoostersGone;
  }
  return stack.BendingWithout(gone)->At(0, 0, ModeTable::kFrequency, propellant_kg);
}

}  // namespace dispersa
