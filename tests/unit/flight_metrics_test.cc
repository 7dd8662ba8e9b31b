// Every metric on made-up histories whose answers are known by hand.
#include "core/control/lyapunov.h"
#include "core/flight/flight_model.h"
#include "core/flight/flight_sums.h"
#include "core/flight/limit_cycle.h"
#include "core/flight/ripple.h"
#include "core/flight/structural_limits.h"
#include "core/flight/tick_sample.h"

#include "core/flight/metrics.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/lane_eigen.h"
#include "core/results/metric_catalogue.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_metrics_test {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kDeg = kRadPerDeg;

FlightDefinition Definition() {
  FlightDefinition definition = SampleDefinition();
  definition.kick_start_s = 0.0;
  definition.kick_end_s = 2.0;
  definition.target = {500e3, 7600.0, 0.1 * kDeg, 61.5 * kDeg};
  definition.vehicle.limits.lateral_load_g = 0.45;
  definition.vehicle.profile = {{ProfileShape::kCone, 2.0, 1.2}, {ProfileShape::kCylinder, 18.0, 1.2}};
  return definition;
}

// A made-up tick: what the engine would know of it, and whether it met loads.
struct Tick : TickSample {
  bool has_loads = false;
};

// One lane of the engine's metrics, fed with made-up ticks as the engine feeds it.
class MetricsRecorder {
 public:
  MetricsRecorder(const FlightModel& model, const FlightInputs& inputs)
      : model_(model), inputs_(inputs), ripple_(kTick_s), cycle_(kTick_s) {
    metrics_.StartFlight(0, FlightInputs{});
  }

  void AddTick(const Tick& s) {
    if (s.has_loads) metrics_.AddLoads(!s.coasting, InstantOf(s.instant));
    const double pitch = -s.error.angle_rad.y();
    if (s.coasting) metrics_.AddCoast(true, s.time_s, pitch);
    if (stage_ >= 0 && (!s.burning || s.stack != stage_)) EndStage();
    if (!s.burning) return;
    stage_ = s.stack;
    lanes::DriveState<double> drives;
    for (std::size_t i = 0; i < kNozzles; ++i) {
      drives.angle_rad[i] = s.nozzle_rad[i];
      drives.rate_rad_s[i] = s.nozzle_rate_rad_s[i];
    }
    const AxisTelemetry& t = s.gimbal.telemetry[kPitch];
    const double p11 = model_.autopilot().laws[kPitch].stages[static_cast<std::size_t>(s.stack)].p11;
    metrics_.AddPowered(true, kTick_s, s.time_s, {-s.error.angle_rad.x(), pitch, -s.error.angle_rad.z()},
                        {t.v, t.v_rate_sign < 0.0 ? 1.0 : 0.0, p11, t.adaptation_norm * t.adaptation_norm});
    metrics_.AddDeflections(true, s.time_s, drives, s.command_rad.data(), s.limit_rad);
    sums_.rules_fired = t.rules_fired;
    const double bottom_m = inputs_.air.gust_altitude_m;
    const double top_m = inputs_.air.gust_speed_m_s != 0.0 ? bottom_m + inputs_.air.gust_length_m : bottom_m;
    const FlightDefinition& d = model_.definition();
    if (lanes::InTransient(s.time_s, s.since_ignition_s, s.instant.air.place.altitude_m, d.kick_start_s,
                           d.kick_end_s, bottom_m, top_m))
      Interrupt();
    else
      Add(0.25 * (s.nozzle_rad[0] - s.nozzle_rad[1] + s.nozzle_rad[2] - s.nozzle_rad[3]),
          0.5 * (s.nozzle_rad[0] + s.nozzle_rad[1]), 0.5 * (s.nozzle_rad[2] + s.nozzle_rad[3]));
  }
  void AddLoads(const LauncherInstant& now) { metrics_.AddLoadsOfLane(0, 0.0, 0.0, {}, InstantOf(now)); }
  void AddMoment(double moment_n_m, double station_m) { metrics_.AddMoment(true, {moment_n_m, station_m}); }
  void AddHandover(const AttitudeError& error) {
    sums_.handed_over = true;
    sums_.handover_angle_rad = error.angle_rad.norm();
    sums_.handover_rate_rad_s = error.rate_rad_s.norm();
  }
  void AddInjection(const Earth& earth, const RigidBodyState& s, double altitude_m) {
    sums_.injected = true;
    sums_.injection_altitude_m = altitude_m;
    sums_.orbit = ElementsOf(earth, s.p_EoC_I, s.v_IC_I);
  }
  void SetExpelledMass(double mass_kg) { sums_.expelled_kg = mass_kg; }
  bool structural_limit_exceeded() const {
    FlightSums sums;
    metrics_.Read(0, sums);
    return ExceedsStructure(model_.definition().vehicle.limits, sums);
  }
  std::vector<double> Finish() const {
    MetricsRecorder ended = *this;
    if (ended.stage_ >= 0) ended.EndStage();
    ended.metrics_.Read(0, ended.sums_);
    ended.sums_.ripple_rad = ripple_.worst_rad();
    ended.sums_.limit_cycle_rad = cycle_.worst_rad();
    return Measure(ended.sums_, model_.definition()).metrics;
  }

 private:
  static lanes::Instant<double> InstantOf(const LauncherInstant& now) {
    const Vector3& f = now.loads.force_n;
    return {now.air.place.altitude_m,
            now.air.qbar_pa,
            now.air.mach,
            TotalIncidence(now.v_AB_B),
            now.loads.mass_kg,
            now.thrust_n,
            ToLanes(f),
            {},
            {},
            {},
            {}};
  }
  void EndStage() {
    metrics_.EndStage(0, stage_, sums_);
    Interrupt();
    stage_ = -1;
  }
  void Interrupt() {
    ripple_.Interrupt();
    cycle_.Interrupt();
  }
  void Add(double roll_rad, double pitch_rad, double yaw_rad) {
    ripple_.Add(roll_rad, pitch_rad, yaw_rad);
    cycle_.Add(roll_rad, pitch_rad, yaw_rad);
  }

  const FlightModel& model_;
  FlightInputs inputs_;
  lanes::LaneMetrics<double> metrics_;
  RippleMeter ripple_;
  LimitCycleMeter cycle_;
  FlightSums sums_;
  int stage_ = -1;
};

// A recorder with names for its results.
class Recording {
 public:
  explicit Recording(const FlightInputs& inputs = {}, const FlightDefinition& definition = Definition())
      : model_(definition), recorder(model_, inputs) {}

  double operator[](const std::string& name) const {
    const auto& names = MetricNames();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return recorder.Finish()[i];
    ADD_FAILURE() << "no metric " << name;
    return 0.0;
  }

 private:
  FlightModel model_;

 public:
  MetricsRecorder recorder;
};

// A tick of powered flight of stage 1 (index 0), ignited at 0, with everything at zero and no loads.
Tick Powered(double time_s, int stack = 0, double ignition_s = 0.0) {
  Tick s;
  s.time_s = time_s;
  s.stack = stack;
  s.burning = true;
  s.since_ignition_s = time_s - ignition_s;
  s.limit_rad = 6.0 * kDeg;
  return s;
}

Tick Coasting(double time_s) {
  Tick s;
  s.time_s = time_s;
  s.stack = 1;
  s.coasting = true;
  return s;
}

// True less reference, as metrics report it; `error` is reference less true.
void SetErrors(Tick& s, double roll_deg, double pitch_deg, double yaw_deg) {
  s.error.angle_rad = -kDeg * Vector3(roll_deg, pitch_deg, yaw_deg);
}

void SetLoads(Tick& s, double qbar_pa, double incidence_deg, const Vector3& specific_g) {
  s.has_loads = true;
  s.instant.air.qbar_pa = qbar_pa;
  s.instant.v_AB_B = Vector3(std::cos(incidence_deg * kDeg), 0.0, std::sin(incidence_deg * kDeg));
  s.instant.loads.mass_kg = 100.0;
  s.instant.loads.force_n = 100.0 * kStandardGravity * specific_g;
}

// An orbit's state at true anomaly nu, from perigee and apogee radius, inclined about the x axis.
RigidBodyState OrbitState(double mu, double perigee_m, double apogee_m, double inclination, double nu) {
  const double e = (apogee_m - perigee_m) / (apogee_m + perigee_m);
  const double p = perigee_m * (1.0 + e);
  const double r = p / (1.0 + e * std::cos(nu));
  const Vector3 along_x(std::cos(nu), std::sin(nu), 0.0);
  const Vector3 velocity = std::sqrt(mu / p) * Vector3(-std::sin(nu), e + std::cos(nu), 0.0);
  const auto tilt = [&](const Vector3& v) {
    return Vector3(v.x(), v.y() * std::cos(inclination), v.y() * std::sin(inclination));
  };
  RigidBodyState s;
  s.p_EoC_I = tilt(r * along_x);
  s.v_IC_I = tilt(velocity);
  return s;
}

// One made-up flight for all metrics at once: stage 1 burns 0 to 10 s, a coast to 60 s, stage 2 to 70 s.
TEST(MetricsRecorder, EveryMetricOfAMadeUpFlight) {
  Recording flight;
  Matrix2 q;
  q << 1.0, 0.0, 0.0, 0.02;
  // V at the edge of the residual set.
  const double residual_v = 0.5 * SolveLyapunov({16.0, 7.0}, q)(0, 0) * Square(0.05 * kDeg);
  for (int i = 0; i < 1000; ++i) {
    Tick s = Powered(i * kTick_s);
    SetErrors(s, -0.4, i < 500 ? 1.0 : -2.0, 0.3);
    s.gimbal.telemetry[kPitch].v = (i < 800 ? 1.01 : 0.99) * residual_v;
    const double chatter = i % 2 ? -0.5 : 0.5;
    s.nozzle_rad = {(2.0 + chatter) * kDeg, (2.0 + chatter) * kDeg, -1.0 * kDeg, -1.0 * kDeg};
    s.nozzle_rate_rad_s = {0.0, 0.0, 0.0, i == 700 ? -12.0 * kDeg : 0.0};
    s.command_rad = {0.0, 0.0, 0.0, i < 250 ? -6.0 * kDeg : -5.9 * kDeg};
    s.gimbal.telemetry[kPitch].v_rate_sign = i < 500 ? -1.0 : 1.0;
    s.gimbal.telemetry[kPitch].adaptation_norm = i == 300 ? 0.7 * kDeg : 0.1 * kDeg;
    s.gimbal.telemetry[kPitch].rules_fired = 0b10110;
    SetLoads(s, i == 400 ? 50e3 : (i == 401 ? 70e3 : (i == 402 ? 900.0 : 2000.0)),
             i == 400 ? 4.0 : (i == 401 ? 1.0 : (i == 402 ? 20.0 : 0.1)), Vector3(5.0, 0.3, -0.4));
    flight.recorder.AddTick(s);
  }
  LauncherInstant burnout;
  burnout.loads.mass_kg = 100.0;
  burnout.loads.force_n = Vector3(-6.0 * 100.0 * kStandardGravity, 0.0, 0.0);
  flight.recorder.AddLoads(burnout);
  flight.recorder.AddMoment(12e3, 6.75);
  flight.recorder.AddMoment(25e3, 20.25);
  flight.recorder.AddMoment(24e3, 13.5);
  for (int i = 0; i < 5000; ++i) {
    Tick s = Coasting(10.0 + i * kTick_s);
    SetErrors(s, 50.0, i == 2000 ? 3.0 : -0.1, 60.0);
    flight.recorder.AddTick(s);
  }
  flight.recorder.AddHandover({kDeg * Vector3(0.03, 0.04, 0.0), kDeg * Vector3(0.0, 0.0, 0.2)});
  for (int i = 0; i < 1000; ++i) {
    Tick s = Powered(60.0 + i * kTick_s, 1, 60.0);
    SetErrors(s, 0.0, 0.5, 0.0);
    s.gimbal.telemetry[kPitch].v_rate_sign = -1.0;
    s.gimbal.telemetry[kPitch].rules_fired = 0b11110;
    flight.recorder.AddTick(s);
  }
  const Earth earth = Wgs84();
  const double perigee = earth.equatorial_radius_m + 400e3, apogee = earth.equatorial_radius_m + 900e3;
  const double nu = 1.1;
  flight.recorder.AddInjection(earth, OrbitState(earth.mu_m3_s2, perigee, apogee, 62.0 * kDeg, nu), 512e3);
  flight.recorder.SetExpelledMass(1.25);

  const double e = (apogee - perigee) / (apogee + perigee);
  const double gamma = std::atan2(e * std::sin(nu), 1.0 + e * std::cos(nu)) / kDeg;
  const double speed =
      std::sqrt(earth.mu_m3_s2 / (perigee * (1.0 + e)) * (1.0 + e * e + 2.0 * e * std::cos(nu)));
  const double radius = perigee * (1.0 + e) / (1.0 + e * std::cos(nu));
  // Sum of t over the ticks of a span: n first + step n (n - 1) / 2.
  const auto times = [](double first, int n) { return n * first + kTick_s * n * (n - 1) / 2.0; };
  std::map<std::string, double> expected = {
      {"pitch_error_rms_deg", std::sqrt((500 * 1.0 + 500 * 4.0 + 1000 * 0.25) / 2000)},
      {"pitch_error_peak_deg", 2.0},
      {"pitch_error_peak_time_s", 5.0},
      {"pitch_error_rms_stage1_deg", std::sqrt(2.5)},
      {"pitch_error_peak_stage1_deg", 2.0},
      {"pitch_error_peak_time_stage1_s", 5.0},
      {"pitch_error_rms_stage2_deg", 0.5},
      {"pitch_error_peak_stage2_deg", 0.5},
      {"pitch_error_peak_time_stage2_s", 60.0},
      {"pitch_error_rms_coast_deg", std::sqrt((9.0 + 4999 * 0.01) / 5000)},
      {"pitch_error_peak_coast_deg", 3.0},
      {"pitch_error_peak_time_coast_s", 30.0},
      {"pitch_error_itae_deg_s2",
       kTick_s * (times(0.0, 500) + 2.0 * times(5.0, 500) + 0.5 * times(60.0, 1000))},
      {"yaw_error_rms_deg", 0.3 / std::sqrt(2.0)},
      {"yaw_error_peak_deg", 0.3},
      {"roll_error_rms_deg", 0.4 / std::sqrt(2.0)},
      {"roll_error_peak_deg", 0.4},
      {"deflection_peak_deg", 2.5},
      // Two nozzles 2 ± 0.5 and two -1 over half the ticks: (2 * 4.25 + 2) / 4 / 2.
      {"deflection_rms_deg", std::sqrt(2.625 / 2.0)},
      {"deflection_rate_peak_deg_s", 12.0},
      {"deflection_saturated_fraction", 250.0 / 2000.0},
      // Two of four nozzles move 1° between each of 1000 ticks.
      {"deflection_travel_deg", 0.5 * 999},
      // The least-squares line of an alternation of amplitude a over 100 samples has the slope
      // 50 a / 83325 a sample, which widens 2a by 48.5 samples on either side.
      {"deflection_ripple_deg", 2.0 * 0.5 * (1.0 + 48.5 * 50.0 / 83325.0)},
      {"deflection_limit_cycle_deg", 0.0},  // an alternation of 50 Hz is faster than it measures
      {"q_max_pa", 70e3},
      {"q_alpha_max_pa_rad", 50e3 * 4.0 * kDeg},
      {"alpha_max_deg", 4.0},
      {"axial_load_max_g", 6.0},
      {"lateral_load_max_g", 0.5},
      {"bending_moment_max_n_m", 25e3},
      {"bending_moment_station_m", 20.25},
      {"structural_limit_exceeded", 1.0},
      {"handover_attitude_error_deg", 0.05},
      {"handover_rate_error_deg_s", 0.2},
      {"rcs_propellant_kg", 1.25},
      {"injection_altitude_km", 512.0},
      {"injection_velocity_m_s", speed},
      {"injection_flight_path_angle_deg", gamma},
      {"apogee_km", 900.0},
      {"perigee_km", 400.0},
      {"inclination_deg", 62.0},
      {"injection_altitude_error_km", 12.0},
      {"injection_velocity_error_m_s", speed - 7600.0},
      {"injection_flight_path_angle_error_deg", gamma - 0.1},
      {"lyapunov_outside_fraction", 0.4},
      {"lyapunov_decreasing_fraction", 0.625},
      {"adaptation_norm_peak_deg_s2", 0.7},
      {"rules_fired", 4.0},
      // The target's orbit where it was reached: 12 km lower at 7600 m/s.
      {"semi_major_axis_error_km",
       1e-3 * (0.5 * (apogee + perigee) - 1.0 / (2.0 / (radius - 12e3) - 7600.0 * 7600.0 / earth.mu_m3_s2))},
      {"inclination_error_deg", 0.5}};
  // Of stages that it has not, of guidance, of what goes on after injection, of rails, of targets that name
  // them, and of parts that the recorder does not know.
  for (const std::string& name :
       Words("pitch_error_rms_stage3_deg pitch_error_peak_stage3_deg pitch_error_peak_time_stage3_s "
             "pitch_error_rms_stage4_deg pitch_error_peak_stage4_deg pitch_error_peak_time_stage4_s "
             "guidance_converged guidance_ignition_shift_s guidance_postponement_s "
             "guidance_excess_velocity_m_s step_limit_fraction apogee_altitude_km apogee_time_s "
             "impact_time_s impact_latitude_deg impact_longitude_deg impact_downrange_km "
             "impact_crossrange_km impact_speed_m_s rail_exit_time_s rail_exit_speed_m_s "
             "roll_rate_peak_deg_s static_margin_min node_error_deg argument_of_perigee_error_deg "
             "true_anomaly_error_deg rail_exit_incidence_deg propellant_left_kg propellant_left_stage1_kg "
             "propellant_left_stage2_kg propellant_left_stage3_kg propellant_left_stage4_kg depleted"))
    expected[name] = std::nan("");

  const std::vector<double> values = flight.recorder.Finish();
  ASSERT_EQ(values.size(), MetricCount(kUsualStages));
  const std::set<std::string> all(MetricNames().begin(), MetricNames().end());
  ASSERT_EQ(all.size(), MetricNames().size()) << "a name occurs twice";
  std::set<std::string> names(MetricNames().begin(), MetricNames().begin() + std::ssize(values));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = MetricNames()[i];
    const auto known = expected.find(name);
    if (known == expected.end()) {
      ADD_FAILURE() << name << " has no known answer in this test";
      continue;
    }
    if (std::isnan(known->second))
      EXPECT_TRUE(std::isnan(values[i])) << name;
    else
      // Sums of thousands of terms, orbit radii of 1e7 m: rounding.
      EXPECT_NEAR(values[i], known->second, 1e-9 * std::max(1.0, std::fabs(known->second))) << name;
    names.erase(name);
  }
  EXPECT_TRUE(names.empty());
}

TEST(MetricsRecorder, WhatAFlightDoesNotReachIsUndefined) {
  const Recording flight;
  for (const std::string& name :
       Words("pitch_error_rms_deg pitch_error_peak_deg pitch_error_peak_time_s "
             "pitch_error_rms_coast_deg yaw_error_rms_deg roll_error_peak_deg deflection_peak_deg "
             "deflection_saturated_fraction deflection_ripple_deg deflection_limit_cycle_deg "
             "handover_attitude_error_deg handover_rate_error_deg_s injection_altitude_km apogee_km "
             "inclination_deg injection_velocity_error_m_s lyapunov_outside_fraction "
             "lyapunov_decreasing_fraction semi_major_axis_error_km inclination_error_deg "
             "guidance_converged pitch_error_itae_deg_s2 deflection_rate_peak_deg_s "
             "deflection_travel_deg q_max_pa q_alpha_max_pa_rad alpha_max_deg axial_load_max_g "
             "lateral_load_max_g bending_moment_max_n_m bending_moment_station_m "
             "adaptation_norm_peak_deg_s2 step_limit_fraction"))
    EXPECT_TRUE(std::isnan(flight[name])) << name;
  for (const char* name : {"rcs_propellant_kg", "structural_limit_exceeded", "rules_fired"})
    EXPECT_EQ(flight[name], 0.0) << name;
}

// The loads at a burnout, of which some are of no tick before, leave all else as it is.
TEST(MetricsRecorder, ABurnoutRaisesItsLoadsAlone) {
  Recording flight;
  LauncherInstant burnout;
  burnout.loads.mass_kg = 100.0;
  burnout.loads.force_n = Vector3(-6.0 * 100.0 * kStandardGravity, 0.0, 0.0);
  flight.recorder.AddLoads(burnout);
  EXPECT_NEAR(flight["axial_load_max_g"], 6.0, 1e-12);
  EXPECT_EQ(flight["lateral_load_max_g"], 0.0);
  EXPECT_EQ(flight["q_max_pa"], 0.0);
  for (const char* name : {"alpha_max_deg", "q_alpha_max_pa_rad", "deflection_rate_peak_deg_s",
                           "adaptation_norm_peak_deg_s2", "pitch_error_itae_deg_s2"})
    EXPECT_TRUE(std::isnan(flight[name])) << name;
}

// Those of free stages; of a guided flight that is lost before its last ignition.
TEST(MetricsRecorder, PeaksOfFreeStagesAndGuidanceNeedTheirPart) {
  FlightDefinition definition = Definition();
  for (Stage& stage : definition.vehicle.stages) stage.gimbal = FixedNozzle(stage.gimbal.pivot_station_m);
  definition.course.is_controlled = false;
  FlightSums sums;
  const auto value = [&](const char* name) { return Measure(sums, definition).metrics[MetricColumn(name)]; };
  EXPECT_TRUE(std::isnan(value("roll_rate_peak_deg_s")));
  EXPECT_TRUE(std::isnan(value("static_margin_min")));
  sums.free.roll_rate_peak_rad_s = 0.0;
  EXPECT_EQ(value("roll_rate_peak_deg_s"), 0.0);

  definition = Definition();
  sums.guidance.acted = true;
  for (const bool ignites : {false, true}) {
    sums.handed_over = ignites;
    for (const char* name :
         {"guidance_ignition_shift_s", "guidance_postponement_s", "guidance_excess_velocity_m_s"})
      EXPECT_EQ(std::isnan(value(name)), !ignites) << name;
    EXPECT_EQ(value("guidance_converged"), 0.0);
  }
}

// What is known of a part of the flight only is no maximum of the flight.
TEST(MetricsRecorder, BendingMomentsNeedTheBoostersAttachment) {
  FlightSums sums;
  sums.bending_moment_max_n_m = 25e3;
  sums.bending_moment_station_m = 6.0;
  FlightDefinition beside = Definition(), carried = Definition(), bare = Definition();
  beside.vehicle.boosters.count = carried.vehicle.boosters.count = 2;
  carried.vehicle.boosters.attachment_station_m = 5.0;
  bare.vehicle.profile.clear();
  for (const char* name : {"bending_moment_max_n_m", "bending_moment_station_m"}) {
    EXPECT_FALSE(std::isnan(Measure(sums, Definition()).metrics[MetricColumn(name)])) << name;
    EXPECT_FALSE(std::isnan(Measure(sums, carried).metrics[MetricColumn(name)])) << name;
    EXPECT_TRUE(std::isnan(Measure(sums, beside).metrics[MetricColumn(name)])) << name;
    EXPECT_TRUE(std::isnan(Measure(sums, bare).metrics[MetricColumn(name)])) << name;
  }
}

// On both sides of the turn at which angles begin again.
TEST(MetricsRecorder, ErrorsOfTheNodeAreTheShorterWayRound) {
  FlightDefinition definition = Definition();
  FlightSums sums;
  sums.injected = true;
  for (const auto& [is_deg, wanted_deg, error_deg] :
       {std::array{359.0, 1.0, -2.0}, {1.0, 359.0, 2.0}, {30.0, 10.0, 20.0}, {10.0, 200.0, 170.0}}) {
    sums.orbit.ascending_node_rad = is_deg * kDeg;
    definition.target.node_rad = wanted_deg * kDeg;
    EXPECT_NEAR(Measure(sums, definition).metrics[MetricColumn("node_error_deg")], error_deg, 1e-9) << is_deg;
  }
}

TEST(MetricsRecorder, PeakIsTheLargestMagnitudeAndItsFirstTime) {
  Recording flight;
  const double values[] = {0.1, -0.8, 0.5, 0.8, -0.3};
  for (int i = 0; i < 5; ++i) {
    Tick s = Powered(i);
    SetErrors(s, 0.0, values[i], 0.0);
    flight.recorder.AddTick(s);
  }
  EXPECT_DOUBLE_EQ(flight["pitch_error_peak_deg"], 0.8);
  EXPECT_EQ(flight["pitch_error_peak_time_s"], 1.0);
}

TEST(MetricsRecorder, IncidenceCountsFromOneKilopascal) {
  Recording flight;
  Tick below = Powered(0.0), at = Powered(0.01);
  SetLoads(below, 999.9, 30.0, Vector3::Zero());
  flight.recorder.AddTick(below);
  EXPECT_TRUE(std::isnan(flight["alpha_max_deg"]));
  EXPECT_TRUE(std::isnan(flight["q_alpha_max_pa_rad"]));
  SetLoads(at, 1000.0, 30.0, Vector3::Zero());
  flight.recorder.AddTick(at);
  EXPECT_NEAR(flight["alpha_max_deg"], 30.0, 1e-12);
  EXPECT_NEAR(flight["q_alpha_max_pa_rad"], 1000.0 * 30.0 * kDeg, 1e-9);
}

TEST(MetricsRecorder, StructuralFlagNamesOnlyGivenLimits) {
  FlightDefinition unlimited = Definition();
  unlimited.vehicle.limits = {};
  Recording flight({}, unlimited);
  Tick s = Powered(0.0);
  SetLoads(s, 1e6, 50.0, Vector3(100.0, 100.0, 0.0));
  flight.recorder.AddTick(s);
  EXPECT_TRUE(std::isnan(flight["structural_limit_exceeded"]));

  for (const StructuralLimits& limits :
       {StructuralLimits{.q_max_pa = 1e3}, StructuralLimits{.q_alpha_pa_rad = 1e3},
        StructuralLimits{.axial_load_g = 1.0}, StructuralLimits{.lateral_load_g = 1.0},
        StructuralLimits{.bending_moment_n_m = 20e3}}) {
    FlightDefinition limited = Definition();
    limited.vehicle.limits = limits;
    Recording other({}, limited);
    other.recorder.AddTick(s);
    other.recorder.AddMoment(21e3, 1.0);
    EXPECT_EQ(other["structural_limit_exceeded"], 1.0);
    EXPECT_TRUE(other.recorder.structural_limit_exceeded());
  }
}

// Ripple -----------------------------------------------------------------------------------------------

// Flies `channel(t)`, degrees, in the pitch pair of stage 1.
template <typename Channel>
double RippleOf(double from_s, double to_s, const Channel& channel, const FlightInputs& inputs = {},
                double altitude_m = 0.0) {
  Recording flight(inputs);
  const long last = std::lround(to_s / kTick_s);
  for (long i = std::lround(from_s / kTick_s); i < last; ++i) {
    Tick s = Powered(static_cast<double>(i) * kTick_s);
    s.nozzle_rad[0] = s.nozzle_rad[1] = channel(s.time_s) * kDeg;
    s.instant.air.place.altitude_m = altitude_m;
    flight.recorder.AddTick(s);
  }
  return flight["deflection_ripple_deg"];
}

TEST(Ripple, ALinearTrendIsNone) {
  EXPECT_NEAR(RippleOf(0.0, 20.0, [](double t) { return 3.0 * t - 7.0; }), 0.0, 1e-11);
}

TEST(Ripple, ASineHasItsPeakToPeakLessTheLinesTilt) {
  // 4 Hz, amplitude 1°: the line through a whole number k of periods of a sine tilts by at most
  // 6 / (pi k) over the window, and the amplitude is met within 1 - cos(pi 4 / 100).
  const double cycle = RippleOf(0.0, 20.0, [](double t) { return std::sin(kTwoPi * 4.0 * t); });
  EXPECT_GT(cycle, 2.0 * std::cos(kPi * 4.0 / 100.0));
  EXPECT_LT(cycle, 2.0 + 6.0 / (kPi * 4.0));
}

TEST(Ripple, TheFirstFiveSecondsAfterIgnitionDoNotCount) {
  const auto burst = [](double t) { return t < 4.99 && std::lround(t / kTick_s) % 2 ? 1.0 : 0.0; };
  EXPECT_NEAR(RippleOf(0.0, 20.0, burst), 0.0, 1e-12);
  EXPECT_TRUE(std::isnan(RippleOf(0.0, 5.99, burst))) << "no whole window";
}

TEST(Ripple, ABurstOfASecondIsFound) {
  const auto burst = [](double t) {
    return t >= 10.0 && t < 11.0 && std::lround(t / kTick_s) % 2 ? 1.0 : 0.0;
  };
  EXPECT_GT(RippleOf(0.0, 20.0, burst), 0.99);
}

TEST(Ripple, GustsDoNotCount) {
  FlightInputs gust;
  gust.air.gust_speed_m_s = 9.0;
  gust.air.gust_altitude_m = 5000.0;
  gust.air.gust_length_m = 1000.0;
  const auto chatter = [](double t) { return std::lround(t / kTick_s) % 2 ? 1.0 : -1.0; };
  EXPECT_TRUE(std::isnan(RippleOf(0.0, 20.0, chatter, gust, 5500.0)));
  EXPECT_GT(RippleOf(0.0, 20.0, chatter, gust, 6500.0), 1.9);
  EXPECT_GT(RippleOf(0.0, 20.0, chatter, {}, 5500.0), 1.9);
}

TEST(Ripple, TheKickDoesNotCount) {
  FlightDefinition definition = Definition();
  definition.kick_start_s = 6.0;
  definition.kick_end_s = 12.0;
  const auto fly = [&](double burst_from_s) {
    Recording flight({}, definition);
    for (int i = 0; i < 2000; ++i) {
      Tick s = Powered(i * kTick_s);
      const bool burst = s.time_s >= burst_from_s && s.time_s < burst_from_s + 2.0;
      if (burst && i % 2) s.nozzle_rad[2] = s.nozzle_rad[3] = 1.0 * kDeg;
      flight.recorder.AddTick(s);
    }
    return flight["deflection_ripple_deg"];
  };
  EXPECT_NEAR(fly(9.0), 0.0, 1e-12);
  EXPECT_GT(fly(13.0), 0.99);
}

TEST(Ripple, RollIsSeenInItsOwnChannel) {
  Recording flight;
  for (int i = 0; i < 2000; ++i) {
    Tick s = Powered(i * kTick_s);
    const double roll = i % 2 ? 0.5 * kDeg : -0.5 * kDeg;
    s.nozzle_rad = {roll, -roll, roll, -roll};
    flight.recorder.AddTick(s);
  }
  EXPECT_NEAR(flight["deflection_ripple_deg"], 1.0 * (1.0 + 48.5 * 50.0 / 83325.0), 1e-9);
}

TEST(Travel, DoesNotCountTheCentringBetweenStages) {
  Recording flight;
  Tick s = Powered(0.0);
  s.nozzle_rad = {0.1, 0.1, 0.1, 0.1};
  flight.recorder.AddTick(s);
  flight.recorder.AddTick(Coasting(1.0));
  Tick next = Powered(2.0, 1, 2.0);
  flight.recorder.AddTick(next);
  EXPECT_EQ(flight["deflection_travel_deg"], 0.0);
}

// Orbit ------------------------------------------------------------------------------------------------

TEST(ElementsOf, AnUnboundOrbitHasNoApogee) {
  const Earth earth = Wgs84();
  RigidBodyState s;
  s.p_EoC_I = Vector3(7e6, 0.0, 0.0);
  s.v_IC_I = Vector3(0.0, 12e3, 0.0);
  const OrbitElements e = ElementsOf(earth, s.p_EoC_I, s.v_IC_I);
  EXPECT_TRUE(std::isinf(e.apogee_altitude_m));
  EXPECT_NEAR(e.perigee_altitude_m, 7e6 - earth.equatorial_radius_m, 1e-6);
  Recording flight;
  flight.recorder.AddInjection(earth, s, 600e3);
  EXPECT_TRUE(std::isnan(flight["apogee_km"]));
  EXPECT_NEAR(flight["perigee_km"], (7e6 - earth.equatorial_radius_m) * 1e-3, 1e-9);
}

TEST(ElementsOf, RetrogradeAndDescending) {
  const Earth earth = Wgs84();
  const RigidBodyState s = OrbitState(earth.mu_m3_s2, 6.8e6, 7.2e6, 97.5 * kDeg, -2.0);
  const OrbitElements e = ElementsOf(earth, s.p_EoC_I, s.v_IC_I);
  EXPECT_NEAR(e.inclination_rad, 97.5 * kDeg, 1e-14);
  EXPECT_LT(e.flight_path_angle_rad, 0.0);
}

TEST(ElementsOf, TheArgumentOfLatitudeCountsFromTheNodeAlongTheOrbit) {
  const Earth earth = Wgs84();
  const double inclination = 97.0 * kDeg, node = 200.0 * kDeg;
  for (const double argument : {0.1, 80.0, 179.0, 181.0, 300.0, 359.9}) {
    const auto at = [&](double u) {
      return Vector3(std::cos(node) * std::cos(u) - std::sin(node) * std::sin(u) * std::cos(inclination),
                     std::sin(node) * std::cos(u) + std::cos(node) * std::sin(u) * std::cos(inclination),
                     std::sin(u) * std::sin(inclination));
    };
    const double u = argument * kDeg;
    const OrbitElements e = ElementsOf(earth, 7e6 * at(u), 7.5e3 * at(u + 0.5 * kPi));
    EXPECT_NEAR(e.argument_of_latitude_rad, u, 1e-12);
    EXPECT_NEAR(e.ascending_node_rad, node, 1e-12);
    EXPECT_NEAR(e.inclination_rad, inclination, 1e-12);
  }
}

TEST(ElementsOf, TheNodeIsWhereTheOrbitGoesNorth) {
  const Earth earth = Wgs84();
  const Vector3 p(0.0, 7e6, 0.0);
  EXPECT_NEAR(ElementsOf(earth, p, Vector3(-5e3, 0.0, 5e3)).ascending_node_rad, 90.0 * kDeg, 1e-15);
  EXPECT_NEAR(ElementsOf(earth, p, Vector3(-5e3, 0.0, -5e3)).ascending_node_rad, 270.0 * kDeg, 1e-15);
  EXPECT_NEAR(ElementsOf(earth, p, Vector3(5e3, 0.0, 5e3)).ascending_node_rad, 90.0 * kDeg, 1e-15);
  EXPECT_EQ(ElementsOf(earth, p, Vector3(-7e3, 0.0, 0.0)).ascending_node_rad, 0.0);
}

TEST(OutcomeNames, ReadBackAsTheyAreWritten) {
  std::set<std::string> names;
  for (int i = 0; i < kOutcomeCount; ++i) {
    const std::string name = OutcomeName(static_cast<Outcome>(i));
    names.insert(name);
    Outcome outcome;
    ASSERT_TRUE(ParseOutcome(name, &outcome));
    EXPECT_EQ(static_cast<int>(outcome), i);
  }
  EXPECT_EQ(names, (std::set<std::string>{"completed", "lost_control", "structural_limit", "impact",
                                          "numerical_failure", "timeout"}));
  Outcome outcome;
  EXPECT_FALSE(ParseOutcome("exploded", &outcome));
}

// A unit at the end of a column's name is the one that people read; of an integral over time twice, the
// square of seconds is no acceleration's.
TEST(Metrics, TheirUnitsAreThoseOfTheirNames) {
  for (const Metric& metric : Metrics()) {
    if (metric.name == "pitch_error_itae_deg_s2")
      EXPECT_EQ(metric.unit, "° s²");
    else
      EXPECT_EQ(metric.unit, SplitUnit(metric.name).unit) << metric.name;
  }
  EXPECT_EQ(SplitUnit("bending_moment_max_n_m").unit, "N m");
  EXPECT_EQ(SplitUnit("bending_moment_max_n_m").stem, "bending_moment_max");
}

}  // namespace
}  // namespace dispersa::flight_metrics_test
