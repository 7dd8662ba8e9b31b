// Every input of a flight: one declaration each, by what carries it.
#include "core/environment/weather_ensemble.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {
namespace {

// Usual values that several declarations have.
constexpr UsualValues kUsualMisalignment = {-1.5, 1.5, "0.1 to 0.5 deg of solid motors"};
constexpr UsualValues kUsualThrustOffset = {-0.1, 0.1, "millimetres"};
constexpr UsualValues kUsualCgOffset = {-0.2, 0.2, "millimetres to centimetres"};
constexpr UsualValues kUsualMotor = {0.8, 1.2, "1 to 5 % of motors"};
constexpr UsualValues kUsualCoefficient = {0.4, 1.6, "10 to 20 %"};
constexpr UsualValues kUsualCp = {0.4, 1.6, "of the distance from the nose"};
constexpr UsualValues kUsualCg = {0.7, 1.3, "of the distance from the nose"};
constexpr UsualValues kUsualDryMass = {0.8, 1.2, "1 to 5 %"};
constexpr UsualValues kUsualLoad = {0.9, 1.1, "0.3 to 1 %"};
constexpr UsualValues kUsualInertia = {0.7, 1.3, "2 to 10 %"};
constexpr UsualValues kUsualBandwidth = {0.3, 2.0, "10 to 20 %"};
constexpr UsualValues kUsualTipOff = {-5.0, 5.0, "0.1 to 2 deg/s of a separation"};
constexpr UsualValues kUsualGyroBias = {-0.1, 0.1, "0.0001 to 0.01 deg/s of inertial units"};
constexpr UsualValues kUsualDelay = {-10.0, 10.0, "fractions of a second"};
constexpr UsualValues kUsualPadError = {-5.0, 5.0, "fractions of a degree on the pad"};
constexpr UsualValues kUsualMixture = {0.9, 1.1, "0.5 to 3 % of engines"};

// Of a stage.
void DeclareThrust(InputDeclarations& inputs, const StageInputs& stage) {
  inputs.EachStage(1, stage.thrust.misalignment_rad.magnitude, "thrust_misalignment", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs
      .EachStage(2, stage.thrust.misalignment_rad.clock_rad, "thrust_misalignment_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithThrustMisalignment);
  inputs.EachStage(3, stage.thrust.offset_m.magnitude, "thrust_offset", "_m").Usually(kUsualThrustOffset);
  inputs.EachStage(4, stage.thrust.offset_m.clock_rad, "thrust_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithThrustOffset);
  inputs.EachStage(12, stage.thrust_factor, "thrust_factor").Within(kPositiveValues).Usually(kUsualMotor);
  inputs.EachStage(13, stage.mass_flow_factor, "mass_flow_factor")
      .Within(kPositiveValues)
      .Usually(kUsualMotor);
  inputs.EachStage(14, stage.specific_impulse_factor, "specific_impulse_factor")
      .Within(kPositiveValues)
      .Usually({0.94, 1.06, "0.3 to 1 %"});
  inputs.EachStage(75, stage.thrust.misalignment_rad.y, "thrust_misalignment_y", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachStage(76, stage.thrust.misalignment_rad.z, "thrust_misalignment_z", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachStage(77, stage.thrust.offset_m.y, "thrust_offset_y", "_m").Usually(kUsualThrustOffset);
  inputs.EachStage(78, stage.thrust.offset_m.z, "thrust_offset_z", "_m").Usually(kUsualThrustOffset);
  inputs
      .EachStage(104, stage.tail_off_factor, "tail_off_factor", "", 1.0,
                 {"tail_off", "factor of the duration of tail_off_*; by a cut-off the impulse goes with it"})
      .Within(kPositiveValues)
      .ReadBy(kByTailOff)
      .Usually({0.4, 1.6, "5 to 20 %"});
  inputs.EachStage(105, stage.mixture_ratio_factor, "mixture_ratio_factor")
      .Within(kPositiveValues)
      .ReadBy(kByMixture)
      .Usually(kUsualMixture);
}

// Of a stage.
void DeclareMasses(InputDeclarations& inputs, const StageInputs& stage) {
  inputs.EachStage(10, stage.cg_offset_m.magnitude, "cg_offset", "_m").Usually(kUsualCgOffset);
  inputs.EachStage(11, stage.cg_offset_m.clock_rad, "cg_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithCgOffset);
  inputs.EachStage(56, stage.dry_mass_factor, "dry_mass_factor")
      .Within(kPositiveValues)
      .ReadBy(kByFirstBurn)
      .Usually(kUsualDryMass);
  inputs.EachStage(57, stage.propellant_factor, "propellant_factor")
      .Within({kPositive, false, PropellantThatFits})
      .ReadBy(kByFirstBurn)
      .Usually(kUsualLoad);
  inputs.EachStage(60, stage.product_of_inertia_xy_kg_m2, "product_of_inertia_xy", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(61, stage.product_of_inertia_xz_kg_m2, "product_of_inertia_xz", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(62, stage.product_of_inertia_yz_kg_m2, "product_of_inertia_yz", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(71, stage.cg_factor, "cg_factor").Within(kPositiveValues).Usually(kUsualCg);
  inputs.EachStage(73, stage.inertia_factor, "inertia_factor").Within(kPositiveValues).Usually(kUsualInertia);
  inputs.EachStage(79, stage.cg_offset_m.y, "cg_offset_y", "_m").Usually(kUsualCgOffset);
  inputs.EachStage(80, stage.cg_offset_m.z, "cg_offset_z", "_m").Usually(kUsualCgOffset);
}

// Of a stage: its air, its drives and its times.
void DeclareCourse(InputDeclarations& inputs, const StageInputs& stage) {
  inputs.EachStage(38, stage.tip_off_pitch_rad_s, "tip_off_pitch", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.EachStage(39, stage.tip_off_yaw_rad_s, "tip_off_yaw", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.EachStage(40, stage.tip_off_roll_rad_s, "tip_off_roll", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.EachStage(63, stage.ignition_delay_s, "ignition_delay", "_s")
      .Within({kAnyNumber, false, IgnitionAfterItsTrigger})
      .ReadBy(kByIgnition)
      .Usually(kUsualDelay);
  inputs.EachStage(64, stage.separation_delay_s, "separation_delay", "_s")
      .Within({kAnyNumber, false, SeparationAfterBurnout})
      .ReadBy(kBySeparation)
      .Usually(kUsualDelay);
  inputs.EachStage(69, stage.drag_factor, "drag_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.EachStage(70, stage.lift_factor, "lift_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.EachStage(72, stage.cp_factor, "cp_factor").Within(kPositiveValues).Usually(kUsualCp);
  inputs.EachStage(74, stage.actuator_bandwidth_factor, "actuator_bandwidth_factor")
      .Within(kPositiveValues)
      .ReadBy(kByDrives)
      .Usually(kUsualBandwidth);
  inputs
      .EachStage(96, stage.fin_cant_rad, "fin_cant", "_deg", kRadPerDeg,
                 {"fin_cant", "added to the cant of a stage's fins, mean of all of them", kAngle})
      .ReadBy(kByFins)
      .Usually({-1.0, 1.0, "0.01 to 0.1 deg of a set's mean"});
}

// Of a stage or of a booster.
void DeclareNozzles(InputDeclarations& inputs, const NozzleInputs& nozzle) {
  inputs
      .EachNozzle({5, 86}, nozzle.line.misalignment_rad.magnitude, "nozzle_misalignment", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs
      .EachNozzle({6, 87}, nozzle.line.misalignment_rad.clock_rad, "nozzle_misalignment_clock", "_deg",
                  kRadPerDeg)
      .ReadBy(kWithNozzleMisalignment);
  inputs.EachNozzle({7, 90}, nozzle.line.offset_m.magnitude, "nozzle_offset", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset)
      .OfFurtherReadBy(kByFurtherNozzle);
  inputs.EachNozzle({8, 91}, nozzle.line.offset_m.clock_rad, "nozzle_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithNozzleOffset);
  inputs.EachNozzle({9, 94}, nozzle.thrust_factor, "nozzle_thrust_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByNozzle)
      .Usually(kUsualMotor);
  inputs.EachNozzle({81, 88}, nozzle.line.misalignment_rad.y, "nozzle_misalignment_y", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs.EachNozzle({82, 89}, nozzle.line.misalignment_rad.z, "nozzle_misalignment_z", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs.EachNozzle({83, 92}, nozzle.line.offset_m.y, "nozzle_offset_y", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset)
      .OfFurtherReadBy(kByFurtherNozzle);
  inputs.EachNozzle({84, 93}, nozzle.line.offset_m.z, "nozzle_offset_z", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset)
      .OfFurtherReadBy(kByFurtherNozzle);
  inputs.EachNozzle({85, 95}, nozzle.flow_factor, "nozzle_flow_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByNozzle)
      .Usually(kUsualMotor);
}

void DeclareBoosters(InputDeclarations& inputs, const BoosterInputs& booster) {
  inputs.EachBooster(101, booster.dry_mass_factor, "booster_dry_mass_factor")
      .Within(kPositiveValues)
      .ReadBy(kByBoosters)
      .Usually(kUsualDryMass);
  inputs.EachBooster(102, booster.propellant_factor, "booster_propellant_factor")
      .Within({kPositive, false, BoosterPropellantThatFits})
      .ReadBy(kByBoosters)
      .Usually(kUsualLoad);
  inputs.EachBooster(103, booster.mixture_ratio_factor, "booster_mixture_ratio_factor")
      .Within(kPositiveValues)
      .ReadBy(kByBoosterMixture)
      .Usually(kUsualMixture);
}

void DeclareAir(InputDeclarations& inputs, const AirInputs& air) {
  inputs.One(15, air.wind_max_speed_m_s, "wind_max_speed_m_s")
      .Within({Between(0.0, 200.0)})
      .Usually({0.0, 130.0, "the strongest jet streams have 100 to 120 m/s"});
  inputs.One(16, air.wind_azimuth_rad, "wind_azimuth_deg", kRadPerDeg).ReadBy(kWithWind);
  inputs.One(17, air.wind_altitude_m, "wind_altitude_m")
      .Within({Between(0.0, 100e3)})
      .ReadBy(kWithWind)
      .Usually({3000.0, 60000.0, "jet streams are at 9 to 16 km"});
  inputs.One(18, air.wind_width_m, "wind_width_m")
      .Within({Between(100.0, 100e3)})
      .ReadBy(kWithWind)
      .Usually({1000.0, 60000.0, "some kilometres"});
  inputs.One(19, air.gust_speed_m_s, "gust_speed_m_s")
      .Within({Between(-100.0, 100.0)})
      .Usually({-30.0, 30.0, "9 m/s of MIL-F-8785C's and NASA's discrete gusts"});
  inputs.One(20, air.gust_altitude_m, "gust_altitude_m").Within({Between(0.0, 100e3)}).ReadBy(kWithGust);
  inputs.One(21, air.gust_length_m, "gust_length_m")
      .Within({Between(1.0, 10e3)})
      .ReadBy(kWithGust)
      .Usually({5.0, 3000.0, "30 to 300 m"});
  inputs.One(22, air.gust_azimuth_rad, "gust_azimuth_deg", kRadPerDeg).ReadBy(kWithGust);
  inputs.EachLevel(23, air.wind_profile_north_m_s, "wind_profile_north", "_m_s")
      .Within(kProfileWind)
      .ReadBy(kWithProfile);
  inputs.EachLevel(24, air.wind_profile_east_m_s, "wind_profile_east", "_m_s")
      .Within(kProfileWind)
      .ReadBy(kWithProfile);
  inputs.One(25, air.turbulence_exceedance, "turbulence_exceedance")
      .Within({Between(0.0, kLargestExceedance)});
  inputs.One(26, air.turbulence_wind_20ft_m_s, "turbulence_wind_20ft_m_s")
      .Within({Between(0.0, 50.0)})
      .ReadBy(kWithTurbulence);
  inputs.One(27, air.turbulence_scale, "turbulence_scale").Within(kPositiveValues).ReadBy(kWithTurbulence);
  inputs.One(32, air.density_factor, "density_factor")
      .Within(kPositiveValues)
      .Usually({0.6, 1.4, "5 to 30 % by altitude and season"});
  inputs.EachLevel(106, air.wind_profile_altitude_m, "wind_profile_altitude", "_m")
      .Within({Between(0.0, 100e3)});
  inputs.One(107, air.weather_sounding, "weather_sounding")
      .Within({Between(0.0, static_cast<double>(kMostSoundings)), true})
      .ReadBy(kBySoundings);
}

void DeclareSensors(InputDeclarations& inputs, const SensorInputs& sensors) {
  inputs.One(41, sensors.gyro_bias_roll_rad_s, "gyro_bias_roll_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(42, sensors.gyro_bias_pitch_rad_s, "gyro_bias_pitch_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(43, sensors.gyro_bias_yaw_rad_s, "gyro_bias_yaw_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(44, sensors.gyro_noise_rad_s, "gyro_noise_deg_s", kRadPerDeg)
      .Within(kNoLessThanZero)
      .ReadBy(kByAutopilot)
      .Usually({0.0, 0.5, "0.001 to 0.05 deg/s a sample"});
  inputs.EachLaunchAxis(53, sensors.navigation_position_error_m, "navigation_position_error", "_m")
      .ReadBy(kByNavigation)
      .Usually({-20000.0, 20000.0, "10 m aided by satellites, kilometres of a free unit"});
  inputs.EachLaunchAxis(54, sensors.navigation_velocity_error_m_s, "navigation_velocity_error", "_m_s")
      .ReadBy(kByNavigation)
      .Usually({-50.0, 50.0, "0.1 m/s aided by satellites, metres a second of a free unit"});
  inputs.One(55, sensors.accelerometer_scale_factor, "accelerometer_scale_factor")
      .Within(kPositiveValues)
      .ReadBy(kByNavigation)
      .Usually({0.99, 1.01, "0.0001 to 0.001"});
}

void DeclareVehicle(InputDeclarations& inputs, const FlightInputs& in) {
  inputs.One(28, in.drag_factor, "drag_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.One(29, in.lift_factor, "lift_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.One(30, in.cg_factor, "cg_factor").Within(kPositiveValues).Usually(kUsualCg);
  inputs.One(31, in.cp_factor, "cp_factor").Within(kPositiveValues).Usually(kUsualCp);
  inputs.One(33, in.inertia_factor, "inertia_factor").Within(kPositiveValues).Usually(kUsualInertia);
  inputs.One(34, in.actuator_bandwidth_factor, "actuator_bandwidth_factor")
      .Within(kPositiveValues)
      .ReadBy(kByDrives)
      .Usually(kUsualBandwidth);
  inputs.EachMode(35, in.bending_frequency_factor, "bending_frequency_factor")
      .Within(kPositiveValues)
      .ReadBy(kByModes)
      .Usually({0.6, 1.5, "5 to 15 %"});
  inputs.One(36, in.bending_damping_factor, "bending_damping_factor")
      .Within(kPositiveValues)
      .ReadBy(kByModes);
  inputs.One(37, in.bending_slope_factor, "bending_slope_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByModeSensors);
  inputs.One(45, in.stuck_nozzle, "stuck_nozzle")
      .Within({kNonNegative, true, NozzlesThatThereAre})
      .ReadBy(kByDrives);
  inputs.One(46, in.stuck_nozzle_stage, "stuck_nozzle_stage")
      .Within({kNonNegative, true, StagesThatThereAre})
      .ReadBy(kWithStuckNozzle);
  inputs.One(47, in.stuck_nozzle_rad, "stuck_nozzle_deg", kRadPerDeg)
      .Within({Inside(-kQuarterTurn, kQuarterTurn)})
      .ReadBy(kWithStuckNozzle);
  inputs
      .One(48, in.pn_error_factor, "pn_error_factor", 1.0,
           {"pn_error", "factor of P_n's first component, for studies; no limits"})
      .ReadBy(kByAdaptation);
  inputs
      .One(49, in.pn_rate_factor, "pn_rate_factor", 1.0,
           {"pn_rate", "factor of P_n's second component, for studies; no limits"})
      .ReadBy(kByAdaptation);
  inputs
      .One(50, in.loop_gain_factor, "loop_gain_factor", 1.0,
           {"loop_gain", "factor of the commanded deflections"})
      .Within(kPositiveValues)
      .ReadBy(kByAutopilot)
      .Usually({0.25, 4.0, "a few % of sensors and actuators, a factor of 2 at a gain margin"});
  inputs
      .One(51, in.loop_delay_s, "loop_delay_s", 1.0,
           {"loop_delay", "additional delay of the commands", kTime})
      .Within(kNoLessThanZero)
      .ReadBy(kByAutopilot)
      .Usually({0.0, 0.25, "up to some tens of milliseconds of a computer and its bus"});
  inputs.One(52, in.loop_stage, "loop_stage")
      .Within({kNonNegative, true, StagesThatThereAre})
      .ReadBy(kWithLoop);
  inputs.One(58, in.payload_mass_kg, "payload_mass_kg").Within({kAnyNumber, false, PayloadThatMayLeave});
  inputs.One(59, in.payload_element, "payload_element")
      .Within({kNonNegative, true, ElementsThatThereAre})
      .ReadBy(kWithPayload);
  inputs.One(65, in.launch_azimuth_error_rad, "launch_azimuth_error_deg", kRadPerDeg)
      .Usually({-2.0, 2.0, "0.01 to 0.2 deg of an alignment"});
  inputs.One(66, in.initial_roll_error_rad, "initial_roll_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.One(67, in.initial_pitch_error_rad, "initial_pitch_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.One(68, in.initial_yaw_error_rad, "initial_yaw_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.One(97, in.table_ca_sigmas, "table_ca_sigmas").ReadBy(kByUncertainTables);
  inputs.One(98, in.table_cn_sigmas, "table_cn_sigmas").ReadBy(kByUncertainTables);
  inputs.One(99, in.table_xcp_sigmas, "table_xcp_sigmas").ReadBy(kByUncertainTables);
  inputs.One(100, in.table_damping_sigmas, "table_damping_sigmas").ReadBy(kByUncertainTables);
}

}  // namespace

void DeclareInputs(InputDeclarations& inputs) {
  const FlightInputs& in = inputs.nominal();
  DeclareThrust(inputs, in.stages[0]);
  DeclareMasses(inputs, in.stages[0]);
  DeclareCourse(inputs, in.stages[0]);
  DeclareNozzles(inputs, in.stages[0].nozzles[0]);
  DeclareBoosters(inputs, in.further[0].booster);
  DeclareAir(inputs, in.air);
  DeclareSensors(inputs, in.sensors);
  DeclareVehicle(inputs, in);
  inputs.Finish();
}

}  // namespace dispersa
