#include "core/campaign/flight_definition.h"

#include <algorithm>
#include <memory>

#include "core/flight/flight.h"
#include "core/math/functions.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/ascent.h"

namespace dispersa {
namespace {

AscentResult FlyReference(const Campaign& campaign) {
  AscentOptions options;
  options.record = true;
  AscentModel model = BuildAscentModel(campaign.vehicle, campaign.autopilot.tick_s);
  AimAt(campaign.reference.problem, model.vehicle);
  return FlyAscent(model, campaign.reference.program, options);
}

}  // namespace

double AltitudeOfMaxQ(const Campaign& campaign) {
  const AscentResult ascent = FlyReference(campaign);
  const auto less = [](const AscentSample& a, const AscentSample& b) { return a.qbar_pa < b.qbar_pa; };
  const auto greatest = std::max_element(ascent.samples.begin(), ascent.samples.end(), less);
  return greatest == ascent.samples.end() ? 0.0 : greatest->altitude_m;
}

namespace {

bool Jettisons(const Vehicle& vehicle) {
  return std::any_of(vehicle.stages.begin(), vehicle.stages.end(),
                     [](const Stage& stage) { return !stage.jettisoned.empty(); });
}

// The reference's own way up, the same for every autopilot: over the ground, until it leaves the air that
// matters or climbs no more.
ClimbPath ClimbOf(const Campaign& campaign) {
  const AscentResult ascent = FlyReference(campaign);
  ClimbPath path;
  path.azimuth_rad = campaign.reference.program.launch_azimuth_rad;
  const double ground_m = campaign.vehicle.site.altitude_m;
  path.altitude_m = {ground_m};
  path.sine_angle = {1.0};
  for (const AscentSample& s : ascent.samples) {
    // The first metres have no direction yet.
    if (s.altitude_m < ground_m + 1.0) continue;
    if (s.altitude_m <= path.altitude_m.back()) break;
    path.altitude_m.push_back(s.altitude_m);
    path.sine_angle.push_back(Sin(s.relative_path_angle_rad));
  }
  if (path.altitude_m.size() < 2) {  // it never left the ground
    path.altitude_m.push_back(ground_m + 1.0);
    path.sine_angle.push_back(1.0);
  }
  return path;
}

// The same of flights that nothing controls: the nominal one's.
ClimbPath FreeClimbOf(const Campaign& campaign, const FlightDefinition& definition) {
  History history;
  history.step_s = 0.1;
  FlightOptions options;
  options.history = &history;
  Fly(FlightModel(definition), {}, options);
  const int altitude = FindHistoryColumn("altitude_m"), down = FindHistoryColumn("ned_v_d_m_s");
  const int north = FindHistoryColumn("ned_v_n_m_s"), east = FindHistoryColumn("ned_v_e_m_s");
  const double ground_m = campaign.vehicle.site.altitude_m;
  ClimbPath path;
  path.azimuth_rad = campaign.reference.program.launch_azimuth_rad;
  path.altitude_m = {ground_m};
  path.sine_angle = {Sin(campaign.vehicle.rail->elevation_rad)};
  for (std::size_t row = 0; row < history.rows(); ++row) {
    const double altitude_m = history.at(row, altitude);
    if (altitude_m < ground_m + 1.0) continue;
    if (altitude_m <= path.altitude_m.back()) break;
    const Vector3 v(history.at(row, north), history.at(row, east), history.at(row, down));
    path.altitude_m.push_back(altitude_m);
    path.sine_angle.push_back(-v.z() / v.norm());
  }
  if (path.altitude_m.size() < 2) {
    path.altitude_m.push_back(ground_m + 1.0);
    path.sine_angle.push_back(path.sine_angle.back());
  }
  return path;
}

bool MeetsTurbulence(const Campaign& campaign) {
  const int exceedance = FindInput("turbulence_exceedance");
  return std::any_of(campaign.dispersions.begin(), campaign.dispersions.end(), [&](const Dispersion& d) {
    return std::find(d.inputs.begin(), d.inputs.end(), exceedance) != d.inputs.end();
  });
}

}  // namespace

FlightDefinition DefinitionOf(const Campaign& campaign) {
  FlightDefinition definition;
  definition.vehicle = campaign.vehicle;
  definition.autopilot = campaign.autopilot;
  definition.program = campaign.reference.attitude;
  definition.last_ignition_s = campaign.reference.last_ignition_s;
  definition.kick_start_s = campaign.reference.program.t1_s;
  definition.kick_end_s = campaign.reference.program.t2_s;
  const TrajectoryProblem& problem = campaign.reference.problem;
  AimAt(problem, definition.vehicle);
  definition.earlier_ignition_s = campaign.reference.earlier_ignition_s;
  // The reference gives the values that the target leaves open, or measures from another origin.
  const Orbit& reached = campaign.reference.orbit;
  definition.target = {
      problem.target_apogee_m ? reached.altitude_m : problem.target_altitude_m,
      problem.velocity_is_free || problem.is_entered_anywhere
          ? reached.velocity_m_s - problem.velocity_reserve_m_s
          : problem.target_velocity_m_s,
      problem.is_entered_anywhere ? reached.flight_path_angle_rad : problem.target_flight_path_angle_rad,
      problem.target_inclination_rad.value_or(reached.inclination_rad)};
  if (problem.is_entered_anywhere || problem.target_argument_of_perigee_rad ||
      problem.target_true_anomaly_rad) {
    const AimedEllipse ellipse = EllipseOf(problem);
    TargetOrbit& orbit = definition.target.orbit.emplace();
    orbit = {ellipse.semi_major_axis_m, ellipse.eccentricity, problem.target_argument_of_perigee_rad};
    if (!problem.is_entered_anywhere) orbit.true_anomaly_rad = problem.target_true_anomaly_rad.value_or(0.0);
  }
  // The time of day gives the reference's node its right ascension. I turns with that time.
  if (problem.target_node_rad) definition.target.node_rad = reached.node_longitude_rad;
  definition.guidance = campaign.guidance;
  definition.velocity_reserve_m_s = problem.velocity_reserve_m_s;
  definition.wind_table = campaign.wind_table;
  if (!campaign.soundings.empty()) definition.wind_table = MeanWeather(campaign.soundings);
  for (const DatedWeather& sounding : campaign.soundings) definition.soundings.push_back(sounding.table);
  definition.wind_statistics = campaign.wind_statistics;
  definition.noise_seed = campaign.sampling.seed;
  definition.own_metrics = campaign.own_metrics;
  definition.course = campaign.course;
  if (campaign.course.is_controlled && (Jettisons(campaign.vehicle) || CutsOffInFlight(campaign.vehicle))) {
    const AscentResult ascent = FlyReference(campaign);
    definition.jettison_s = ascent.jettison_s;
    definition.cut_off_s = ascent.cut_off_s;
  }
  if (MeetsTurbulence(campaign))
    definition.turbulence_path = std::make_shared<const TurbulencePath>(
        campaign.course.is_controlled ? ClimbOf(campaign) : FreeClimbOf(campaign, definition));
  return definition;
}

}  // namespace dispersa
