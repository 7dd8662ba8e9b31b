#include "core/flight/flight_inputs.h"

#include <cassert>
#include <cstring>

#include "core/math/constants.h"

namespace dispersa {
namespace {

constexpr std::size_t kInputCount = sizeof(FlightInputs) / sizeof(double);

// Names the fields of FlightInputs, in the order of the columns: of stages that few vehicles have behind all
// others.
class ColumnList {
 public:
  void One(double FlightInputs::*field, const std::string& name, double unit = 1.0) {
    columns_.push_back({name, unit, OffsetOf(&(nominal_.*field))});
  }
  void EachStage(PerStage FlightInputs::*field, const std::string& stem, const std::string& unit_suffix = "",
                 double unit = 1.0) {
    for (std::size_t i = 0; i < kMaxStages; ++i)
      ColumnsWith(i).push_back(
          {stem + "_stage" + std::to_string(i + 1) + unit_suffix, unit, OffsetOf(&(nominal_.*field)[i])});
  }
  void EachNozzle(PerNozzle FlightInputs::*field, const std::string& stem,
                  const std::string& unit_suffix = "", double unit = 1.0) {
    for (std::size_t i = 0; i < kMaxStages; ++i)
      for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle)
        ColumnsWith(i).push_back(
            {stem + "_stage" + std::to_string(i + 1) + "_" + kNozzleNames[nozzle] + unit_suffix, unit,
             OffsetOf(&(nominal_.*field)[i][nozzle])});
  }
  void EachMode(std::array<double, kModes> FlightInputs::*field, const std::string& stem) {
    for (std::size_t i = 0; i < kModes; ++i)
      columns_.push_back({stem + "_mode" + std::to_string(i + 1), 1.0, OffsetOf(&(nominal_.*field)[i])});
  }
  void EachLevel(std::array<double, kWindLevels> FlightInputs::*field, const std::string& stem) {
    for (std::size_t i = 0; i < kWindLevels; ++i)
      columns_.push_back({stem + "_" + std::to_string(i + 1), 1.0, OffsetOf(&(nominal_.*field)[i])});
  }
  void EachLaunchAxis(std::array<double, 3> FlightInputs::*field, const std::string& stem,
                      const std::string& unit_suffix) {
    const char* const axes[] = {"_downrange", "_right", "_down"};
    for (std::size_t i = 0; i < 3; ++i)
      columns_.push_back({stem + axes[i] + unit_suffix, 1.0, OffsetOf(&(nominal_.*field)[i])});
  }
  std::size_t usual() const { return columns_.size(); }
  std::vector<InputColumn> Take() {
    columns_.insert(columns_.end(), rare_.begin(), rare_.end());
    return std::move(columns_);
  }

 private:
  std::size_t OffsetOf(const double* value) const {
    const char* const first = reinterpret_cast<const char*>(&nominal_);
    return static_cast<std::size_t>(reinterpret_cast<const char*>(value) - first);
  }

  std::vector<InputColumn>& ColumnsWith(std::size_t stage) { return stage < kUsualStages ? columns_ : rare_; }

  const FlightInputs nominal_;
  std::vector<InputColumn> columns_, rare_;
};

struct Columns {
  std::vector<InputColumn> all;
  std::size_t usual;
};

Columns MakeColumns() {
  using In = FlightInputs;
  ColumnList list;
  list.EachStage(&In::thrust_misalignment_rad, "thrust_misalignment", "_deg", kRadPerDeg);
  list.EachStage(&In::thrust_misalignment_clock_rad, "thrust_misalignment_clock", "_deg", kRadPerDeg);
  list.EachStage(&In::thrust_offset_m, "thrust_offset", "_m");
  list.EachStage(&In::thrust_offset_clock_rad, "thrust_offset_clock", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_misalignment_rad, "nozzle_misalignment", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_misalignment_clock_rad, "nozzle_misalignment_clock", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_offset_m, "nozzle_offset", "_m");
  list.EachNozzle(&In::nozzle_offset_clock_rad, "nozzle_offset_clock", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_thrust_factor, "nozzle_thrust_factor");
  list.EachStage(&In::cg_offset_m, "cg_offset", "_m");
  list.EachStage(&In::cg_offset_clock_rad, "cg_offset_clock", "_deg", kRadPerDeg);
  list.EachStage(&In::thrust_factor, "thrust_factor");
  list.EachStage(&In::mass_flow_factor, "mass_flow_factor");
  list.EachStage(&In::specific_impulse_factor, "specific_impulse_factor");
  list.One(&In::wind_max_speed_m_s, "wind_max_speed_m_s");
  list.One(&In::wind_azimuth_rad, "wind_azimuth_deg", kRadPerDeg);
  list.One(&In::wind_altitude_m, "wind_altitude_m");
  list.One(&In::wind_width_m, "wind_width_m");
  list.One(&In::gust_speed_m_s, "gust_speed_m_s");
  list.One(&In::gust_altitude_m, "gust_altitude_m");
  list.One(&In::gust_length_m, "gust_length_m");
  list.One(&In::gust_azimuth_rad, "gust_azimuth_deg", kRadPerDeg);
  list.EachLevel(&In::wind_profile_north, "wind_profile_north");
  list.EachLevel(&In::wind_profile_east, "wind_profile_east");
  list.One(&In::turbulence_exceedance, "turbulence_exceedance");
  list.One(&In::turbulence_wind_20ft_m_s, "turbulence_wind_20ft_m_s");
  list.One(&In::turbulence_scale, "turbulence_scale");
  list.One(&In::drag_factor, "drag_factor");
  list.One(&In::lift_factor, "lift_factor");
  list.One(&In::cg_factor, "cg_factor");
  list.One(&In::cp_factor, "cp_factor");
  list.One(&In::density_factor, "density_factor");
  list.One(&In::inertia_factor, "inertia_factor");
  list.One(&In::actuator_bandwidth_factor, "actuator_bandwidth_factor");
  list.EachMode(&In::bending_frequency_factor, "bending_frequency_factor");
  list.One(&In::bending_damping_factor, "bending_damping_factor");
  list.One(&In::bending_slope_factor, "bending_slope_factor");
  list.EachStage(&In::tip_off_pitch_rad_s, "tip_off_pitch", "_deg_s", kRadPerDeg);
  list.EachStage(&In::tip_off_yaw_rad_s, "tip_off_yaw", "_deg_s", kRadPerDeg);
  list.EachStage(&In::tip_off_roll_rad_s, "tip_off_roll", "_deg_s", kRadPerDeg);
  list.One(&In::gyro_bias_roll_rad_s, "gyro_bias_roll_deg_s", kRadPerDeg);
  list.One(&In::gyro_bias_pitch_rad_s, "gyro_bias_pitch_deg_s", kRadPerDeg);
  list.One(&In::gyro_bias_yaw_rad_s, "gyro_bias_yaw_deg_s", kRadPerDeg);
  list.One(&In::gyro_noise_rad_s, "gyro_noise_deg_s", kRadPerDeg);
  list.One(&In::stuck_nozzle, "stuck_nozzle");
  list.One(&In::stuck_nozzle_stage, "stuck_nozzle_stage");
  list.One(&In::stuck_nozzle_rad, "stuck_nozzle_deg", kRadPerDeg);
  list.One(&In::pn_error_factor, "pn_error_factor");
  list.One(&In::pn_rate_factor, "pn_rate_factor");
  list.One(&In::loop_gain_factor, "loop_gain_factor");
  list.One(&In::loop_delay_s, "loop_delay_s");
  list.One(&In::loop_stage, "loop_stage");
  list.EachLaunchAxis(&In::navigation_position_error_m, "navigation_position_error", "_m");
  list.EachLaunchAxis(&In::navigation_velocity_error_m_s, "navigation_velocity_error", "_m_s");
  list.One(&In::accelerometer_scale_factor, "accelerometer_scale_factor");
  list.EachStage(&In::dry_mass_factor, "dry_mass_factor");
  list.EachStage(&In::propellant_factor, "propellant_factor");
  list.One(&In::payload_mass_kg, "payload_mass_kg");
  list.One(&In::payload_element, "payload_element");
  list.EachStage(&In::product_of_inertia_xy_kg_m2, "product_of_inertia_xy", "_kg_m2");
  list.EachStage(&In::product_of_inertia_xz_kg_m2, "product_of_inertia_xz", "_kg_m2");
  list.EachStage(&In::product_of_inertia_yz_kg_m2, "product_of_inertia_yz", "_kg_m2");
  list.EachStage(&In::ignition_delay_s, "ignition_delay", "_s");
  list.EachStage(&In::separation_delay_s, "separation_delay", "_s");
  list.One(&In::launch_azimuth_error_rad, "launch_azimuth_error_deg", kRadPerDeg);
  list.One(&In::initial_roll_error_rad, "initial_roll_error_deg", kRadPerDeg);
  list.One(&In::initial_pitch_error_rad, "initial_pitch_error_deg", kRadPerDeg);
  list.One(&In::initial_yaw_error_rad, "initial_yaw_error_deg", kRadPerDeg);
  list.EachStage(&In::stack_drag_factor, "drag_factor");
  list.EachStage(&In::stack_lift_factor, "lift_factor");
  list.EachStage(&In::stack_cg_factor, "cg_factor");
  list.EachStage(&In::stack_cp_factor, "cp_factor");
  list.EachStage(&In::stack_inertia_factor, "inertia_factor");
  list.EachStage(&In::stack_actuator_bandwidth_factor, "actuator_bandwidth_factor");
  list.EachStage(&In::thrust_misalignment_y_rad, "thrust_misalignment_y", "_deg", kRadPerDeg);
  list.EachStage(&In::thrust_misalignment_z_rad, "thrust_misalignment_z", "_deg", kRadPerDeg);
  list.EachStage(&In::thrust_offset_y_m, "thrust_offset_y", "_m");
  list.EachStage(&In::thrust_offset_z_m, "thrust_offset_z", "_m");
  list.EachStage(&In::cg_offset_y_m, "cg_offset_y", "_m");
  list.EachStage(&In::cg_offset_z_m, "cg_offset_z", "_m");
  list.EachNozzle(&In::nozzle_misalignment_y_rad, "nozzle_misalignment_y", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_misalignment_z_rad, "nozzle_misalignment_z", "_deg", kRadPerDeg);
  list.EachNozzle(&In::nozzle_offset_y_m, "nozzle_offset_y", "_m");
  list.EachNozzle(&In::nozzle_offset_z_m, "nozzle_offset_z", "_m");
  Columns columns{{}, list.usual()};
  columns.all = list.Take();
  assert(columns.all.size() == kInputCount);
  return columns;
}

const Columns& AllColumns() {
  static const Columns columns = MakeColumns();
  return columns;
}

}  // namespace

const std::vector<InputColumn>& InputColumns() { return AllColumns().all; }

std::size_t InputCount(std::size_t stages) {
  return stages <= kUsualStages ? AllColumns().usual : AllColumns().all.size();
}

int FindInput(const std::string& name) {
  const std::vector<InputColumn>& columns = InputColumns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

double& InputValue(FlightInputs& inputs, int column) {
  const std::size_t offset = InputColumns()[static_cast<std::size_t>(column)].offset;
  return *reinterpret_cast<double*>(reinterpret_cast<char*>(&inputs) + offset);
}

std::vector<double> InputValues(const FlightInputs& inputs, std::size_t stages) {
  std::vector<double> values(InputCount(stages));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const InputColumn& column = InputColumns()[i];
    double value;
    std::memcpy(&value, reinterpret_cast<const char*>(&inputs) + column.offset, sizeof value);
    values[i] = value / column.unit + 0.0;  // + 0.0: results hold no -0
  }
  return values;
}

}  // namespace dispersa
