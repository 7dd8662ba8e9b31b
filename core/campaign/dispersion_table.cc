#include "core/campaign/dispersion_table.h"

#include <algorithm>

#include "core/vehicle/vehicle.h"

namespace dispersa {
namespace {

constexpr Distribution kOfTemperature[] = {Distribution::kNormal, Distribution::kTwoPoint,
                                           Distribution::kValues, Distribution::kConstant};

// A row's range is that of its columns' declarations, unless it draws something else than they hold.
constexpr DispersedScalar Any(Dimension dimension) { return {dimension, kAnyNumber}; }

const Stage& StageAt(const Vehicle& vehicle, int stage) {
  return vehicle.stages[static_cast<std::size_t>(stage) - 1];
}

// ---- what takes no values ----

std::optional<Unfit> LiquidStage(const Vehicle& vehicle, int stage) {
  if (!StageAt(vehicle, stage).is_liquid()) return std::nullopt;
  return Unfit{"stage " + std::to_string(stage) + " is liquid", "stage: those with solid motors"};
}
std::optional<Unfit> LiquidBoosters(const Vehicle& vehicle, int) {
  if (!vehicle.boosters.is_liquid()) return std::nullopt;
  return Unfit{"the boosters are liquid: pumps or tank pressure set their flow",
               "booster_burn_rate, or boosters with solid motors"};
}
std::optional<Unfit> StageWithoutMixture(const Vehicle& vehicle, int stage) {
  if (StageAt(vehicle, stage).tanks.size() >= 2) return std::nullopt;
  return Unfit{"stage " + std::to_string(stage) + " has no two tanks, whose flows could differ",
               "stage: those with liquid engines of two propellants"};
}
std::optional<Unfit> BoostersWithoutMixture(const Vehicle& vehicle, int) {
  if (vehicle.boosters.tanks.size() >= 2) return std::nullopt;
  return Unfit{"the boosters have no two tanks, whose flows could differ",
               "boosters with liquid engines of two propellants"};
}

// ---- rows ----

// `unit` ends the names of the columns; a nozzle's own begin with `nozzle`, if it has.
DispersionRow OffAxis(const char* key, Dimension dimension, const std::string& stem, const std::string& unit,
                      const std::string& nozzle, const char* meaning) {
  const auto columns = [&unit](const std::string& name, const std::string& of) {
    return std::vector<std::string>{name + of + unit, name + "_clock" + of + "_deg", name + "_y" + of + unit,
                                    name + "_z" + of + unit};
  };
  DispersionRow row = {key, meaning, Draws::kOffAxis, Any(dimension), columns(stem, "_{stage}")};
  if (!nozzle.empty()) row.nozzle_columns = columns(nozzle, "_{stage}_{nozzle}");
  return row;
}

DispersionRow Row(const char* key, const char* meaning, Draws draws, const DispersedScalar& scalar,
                  std::vector<std::string> columns) {
  return {key, meaning, draws, scalar, std::move(columns)};
}

// The column of the whole vehicle, and those of its stages' stacks.
DispersionRow VehicleOrStages(const char* key, const std::string& column, const char* meaning) {
  return {key, meaning, Draws::kVehicleOrStages, kPositiveFactor, {column, column + "_{stage}"}};
}

// A row an axis; {body} stands for its name in the column.
DispersionRow BodyAxes(const char* key, Draws draws, Dimension dimension, const std::string& column,
                       const char* meaning) {
  DispersionRow row = {key, meaning, Draws::kParts};
  for (const char* axis : {"roll", "pitch", "yaw"})
    row.parts.push_back({axis, "about this axis", draws, Any(dimension), {FillColumn(column, "body", axis)}});
  return row;
}

void SetRange(DispersionRow& row) {
  const bool is_temperature =
      row.draws == Draws::kPropellantTemperature || row.draws == Draws::kBoostersTemperature;
  if (!row.columns.empty() && !is_temperature) {
    const int column = FindInput(ExpandColumn(row.columns.front()).front());
    row.scalar.range = InputColumns()[static_cast<std::size_t>(column)].allowed.range;
  }
  for (DispersionRow& part : row.parts) SetRange(part);
}

std::vector<DispersionRow> MakeRows() {
  const auto once = [](const char* key, const DispersedScalar& scalar, const char* column,
                       const char* meaning) {
    return DispersionRow{key, meaning, Draws::kOnce, scalar, {column}};
  };
  const auto stages = [](const char* key, std::vector<std::string> columns, const char* meaning) {
    return DispersionRow{key, meaning, Draws::kStages, kPositiveFactor, std::move(columns)};
  };
  std::vector<DispersionRow> rows;
  const auto add = [&rows](DispersionRow row) -> DispersionRow& { return rows.emplace_back(std::move(row)); };

  add(OffAxis("thrust_misalignment", kAngle, "thrust_misalignment", "_deg", "nozzle_misalignment",
              "angle of the thrust off the axis"));
  add(OffAxis("thrust_offset", kLength, "thrust_offset", "_m", "nozzle_offset",
              "lateral distance of the thrust line"));
  add(OffAxis("center_of_gravity_offset", kLength, "cg_offset", "_m", "",
              "lateral distance of the stack's centre of gravity, without the propellant that it burns"));
  add({"thrust",
       "factor of the thrust",
       Draws::kThrust,
       kPositiveFactor,
       {"thrust_factor_{stage}", "mass_flow_factor_{stage}"},
       {"nozzle_thrust_factor_{stage}_{nozzle}", "nozzle_flow_factor_{stage}_{nozzle}"}});
  add(stages("burn_rate", {"thrust_factor_{stage}", "mass_flow_factor_{stage}"},
             "factor of thrust and flow together"));
  add(Row("propellant_temperature",
          "difference to the nominal temperature of a solid propellant; sets the burn rate",
          Draws::kPropellantTemperature, {kTemperatureDifference, Between(-200.0, 200.0), kOfTemperature},
          {"thrust_factor_{stage}", "mass_flow_factor_{stage}"}))
      .unfit = LiquidStage;
  add(stages("specific_impulse", {"specific_impulse_factor_{stage}"},
             "factor of the thrust at the same flow"));
  add(stages("dry_mass", {"dry_mass_factor_{stage}"},
             "factor of a stage's whole structure; in the last stage with the payload"));
  add(stages("propellant_load", {"propellant_factor_{stage}"}, "factor of the propellant at ignition"));
  add(Row("payload_mass", "added to one element of the last stage's structure", Draws::kPayloadMass,
          Any(kMass), {"payload_mass_kg", "payload_element"}));
  DispersionRow& products =
      add({"product_of_inertia", "of the stack, about its centre of gravity, constant over the burn",
           Draws::kParts});
  for (const char* plane : {"xy", "xz", "yz"}) {
    products.parts.push_back(Row(plane, "in this plane of the body axes", Draws::kStages, Any(kInertia),
                                 {"product_of_inertia_" + std::string(plane) + "_{stage}_kg_m2"}));
  }
  DispersionRow& ignition =
      add(Row("ignition_delay", "delay of a stage's ignition; stage 1 ignites before lift-off",
              Draws::kStages, Any(kTime), {"ignition_delay_{stage}_s"}));
  ignition.first_stage = 2;
  DispersionRow& separation =
      add(Row("separation_delay", "delay of a stage's separation; the last stage does not separate",
              Draws::kStages, Any(kTime), {"separation_delay_{stage}_s"}));
  separation.last_stages_without = 1;
  add(once("launch_azimuth_error", Any(kAngle), "launch_azimuth_error_deg",
           "clockwise, of the vehicle and the inertial unit; not measured"));
  add(BodyAxes("initial_attitude_error", Draws::kOnce, kAngle, "initial_{body}_error_deg",
               "of the body from the program at lift-off; the inertial unit measures it"));
  add(Row("weather", "a measured wind and air for each flight, of several", Draws::kWeather, Any({}),
          {"weather_sounding"}));
  add({"wind",
       "jet stream",
       Draws::kWind,
       Any(kSpeed),
       {"wind_max_speed_m_s"},
       {},
       {{"azimuth", "direction from which it blows", Draws::kDirection, Any(kAngle), {"wind_azimuth_deg"}},
        {"altitude", "of the maximum", Draws::kFixedOrAbsent, Any(kLength), {"wind_altitude_m"}},
        {"width", "full width at half the maximum", Draws::kFixedOrAbsent, Any(kLength), {"wind_width_m"}}}});
  add({"gust",
       "1 - cosine gust",
       Draws::kGust,
       Any(kSpeed),
       {},
       {},
       {{"speed", "the largest", Draws::kFixed, Any(kSpeed), {"gust_speed_m_s"}},
        {"altitude", "altitude at which it begins", Draws::kFixed, Any(kLength), {"gust_altitude_m"}},
        {"length", "in altitude", Draws::kFixed, Any(kLength), {"gust_length_m"}},
        {"azimuth", "direction from which it blows", Draws::kDirection, Any(kAngle), {"gust_azimuth_deg"}}}});
  add(Row("wind_profile", "one profile for all flights, the nominal too, or statistics to draw profiles from",
          Draws::kWindProfile, Any(kSpeed),
          {"wind_profile_north_{level}_m_s", "wind_profile_east_{level}_m_s",
           "wind_profile_altitude_{level}_m"}));
  add({"turbulence",
       "Dryden's, of MIL-F-8785C",
       Draws::kTurbulence,
       kPositiveFactor,
       {"turbulence_exceedance", "turbulence_wind_20ft_m_s"},
       {},
       {{"scale",
         "factor of all intensities",
         Draws::kOnce,
         kPositiveFactor,
         {"turbulence_scale"},
         {},
         {},
         1.0}}});
  add(VehicleOrStages("drag_coefficient", "drag_factor", "factor of the axial force"));
  add(VehicleOrStages("lift_coefficient", "lift_factor", "factor of the normal force"));
  add(VehicleOrStages("center_of_gravity", "cg_factor",
                      "factor of its distance from the nose of the current stack"));
  add(VehicleOrStages("center_of_pressure", "cp_factor",
                      "factor of its distance from the nose of the current stack"));
  add(once("density", kPositiveFactor, "density_factor", "factor of the air's density"));
  add(VehicleOrStages("inertia", "inertia_factor", "factor of the moments of inertia"));
  add(VehicleOrStages("actuator_bandwidth", "actuator_bandwidth_factor", "factor of the drives' bandwidth"));
  add(Row("bending_frequency", "factor of the modes' frequencies", Draws::kEachMode, kPositiveFactor,
          {"bending_frequency_factor_{mode}"}));
  add(once("bending_damping", kPositiveFactor, "bending_damping_factor",
           "factor of the modes' damping ratio"));
  add(once("bending_slope", kPositiveFactor, "bending_slope_factor",
           "factor of the modes' slopes at the sensors"));
  DispersionRow& tip_off =
      add(BodyAxes("tip_off_rate", Draws::kEachStage, kAngularRate, "tip_off_{body}_{stage}_deg_s",
                   "of the upper stack at each separation"));
  for (DispersionRow& part : tip_off.parts) part.last_stages_without = 1;
  add(BodyAxes("gyro_bias", Draws::kOnce, kAngularRate, "gyro_bias_{body}_deg_s", "of the rate gyros"));
  add(once("gyro_noise", Any(kAngularRate), "gyro_noise_deg_s", "standard deviation of a sample"));
  add(Row("navigation_position_error", "constant error of guidance's navigation", Draws::kEachAxis,
          Any(kLength), {"navigation_position_error_{axis}_m"}));
  add(Row("navigation_velocity_error", "constant error of guidance's navigation", Draws::kEachAxis,
          Any(kSpeed), {"navigation_velocity_error_{axis}_m_s"}));
  add(once("accelerometer_scale", kPositiveFactor, "accelerometer_scale_factor",
           "factor of the specific force measured for guidance"));
  add({"stuck_nozzle",
       "a nozzle that does not follow its commands",
       Draws::kStuckNozzle,
       Any(kAngle),
       {"stuck_nozzle", "stuck_nozzle_stage"},
       {},
       {{"angle", "at which it stays", Draws::kFixed, Any(kAngle), {"stuck_nozzle_deg"}}}});
  const std::vector<std::string> of_booster = {"nozzle_thrust_factor_{further}",
                                               "nozzle_flow_factor_{further}"};
  add(Row("booster_burn_rate", "factor of a booster's thrust and flow together; its impulse stays",
          Draws::kBoosters, kPositiveFactor, of_booster));
  add(Row("booster_temperature",
          "difference to the nominal temperature of a booster's propellant; sets its burn rate",
          Draws::kBoostersTemperature, {kTemperatureDifference, Between(-200.0, 200.0), kOfTemperature},
          of_booster))
      .unfit = LiquidBoosters;
  add(Row("booster_misalignment",
          "of a booster's thrust off its nozzle's axis: components towards body y and z",
          Draws::kBoostersAside, Any(kAngle),
          {"nozzle_misalignment_y_{further}_deg", "nozzle_misalignment_z_{further}_deg"}));
  add(Row("booster_dry_mass", "factor of a booster's shell", Draws::kBoosters, kPositiveFactor,
          {"booster_dry_mass_factor_{further}"}));
  add(Row("booster_propellant_load", "factor of a booster's propellant", Draws::kBoosters, kPositiveFactor,
          {"booster_propellant_factor_{further}"}));
  add(Row("booster_mixture_ratio", "factor of the first tank's flow over the others'", Draws::kBoosters,
          kPositiveFactor, {"booster_mixture_ratio_factor_{further}"}))
      .unfit = BoostersWithoutMixture;
  add(stages("mixture_ratio", {"mixture_ratio_factor_{stage}"},
             "factor of the first tank's flow over the others'"))
      .unfit = StageWithoutMixture;
  add(Row("aerodynamic_uncertainty", "of the vehicle's aerodynamic tables, as they state it",
          Draws::kAeroUncertainty, Any({}),
          {"table_ca_sigmas", "table_cn_sigmas", "table_xcp_sigmas", "table_damping_sigmas"}));
  // Those that their inputs declare (core/flight/flight_inputs.h).
  for (const DispersedInput& input : DeclaredDispersals()) {
    const Draws draws = input.drawn_for == DrawnFor::kEachStage  ? Draws::kStages
                        : input.drawn_for == DrawnFor::kEachMode ? Draws::kEachMode
                                                                 : Draws::kOnce;
    const Dispersal& by = input.dispersal;
    add({by.key, by.meaning, draws, Any(by.dimension), {input.column}});
  }
  for (DispersionRow& row : rows) SetRange(row);
  return rows;
}

// ---- columns ----

std::vector<std::string> Numbered(const std::string& stem, int count) {
  std::vector<std::string> names;
  for (int i = 1; i <= count; ++i) names.push_back(stem + std::to_string(i));
  return names;
}

// Of nozzles beyond four of a stage, and of boosters.
std::vector<std::string> FurtherNames() {
  std::vector<std::string> names;
  for (int i = 0; i < kFurtherNozzles; ++i) names.push_back("nozzle" + std::to_string(kNozzles + 1 + i));
  return names;
}

// The keys of all columns, by their positions, in the order of the table.
std::vector<std::vector<std::string>> MakeKeys() {
  std::vector<std::vector<std::string>> keys(InputColumns().size());
  const auto fill = [&](const auto& self, const DispersionRow& row, const std::string& key) -> void {
    for (const auto* columns : {&row.columns, &row.nozzle_columns})
      for (const std::string& pattern : *columns)
        for (const std::string& name : ExpandColumn(pattern))
          keys.at(static_cast<std::size_t>(FindInput(name))).push_back(key);
    for (const DispersionRow& part : row.parts) self(self, part, key + "." + part.key);
  };
  for (const DispersionRow& row : DispersionRows()) fill(fill, row, row.key);
  return keys;
}

const std::vector<std::string>& KeysOf(int column) {
  static const std::vector<std::vector<std::string>> keys = MakeKeys();
  return keys.at(static_cast<std::size_t>(column));
}

}  // namespace

const std::vector<DispersionRow>& DispersionRows() {
  static const std::vector<DispersionRow> rows = MakeRows();
  return rows;
}

std::string FillColumn(std::string pattern, const std::string& what, const std::string& name) {
  const std::string mark = "{" + what + "}";
  if (const std::size_t at = pattern.find(mark); at != std::string::npos)
    pattern.replace(at, mark.size(), name);
  return pattern;
}

std::vector<std::string> ExpandColumn(const std::string& pattern) {
  static const std::pair<std::string, std::vector<std::string>> kNames[] = {
      {"stage", Numbered("stage", kMaxStages)},
      {"nozzle", {std::begin(kNozzleNames), std::end(kNozzleNames)}},
      {"mode", Numbered("mode", kModes)},
      {"level", Numbered("", kWindLevels)},
      {"axis", {"downrange", "right", "down"}},
      {"further", FurtherNames()}};
  std::vector<std::string> columns = {pattern};
  for (const auto& [what, names] : kNames) {
    if (pattern.find("{" + what + "}") == std::string::npos) continue;
    std::vector<std::string> filled;
    for (const std::string& column : columns)
      for (const std::string& name : names) filled.push_back(FillColumn(column, what, name));
    columns = std::move(filled);
  }
  // Those beyond four of a stage have names of their own.
  if (pattern.find("{stage}_{nozzle}") != std::string::npos)
    for (const std::string& name : FurtherNames())
      columns.push_back(FillColumn(pattern, "stage}_{nozzle", name));
  return columns;
}

std::string InputKey(int column) {
  const std::vector<std::string>& keys = KeysOf(column);
  return keys.empty() ? "" : keys.front();
}

std::string InputKey(const Campaign& campaign, int column) {
  for (const DerivedInput& derived : campaign.derived)
    if (derived.column == column) return "derived";
  const std::vector<std::string>& keys = KeysOf(column);
  for (const Dispersion& dispersion : campaign.dispersions) {
    if (std::find(dispersion.inputs.begin(), dispersion.inputs.end(), column) == dispersion.inputs.end())
      continue;
    // "wind/azimuth" is drawn by wind.azimuth, "burn_rate/stage1" by burn_rate.
    const std::string top = dispersion.name.substr(0, dispersion.name.find('/'));
    for (const std::string& key : keys)
      if (key.substr(0, key.find('.')) == top) return key;
  }
  return InputKey(column);
}

}  // namespace dispersa
