// Every pair of the vehicle's capabilities in one launcher: it flies to its end, in any number of lanes with
// the same bits, and neither mass nor momentum appears or vanishes. The page of capabilities is written from
// what this test finds.
#include "core/campaign/flight_definition.h"
#include "core/campaign/free_flight.h"
#include "core/campaign_yaml/load.h"
#include "core/environment/atmosphere.h"
#include "core/environment/earth.h"
#include "core/flight/flight_queue.h"
#include "core/flight/flight_record.h"
#include "core/flight/lane_engine.h"
#include "core/flight/tick_sample.h"
#include "core/math/rotation.h"
#include "core/random/draws.h"
#include "core/trajectory/ascent.h"
#include "core/vehicle/aerodynamics_build_up.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/long.h"
#include "tests/same_events.h"
#include "tests/slv4_flight.h"
#include "tests/tabulated_masses.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::capability_pairs_test {
namespace {

// The tables of the site's page of capabilities.
constexpr char kPairs[] = DISPERSA_CAMPAIGNS "/../services/docs/pairs.csv";
constexpr char kRefused[] = DISPERSA_CAMPAIGNS "/../services/docs/refused_pairs.csv";

// The files, each read once: there are hundreds of pairs.
const Vehicle& Rigid() {
  static const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  return vehicle;
}
const Vehicle& Flexible() {
  static const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  return vehicle;
}
const FlightProgram& Program() {
  static const FlightProgram program =
      LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km_reserve.yaml").program;
  return program;
}

// SLV-4 with capabilities. What it flies follows from the vehicle, by an ascent of its own.
struct Launcher {
  Vehicle vehicle = Rigid();
  FlightProgram program = Program();
  std::string autopilot = "adaptive_fuzzy";
  bool is_guided = false, is_turbulent = false, draws_masses = false, has_weather = false;
  FlightCourse course;
};

void AddBoosters(Launcher& launcher) {
  Boosters& b = launcher.vehicle.boosters;
  b = {4, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {22.0, 24.05, 0.6, 0.2}, 0.5};
  b.motor.thrust_n = 80e3;
  b.motor.burning_time_s = 30.0;
  launcher.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
}
// The same boosters, or as many: each a body of its own, with a canted nozzle that turns.
void SteerByBoosters(Launcher& launcher) {
  Boosters& b = launcher.vehicle.boosters;
  if (b.count == 0) AddBoosters(launcher);
  for (int k = 0; k < b.count; ++k) b.angles_rad.push_back(kTwoPi * k / b.count);
  b.cant_rad = 3.0 * kRadPerDeg;
  b.gimbal = launcher.vehicle.stages[0].gimbal;
  b.gimbal.nozzles.clear();
  b.gimbal.nozzle_mass_kg = b.gimbal.nozzle_inertia_kg_m2 = b.gimbal.nozzle_cg_m = 0.0;
  b.towards_rad = {90.0 * kRadPerDeg, 180.0 * kRadPerDeg};
}
// The same boosters, or as many, with tanks that keep a rest.
void MakeBoostersLiquid(Launcher& launcher) {
  Boosters& b = launcher.vehicle.boosters;
  if (b.count == 0) AddBoosters(launcher);
  MakeLiquid(b);
  b.motor.residual_mass_kg = 10.0;
  b.motor.throttle = {{0.0, 12.0, 14.0}, {1.0, 1.0, 0.8}};
}
void AddFairing(Launcher& launcher) {
  launcher.vehicle.stages[3].jettisoned = {
      {"fairing", 50.0, 0.1, 2.5, 0.6, 0.57, JettisonTrigger::kAtAltitude, 90e3}};
}
void AddBending(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  vehicle.structure_beam = Flexible().structure_beam;
  vehicle.sensors = Flexible().sensors;
  launcher.autopilot = "flexible";  // which blends the gyros
  StructureBeam& beam = *vehicle.structure_beam;
  vehicle.boosters.attachment_station_m = 23.0;
  beam.elements = 12;  // coarse: flights whose masses are drawn have modes of their own
  beam.propellant_levels = 5;
  if (vehicle.stages[3].jettisoned.empty()) return;
  LumpedMass fairing;
  fairing.name = fairing.element = "fairing";
  fairing.station_m = 1.65;
  beam.stages[3].lumped_masses.push_back(fairing);
}
void MakeLastStageLiquid(Launcher& launcher) {
  Stage& last = launcher.vehicle.stages.back();
  if (!last.is_liquid()) MakeLiquid(last);
}
void AddRestart(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  MakeLastStageLiquid(launcher);
  vehicle.stages.back().motor.tail_off_s = 0.5;
  vehicle.stages.push_back(vehicle.stages.back());
  Stage &first = *(vehicle.stages.end() - 2), &again = vehicle.stages.back();
  again.restarts = true;
  first.motor.cut_off = CutOff::kAtTime;
  first.motor.cut_off_s = 0.5 * first.motor.burning_time_s;
  again.liftoff_mass_kg -= 0.5 * again.propellant_mass_kg;
  again.propellant_mass_kg *= 0.5;
  again.motor.burning_time_s *= 0.5;
  for (Tank& tank : again.tanks) tank.propellant_mass_kg *= 0.5;
  launcher.program.earlier_coast_s[3] = launcher.program.coast_s;
  launcher.program.coast_s = 100.0;
  if (!vehicle.structure_beam) return;
  vehicle.structure_beam->stages.push_back(vehicle.structure_beam->stages.back());
}
void CutOffAtVelocity(Launcher& launcher) {
  MakeLastStageLiquid(launcher);
  Motor& engine = launcher.vehicle.stages.back().motor;
  engine.cut_off = CutOff::kAtVelocity;
  engine.cut_off_velocity_m_s = 7300.0;
  engine.tail_off_s = 0.6;
}
void Throttle(Launcher& launcher) {
  Stage& stage = launcher.vehicle.stages[1];
  MakeLiquid(stage);
  stage.motor.residual_mass_kg = 0.005 * stage.propellant_mass_kg;
  stage.motor.throttle = {{0.0, 10.0, 20.0}, {1.0, 1.0, 0.8}};
}
void UseThrustCurve(Launcher& launcher) {
  Motor& motor = launcher.vehicle.stages[0].motor;
  ThrustCurve curve{{0.0, 0.7, 13.3, 41.1, 54.0, 55.0}, {0.3, 1.0, 1.05, 0.95, 0.9, 0.0}};
  for (double& time_s : curve.time_s) time_s *= motor.burning_time_s / 55.0;
  for (double& thrust_n : curve.thrust_n) thrust_n *= motor.thrust_n;
  SetThrustCurve(curve, motor);
}
void ListNozzles(Launcher& launcher) {
  Gimbal& gimbal = launcher.vehicle.stages[1].gimbal;
  for (const double at : {0.0, 120.0 * kRadPerDeg, 240.0 * kRadPerDeg})
    gimbal.nozzles.push_back({"at " + std::to_string(gimbal.nozzles.size()),
                              gimbal.radius_m * std::cos(at),
                              gimbal.radius_m * std::sin(at),
                              1.0 / 3.0,
                              {at + 90.0 * kRadPerDeg},
                              0.0});
}
// Eight engines in a ring about one, with two hinges each.
void AddCluster(Launcher& launcher) {
  Gimbal& gimbal = launcher.vehicle.stages[0].gimbal;
  const std::vector<double> hinges = {90.0 * kRadPerDeg, 180.0 * kRadPerDeg};
  gimbal.nozzles = {{"centre", 0.0, 0.0, 1.0 / 9.0, hinges, 0.0}};
  for (int k = 0; k < 8; ++k)
    gimbal.nozzles.push_back({"ring " + std::to_string(k + 1), 0.4 * std::cos(kTwoPi * k / 8),
                              0.4 * std::sin(kTwoPi * k / 8), 1.0 / 9.0, hinges, 0.0});
}
FinSet Fins(double leading_edge_m, double root_m, double tip_m, double span_m) {
  FinSet fins;
  fins.leading_edge_station_m = leading_edge_m;
  fins.root_chord_m = root_m;
  fins.tip_chord_m = tip_m;
  fins.span_m = span_m;
  fins.sweep_m = root_m - tip_m;
  fins.thickness_m = 0.04;
  return fins;
}
void AddFins(Launcher& launcher) { launcher.vehicle.stages[0].fins = {Fins(24.6, 1.8, 1.0, 0.8)}; }
void AddRail(Launcher& launcher) { launcher.vehicle.rail = Rail{8.0, 0.1, 2.5, 80.0 * kRadPerDeg}; }
// Twice the thrust in half the time.
void Hasten(Motor& motor) {
  motor.thrust_n *= 2.0;
  motor.burning_time_s *= 0.5;
  motor.cut_off_s *= 0.5;
  for (double& thrust_n : motor.thrust_curve.thrust_n) thrust_n *= 2.0;
  for (auto* times_s : {&motor.thrust_curve.time_s, &motor.throttle.time_s})
    for (double& time_s : *times_s) time_s *= 0.5;
}
// A sounding rocket of the same stages: canted fins hold each of them and spin it. It leaves a long rail
// fast, and nothing commands it. Lists of nozzles and boosters that steer stay, which are refused.
void LetFree(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  launcher.course.is_controlled = false;
  launcher.course.ends = FlightEnd::kApogee;
  vehicle.rail = Rail{30.0, 0.1, 2.5, 85.0 * kRadPerDeg};
  Hasten(vehicle.boosters.motor);
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    Stage& stage = vehicle.stages[i];
    Hasten(stage.motor);
    if (i > 0) stage.ignition = IgnitionTrigger::kBurnoutDetection;
    if (stage.gimbal.nozzles.empty()) stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
    const double root_m = 2.0 * stage.diameter_m;
    stage.fins = {Fins(stage.bottom_station_m - root_m, root_m, 0.6 * root_m, 1.2 * stage.diameter_m)};
    stage.fins[0].cant_rad = (i == 0 ? 0.2 : i == 1 ? 0.04 : 0.0) * kRadPerDeg;
  }
}
// The last stage, in each of its burns: held by thrusters in the coast, by its spin while it burns. Where
// nothing controls the vehicle it spins already.
void SpinLastStage(Launcher& launcher) {
  std::vector<Stage>& stages = launcher.vehicle.stages;
  for (std::size_t i = 3; i < stages.size(); ++i) {
    stages[i].gimbal = FixedNozzle(stages[i].gimbal.pivot_station_m);
    stages[i].spin_motors = SpinMotors{launcher.course.is_controlled ? 60.0 : 5.0, 1.5};
  }
  // Nothing steers it against a misaligned thrust: it cones.
  launcher.vehicle.loss_of_control = {170.0 * kRadPerDeg, 0.5, 50.0};
}
// Tables of what is computed, with the motor out, and after each body has left.
void UseAeroTables(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  std::vector<AeroTable> tables = AerodynamicsOf(vehicle);
  for (AeroTable& table : tables) {
    table.ca_power_off = table.ca;
    for (double& ca : table.ca_power_off) ca *= 1.1;
  }
  const auto leaves = [](const char* name, AeroTable& table) {
    AeroTable lighter = table;
    for (double& cn : lighter.cn) cn *= 0.9;
    table.lighter.push_back({{name}, lighter});
  };
  for (AeroTable& table : tables)
    if (!vehicle.stages[3].jettisoned.empty()) leaves("fairing", table);
  if (vehicle.boosters.count > 0) leaves(kBoostersName, tables[0]);
  vehicle.aerodynamics = std::move(tables);
}
// The same tables, or those computed, of a body that is wider in yaw: two planes until boosters have left.
void UseYawPlane(Launcher& launcher) {
  std::vector<AeroTable> tables = AerodynamicsOf(launcher.vehicle);
  for (AeroTable& table : tables) {
    AeroTable yaw = table;
    yaw.lighter.clear();
    for (double& cn : yaw.cn) cn *= 1.2;
    for (double& xcp_m : yaw.xcp_station_m) xcp_m += 0.1;
    for (double& cmq : yaw.cmq_per_rad) cmq *= 1.1;
    table.yaw_plane = {yaw};
  }
  if (launcher.vehicle.boosters.count > 0 && tables[0].lighter.empty()) {
    AeroTable round = tables[0];
    round.yaw_plane.clear();
    tables[0].lighter = {{{kBoostersName}, round}};
  }
  launcher.vehicle.aerodynamics = std::move(tables);
}
// A little more than the tubes: CAD knows better.
void UseMassTables(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    Stage& stage = vehicle.stages[i];
    if (stage.restarts) {
      stage.flown_mass = vehicle.stages[i - 1].flown_mass;
      continue;
    }
    stage.mass_table = TableOfTubes(vehicle, i, 41);
    for (double& inertia : stage.mass_table.transverse_inertia_kg_m2) inertia *= 1.03;
    if (i == 0) stage.mass_table.cg_y_m.assign(41, 0.002);
    stage.mass_table.yaw_inertia_kg_m2 = stage.mass_table.transverse_inertia_kg_m2;
    for (double& inertia : stage.mass_table.yaw_inertia_kg_m2) inertia *= 1.02;
    stage.flown_mass.rows = std::make_shared<const MassRows>(
        BuildMassRows(stage.mass_table, DryMass(vehicle, static_cast<int>(i))));
  }
}
// The last stage has a third of its thrust, stays below an orbit and comes down under a parachute.
void Land(Launcher& launcher) {
  Vehicle& vehicle = launcher.vehicle;
  for (std::size_t i = 3; i < vehicle.stages.size(); ++i) {
    Motor& motor = vehicle.stages[i].motor;
    motor.thrust_n *= 0.3;
    for (double& thrust_n : motor.thrust_curve.thrust_n) thrust_n *= 0.3;
  }
  vehicle.descent.parachute_area_m2 = 40.0;
  vehicle.descent.parachute_drag_coefficient = 0.8;
  vehicle.descent.parachute_altitude_m = 4000.0;
  launcher.course.ends = FlightEnd::kImpact;
}
void AddGyros(Launcher& launcher) { launcher.vehicle.sensors = Flexible().sensors; }

struct Capability {
  std::string name;
  std::function<void(Launcher&)> add;
};
// In the order in which they are added. What comes later knows what came before.
const std::vector<Capability>& Capabilities() {
  static const std::vector<Capability> all = {
      {"boosters", AddBoosters},
      {"boosters that steer", SteerByBoosters},
      {"liquid boosters", MakeBoostersLiquid},
      {"fairing", AddFairing},
      {"bending", AddBending},
      {"restart", AddRestart},
      {"cut-off by velocity", CutOffAtVelocity},
      {"throttle", Throttle},
      {"thrust curve", UseThrustCurve},
      {"list of nozzles", ListNozzles},
      {"cluster of engines", AddCluster},
      {"fins", AddFins},
      {"rail", AddRail},
      {"no control", LetFree},
      {"spun last stage", SpinLastStage},
      {"tables of aerodynamics", UseAeroTables},
      {"aerodynamics of two planes", UseYawPlane},
      {"mass tables", UseMassTables},
      {"rate gyros", AddGyros},
      {"closed loop", [](Launcher& launcher) { launcher.is_guided = true; }},
      {"turbulence", [](Launcher& launcher) { launcher.is_turbulent = true; }},
      {"drawn masses", [](Launcher& launcher) { launcher.draws_masses = true; }},
      {"measured atmosphere", [](Launcher& launcher) { launcher.has_weather = true; }},
      {"parachute", Land},
  };
  return all;
}

// Wind, and air a little denser than the standard's.
WeatherTable Weather() {
  WeatherTable table;
  for (double z = 0.0; z <= 30e3; z += 2000.0) {
    const AirState air = StandardAtmosphere1976(z);
    table.altitude_m.push_back(z);
    table.north_m_s.push_back(5.0 + 1e-3 * z);
    table.east_m_s.push_back(-0.5e-3 * z);
    table.pressure_pa.push_back(1.01 * air.pressure_pa);
    table.density_kg_m3.push_back(1.02 * air.density_kg_m3);
  }
  return table;
}

// A flight along no reference.
FlightDefinition FreeDefinitionOf(const Launcher& launcher) {
  Campaign campaign;
  campaign.vehicle = launcher.vehicle;
  campaign.course = launcher.course;
  SetFreeFlight(campaign);
  return DefinitionOf(campaign);
}

FlightDefinition GuidedDefinitionOf(const Launcher& launcher) {
  AscentOptions options;
  options.record = true;
  const AscentResult ascent = FlyAscent(BuildAscentModel(launcher.vehicle, 0.01), launcher.program, options);
  static std::map<std::string, FlightDefinition> definitions;  // by autopilot: three files each
  auto& [name, of_slv4] = *definitions.try_emplace(launcher.autopilot).first;
  if (of_slv4.vehicle.stages.empty())
    of_slv4 = Slv4Definition(DISPERSA_CAMPAIGNS, name, "slv4_500km_reserve");
  FlightDefinition definition = of_slv4;
  definition.vehicle = launcher.vehicle;
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  definition.earlier_ignition_s = ascent.earlier_ignition_s;
  definition.cut_off_s = ascent.cut_off_s;
  definition.jettison_s = ascent.jettison_s;
  definition.course = launcher.course;
  definition.guidance.closed_loop = launcher.is_guided;
  definition.guidance.steers_last_burn = launcher.vehicle.stages.back().is_controlled();
  for (AxisConfig* axis :
       {&definition.autopilot.roll, &definition.autopilot.pitch, &definition.autopilot.yaw})
    for (std::size_t stage = 4; stage < launcher.vehicle.stages.size(); ++stage) {
      const auto repeat = [](auto& list) {
        if (list.size() >= 4) list.push_back(list.back());
      };
      repeat(axis->gains);
      repeat(axis->adaptation.gamma);
      repeat(axis->integral.ki_1_s3);
    }
  return definition;
}

FlightDefinition DefinitionOf(const Launcher& launcher) {
  FlightDefinition definition =
      launcher.course.is_controlled ? GuidedDefinitionOf(launcher) : FreeDefinitionOf(launcher);
  definition.noise_seed = 7;
  if (launcher.has_weather) {
    definition.wind_table = Weather();
    definition.soundings = {Weather()};
    for (double& pressure_pa : definition.soundings[0].pressure_pa) pressure_pa *= 0.98;
  }
  if (launcher.is_turbulent)
    definition.turbulence_path =
        std::make_shared<const TurbulencePath>(ClimbPath{{0.0, 1000.0, 40e3}, {1.0, 1.0, 0.5}, 3.0});
  return definition;
}

FlightInputs InputsOf(const Launcher& launcher, std::uint64_t index) {
  Stream draws(3, index, "pairs");
  FlightInputs in = Table3Inputs();
  for (StageInputs& stage : in.stages) stage.thrust_factor = 1.0 + 0.002 * draws.Normal();
  for (StageInputs& stage : in.stages) stage.tail_off_factor = 1.2;
  // What is left of the wind after a rail was set for it.
  in.air.wind_max_speed_m_s = (launcher.course.is_controlled ? 30.0 : 3.0) * draws.Uniform();
  if (launcher.is_turbulent) in.air.turbulence_exceedance = 1e-1;
  if (launcher.has_weather) in.air.weather_sounding = static_cast<double>(index % 2);
  if (launcher.vehicle.sensors.rate_gyros.empty()) in.sensors.gyro_noise_rad_s = 0.002 * kRadPerDeg;
  if (!launcher.draws_masses) return in;
  for (std::size_t stage = 0; stage < 4; ++stage) {
    in.stages[stage].dry_mass_factor = 1.0 + 0.005 * draws.Normal();
    in.stages[stage].propellant_factor = 1.0 + 0.002 * draws.Normal();
  }
  const Vehicle& vehicle = launcher.vehicle;
  for (std::size_t stage = 0; stage < vehicle.stages.size(); ++stage)
    if (vehicle.stages[stage].is_liquid())
      in.stages[stage].mixture_ratio_factor = 1.0 + 0.01 * draws.Normal();
  auto at = static_cast<std::size_t>(FurtherNozzlesBefore(vehicle, vehicle.stages.size()));
  for (int k = 0; k < vehicle.boosters.count; ++k, ++at) {
    in.further[at].booster.dry_mass_factor = 1.0 + 0.02 * draws.Normal();
    in.further[at].booster.propellant_factor = 1.0 + 0.002 * draws.Normal();
    if (vehicle.boosters.is_liquid())
      in.further[at].booster.mixture_ratio_factor = 1.0 + 0.01 * draws.Normal();
  }
  return in;
}

// What an outsider with a balance and a clock sees of a flight: samples at its ticks and events.
class Bookkeeper {
 public:
  explicit Bookkeeper(const Earth& earth) : earth_(earth) {}

  /// On a rail a force acts that no sample has.
  double held_until_s = 0.0;

  void See(const TickSample& now) {
    if (now.time_s < held_until_s) return;
    const double mass_kg = now.instant.loads.mass_kg;
    const Vector3 acceleration =
        Gravitation(earth_, now.state.p_EoC_I) + Rotate(now.state.q_IB, now.instant.loads.force_n / mass_kg);
    if (is_first_) {
      is_first_ = false;
    } else {
      const double step_s = now.time_s - time_s_;
      const bool is_event = step_s <= 0.0 || now.stack != stack_ || now.burning != burning_ ||
                            now.boosting != boosting_ || now.boosters_burning != boosters_burning_ ||
                            now.jettisoned != jettisoned_;
      const double change_m_s = (now.state.v_IC_I - v_m_s_ - 0.5 * step_s * (acceleration + a_m_s2_)).norm();
      const double flown_kg = mass_kg_ - mass_kg;
      if (is_event) {
        // The rest's centre of gravity is elsewhere in a turning body.
        const double shifted_m = std::fabs(now.instant.cg_station_m - cg_station_m_);
        const double part_m_s = step_s * std::max(acceleration.norm(), a_m_s2_.norm()) +
                                shifted_m * now.state.w_IB_B.tail<2>().norm();
        largest_event_m_s = std::max(largest_event_m_s, change_m_s - part_m_s);
      } else {
        largest_tick_m_s = std::max(largest_tick_m_s, change_m_s);
        unbooked_kg += flown_kg - 0.5 * step_s * (now.instant.flow_kg_s + flow_kg_s_) -
                       (now.expelled_mass_kg - expelled_kg_);
      }
    }
    time_s_ = now.time_s;
    stack_ = now.stack;
    burning_ = now.burning;
    boosting_ = now.boosting;
    boosters_burning_ = now.boosters_burning;
    jettisoned_ = now.jettisoned;
    mass_kg_ = mass_kg;
    cg_station_m_ = now.instant.cg_station_m;
    flow_kg_s_ = now.instant.flow_kg_s;
    expelled_kg_ = now.expelled_mass_kg;
    v_m_s_ = now.state.v_IC_I;
    a_m_s2_ = acceleration;
  }

  double largest_tick_m_s = 0.0;   ///< change of speed that no force explains, over a tick
  double largest_event_m_s = 0.0;  ///< the same over a tick with an event, without what a part of it may do
  double unbooked_kg = 0.0;        ///< mass that left neither through a nozzle nor at an event

 private:
  const Earth& earth_;
  bool is_first_ = true;
  double time_s_ = 0.0, mass_kg_ = 0.0, cg_station_m_ = 0.0, flow_kg_s_ = 0.0, expelled_kg_ = 0.0;
  int stack_ = 0;
  bool burning_ = false, boosting_ = false;
  unsigned boosters_burning_ = 0, jettisoned_ = 0;
  Vector3 v_m_s_ = Vector3::Zero(), a_m_s2_ = Vector3::Zero();
};

class Queue : public FlightQueue {
 public:
  Queue(const FlightModel& model, std::vector<FlightOrder> orders)
      : model_(model), orders_(std::move(orders)) {
    results.resize(orders_.size());
    records_.resize(orders_.size());
  }
  FlightRecord* Next(bool) override {
    if (next_ == orders_.size()) return nullptr;
    records_[next_] = std::make_unique<FlightRecord>(model_, orders_[next_]);
    return records_[next_++].get();
  }
  void Done(FlightRecord* record) override {
    for (std::size_t i = 0; i < records_.size(); ++i)
      if (records_[i].get() == record) results[i] = record->Result();
  }
  std::vector<FlightResult> results;

 private:
  const FlightModel& model_;
  std::vector<FlightOrder> orders_;
  std::vector<std::unique_ptr<FlightRecord>> records_;
  std::size_t next_ = 0;
};

// Empty if the pair flies, else why the vehicle is refused.
std::string Refusal(const Launcher& launcher) {
  std::vector<StructProblem> problems = Problems(launcher.vehicle);
  if (problems.empty()) problems = ControlProblems(launcher.vehicle, launcher.course);
  // As the reader of campaigns says it.
  if (problems.empty() && launcher.is_guided && !launcher.course.is_controlled)
    problems.push_back({"guidance", "'guidance' is given, and nothing controls the flights", ""});
  return problems.empty() ? "" : problems[0].path + ": " + problems[0].message;
}

// The first is also flown alone, each of them in the long test.
std::uint64_t Cases() { return IsLong() ? 20 : 2; }

// The one that campaigns use; in the long test all. That levels and numbers of lanes give the same bits is
// the subject of flight_lanes_test.cc.
std::vector<LaneEngine> EnginesToCompare() {
  return IsLong() ? UsableEngines() : std::vector{ChosenEngine()};
}

void ExpectFlies(const Launcher& launcher) {
  const FlightModel model(DefinitionOf(launcher));
  std::vector<FlightOrder> orders;
  for (std::uint64_t index = 0; index < Cases(); ++index) {
    FlightOrder order{InputsOf(launcher, index), {}};
    order.options.case_index = index;
    orders.push_back(order);
  }
  std::vector<FlightResult> alone;
  for (std::size_t i = 0; i < (IsLong() ? orders.size() : 1); ++i) {
    FlightOptions options = orders[i].options;
    Bookkeeper books(model.nominal_plant().environment.earth);
    if (launcher.vehicle.rail) books.held_until_s = 3.0;
    options.observe = [&](const TickSample& now) { books.See(now); };
    alone.push_back(Fly(model, orders[i].inputs, options));
    // Of the trapezium rule over a tick, with the jumps of wind and thrust inside it.
    EXPECT_LT(books.largest_tick_m_s, 2e-3);
    // Nothing pushes where a body leaves. Bending passes some of its motion on.
    EXPECT_LT(books.largest_event_m_s, 0.5);
    EXPECT_LT(std::fabs(books.unbooked_kg), 1e-4 * launcher.vehicle.stages[0].liftoff_mass_kg);
  }
  for (const LaneEngine& engine : EnginesToCompare()) {
    Queue together(model, orders);
    engine.fly(model, together);
    for (const FlightResult& flown : together.results)
      EXPECT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(together.results[i].digest, alone[i].digest)
          << engine.isa << ", " << engine.lanes << " lanes, case " << i;
      EXPECT_TRUE(AreSame(together.results[i].events, alone[i].events)) << engine.isa << ", case " << i;
    }
  }
}

Launcher With(const std::vector<std::size_t>& capabilities) {
  Launcher launcher;
  for (const std::size_t i : capabilities) Capabilities()[i].add(launcher);
  return launcher;
}

TEST(FreeFlights, HaveNoBoostersThatSteer) {
  Launcher launcher = With({1});
  for (Stage& stage : launcher.vehicle.stages) {
    stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
    stage.ignition = IgnitionTrigger::kBurnoutDetection;
  }
  launcher.vehicle.rail = Rail{};
  const std::vector<StructProblem> problems =
      ControlProblems(launcher.vehicle, {FlightEnd::kApogee, false, kFreeStep_s});
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].message, "the boosters of 'slv4' have a gimbal, which nothing would command");
}

// Of liquid boosters too, whose mixtures are drawn, beside a stage that bends: no pair has all of them.
TEST(DrawnMasses, OfLiquidBoostersThatSteerFlyWhereTheBodyBends) {
  const auto place_of = [](std::string_view name) {
    const auto& all = Capabilities();
    return static_cast<std::size_t>(
        std::find_if(all.begin(), all.end(), [&](const Capability& each) { return each.name == name; }) -
        all.begin());
  };
  ExpectFlies(With({place_of("boosters that steer"), place_of("liquid boosters"), place_of("bending"),
                    place_of("drawn masses")}));
}

class Pair : public testing::TestWithParam<std::size_t> {};

// A capability with each of those after it, and alone.
TEST_P(Pair, Flies) {
  const std::size_t first = GetParam();
  for (std::size_t second = first; second < Capabilities().size(); ++second) {
    SCOPED_TRACE(Capabilities()[first].name + ", " + Capabilities()[second].name);
    const Launcher launcher =
        With(first == second ? std::vector<std::size_t>{first} : std::vector<std::size_t>{first, second});
    if (Refusal(launcher).empty()) ExpectFlies(launcher);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, Pair, testing::Range<std::size_t>(0, Capabilities().size()),
                         [](const auto& one) {
                           std::string name = Capabilities()[one.param].name;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
                           return name;
                         });

// A row and a column for each capability; the reasons of what is refused.
struct PairTables {
  std::string pairs, refused = "capability,with,reason\n";
};
PairTables Tables() {
  const std::vector<Capability>& all = Capabilities();
  PairTables tables;
  std::vector<std::vector<std::string>> refusals(all.size(), std::vector<std::string>(all.size()));
  for (std::size_t row = 0; row < all.size(); ++row)
    for (std::size_t column = row + 1; column < all.size(); ++column) {
      const std::string refusal = refusals[row][column] = refusals[column][row] =
          Refusal(With({row, column}));
      if (!refusal.empty())
        tables.refused += all[row].name + "," + all[column].name + ",\"" + refusal + "\"\n";
    }
  for (const Capability& one : all) tables.pairs += "," + one.name;
  for (std::size_t row = 0; row < all.size(); ++row) {
    tables.pairs += "\n" + all[row].name;
    for (std::size_t column = 0; column < all.size(); ++column)
      tables.pairs += row == column ? "," : refusals[row][column].empty() ? ",flies" : ",refused";
  }
  tables.pairs += "\n";
  return tables;
}

void ExpectFile(const char* path, const std::string& wanted) {
  const std::string text = TextOfFile(path);
  if (std::getenv("DISPERSA_REWRITE_TABLES") != nullptr) std::ofstream(path) << wanted;
  EXPECT_EQ(text, wanted) << "DISPERSA_REWRITE_TABLES=1 build/release/tests/property_tests "
                             "--gtest_filter=CapabilityPage.*";
}

TEST(CapabilityPage, ListsWhatFliesTogether) {
  const PairTables tables = Tables();
  ExpectFile(kPairs, tables.pairs);
  ExpectFile(kRefused, tables.refused);
}

}  // namespace
}  // namespace dispersa::capability_pairs_test
