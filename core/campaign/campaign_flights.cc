#include "core/campaign/campaign_flights.h"

#include "core/flight/flight.h"

namespace dispersa {

namespace {

FlightDefinition DefinitionOf(const Campaign& campaign) {
  FlightDefinition definition;
  definition.vehicle = campaign.vehicle;
  definition.autopilot = campaign.autopilot;
  definition.program = campaign.reference.attitude;
  definition.last_ignition_s = campaign.reference.last_ignition_s;
  definition.kick_start_s = campaign.reference.program.t1_s;
  definition.kick_end_s = campaign.reference.program.t2_s;
  const TrajectoryProblem& problem = campaign.reference.problem;
  definition.target = {problem.target_altitude_m, problem.target_velocity_m_s,
                       problem.target_flight_path_angle_rad};
  definition.wind_table = campaign.wind_table;
  definition.wind_statistics = campaign.wind_statistics;
  definition.noise_seed = campaign.sampling.seed;
  return definition;
}

}  // namespace

CampaignFlights::CampaignFlights(const Campaign& campaign)
    : design_(campaign), model_(std::make_unique<FlightModel>(DefinitionOf(campaign))) {}

CampaignFlights::~CampaignFlights() = default;

CaseResult CampaignFlights::FlyCase(std::uint64_t case_index, History* history) const {
  return Fly(Draw(case_index), case_index, history);
}

CaseResult CampaignFlights::FlyNominal(History* history) const { return Fly(FlightInputs{}, 0, history); }

CaseResult CampaignFlights::Fly(const FlightInputs& inputs, std::uint64_t case_index, History* history,
                                Scheme scheme) const {
  FlightOptions options;
  options.scheme = scheme;
  options.case_index = case_index;
  options.history = history;
  FlightResult flight = dispersa::Fly(*model_, inputs, options);

  CaseResult result;
  result.case_index = case_index;
  result.outcome = flight.outcome;
  result.end_time_s = flight.end_time_s;
  result.end_stage = flight.end_stage;
  result.reason = std::move(flight.reason);
  result.inputs = InputValues(inputs);
  result.metrics = std::move(flight.metrics);
  result.digest = flight.digest;
  return result;
}

}  // namespace dispersa
