// The launchers of the gallery, for tests of their guidance.
#pragma once

#include <string>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"

namespace dispersa {

/// `campaigns` is the folder of the shipped campaigns.
inline Campaign GalleryLauncher(const std::string& campaigns, const std::string& name) {
  return LoadCampaign(campaigns + "/gallery/" + name + "/campaign.yaml");
}

/// The same with engines that end at once, as predictions have them.
inline Campaign GalleryLauncherWithoutTailOff(const std::string& campaigns, const std::string& name) {
  Campaign campaign = GalleryLauncher(campaigns, name);
  for (Stage& stage : campaign.vehicle.stages)
    if (stage.is_liquid()) stage.motor.tail_off_s = 0.0;
  return campaign;
}

/// A case's inputs, with navigation that does not err and tail-offs that the flight computer knows.
inline FlightInputs DrawnWithoutErrorsOfTheComputer(const CampaignFlights& flights, std::uint64_t index) {
  FlightInputs inputs = flights.Draw(index);
  inputs.sensors.navigation_position_error_m = inputs.sensors.navigation_velocity_error_m_s = {};
  inputs.sensors.accelerometer_scale_factor = 1.0;
  for (StageInputs& stage : inputs.stages) stage.tail_off_factor = 1.0;
  return inputs;
}

/// The same with masses, loads and specific impulses that it knows too.
inline FlightInputs DrawnWithoutErrorsOfTheVehicle(const CampaignFlights& flights, std::uint64_t index) {
  FlightInputs inputs = DrawnWithoutErrorsOfTheComputer(flights, index);
  for (StageInputs& stage : inputs.stages)
    stage.dry_mass_factor = stage.propellant_factor = stage.specific_impulse_factor = 1.0;
  return inputs;
}

}  // namespace dispersa
