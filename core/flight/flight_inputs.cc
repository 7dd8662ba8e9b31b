#include "core/flight/flight_inputs.h"

#include <cassert>

#include "core/math/constants.h"

namespace dispersa {
namespace {

constexpr std::size_t kInputCount = sizeof(FlightInputs) / sizeof(double);

// Names the doubles of FlightInputs in the order of their declaration.
class ColumnList {
 public:
  void One(const std::string& name, double unit = 1.0) { columns_.push_back({name, unit, columns_.size()}); }
  void EachStage(const std::string& stem, const std::string& unit_suffix = "", double unit = 1.0) {
    for (int stage = 1; stage <= kMaxStages; ++stage) {
      One(stem + "_stage" + std::to_string(stage) + unit_suffix, unit);
    }
  }
  void EachLevel(const std::string& stem) {
    for (int level = 1; level <= kWindLevels; ++level) One(stem + "_" + std::to_string(level));
  }
  std::vector<InputColumn> Take() { return std::move(columns_); }

 private:
  std::vector<InputColumn> columns_;
};

std::vector<InputColumn> MakeColumns() {
  ColumnList list;
  list.EachStage("thrust_misalignment", "_deg", kRadPerDeg);
  list.EachStage("thrust_misalignment_clock", "_deg", kRadPerDeg);
  list.EachStage("thrust_offset", "_m");
  list.EachStage("thrust_offset_clock", "_deg", kRadPerDeg);
  list.EachStage("thrust_factor");
  list.EachStage("mass_flow_factor");
  list.EachStage("specific_impulse_factor");
  list.One("wind_max_speed_m_s");
  list.One("wind_azimuth_deg", kRadPerDeg);
  list.One("wind_altitude_m");
  list.One("wind_width_m");
  list.One("gust_speed_m_s");
  list.One("gust_altitude_m");
  list.One("gust_length_m");
  list.One("gust_azimuth_deg", kRadPerDeg);
  list.EachLevel("wind_profile_north");
  list.EachLevel("wind_profile_east");
  list.One("drag_factor");
  list.One("lift_factor");
  list.One("cg_factor");
  list.One("cp_factor");
  list.One("density_factor");
  list.One("inertia_factor");
  list.One("actuator_bandwidth_factor");
  list.EachStage("tip_off_pitch", "_deg_s", kRadPerDeg);
  list.EachStage("tip_off_yaw", "_deg_s", kRadPerDeg);
  list.EachStage("tip_off_roll", "_deg_s", kRadPerDeg);
  list.One("gyro_bias_roll_deg_s", kRadPerDeg);
  list.One("gyro_bias_pitch_deg_s", kRadPerDeg);
  list.One("gyro_bias_yaw_deg_s", kRadPerDeg);
  list.One("gyro_noise_deg_s", kRadPerDeg);
  list.One("stuck_nozzle");
  list.One("stuck_nozzle_stage");
  list.One("stuck_nozzle_deg", kRadPerDeg);
  list.One("pn_error_factor");
  list.One("pn_rate_factor");
  list.One("loop_gain_factor");
  list.One("loop_delay_s");
  list.One("loop_stage");
  std::vector<InputColumn> columns = list.Take();
  assert(columns.size() == kInputCount);
  return columns;
}

}  // namespace

const std::vector<InputColumn>& InputColumns() {
  static const std::vector<InputColumn> columns = MakeColumns();
  return columns;
}

int FindInput(const std::string& name) {
  const std::vector<InputColumn>& columns = InputColumns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

double& InputValue(FlightInputs& inputs, int column) {
  return reinterpret_cast<double*>(&inputs)[InputColumns()[static_cast<std::size_t>(column)].offset];
}

std::vector<double> InputValues(const FlightInputs& inputs) {
  const double* first = reinterpret_cast<const double*>(&inputs);
  std::vector<double> values;
  values.reserve(InputColumns().size());
  // + 0.0: results hold no -0.
  for (const InputColumn& column : InputColumns()) values.push_back(first[column.offset] / column.unit + 0.0);
  return values;
}

}  // namespace dispersa
