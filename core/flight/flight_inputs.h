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

constexpr std::array<double, kMaxStages> AllStages(double value) {
  std::array<double, kMaxStages> values{};
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

/// Across the body: a magnitude with its direction from body y towards body z, and components besides. In
/// the unit that the name of such a value says.
struct Lateral {
  double magnitude = 0.0, clock_rad = 0.0;
  double y = 0.0, z = 0.0;
};
/// A thrust against its nominal line: tilted, and moved.
struct ThrustLine {
  Lateral misalignment_rad, offset_m;
};
/// A nozzle, in addition to its stage's or its booster's thrust.
struct NozzleInputs {
  ThrustLine line;
  double thrust_factor = 1.0;  ///< at the same flow
  double flow_factor = 1.0;    ///< of its share of the flow
};
struct BoosterInputs {
  double dry_mass_factor = 1.0, propellant_factor = 1.0, mixture_ratio_factor = 1.0;
};
/// A nozzle beyond four of its stage, or a booster with its own: stage by stage, in the order of the lists,
/// then the boosters.
struct FurtherInputs {
  NozzleInputs nozzle;
  BoosterInputs booster;
};
struct StageInputs {
  ThrustLine thrust;
  std::array<NozzleInputs, kNozzles> nozzles;  ///< right, left, bottom, top; those of a list in its order
  double thrust_factor = 1.0;
  double mass_flow_factor = 1.0;         ///< flow at full thrust: more flow shortens the burn
  double specific_impulse_factor = 1.0;  ///< thrust at the same flow
  double tail_off_factor = 1.0;          ///< of the duration of a motor's tail-off
  double mixture_ratio_factor = 1.0;     ///< of the first tank's flow over the others'
  Lateral cg_offset_m;                   ///< of the stack without its burning propellant
  double dry_mass_factor = 1.0;          ///< of the stage (dispersed_vehicle.h)
  double propellant_factor = 1.0;        ///< of the propellant at ignition
  /// Integrals of x y dm, x z dm and y z dm about C, of the stack, during the whole burn.
  double product_of_inertia_xy_kg_m2 = 0.0, product_of_inertia_xz_kg_m2 = 0.0,
         product_of_inertia_yz_kg_m2 = 0.0;
  /// Rates added to the upper stack as the stage separates.
  double tip_off_pitch_rad_s = 0.0, tip_off_yaw_rad_s = 0.0, tip_off_roll_rad_s = 0.0;
  double ignition_delay_s = 0.0;  ///< without effect for the first stage
  double separation_delay_s = 0.0;
  double fin_cant_rad = 0.0;  ///< added to the cant of all its fins
  // Of the stack, in addition to the factors of the whole vehicle.
  double drag_factor = 1.0, lift_factor = 1.0, cg_factor = 1.0, cp_factor = 1.0;
  double inertia_factor = 1.0, actuator_bandwidth_factor = 1.0;
};
struct AirInputs {
  double wind_max_speed_m_s = 0.0;   ///< of the jet stream
  double wind_azimuth_rad = 0.0;     ///< from where the wind comes, clockwise from north
  double wind_altitude_m = 12000.0;  ///< of the maximum
  double wind_width_m = 12000.0;     ///< full width at half the maximum
  double gust_speed_m_s = 0.0;       ///< 1 - cosine gust
  double gust_altitude_m = 0.0;      ///< where it starts
  double gust_length_m = 0.0;
  double gust_azimuth_rad = 0.0;
  /// Velocity of the air at the levels' altitudes, which grow and then are 0. All 0: the campaign's own
  /// profile, if it has one.
  std::array<double, kWindLevels> wind_profile_north_m_s{}, wind_profile_east_m_s{},
      wind_profile_altitude_m{};
  double turbulence_exceedance = 0.0;     ///< probability that picks the intensity (0: none)
  double turbulence_wind_20ft_m_s = 0.0;  ///< mean wind near the ground, which makes the turbulence there
  double turbulence_scale = 1.0;          ///< of all intensities
  double density_factor = 1.0;
  double weather_sounding =
      0.0;  ///< number of the campaign's sounding, from 1; 0: the campaign's table or mean
};
struct SensorInputs {
  double gyro_bias_roll_rad_s = 0.0, gyro_bias_pitch_rad_s = 0.0, gyro_bias_yaw_rad_s = 0.0;
  double gyro_noise_rad_s = 0.0;                          ///< standard deviation of each sample
  std::array<double, 3> navigation_position_error_m{};    ///< navigated less true, constant, along L's axes
  std::array<double, 3> navigation_velocity_error_m_s{};  ///< the same for the velocity
  double accelerometer_scale_factor = 1.0;                ///< of the sensed specific force
};

/// Only doubles, each declared by DeclareInputs(), in SI units and radians. The defaults are the nominal
/// flight. Factors multiply the nominal value.
struct FlightInputs {
  std::array<StageInputs, kMaxStages> stages;
  std::array<FurtherInputs, kFurtherNozzles> further;
  AirInputs air;
  SensorInputs sensors;
  // The whole vehicle.
  double drag_factor = 1.0;  ///< of the axial force
  double lift_factor = 1.0;  ///< of the normal force
  double cg_factor = 1.0;    ///< of the CG's distance from the nose of the current stack
  double cp_factor = 1.0;    ///< of the CP's
  double inertia_factor = 1.0;
  double actuator_bandwidth_factor = 1.0;
  std::array<double, kModes> bending_frequency_factor = {1.0, 1.0, 1.0, 1.0,
                                                         1.0};  ///< of each mode, both planes
  double bending_damping_factor = 1.0;                          ///< of the modes' damping ratio
  double bending_slope_factor = 1.0;                            ///< of the slopes that sensors feel
  double stuck_nozzle = 0.0;        ///< 0 none, 1..4 right, left, bottom, top; by the order of a list
  double stuck_nozzle_stage = 0.0;  ///< 1-based
  double stuck_nozzle_rad = 0.0;    ///< angle at which it stays
  double pn_error_factor = 1.0;     ///< factor of the first component of P_n, the paper's Fig. 5
  double pn_rate_factor = 1.0;      ///< factor of the second component of P_n
  double loop_gain_factor = 1.0;    ///< factor of every commanded deflection; measures the gain margin
  double loop_delay_s = 0.0;        ///< additional delay of the commands; measures the delay margin
  double loop_stage = 0.0;          ///< stage (1-based) whose loop gain and delay are changed; 0: all
  double payload_mass_kg = 0.0;     ///< additional mass of the payload
  double payload_element = 0.0;     ///< 1-based position of the payload in the last stage's structure
  double launch_azimuth_error_rad =
      0.0;  ///< vehicle and inertial unit are turned clockwise; the flight software does not know
  /// Rotation of the body at lift-off about its axes; the inertial unit measures it.
  double initial_roll_error_rad = 0.0, initial_pitch_error_rad = 0.0, initial_yaw_error_rad = 0.0;
  // Standard deviations of the uncertainties that aerodynamic tables state (AeroSigmas).
  double table_ca_sigmas = 0.0, table_cn_sigmas = 0.0, table_xcp_sigmas = 0.0, table_damping_sigmas = 0.0;
};
/// The inputs of a nozzle of a stage, or (stage 0) of one beyond.
inline const NozzleInputs& NozzleAt(const FlightInputs& in, const InputPlace& place) {
  const std::size_t item = static_cast<std::size_t>(place.item);
  return place.stage > 0 ? in.stages[static_cast<std::size_t>(place.stage) - 1].nozzles[item]
                         : in.further[item].nozzle;
}

/// The usual range of an input, in the unit of its column. `validate --strict` warns about values outside it.
struct UsualValues {
  double low = -HUGE_VAL, high = HUGE_VAL;
  const char* source = "";  ///< reason of the range
};

/// A column of the applied inputs: its name carries the unit, e.g. "thrust_misalignment_stage1_deg".
struct InputColumn {
  int number = 0;  ///< of its declaration
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
  int number;
  Dispersal dispersal;
  DrawnFor drawn_for;
  std::string column;  ///< {stage} and {mode} stand for the name of each
};

/// The declared columns. Each input has a number of its own, which is the order of the columns and, with it,
/// a dimension of Sobol's sequence: a new input takes the next number. Columns of stages that few vehicles
/// have come last but for those of further nozzles. `of` is the value in nominal(): of several carriers that
/// of the first.
class InputDeclarations {
 public:
  const FlightInputs& nominal() const { return nominal_; }
  InputDeclarations& One(int number, const double& of, const std::string& name, double unit = 1.0,
                         const Dispersal& dispersal = {});
  InputDeclarations& EachStage(int number, const double& of, const std::string& stem,
                               const std::string& unit_suffix = "", double unit = 1.0,
                               const Dispersal& dispersal = {});
  /// Of stages, and of those beyond four of a stage.
  struct NozzleNumbers {
    int of_stage, further;
  };
  InputDeclarations& EachNozzle(NozzleNumbers numbers, const double& of, const std::string& stem,
                                const std::string& unit_suffix = "", double unit = 1.0);
  InputDeclarations& EachBooster(int number, const double& of, const std::string& stem);
  InputDeclarations& EachMode(int number, const std::array<double, kModes>& of, const std::string& stem,
                              const Dispersal& dispersal = {});
  InputDeclarations& EachLevel(int number, const std::array<double, kWindLevels>& of, const std::string& stem,
                               const std::string& unit_suffix);
  InputDeclarations& EachLaunchAxis(int number, const std::array<double, 3>& of, const std::string& stem,
                                    const std::string& unit_suffix);
  // Of the columns that were declared last: what a flight can apply (default: any number), what reads them
  // (default: every flight), and their usual values.
  InputDeclarations& Within(const AllowedValues& allowed);
  InputDeclarations& ReadBy(const Readers& readers);
  InputDeclarations& OfFurtherReadBy(const Readers& readers);
  InputDeclarations& Usually(const UsualValues& usual);
  /// Every input has been declared: puts the columns into their order.
  void Finish();

  std::size_t usual() const { return columns_.size(); }
  std::size_t of_stages() const { return columns_.size() + rare_.size(); }
  std::size_t of_further_nozzle() const { return further_[0].size(); }
  std::vector<InputColumn> AllColumns() const;
  const std::vector<DispersedInput>& dispersed() const { return dispersed_; }

 private:
  std::size_t OffsetOf(const double& value) const;
  void Begin();
  template <typename Set>
  InputDeclarations& ForLast(Set set);
  std::vector<InputColumn>& ColumnsWith(std::size_t stage);
  void Further(Carrier carrier, int number, std::size_t offset, const std::string& stem,
               const std::string& unit_suffix, double unit);
  void Disperse(int number, const Dispersal& dispersal, DrawnFor drawn_for, const std::string& column);

  const FlightInputs nominal_;
  std::vector<InputColumn> columns_, rare_;
  std::array<std::vector<InputColumn>, kFurtherNozzles> further_;
  std::size_t last_ = 0, last_rare_ = 0, last_further_ = 0;  ///< where the columns declared last begin
  std::vector<DispersedInput> dispersed_;
};

/// Number, place, column, plain dispersal and usual values of every input, by its carrier.
void DeclareInputs(InputDeclarations& inputs);

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
