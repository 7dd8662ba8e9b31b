#include "core/campaign/free_flight.h"

#include <algorithm>

#include "core/input/input_error.h"
#include "core/math/assertion.h"

namespace dispersa {

void SetFreeFlight(Campaign& campaign) {
  DISPERSA_ASSERT(campaign.vehicle.rail.has_value() && !campaign.course.is_controlled);
  const Rail& rail = *campaign.vehicle.rail;
  Reference& reference = campaign.reference;
  reference.name = "none";
  reference.program.launch_azimuth_rad = reference.attitude.launch_azimuth_rad = rail.azimuth_rad;
  AttitudeKnot first, last;
  first.pitch = last.pitch = rail.elevation_rad;
  last.time_s = 1.0;
  reference.attitude.knots = {first, last};

  AutopilotConfig& autopilot = campaign.autopilot;
  autopilot.name = "none";
  autopilot.tick_s = campaign.course.step_s;
  for (AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll})
    axis->gains.assign(campaign.vehicle.stages.size(), {});
}

void RequireControl(const Campaign& campaign, const char* what) {
  if (!campaign.course.is_controlled)
    throw InputError(
        "'" + campaign.name + "' has no autopilot, so there is nothing of which to compute " + what,
        "a campaign without flight: {control: none}");
}

std::vector<StructProblem> ControlProblems(const Vehicle& vehicle, const FlightCourse& course) {
  const auto& stages = vehicle.stages;
  const auto controlled =
      std::find_if(stages.begin(), stages.end(), [](const Stage& stage) { return stage.is_controlled(); });
  const std::string name = "'" + vehicle.name + "'";
  std::vector<StructProblem> problems;
  if (course.is_controlled) {
    if (controlled == stages.end())
      problems.push_back({"control", "no stage of " + name + " has a gimbal, so nothing can be controlled",
                          "flight: {control: none}, without reference and autopilot"});
    return problems;
  }
  if (controlled != stages.end()) {
    problems.push_back({"control",
                        "stage " + std::to_string(controlled - stages.begin() + 1) + " of " + name +
                            " has a gimbal, which nothing would command",
                        "autopilot, or stages with nozzle_station_m in place of gimbal"});
    return problems;
  }
  if (vehicle.boosters.turn_nozzles())
    problems.push_back({"control", "the boosters of " + name + " have a gimbal, which nothing would command",
                        "autopilot, or boosters without gimbal"});
  if (!vehicle.rail)
    problems.push_back({"control", name + " has no rail, so its direction is not known",
                        "a vehicle with rail: {length_m, azimuth_deg, elevation_deg}"});
  for (std::size_t i = 1; i < stages.size(); ++i)
    if (stages[i].ignition == IgnitionTrigger::kTimer)
      problems.push_back({"control",
                          "stage " + std::to_string(i + 1) + " of " + name +
                              " ignites by the timer of a reference, and there is none",
                          "ignition: {trigger: burnout_detection, delay_s: x}"});
  return problems;
}

}  // namespace dispersa
