// The inputs of a flight: every number by which it differs from the nominal flight. A case draws them, the
// flight applies them, the result contains them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/dynamics/launcher.h"
#include "core/environment/turbulence.h"
#include "core/flight/input_rules.h"
#include "core/input/units.h"
#include "core/math/circle.h"
#include "core/math/constants.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

using PerStage = std::array<double, kMaxStages>;

constexpr PerStage AllStages(double value) {
  PerStage values{};
  for (double& v : values) v = value;
  return values;
}

/// One value for each nozzle (right, left, bottom, top; those of a list in its order) of each stage.
using PerNozzle = std::array<std::array<double, kNozzles>, kMaxStages>;

constexpr PerNozzle AllNozzles(double value) {
  PerNozzle values{};
  for (auto& stage : values)
    for (double& v : stage) v = value;
  return values;
}

/// One value for each nozzle beyond four of its stage: stage by stage, in the order of the lists.
using PerFurtherNozzle = std::array<double, kFurtherNozzles>;

constexpr PerFurtherNozzle AllFurtherNozzles(double value) {
  PerFurtherNozzle values{};
  for (double& v : values) v = value;
  return values;
}

/// Largest number of altitude levels of a drawn wind profile: every kilometre up to 30 km.
inline constexpr int kWindLevels = 30;

/// Number of levels of a profile: the altitudes that grow, of which there are two or more; 0: no profile.
inline int WindLevelsOf(const std::array<double, kWindLevels>& altitude_m) {
  int levels = 1;
  while (levels < kWindLevels &&
         altitude_m[static_cast<std::size_t>(levels)] > altitude_m[static_cast<std::size_t>(levels) - 1])
    ++levels;
  return levels > 1 ? levels : 0;
}

/// Only doubles, each declared by DeclareInputs() below, in SI units and radians. The defaults are the
/// nominal flight. Factors multiply the nominal value.
struct FlightInputs {
  PerStage thrust_misalignment_rad{};        ///< tilt of the thrust against the body axis
  PerStage thrust_misalignment_clock_rad{};  ///< direction of the tilt: from body y towards body z
  PerStage thrust_offset_m{};                ///< lateral offset of the thrust line
  PerStage thrust_offset_clock_rad{};        ///< direction of the offset: from body y towards body z
  PerNozzle nozzle_misalignment_rad{};       ///< tilt of one nozzle, added to the stage's
  PerNozzle nozzle_misalignment_clock_rad{};
  PerNozzle nozzle_offset_m{};
  PerNozzle nozzle_offset_clock_rad{};
  PerNozzle nozzle_thrust_factor = AllNozzles(1.0);  ///< factor of a nozzle's thrust at the same flow
  PerStage cg_offset_m{};  ///< distance of the CG from the axis, of the stack without its burning propellant
  PerStage cg_offset_clock_rad{};  ///< direction of the offset: from body y towards body z
  PerStage thrust_factor = AllStages(1.0);
  PerStage mass_flow_factor = AllStages(1.0);         ///< flow at full thrust: more flow shortens the burn
  PerStage specific_impulse_factor = AllStages(1.0);  ///< thrust at the same flow
  double wind_max_speed_m_s = 0.0;                    ///< of the jet stream
  double wind_azimuth_rad = 0.0;                      ///< from where the wind comes, clockwise from north
  double wind_altitude_m = 12000.0;                   ///< of the maximum
  double wind_width_m = 12000.0;                      ///< full width at half the maximum
  double gust_speed_m_s = 0.0;                        ///< 1 - cosine gust
  double gust_altitude_m = 0.0;                       ///< where it starts
  double gust_length_m = 0.0;
  double gust_azimuth_rad = 0.0;
  std::array<double, kWindLevels> wind_profile_north_m_s{};  ///< velocity of the air at the levels' altitudes
  std::array<double, kWindLevels> wind_profile_east_m_s{};
  double turbulence_exceedance = 0.0;     ///< probability that picks the intensity (0: none)
  double turbulence_wind_20ft_m_s = 0.0;  ///< mean wind near the ground, which makes the turbulence there
  double turbulence_scale = 1.0;          ///< of all intensities
  double drag_factor = 1.0;               ///< of the axial force
  double lift_factor = 1.0;               ///< of the normal force
  double cg_factor = 1.0;                 ///< of the CG's distance from the nose of the current stack
  double cp_factor = 1.0;                 ///< of the CP's
  double density_factor = 1.0;
  double inertia_factor = 1.0;
  double actuator_bandwidth_factor = 1.0;
  std::array<double, kModes> bending_frequency_factor = {1.0, 1.0, 1.0, 1.0,
                                                         1.0};  ///< of each mode, both planes
  double bending_damping_factor = 1.0;                          ///< of the modes' damping ratio
  double bending_slope_factor = 1.0;                            ///< of the slopes that sensors feel
  PerStage tip_off_pitch_rad_s{};  ///< rate added to the upper stack as stage i separates
  PerStage tip_off_yaw_rad_s{};
  PerStage tip_off_roll_rad_s{};
  double gyro_bias_roll_rad_s = 0.0;
  double gyro_bias_pitch_rad_s = 0.0;
  double gyro_bias_yaw_rad_s = 0.0;
  double gyro_noise_rad_s = 0.0;    ///< standard deviation of each sample
  double stuck_nozzle = 0.0;        ///< 0 none, 1..4 right, left, bottom, top; by the order of a list
  double stuck_nozzle_stage = 0.0;  ///< 1-based
  double stuck_nozzle_rad = 0.0;    ///< angle at which it stays
  double pn_error_factor = 1.0;     ///< factor of the first component of P_n, the paper's Fig. 5
  double pn_rate_factor = 1.0;      ///< factor of the second component of P_n
  double loop_gain_factor = 1.0;    ///< factor of every commanded deflection; measures the gain margin
  double loop_delay_s = 0.0;        ///< additional delay of the commands; measures the delay margin
  double loop_stage = 0.0;          ///< stage (1-based) whose loop gain and delay are changed; 0: all
  std::array<double, 3> navigation_position_error_m{};    ///< navigated less true, constant, along L's axes
  std::array<double, 3> navigation_velocity_error_m_s{};  ///< the same for the velocity
  double accelerometer_scale_factor = 1.0;                ///< of the sensed specific force
  // Later inputs go to the end: a Sobol design's dimensions are the columns' positions.
  PerStage dry_mass_factor = AllStages(1.0);    ///< factor of a stage's dry mass (dispersed_vehicle.h)
  PerStage propellant_factor = AllStages(1.0);  ///< of the propellant at ignition
  double payload_mass_kg = 0.0;                 ///< additional mass of the payload
  double payload_element = 0.0;  ///< 1-based position of the payload in the last stage's structure
  PerStage
      product_of_inertia_xy_kg_m2{};  ///< integral of x y dm about C, of the stack, during the whole burn
  PerStage product_of_inertia_xz_kg_m2{};
  PerStage product_of_inertia_yz_kg_m2{};
  PerStage ignition_delay_s{};    ///< delay of the stage's ignition, without effect for the first stage
  PerStage separation_delay_s{};  ///< delay of the stage's separation
  double launch_azimuth_error_rad =
      0.0;  ///< vehicle and inertial unit are turned clockwise; the flight software does not know
  double initial_roll_error_rad =
      0.0;  ///< rotation of the body at lift-off about its axes; the inertial unit measures it
  double initial_pitch_error_rad = 0.0;
  double initial_yaw_error_rad = 0.0;
  // One stack each, in addition to the factor of the whole vehicle.
  PerStage stack_drag_factor = AllStages(1.0);
  PerStage stack_lift_factor = AllStages(1.0);
  PerStage stack_cg_factor = AllStages(1.0);
  PerStage stack_cp_factor = AllStages(1.0);
  PerStage stack_inertia_factor = AllStages(1.0);
  PerStage stack_actuator_bandwidth_factor = AllStages(1.0);
  // Components towards body y and z, in addition to magnitude and clock angle.
  PerStage thrust_misalignment_y_rad{};
  PerStage thrust_misalignment_z_rad{};
  PerStage thrust_offset_y_m{};
  PerStage thrust_offset_z_m{};
  PerStage cg_offset_y_m{};
  PerStage cg_offset_z_m{};
  PerNozzle nozzle_misalignment_y_rad{};
  PerNozzle nozzle_misalignment_z_rad{};
  PerNozzle nozzle_offset_y_m{};
  PerNozzle nozzle_offset_z_m{};
  PerNozzle nozzle_flow_factor = AllNozzles(1.0);  ///< factor of a nozzle's share of the flow
  // The same of nozzles beyond four of a stage.
  PerFurtherNozzle further_misalignment_rad{};
  PerFurtherNozzle further_misalignment_clock_rad{};
  PerFurtherNozzle further_misalignment_y_rad{};
  PerFurtherNozzle further_misalignment_z_rad{};
  PerFurtherNozzle further_offset_m{};
  PerFurtherNozzle further_offset_clock_rad{};
  PerFurtherNozzle further_offset_y_m{};
  PerFurtherNozzle further_offset_z_m{};
  PerFurtherNozzle further_thrust_factor = AllFurtherNozzles(1.0);
  PerFurtherNozzle further_flow_factor = AllFurtherNozzles(1.0);
  PerStage fin_cant_rad{};  ///< added to the cant of all fins of a stage
  // Standard deviations of the uncertainties that aerodynamic tables state (AeroSigmas).
  double table_ca_sigmas = 0.0;
  double table_cn_sigmas = 0.0;
  double table_xcp_sigmas = 0.0;
  double table_damping_sigmas = 0.0;
  // Masses of boosters that are bodies of their own, at their places among the further nozzles.
  PerFurtherNozzle booster_dry_mass_factor = AllFurtherNozzles(1.0);
  PerFurtherNozzle booster_propellant_factor = AllFurtherNozzles(1.0);
  PerFurtherNozzle booster_mixture_ratio_factor = AllFurtherNozzles(1.0);
  PerStage tail_off_factor = AllStages(1.0);       ///< of the duration of a motor's tail-off
  PerStage mixture_ratio_factor = AllStages(1.0);  ///< of the first tank's flow over the others'
  /// Of the wind profile's levels: growing, then 0. All 0: the campaign's own profile, if it has one.
  std::array<double, kWindLevels> wind_profile_altitude_m{};
};

/// The usual range of an input, in the unit of its column. `validate --strict` warns about values outside it.
struct UsualValues {
  double low = -HUGE_VAL, high = HUGE_VAL;
  const char* source = "";  ///< reason of the range
};

/// A column of the applied inputs: its name carries the unit, e.g. "thrust_misalignment_stage1_deg".
struct InputColumn {
  std::string name;
  double unit = 1.0;       ///< internal value = value in the unit of the name * unit
  std::size_t offset = 0;  ///< in bytes from the start of FlightInputs
  InputPlace place = {};
  UsualValues usual = {};
  AllowedValues allowed = {};
  Readers readers = {};
};

/// How a campaign disperses an input by its own key: one draw, or one for each stage or mode. A dispersion
/// that takes several inputs or further keys is a row of core/campaign/dispersion_table.cc.
struct Dispersal {
  const char* key = nullptr;  ///< key in `dispersions` (null: none)
  const char* meaning = "";   ///< one line
  Dimension dimension = {};   ///< empty: a factor
};
enum class DrawnFor { kFlight, kEachStage, kEachMode };
struct DispersedInput {
  Dispersal dispersal;
  DrawnFor drawn_for;
  std::string column;  ///< {stage} and {mode} stand for the name of each
};

/// The declared columns. Columns of stages that few vehicles have come last but for those of further nozzles.
class InputDeclarations {
 public:
  InputDeclarations& One(double FlightInputs::*field, const std::string& name, double unit = 1.0,
                         const Dispersal& dispersal = {});
  InputDeclarations& EachStage(PerStage FlightInputs::*field, const std::string& stem,
                               const std::string& unit_suffix = "", double unit = 1.0,
                               const Dispersal& dispersal = {});
  InputDeclarations& EachNozzle(PerNozzle FlightInputs::*field, const std::string& stem,
                                const std::string& unit_suffix = "", double unit = 1.0);
  InputDeclarations& EachFurtherNozzle(PerFurtherNozzle FlightInputs::*field, const std::string& stem,
                                       const std::string& unit_suffix = "", double unit = 1.0);
  InputDeclarations& EachMode(std::array<double, kModes> FlightInputs::*field, const std::string& stem,
                              const Dispersal& dispersal = {});
  InputDeclarations& EachLevel(std::array<double, kWindLevels> FlightInputs::*field, const std::string& stem,
                               const std::string& unit_suffix);
  InputDeclarations& EachLaunchAxis(std::array<double, 3> FlightInputs::*field, const std::string& stem,
                                    const std::string& unit_suffix);
  // Of the columns that were declared last: what a flight can apply (default: any number), what reads them
  // (default: every flight), and their usual values.
  InputDeclarations& Within(const AllowedValues& allowed);
  InputDeclarations& ReadBy(const Readers& readers);
  InputDeclarations& Usually(const UsualValues& usual);

  std::size_t usual() const { return columns_.size(); }
  std::size_t of_stages() const { return columns_.size() + rare_.size(); }
  std::size_t of_further_nozzle() const { return further_[0].size(); }
  std::vector<InputColumn> AllColumns() const;
  const std::vector<DispersedInput>& dispersed() const { return dispersed_; }

 private:
  std::size_t OffsetOf(const double* value) const;
  void Begin();
  template <typename Set>
  InputDeclarations& ForLast(Set set);
  std::vector<InputColumn>& ColumnsWith(std::size_t stage);
  void Disperse(const Dispersal& dispersal, DrawnFor drawn_for, const std::string& column);

  const FlightInputs nominal_;
  std::vector<InputColumn> columns_, rare_;
  std::array<std::vector<InputColumn>, kFurtherNozzles> further_;
  std::size_t last_ = 0, last_rare_ = 0, last_further_ = 0;  ///< where the columns declared last begin
  std::vector<DispersedInput> dispersed_;
};

// Usual values that several declarations have.
inline constexpr UsualValues kUsualMisalignment = {-1.5, 1.5, "0.1 to 0.5 deg of solid motors"};
inline constexpr UsualValues kUsualThrustOffset = {-0.1, 0.1, "millimetres"};
inline constexpr UsualValues kUsualCgOffset = {-0.2, 0.2, "millimetres to centimetres"};
inline constexpr UsualValues kUsualMotor = {0.8, 1.2, "1 to 5 % of motors"};
inline constexpr UsualValues kUsualCoefficient = {0.4, 1.6, "10 to 20 %"};
inline constexpr UsualValues kUsualCp = {0.4, 1.6, "of the distance from the nose"};
inline constexpr UsualValues kUsualCg = {0.7, 1.3, "of the distance from the nose"};
inline constexpr UsualValues kUsualDryMass = {0.8, 1.2, "1 to 5 %"};
inline constexpr UsualValues kUsualLoad = {0.9, 1.1, "0.3 to 1 %"};
inline constexpr UsualValues kUsualInertia = {0.7, 1.3, "2 to 10 %"};
inline constexpr UsualValues kUsualBandwidth = {0.3, 2.0, "10 to 20 %"};
inline constexpr UsualValues kUsualTipOff = {-5.0, 5.0, "0.1 to 2 deg/s of a separation"};
inline constexpr UsualValues kUsualGyroBias = {-0.1, 0.1, "0.0001 to 0.01 deg/s of inertial units"};
inline constexpr UsualValues kUsualDelay = {-10.0, 10.0, "fractions of a second"};
inline constexpr UsualValues kUsualPadError = {-5.0, 5.0, "fractions of a degree on the pad"};

/// Field, column, plain dispersal and usual values of every input, in the order of the columns.
inline void DeclareInputs(InputDeclarations& inputs) {
  using In = FlightInputs;
  inputs.EachStage(&In::thrust_misalignment_rad, "thrust_misalignment", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachStage(&In::thrust_misalignment_clock_rad, "thrust_misalignment_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithThrustMisalignment);
  inputs.EachStage(&In::thrust_offset_m, "thrust_offset", "_m").Usually(kUsualThrustOffset);
  inputs.EachStage(&In::thrust_offset_clock_rad, "thrust_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithThrustOffset);
  inputs.EachNozzle(&In::nozzle_misalignment_rad, "nozzle_misalignment", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs.EachNozzle(&In::nozzle_misalignment_clock_rad, "nozzle_misalignment_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithNozzleMisalignment);
  inputs.EachNozzle(&In::nozzle_offset_m, "nozzle_offset", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachNozzle(&In::nozzle_offset_clock_rad, "nozzle_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithNozzleOffset);
  inputs.EachNozzle(&In::nozzle_thrust_factor, "nozzle_thrust_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByNozzle)
      .Usually(kUsualMotor);
  inputs.EachStage(&In::cg_offset_m, "cg_offset", "_m").Usually(kUsualCgOffset);
  inputs.EachStage(&In::cg_offset_clock_rad, "cg_offset_clock", "_deg", kRadPerDeg).ReadBy(kWithCgOffset);
  inputs.EachStage(&In::thrust_factor, "thrust_factor").Within(kPositiveValues).Usually(kUsualMotor);
  inputs.EachStage(&In::mass_flow_factor, "mass_flow_factor").Within(kPositiveValues).Usually(kUsualMotor);
  inputs.EachStage(&In::specific_impulse_factor, "specific_impulse_factor")
      .Within(kPositiveValues)
      .Usually({0.94, 1.06, "0.3 to 1 %"});
  inputs.One(&In::wind_max_speed_m_s, "wind_max_speed_m_s")
      .Within({Between(0.0, 200.0)})
      .Usually({0.0, 130.0, "the strongest jet streams have 100 to 120 m/s"});
  inputs.One(&In::wind_azimuth_rad, "wind_azimuth_deg", kRadPerDeg).ReadBy(kWithWind);
  inputs.One(&In::wind_altitude_m, "wind_altitude_m")
      .Within({Between(0.0, 100e3)})
      .ReadBy(kWithWind)
      .Usually({3000.0, 60000.0, "jet streams are at 9 to 16 km"});
  inputs.One(&In::wind_width_m, "wind_width_m")
      .Within({Between(100.0, 100e3)})
      .ReadBy(kWithWind)
      .Usually({1000.0, 60000.0, "some kilometres"});
  inputs.One(&In::gust_speed_m_s, "gust_speed_m_s")
      .Within({Between(-100.0, 100.0)})
      .Usually({-30.0, 30.0, "9 m/s of MIL-F-8785C's and NASA's discrete gusts"});
  inputs.One(&In::gust_altitude_m, "gust_altitude_m").Within({Between(0.0, 100e3)}).ReadBy(kWithGust);
  inputs.One(&In::gust_length_m, "gust_length_m")
      .Within({Between(1.0, 10e3)})
      .ReadBy(kWithGust)
      .Usually({5.0, 3000.0, "30 to 300 m"});
  inputs.One(&In::gust_azimuth_rad, "gust_azimuth_deg", kRadPerDeg).ReadBy(kWithGust);
  inputs.EachLevel(&In::wind_profile_north_m_s, "wind_profile_north", "_m_s")
      .Within(kProfileWind)
      .ReadBy(kWithProfile);
  inputs.EachLevel(&In::wind_profile_east_m_s, "wind_profile_east", "_m_s")
      .Within(kProfileWind)
      .ReadBy(kWithProfile);
  inputs.One(&In::turbulence_exceedance, "turbulence_exceedance").Within({Between(0.0, kLargestExceedance)});
  inputs.One(&In::turbulence_wind_20ft_m_s, "turbulence_wind_20ft_m_s")
      .Within({Between(0.0, 50.0)})
      .ReadBy(kWithTurbulence);
  inputs.One(&In::turbulence_scale, "turbulence_scale").Within(kPositiveValues).ReadBy(kWithTurbulence);
  inputs.One(&In::drag_factor, "drag_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.One(&In::lift_factor, "lift_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.One(&In::cg_factor, "cg_factor").Within(kPositiveValues).Usually(kUsualCg);
  inputs.One(&In::cp_factor, "cp_factor").Within(kPositiveValues).Usually(kUsualCp);
  inputs.One(&In::density_factor, "density_factor")
      .Within(kPositiveValues)
      .Usually({0.6, 1.4, "5 to 30 % by altitude and season"});
  inputs.One(&In::inertia_factor, "inertia_factor").Within(kPositiveValues).Usually(kUsualInertia);
  inputs.One(&In::actuator_bandwidth_factor, "actuator_bandwidth_factor")
      .Within(kPositiveValues)
      .ReadBy(kByDrives)
      .Usually(kUsualBandwidth);
  inputs.EachMode(&In::bending_frequency_factor, "bending_frequency_factor")
      .Within(kPositiveValues)
      .ReadBy(kByModes)
      .Usually({0.6, 1.5, "5 to 15 %"});
  inputs.One(&In::bending_damping_factor, "bending_damping_factor").Within(kPositiveValues).ReadBy(kByModes);
  inputs.One(&In::bending_slope_factor, "bending_slope_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByModeSensors);
  inputs.EachStage(&In::tip_off_pitch_rad_s, "tip_off_pitch", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.EachStage(&In::tip_off_yaw_rad_s, "tip_off_yaw", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.EachStage(&In::tip_off_roll_rad_s, "tip_off_roll", "_deg_s", kRadPerDeg)
      .ReadBy(kBySeparation)
      .Usually(kUsualTipOff);
  inputs.One(&In::gyro_bias_roll_rad_s, "gyro_bias_roll_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(&In::gyro_bias_pitch_rad_s, "gyro_bias_pitch_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(&In::gyro_bias_yaw_rad_s, "gyro_bias_yaw_deg_s", kRadPerDeg)
      .ReadBy(kByAutopilot)
      .Usually(kUsualGyroBias);
  inputs.One(&In::gyro_noise_rad_s, "gyro_noise_deg_s", kRadPerDeg)
      .Within(kNoLessThanZero)
      .ReadBy(kByAutopilot)
      .Usually({0.0, 0.5, "0.001 to 0.05 deg/s a sample"});
  inputs.One(&In::stuck_nozzle, "stuck_nozzle")
      .Within({kNonNegative, true, NozzlesThatThereAre})
      .ReadBy(kByDrives);
  inputs.One(&In::stuck_nozzle_stage, "stuck_nozzle_stage")
      .Within({kNonNegative, true, StagesThatThereAre})
      .ReadBy(kWithStuckNozzle);
  inputs.One(&In::stuck_nozzle_rad, "stuck_nozzle_deg", kRadPerDeg)
      .Within({Inside(-kQuarterTurn, kQuarterTurn)})
      .ReadBy(kWithStuckNozzle);
  inputs
      .One(&In::pn_error_factor, "pn_error_factor", 1.0,
           {"pn_error", "factor of P_n's first component, for studies; no limits"})
      .ReadBy(kByAdaptation);
  inputs
      .One(&In::pn_rate_factor, "pn_rate_factor", 1.0,
           {"pn_rate", "factor of P_n's second component, for studies; no limits"})
      .ReadBy(kByAdaptation);
  inputs
      .One(&In::loop_gain_factor, "loop_gain_factor", 1.0,
           {"loop_gain", "factor of the commanded deflections"})
      .Within(kPositiveValues)
      .ReadBy(kByAutopilot)
      .Usually({0.25, 4.0, "a few % of sensors and actuators, a factor of 2 at a gain margin"});
  inputs
      .One(&In::loop_delay_s, "loop_delay_s", 1.0, {"loop_delay", "additional delay of the commands", kTime})
      .Within(kNoLessThanZero)
      .ReadBy(kByAutopilot)
      .Usually({0.0, 0.25, "up to some tens of milliseconds of a computer and its bus"});
  inputs.One(&In::loop_stage, "loop_stage")
      .Within({kNonNegative, true, StagesThatThereAre})
      .ReadBy(kWithLoop);
  inputs.EachLaunchAxis(&In::navigation_position_error_m, "navigation_position_error", "_m")
      .ReadBy(kByNavigation)
      .Usually({-20000.0, 20000.0, "10 m aided by satellites, kilometres of a free unit"});
  inputs.EachLaunchAxis(&In::navigation_velocity_error_m_s, "navigation_velocity_error", "_m_s")
      .ReadBy(kByNavigation)
      .Usually({-50.0, 50.0, "0.1 m/s aided by satellites, metres a second of a free unit"});
  inputs.One(&In::accelerometer_scale_factor, "accelerometer_scale_factor")
      .Within(kPositiveValues)
      .ReadBy(kByNavigation)
      .Usually({0.99, 1.01, "0.0001 to 0.001"});
  inputs.EachStage(&In::dry_mass_factor, "dry_mass_factor")
      .Within(kPositiveValues)
      .ReadBy(kByFirstBurn)
      .Usually(kUsualDryMass);
  inputs.EachStage(&In::propellant_factor, "propellant_factor")
      .Within({kPositive, false, PropellantThatFits})
      .ReadBy(kByFirstBurn)
      .Usually(kUsualLoad);
  inputs.One(&In::payload_mass_kg, "payload_mass_kg").Within({kAnyNumber, false, PayloadThatMayLeave});
  inputs.One(&In::payload_element, "payload_element")
      .Within({kNonNegative, true, ElementsThatThereAre})
      .ReadBy(kWithPayload);
  inputs.EachStage(&In::product_of_inertia_xy_kg_m2, "product_of_inertia_xy", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(&In::product_of_inertia_xz_kg_m2, "product_of_inertia_xz", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(&In::product_of_inertia_yz_kg_m2, "product_of_inertia_yz", "_kg_m2")
      .Within({kAnyNumber, false, ProductsOfABody});
  inputs.EachStage(&In::ignition_delay_s, "ignition_delay", "_s")
      .Within({kAnyNumber, false, IgnitionAfterItsTrigger})
      .ReadBy(kByIgnition)
      .Usually(kUsualDelay);
  inputs.EachStage(&In::separation_delay_s, "separation_delay", "_s")
      .Within({kAnyNumber, false, SeparationAfterBurnout})
      .ReadBy(kBySeparation)
      .Usually(kUsualDelay);
  inputs.One(&In::launch_azimuth_error_rad, "launch_azimuth_error_deg", kRadPerDeg)
      .Usually({-2.0, 2.0, "0.01 to 0.2 deg of an alignment"});
  inputs.One(&In::initial_roll_error_rad, "initial_roll_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.One(&In::initial_pitch_error_rad, "initial_pitch_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.One(&In::initial_yaw_error_rad, "initial_yaw_error_deg", kRadPerDeg).Usually(kUsualPadError);
  inputs.EachStage(&In::stack_drag_factor, "drag_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.EachStage(&In::stack_lift_factor, "lift_factor").Within(kPositiveValues).Usually(kUsualCoefficient);
  inputs.EachStage(&In::stack_cg_factor, "cg_factor").Within(kPositiveValues).Usually(kUsualCg);
  inputs.EachStage(&In::stack_cp_factor, "cp_factor").Within(kPositiveValues).Usually(kUsualCp);
  inputs.EachStage(&In::stack_inertia_factor, "inertia_factor")
      .Within(kPositiveValues)
      .Usually(kUsualInertia);
  inputs.EachStage(&In::stack_actuator_bandwidth_factor, "actuator_bandwidth_factor")
      .Within(kPositiveValues)
      .ReadBy(kByDrives)
      .Usually(kUsualBandwidth);
  inputs.EachStage(&In::thrust_misalignment_y_rad, "thrust_misalignment_y", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachStage(&In::thrust_misalignment_z_rad, "thrust_misalignment_z", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachStage(&In::thrust_offset_y_m, "thrust_offset_y", "_m").Usually(kUsualThrustOffset);
  inputs.EachStage(&In::thrust_offset_z_m, "thrust_offset_z", "_m").Usually(kUsualThrustOffset);
  inputs.EachStage(&In::cg_offset_y_m, "cg_offset_y", "_m").Usually(kUsualCgOffset);
  inputs.EachStage(&In::cg_offset_z_m, "cg_offset_z", "_m").Usually(kUsualCgOffset);
  inputs.EachNozzle(&In::nozzle_misalignment_y_rad, "nozzle_misalignment_y", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs.EachNozzle(&In::nozzle_misalignment_z_rad, "nozzle_misalignment_z", "_deg", kRadPerDeg)
      .ReadBy(kByNozzle)
      .Usually(kUsualMisalignment);
  inputs.EachNozzle(&In::nozzle_offset_y_m, "nozzle_offset_y", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachNozzle(&In::nozzle_offset_z_m, "nozzle_offset_z", "_m")
      .ReadBy(kByNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachNozzle(&In::nozzle_flow_factor, "nozzle_flow_factor")
      .Within(kNoLessThanZero)
      .ReadBy(kByNozzle)
      .Usually(kUsualMotor);
  inputs.EachFurtherNozzle(&In::further_misalignment_rad, "nozzle_misalignment", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs
      .EachFurtherNozzle(&In::further_misalignment_clock_rad, "nozzle_misalignment_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithFurtherMisalignment);
  inputs.EachFurtherNozzle(&In::further_misalignment_y_rad, "nozzle_misalignment_y", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachFurtherNozzle(&In::further_misalignment_z_rad, "nozzle_misalignment_z", "_deg", kRadPerDeg)
      .Usually(kUsualMisalignment);
  inputs.EachFurtherNozzle(&In::further_offset_m, "nozzle_offset", "_m")
      .ReadBy(kByFurtherNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachFurtherNozzle(&In::further_offset_clock_rad, "nozzle_offset_clock", "_deg", kRadPerDeg)
      .ReadBy(kWithFurtherOffset);
  inputs.EachFurtherNozzle(&In::further_offset_y_m, "nozzle_offset_y", "_m")
      .ReadBy(kByFurtherNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachFurtherNozzle(&In::further_offset_z_m, "nozzle_offset_z", "_m")
      .ReadBy(kByFurtherNozzle)
      .Usually(kUsualThrustOffset);
  inputs.EachFurtherNozzle(&In::further_thrust_factor, "nozzle_thrust_factor")
      .Within(kNoLessThanZero)
      .Usually(kUsualMotor);
  inputs.EachFurtherNozzle(&In::further_flow_factor, "nozzle_flow_factor")
      .Within(kNoLessThanZero)
      .Usually(kUsualMotor);
  inputs
      .EachStage(&In::fin_cant_rad, "fin_cant", "_deg", kRadPerDeg,
                 {"fin_cant", "added to the cant of a stage's fins, mean of all of them", kAngle})
      .ReadBy(kByFins)
      .Usually({-1.0, 1.0, "0.01 to 0.1 deg of a set's mean"});
  inputs.One(&In::table_ca_sigmas, "table_ca_sigmas").ReadBy(kByUncertainTables);
  inputs.One(&In::table_cn_sigmas, "table_cn_sigmas").ReadBy(kByUncertainTables);
  inputs.One(&In::table_xcp_sigmas, "table_xcp_sigmas").ReadBy(kByUncertainTables);
  inputs.One(&In::table_damping_sigmas, "table_damping_sigmas").ReadBy(kByUncertainTables);
  inputs.EachFurtherNozzle(&In::booster_dry_mass_factor, "booster_dry_mass_factor")
      .Within(kPositiveValues)
      .ReadBy(kByBoosters)
      .Usually(kUsualDryMass);
  inputs.EachFurtherNozzle(&In::booster_propellant_factor, "booster_propellant_factor")
      .Within({kPositive, false, BoosterPropellantThatFits})
      .ReadBy(kByBoosters)
      .Usually(kUsualLoad);
  constexpr UsualValues kUsualMixture = {0.9, 1.1, "0.5 to 3 % of engines"};
  inputs.EachFurtherNozzle(&In::booster_mixture_ratio_factor, "booster_mixture_ratio_factor")
      .Within(kPositiveValues)
      .ReadBy(kByBoosterMixture)
      .Usually(kUsualMixture);
  inputs
      .EachStage(&In::tail_off_factor, "tail_off_factor", "", 1.0,
                 {"tail_off", "factor of the duration of tail_off_*; by a cut-off the impulse goes with it"})
      .Within(kPositiveValues)
      .ReadBy(kByTailOff)
      .Usually({0.4, 1.6, "5 to 20 %"});
  inputs.EachStage(&In::mixture_ratio_factor, "mixture_ratio_factor")
      .Within(kPositiveValues)
      .ReadBy(kByMixture)
      .Usually(kUsualMixture);
  inputs.EachLevel(&In::wind_profile_altitude_m, "wind_profile_altitude", "_m").Within({Between(0.0, 100e3)});
}

/// All columns in their fixed order, names without the prefix `input_`.
const std::vector<InputColumn>& InputColumns();
/// Inputs with a key of their own in `dispersions`, in the order of their columns.
const std::vector<DispersedInput>& DeclaredDispersals();
/// Where an input repeats, in the unit of its name: directions of winds, and clock angles. Errors of an angle
/// repeat too, but they are small ones about 0.
Circle CircleOf(const InputColumn& column);
/// Position of a name in InputColumns(), or -1.
int FindInput(const std::string& name);
/// The input of a column, in internal units.
double& InputValue(FlightInputs& inputs, int column);
/// Makes every input what the value of its column stands for: the draw is the value in the column's unit, and
/// the flight converts it once. A row of cases.csv then gives the same bits again.
void TakeColumns(FlightInputs& inputs);
/// Number that says which columns the results of a vehicle have: that of its stages; with stages of more than
/// four nozzles, or boosters that are bodies of their own, kMaxStages plus the number of these further
/// nozzles.
std::size_t ColumnClass(const Vehicle& vehicle);
/// Further nozzles of a vehicle's stages before this one.
int FurtherNozzlesBefore(const Vehicle& vehicle, std::size_t stage);
/// Name of a nozzle in columns: "stage1_right", and for those beyond four of a stage "nozzle5" and so on,
/// numbered through the vehicle.
std::string NozzleInColumns(const Vehicle& vehicle, std::size_t stage, int nozzle);
/// The same of a booster that is a body of its own: they follow the nozzles of all stages.
std::string BoosterInColumns(const Vehicle& vehicle, std::size_t booster);
/// Number of columns of a class (of a vehicle with so many stages). They are the first of InputColumns().
std::size_t InputCount(std::size_t stages);
/// Values of a vehicle's columns, in the units of their names.
std::vector<double> InputValues(const FlightInputs& inputs, std::size_t stages = kUsualStages);

}  // namespace dispersa
