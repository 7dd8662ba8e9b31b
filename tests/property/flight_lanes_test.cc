// Flights side by side are the flights alone, bit by bit: for any number of lanes, instruction set, order and
// neighbours, under every input that a case may draw.
#include <sys/mman.h>

#include "core/campaign/flight_definition.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/lane_engine.h"
#include "core/random/draws.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "tests/flexible_guided.h"
#include "tests/liquid_stage.h"
#include "tests/long.h"
#include "tests/same_events.h"
#include "tests/slv4_flight.h"
#include "tests/tabulated_masses.h"
#include "tests/test.h"

namespace dispersa::flight_lanes_test {
namespace {

// The shipped definition with all that a file may give it besides.
FlightDefinition Definition(const std::string& law, bool with_winds, bool guided = false) {
  const bool clustered = law.starts_with("clustered_"), boosted = law.starts_with("boosted_");
  const std::string autopilot = clustered                    ? law.substr(10)
                                : boosted                    ? law.substr(8)
                                : law.starts_with("listed_") ? law.substr(7)
                                                             : law;
  FlightDefinition definition =
      Slv4Definition(DISPERSA_CAMPAIGNS, autopilot, guided ? "slv4_500km_reserve" : "slv4_500km");
  definition.guidance.closed_loop = guided;
  if (autopilot == "pid")  // stages with and without a notch, side by side
    definition.autopilot.pitch.filters = definition.autopilot.yaw.filters = {
        {.poles_rad_s = 80.0, .poles_damping = 0.7},
        {.zeros_rad_s = 25.0, .zeros_damping = 0.2, .poles_rad_s = 25.0, .poles_damping = 0.6, .stage = 1}};
  if (autopilot == "pid_aac")  // axes that feed forward beside one that does not
    definition.autopilot.pitch.feed_forward = definition.autopilot.yaw.feed_forward = FeedForward{0.066};
  if (autopilot ==
      "pid") {  // a thrust curve beside constant thrust, as stages and flights stand side by side
    const ThrustCurve shape{{0.0, 0.7, 13.3, 41.1234567, 60.0, 61.7}, {0.3, 0.9, 1.0, 0.8, 0.7, 0.0}};
    for (const std::size_t stage : {0u, 2u}) {
      Motor& motor = definition.vehicle.stages[stage].motor;
      ThrustCurve curve = shape;
      for (double& time_s : curve.time_s) time_s *= motor.burning_time_s / 55.0;
      for (double& thrust_n : curve.thrust_n) thrust_n *= 1.1 * motor.thrust_n;
      SetThrustCurve(curve, motor);
    }
  }
  if (autopilot == "pid") {  // and a throttled liquid stage, which leaves a rest, in between
    Stage& liquid = definition.vehicle.stages[1];
    MakeLiquid(liquid);
    liquid.motor.residual_mass_kg = 0.01 * liquid.propellant_mass_kg;
    liquid.motor.throttle = {{0.0, 0.333, 40.0, 41.7}, {0.4, 1.0, 1.0, 0.8}};
    liquid.motor.cut_off = CutOff::kAtTime;
    liquid.motor.cut_off_s = 55.0123;
  }
  if (autopilot == "pd") {  // a law that changes within a stage beside some that do not
    AxisConfig& pitch = definition.autopilot.pitch;
    pitch.filters = {{.poles_rad_s = 90.0, .poles_damping = 0.7, .stage = 1}};
    pitch.schedule = {{1, 20.0, {20.0, 8.0}, 0.0, {{.poles_rad_s = 60.0, .poles_damping = 0.7}}},
                      {3, 10.0, {30.0, 9.0}, 0.0, {}}};
  }
  if (autopilot == "pd") {  // masses that leave at times of their own, of flights in different stages
    std::vector<Stage>& stages = definition.vehicle.stages;
    stages[0].jettisoned = {{"skirt", 40.0, 14.0, 15.0, 1.2, 1.0, JettisonTrigger::kAtTime, 20.0}};
    stages[3].jettisoned = {{"tower", 15.0, 0.1, 0.5, 0.2, 0.1, JettisonTrigger::kAtAltitude, 60e3},
                            {"fairing", 50.0, 0.2, 2.5, 1.0, 0.97, JettisonTrigger::kAtHeatFlux, 1135.0}};
    definition.jettison_s = {20.0, 85.0, 180.0};
    // Aerodynamics that change with them and with the motor, and states an uncertainty.
    std::vector<AeroTable> tables = BuildAerodynamics(definition.vehicle);
    for (AeroTable& table : tables) {
      table.ca_power_off = table.ca;
      for (double& ca : table.ca_power_off) ca *= 1.1;
      table.uncertainty.cn.assign(table.cn.size(), 0.05);
    }
    AeroTable lighter = tables[0];
    for (double& xcp_m : lighter.xcp_station_m) xcp_m -= 0.2;
    tables[0].lighter = {{{"skirt"}, lighter}};
    // Two planes of symmetry until the skirt has left, and again in the third stack.
    for (const std::size_t stack : {0u, 2u}) {
      AeroTable yaw = tables[stack];
      yaw.lighter.clear();
      for (double& cn : yaw.cn) cn *= 1.3;
      for (double& xcp_m : yaw.xcp_station_m) xcp_m += 0.3;
      tables[stack].yaw_plane = {yaw};
    }
    definition.vehicle.aerodynamics = tables;
    // Masses by tables beside grains.
    for (const std::size_t stage : {0u, 2u}) TabulateMasses(definition.vehicle, stage, 9);
  }
  if (autopilot == "pd_aac") {
    Boosters& b = definition.vehicle.boosters;
    b = {4, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {22.0, 24.05, 0.6, 0.2}, 0.5};
    b.motor.thrust_n = 80e3;
    b.motor.burning_time_s = 30.0;
    definition.vehicle.stages[0].liftoff_mass_kg += 4.0 * 1050.0;
  }
  if (law == "listed_pid_aac") {  // one nozzle, three, and crosses among them
    std::vector<Stage>& stages = definition.vehicle.stages;
    // The single one, which holds no roll, where the air turns nothing.
    stages[2].gimbal.nozzles = {
        {"main", 0.0, 0.0, 1.0, {90.0 * kRadPerDeg, 180.0 * kRadPerDeg}, 5.0 * kRadPerDeg}};
    const double r = stages[1].gimbal.radius_m;
    for (const double at : {0.0, 120.0 * kRadPerDeg, 240.0 * kRadPerDeg})
      stages[1].gimbal.nozzles.push_back({"at " + std::to_string(at),
                                          r * std::cos(at),
                                          r * std::sin(at),
                                          1.0 / 3.0,
                                          {at + 90.0 * kRadPerDeg},
                                          0.0});
  }
  if (boosted) {  // three boosters as bodies of their own, which leave at times of their own
    Boosters& b = definition.vehicle.boosters;
    b = {3, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {22.0, 24.05, 0.6, 0.2}, 0.5};
    b.motor.thrust_n = 60e3;
    b.motor.burning_time_s = 30.0;
    b.motor.tail_off_s = 1.0;
    b.angles_rad = {0.2, 2.3, 4.4};
    b.cant_rad = 0.08;
    b.gimbal.limit_rad = 0.08;
    b.gimbal.rate_limit_rad_s = 0.4;
    b.gimbal.bandwidth_rad_s = 35.0;
    b.towards_rad = {90.0 * kRadPerDeg, 180.0 * kRadPerDeg};
    definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
    definition.vehicle.stages[1].gimbal.nozzles = {
        {"ring", 0.0, 0.0, 0.0, {90.0 * kRadPerDeg, 180.0 * kRadPerDeg}, 0.0, {6, 0.2, 0.0, false}}};
  }
  if (clustered) {  // nine engines, thirteen of which some are fixed and some alike, one, and a cross
    std::vector<Stage>& stages = definition.vehicle.stages;
    const std::vector<double> both = {90.0 * kRadPerDeg, 180.0 * kRadPerDeg};
    stages[0].gimbal.nozzles = {{"centre", 0.0, 0.0, 0.0, both, 0.0},
                                {"outer", 0.0, 0.0, 0.0, both, 0.0, {8, 0.4, 0.1, false}}};
    stages[1].gimbal.nozzles = {{"main", 0.0, 0.0, 0.05, both, 0.0, {5, 0.2, 0.0, false}, "main"},
                                {"more", 0.0, 0.0, 0.05, both, 0.0, {5, 0.2, 0.3, false}},
                                {"fixed", 0.0, 0.0, 0.0, {}, 0.0, {3, 0.3, 0.0, false}}};
    stages[2].gimbal.nozzles = {{"one", 0.0, 0.0, 1.0, both, 4.0 * kRadPerDeg}};
  }
  if (autopilot == "flexible") {
    definition.vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
    // Each flight's masses have modes of their own, which would take ten times as long as flying them.
    definition.vehicle.structure_beam->elements = 12;
    definition.vehicle.structure_beam->propellant_levels = 5;
    // Bodies that leave at times of their own: the modes of flights side by side change at different times.
    std::vector<Stage>& stages = definition.vehicle.stages;
    stages[0].jettisoned = {{"skirt", 40.0, 14.8, 15.2, 1.2, 1.0, JettisonTrigger::kAtTime, 20.0}};
    stages[3].jettisoned = {{"fairing", 50.0, 0.1, 2.5, 0.6, 0.57, JettisonTrigger::kAtAltitude, 60e3}};
    LumpedMass fairing;
    fairing.name = fairing.element = "fairing";
    fairing.station_m = 1.65;
    definition.vehicle.structure_beam->stages[3].lumped_masses.push_back(fairing);
    definition.jettison_s = {20.0, 85.0};
  }
  if (autopilot == "pid_aac" ||
      autopilot == "pid") {  // drives of all kinds, side by side as their flights' stages are
    definition.vehicle.stages[0].gimbal.dead_zone_rad = 0.03 * kRadPerDeg;
    definition.vehicle.stages[0].gimbal.friction_rad = 0.02 * kRadPerDeg;
    definition.vehicle.stages[1].gimbal.resolution_rad = 0.01 * kRadPerDeg;
    definition.vehicle.stages[2].gimbal.friction_rad = 0.01 * kRadPerDeg;
  }
  definition.noise_seed = 11;
  if (with_winds) {
    definition.turbulence_path =
        std::make_shared<const TurbulencePath>(ClimbPath{{0.0, 1000.0, 40e3}, {1.0, 1.0, 0.5}, 3.0});
    definition.wind_table =
        WeatherTable{WindTable{{0.0, 5000.0, 12000.0}, {1.0, 12.0, -20.0}, {3.0, -8.0, 30.0}},
                     {},
                     {100e3, 55e3, 20e3},
                     {1.2, 0.75, 0.32}};
    // Flights of four, side by side: the table above, its wind without its air, another air, and none.
    WeatherTable thick = *definition.wind_table;
    thick.north_m_s = {-5.0, 20.0, 3.0};
    for (double& density : thick.density_kg_m3) density *= 1.1;
    definition.soundings = {{*definition.wind_table}, thick, {{{0.0, 9000.0}, {0.0, 0.0}, {0.0, 0.0}}}};
    definition.soundings[0].pressure_pa = definition.soundings[0].density_kg_m3 = {};
    definition.wind_statistics = WindStatistics{{0.0, 6000.0, 14000.0},
                                                {0.0, 5.0, 20.0},
                                                {1.0, 2.0, 3.0},
                                                {2.0, 5.0, 8.0},
                                                {2.0, 5.0, 8.0},
                                                0.3,
                                                3000.0};
  }
  return definition;
}

// Any input away from its nominal value in about half of the flights.
FlightInputs DrawnInputs(std::uint64_t flight) {
  Stream draws(5, flight, "inputs");
  FlightInputs in;
  const auto some = [&](double& value, double drawn) {
    if (draws.Uniform() < 0.5) value = drawn;
  };
  for (std::size_t stage = 0; stage < kUsualStages; ++stage) {
    some(in.stages[stage].thrust.misalignment_rad.magnitude, 0.25 * kRadPerDeg * draws.Uniform());
    some(in.stages[stage].thrust.misalignment_rad.clock_rad, kTwoPi * draws.Uniform());
    some(in.stages[stage].thrust.offset_m.magnitude, 0.005 * draws.Uniform());
    some(in.stages[stage].thrust.offset_m.clock_rad, kTwoPi * draws.Uniform());
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle) {
      some(in.stages[stage].nozzles[nozzle].line.misalignment_rad.magnitude,
           0.25 * kRadPerDeg * draws.Uniform());
      some(in.stages[stage].nozzles[nozzle].line.misalignment_rad.clock_rad, kTwoPi * draws.Uniform());
      some(in.stages[stage].nozzles[nozzle].line.offset_m.magnitude, 0.002 * draws.Uniform());
      some(in.stages[stage].nozzles[nozzle].thrust_factor, 0.99 + 0.02 * draws.Uniform());
    }
    some(in.stages[stage].cg_offset_m.magnitude, 0.005 * draws.Uniform());
    some(in.stages[stage].cg_offset_m.clock_rad, kTwoPi * draws.Uniform());
    some(in.stages[stage].thrust_factor, 1.0 + 0.02 * draws.Normal());
    some(in.stages[stage].mass_flow_factor, 1.0 + 0.02 * draws.Normal());
    some(in.stages[stage].specific_impulse_factor, 1.0 + 0.01 * draws.Normal());
    some(in.stages[stage].tip_off_pitch_rad_s, 0.5 * kRadPerDeg * draws.Normal());
    some(in.stages[stage].tip_off_yaw_rad_s, 0.5 * kRadPerDeg * draws.Normal());
    some(in.stages[stage].tip_off_roll_rad_s, 0.5 * kRadPerDeg * draws.Normal());
  }
  some(in.air.wind_max_speed_m_s, 60.0 * draws.Uniform());
  some(in.air.wind_azimuth_rad, kTwoPi * draws.Uniform());
  some(in.air.gust_speed_m_s, 9.0 * draws.Uniform());
  some(in.air.gust_altitude_m, 9000.0);
  in.air.gust_length_m = 400.0;
  constexpr double kAltitudes_m[] = {0.0, 6000.0, 14000.0}, kNorth_m_s[] = {0.0, 5.0, 20.0},
                   kEast_m_s[] = {1.0, 2.0, 3.0}, kSigma_m_s[] = {2.0, 5.0, 8.0};
  for (std::size_t level = 0; level < kWindLevels; ++level) {
    double north = 0.0, east = 0.0;
    some(north, draws.Normal());
    some(east, draws.Normal());
    // Without altitudes a flight meets the means of the campaign's statistics.
    if (level >= std::size(kAltitudes_m) || flight % 4 == 1) continue;
    in.air.wind_profile_altitude_m[level] = kAltitudes_m[level];
    in.air.wind_profile_north_m_s[level] = kNorth_m_s[level] + kSigma_m_s[level] * north;
    in.air.wind_profile_east_m_s[level] = kEast_m_s[level] + kSigma_m_s[level] * east;
  }
  for (double* factor :
       {&in.drag_factor, &in.lift_factor, &in.cg_factor, &in.cp_factor, &in.air.density_factor,
        &in.inertia_factor, &in.actuator_bandwidth_factor, &in.bending_damping_factor,
        &in.bending_slope_factor, &in.bending_frequency_factor[0], &in.bending_frequency_factor[1]})
    some(*factor, 1.0 + 0.03 * draws.Normal());
  some(in.sensors.gyro_bias_roll_rad_s, 1e-6 * draws.Normal());
  some(in.sensors.gyro_bias_pitch_rad_s, 1e-6 * draws.Normal());
  some(in.sensors.gyro_bias_yaw_rad_s, 1e-6 * draws.Normal());
  some(in.sensors.gyro_noise_rad_s, 0.005 * kRadPerDeg);
  // Only guided flights feel these, so they are no draws of the stream that the inputs after them follow
  // from.
  Stream navigation(5, flight, "navigation");
  for (double& error_m : in.sensors.navigation_position_error_m) error_m = 30.0 * navigation.Normal();
  for (double& error_m_s : in.sensors.navigation_velocity_error_m_s) error_m_s = 0.3 * navigation.Normal();
  in.sensors.accelerometer_scale_factor = 1.0 + 1e-3 * navigation.Normal();
  // Later inputs have a stream of their own for the same reason.
  Stream later(5, flight, "later inputs");
  const auto seldom = [&](double& value, double drawn) {
    if (later.Uniform() < 0.3) value = drawn;
  };
  for (std::size_t stage = 0; stage < kUsualStages; ++stage) {
    seldom(in.stages[stage].dry_mass_factor, 1.0 + 0.01 * later.Normal());
    seldom(in.stages[stage].propellant_factor, 1.0 + 0.005 * later.Normal());
    seldom(in.stages[stage].product_of_inertia_xy_kg_m2, 0.05 * later.Normal());
    seldom(in.stages[stage].product_of_inertia_xz_kg_m2, 0.03 * later.Normal());
    seldom(in.stages[stage].product_of_inertia_yz_kg_m2, 0.03 * later.Normal());
    seldom(in.stages[stage].ignition_delay_s, 0.2 * later.Uniform());
    seldom(in.stages[stage].separation_delay_s, 0.1 * later.Uniform());
    seldom(in.stages[stage].thrust.misalignment_rad.y, 0.1 * kRadPerDeg * later.Normal());
    seldom(in.stages[stage].cg_offset_m.z, 0.002 * later.Normal());
    for (double* factor : {&in.stages[stage].drag_factor, &in.stages[stage].lift_factor,
                           &in.stages[stage].cg_factor, &in.stages[stage].cp_factor,
                           &in.stages[stage].inertia_factor, &in.stages[stage].actuator_bandwidth_factor})
      seldom(*factor, 1.0 + 0.02 * later.Normal());
  }
  Stream further(5, flight, "further nozzles");
  for (std::size_t nozzle = 0; nozzle < 14; ++nozzle) {
    if (further.Uniform() < 0.5) continue;
    in.further[nozzle].nozzle.line.misalignment_rad.y = 0.2 * kRadPerDeg * further.Normal();
    in.further[nozzle].nozzle.line.misalignment_rad.magnitude = 0.1 * kRadPerDeg * further.Uniform();
    in.further[nozzle].nozzle.line.misalignment_rad.clock_rad = kTwoPi * further.Uniform();
    in.further[nozzle].nozzle.line.offset_m.z = 0.002 * further.Normal();
    in.further[nozzle].nozzle.thrust_factor = 1.0 + 0.01 * further.Normal();
    in.further[nozzle].nozzle.flow_factor = 1.0 + 0.01 * further.Normal();
  }
  // In some flights so fast that a rate limit may act within a tick.
  seldom(in.stages[1].actuator_bandwidth_factor, 9.0);
  seldom(in.payload_mass_kg, 5.0 * later.Normal());
  in.payload_element = 1.0;
  seldom(in.launch_azimuth_error_rad, 0.3 * kRadPerDeg * later.Normal());
  seldom(in.initial_roll_error_rad, 0.5 * kRadPerDeg * later.Normal());
  seldom(in.initial_pitch_error_rad, 0.2 * kRadPerDeg * later.Normal());
  seldom(in.initial_yaw_error_rad, 0.2 * kRadPerDeg * later.Normal());
  if (draws.Uniform() < 0.3) {
    in.stuck_nozzle = std::floor(1.0 + 4.0 * draws.Uniform());
    in.stuck_nozzle_stage = std::floor(1.0 + 4.0 * draws.Uniform());
    in.stuck_nozzle_rad = 3.0 * kRadPerDeg * draws.Normal();  // some are lost
  }
  some(in.pn_error_factor, 1.5);
  some(in.pn_rate_factor, 0.7);
  some(in.loop_gain_factor, 1.0 + 0.5 * draws.Uniform());
  some(in.loop_delay_s, 0.03 * draws.Uniform());
  some(in.loop_stage, std::floor(5.0 * draws.Uniform()));
  some(in.air.turbulence_exceedance, 1e-3);
  some(in.air.turbulence_wind_20ft_m_s, 15.0);
  some(in.air.turbulence_scale, 1.0 + 0.2 * draws.Uniform());
  return in;
}

// A queue that hands flights out in an order, and keeps everything that they give back.
class Queue : public FlightQueue {
 public:
  struct Flown {
    std::unique_ptr<FlightRecord> record;
    History history;
    FlightResult result;
  };

  Queue(const FlightModel& model, std::vector<std::uint64_t> order)
      : model_(model), order_(std::move(order)) {
    flown.resize(order_.size());
  }
  FlightRecord* Next(bool) override {
    if (next_ == order_.size()) return nullptr;
    const std::uint64_t flight = order_[next_++];
    Flown& one = flown[flight];
    FlightOrder order{DrawnInputs(flight), {}};
    order.options.case_index = flight;
    if (!model_.definition().soundings.empty())
      order.inputs.air.weather_sounding = static_cast<double>(flight % 7 % 4);
    one.history.step_s = 0.5;
    if (flight % 4 == 1) order.options.history = &one.history;
    one.record = std::make_unique<FlightRecord>(model_, order);
    return one.record.get();
  }
  void Done(FlightRecord* record) override {
    for (Flown& one : flown)
      if (one.record.get() == record) one.result = record->Result();
  }

  std::vector<Flown> flown;

 private:
  const FlightModel& model_;
  std::vector<std::uint64_t> order_;
  std::size_t next_ = 0;
};

// Gives each flight pages of its own, which nobody may touch once it is done: who does dies of it.
class GuardedQueue : public FlightQueue {
 public:
  GuardedQueue(const FlightModel& model, std::uint64_t flights) : model_(model), left_(flights) {}
  ~GuardedQueue() override {
    for (void* pages : pages_) munmap(pages, sizeof(FlightRecord));
  }
  FlightRecord* Next(bool) override {
    if (left_ == 0) return nullptr;
    void* pages =
        mmap(nullptr, sizeof(FlightRecord), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    pages_.push_back(pages);
    FlightOrder order{DrawnInputs(--left_), {}};
    order.options.case_index = left_;
    return new (pages) FlightRecord(model_, order);
  }
  void Done(FlightRecord* record) override {
    record->~FlightRecord();
    ASSERT_EQ(mprotect(record, sizeof(FlightRecord), PROT_NONE), 0);
    ++done;
  }

  std::uint64_t done = 0;

 private:
  const FlightModel& model_;
  std::uint64_t left_;
  std::vector<void*> pages_;
};

class FlightRecords : public testing::TestWithParam<bool> {};

TEST_P(FlightRecords, AreNotTouchedOnceDone) {
  constexpr std::uint64_t kFlights = 9;  // so that lanes stand empty in the end, whatever their number
  const FlightModel model(Definition("adaptive_fuzzy", true, GetParam()));
  for (const LaneEngine& engine : UsableEngines()) {
    GuardedQueue queue(model, kFlights);
    engine.fly(model, queue);
    EXPECT_EQ(queue.done, kFlights);
  }
}

INSTANTIATE_TEST_SUITE_P(OpenLoopAndGuided, FlightRecords, testing::Bool());

// Each of the flights 0, 1, ... alone in one lane, and then together in every engine.
void ExpectTheFlightsAlone(const FlightModel& model, std::uint64_t flights) {
  std::vector<std::uint64_t> order(flights);
  std::iota(order.begin(), order.end(), 0);

  Queue alone(model, order);
  for (std::uint64_t flight = 0; flight < flights; ++flight) {
    Queue one(model, {flight});
    one.flown.resize(flights);
    OneLaneEngine().fly(model, one);
    alone.flown[flight] = std::move(one.flown[flight]);
  }
  std::size_t completed = 0, lost = 0;
  for (const Queue::Flown& one : alone.flown)
    (one.result.outcome == Outcome::kCompleted ? completed : lost) += 1;
  EXPECT_GT(completed, flights / 3) << "lanes are to be filled anew as flights end at different times; "
                                    << alone.flown[0].result.reason << ", " << alone.flown[1].result.reason;

  // From the last flight to the first in every other engine, so that neighbours change as well.
  for (const LaneEngine& engine : UsableEngines()) {
    if (engine.fly == OneLaneEngine().fly) continue;
    std::reverse(order.begin(), order.end());
    Queue together(model, order);
    engine.fly(model, together);
    for (std::uint64_t k = 0; k < flights; ++k) {
      const FlightResult &a = alone.flown[k].result, &b = together.flown[k].result;
      ASSERT_EQ(a.digest, b.digest) << engine.isa << " " << engine.lanes << " lanes, flight " << k;
      EXPECT_TRUE(AreSame(a.events, b.events)) << engine.isa << " " << engine.lanes << ", flight " << k;
      EXPECT_EQ(a.outcome, b.outcome);
      EXPECT_EQ(a.reason, b.reason);
      EXPECT_EQ(a.end_time_s, b.end_time_s);
      EXPECT_EQ(alone.flown[k].history.values.size(), together.flown[k].history.values.size());
      for (std::size_t i = 0; i < alone.flown[k].history.values.size(); ++i) {
        const double x = alone.flown[k].history.values[i], y = together.flown[k].history.values[i];
        ASSERT_TRUE(x == y || (x != x && y != y)) << "history of flight " << k << ", value " << i;
      }
    }
  }
}

class FlightLanes : public testing::TestWithParam<const char*> {};

TEST_P(FlightLanes, AreTheFlightsAlone) {
  std::string law = GetParam();
  const bool guided = law.starts_with("guided_");
  if (guided) law = law.substr(7);
  ExpectTheFlightsAlone(FlightModel(Definition(law, law != "pd", guided)), 12);
}

// A stage that nothing controls above three that an autopilot does, fins, a rail, spin motors; and the way on
// to the apogee or the ground, of flights whose last burns end at different times.
TEST(FreeStageLanes, AreTheFlightsAlone) {
  for (const FlightEnd ends : {FlightEnd::kApogee, FlightEnd::kImpact}) {
    FlightDefinition definition = Definition("pd", true);
    Vehicle& vehicle = definition.vehicle;
    vehicle.stages[3].gimbal = FixedNozzle(vehicle.stages[3].gimbal.pivot_station_m);
    vehicle.stages[3].spin_motors = SpinMotors{40.0, 1.234};
    vehicle.stages[3].motor.thrust_n *= 0.5;  // it comes down
    vehicle.stages[0].fins = {{4, 14.0, 0.8, 0.4, 0.5, 0.4, 0.02, 0.001}};
    vehicle.rail = Rail{3.0, 0.1, 0.0, 0.0};
    vehicle.loss_of_control.attitude_error_rad = 30.0 * kRadPerDeg;
    vehicle.descent.parachute_area_m2 = 20.0;
    vehicle.descent.parachute_drag_coefficient = 0.8;
    vehicle.descent.parachute_altitude_m = 5000.0;
    definition.course.ends = ends;
    ExpectTheFlightsAlone(FlightModel(definition), 8);
  }
}

// The sounding rocket, whose flights tell rails, spin and fall.
TEST(FreeLanes, AreTheFlightsAlone) {
  const Campaign campaign = LoadCampaign(DISPERSA_CAMPAIGNS "/gallery/nike_apache/campaign.yaml");
  ExpectTheFlightsAlone(FlightModel(DefinitionOf(campaign)), 8);
}

// Two planes, gyros that round, guidance, wind and turbulence at once. Fewer flights: their modes take
// longest.
TEST(FlexibleGuidedLanes, AreTheFlightsAlone) {
  FlightDefinition definition = Definition("flexible", true, true);
  const FlightDefinition flexible = FlexibleGuidedDefinition();
  definition.vehicle.structure_beam = flexible.vehicle.structure_beam;
  ExpectTheFlightsAlone(FlightModel(definition), 4);
}

// Engines that guidance cuts off, at times of their own, once and twice. Flights of the second take a second:
// few of them.
TEST(GuidedCutOffLanes, AreTheFlightsAlone) {
  for (const auto& [launcher, cases] : {std::pair{"electron", 5u}, {"vega", 2u}}) {
    SCOPED_TRACE(launcher);
    const Campaign campaign =
        LoadCampaign(DISPERSA_CAMPAIGNS "/gallery/" + std::string(launcher) + "/campaign.yaml");
    ExpectTheFlightsAlone(FlightModel(DefinitionOf(campaign)), IsLong() ? 12 : cases);
  }
}

// Timers that guidance sets, three guided burns, a node and a place as targets, and a body that leaves at an
// altitude.
TEST(GuidedSequenceLanes, AreTheFlightsAlone) {
  FlightDefinition vega = DefinitionOf(LoadCampaign(DISPERSA_CAMPAIGNS "/gallery/vega/campaign.yaml"));
  vega.guidance.burns = 3;
  vega.target.node_rad = 1.0;  // out of reach
  for (const std::size_t stage : {3u, 4u}) {
    vega.vehicle.stages[stage].motor.cut_off = CutOff::kAtTime;
    vega.vehicle.stages[stage].motor.cut_off_s = vega.cut_off_s[stage];
  }
  ExpectTheFlightsAlone(FlightModel(vega), IsLong() ? 9 : 2);
  FlightDefinition electron =
      DefinitionOf(LoadCampaign(DISPERSA_CAMPAIGNS "/gallery/electron/campaign.yaml"));
  electron.vehicle.stages[1].jettisoned[0].trigger = JettisonTrigger::kAtAltitude;
  electron.vehicle.stages[1].jettisoned[0].threshold = 110e3;
  electron.target.orbit = TargetOrbit{6778137.0, 0.0295, 0.5, 0.01};
  ExpectTheFlightsAlone(FlightModel(electron), 2);
}

INSTANTIATE_TEST_SUITE_P(Laws, FlightLanes,
                         testing::Values("adaptive_fuzzy", "frozen_fuzzy", "pd", "pid", "pd_aac", "pid_aac",
                                         "flexible", "guided_adaptive_fuzzy", "guided_pid_aac",
                                         "listed_pid_aac", "clustered_pid", "clustered_pid_aac",
                                         "clustered_flexible", "boosted_pid", "boosted_pid_aac"),
                         [](const auto& law) { return std::string(law.param); });

}  // namespace
}  // namespace dispersa::flight_lanes_test
