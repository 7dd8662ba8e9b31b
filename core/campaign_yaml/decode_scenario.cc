#include <algorithm>
#include <cmath>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/input/struct_problems.h"
#include "core/input/map_reader.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

constexpr Unit kInertia[] = {{"kg_m2", 1.0}};

// A table that came from a file has its own paths.
std::string TablePath(const InputNode& table, const InputNode& parent, const std::string& path) {
  return table.file == parent.file ? path : "";
}

bool HaveEqualSizes(const InputNode& node, const std::string& path,
                    std::initializer_list<const std::vector<double>*> columns, ProblemList& problems) {
  for (const auto* column : columns) {
    if (column->size() == (*columns.begin())->size()) continue;
    AddProblem(problems, node, path, "the columns have different lengths", "one value a row in each column");
    return false;
  }
  return true;
}

Table2D ConstantTable(double value) { return {{0.0, 1.0}, {0.0, 1.0}, {value, value, value, value}}; }

// A grid needs two points of each argument; one that does not vary gets a second one.
void Widen(Table2D& table) {
  if (table.y.size() == 1) {
    std::vector<double> z;
    for (const double value : table.z) z.insert(z.end(), {value, value});
    table.z = std::move(z);
    table.y.push_back(table.y[0] + 1.0);
  }
  if (table.x.size() == 1) {
    const std::vector<double> row = table.z;
    table.z.insert(table.z.end(), row.begin(), row.end());
    table.x.push_back(table.x[0] + 1.0);
  }
}

// Rows of one value a grid point, Mach by Mach, each with the same incidences; either argument may be
// absent.
Table2D DecodeGrid(const InputNode& node, const std::string& path, const std::string& name,
                   bool over_incidence, ProblemList& problems) {
  const std::size_t before = problems.size();
  std::vector<double> mach;
  std::vector<double> incidence;
  std::vector<double> values;
  std::string incidence_key;
  {
    MapReader map(node, path, problems);
    mach = map.Numbers("mach", kNonNegative, 0);
    if (over_incidence)
      incidence = map.Quantities("incidence", kAngle, Between(0.0, kHalfTurn), 0, SIZE_MAX, &incidence_key);
    values = map.Numbers(name, kAnyNumber, 2);
  }
  if (problems.size() > before) return {};
  const bool has_mach = !mach.empty();
  const bool has_incidence = !incidence.empty();
  if (!has_mach && !has_incidence) {
    AddProblem(problems, node, path, "the table has no argument",
               over_incidence ? "a column mach, incidence_deg or both" : "a column mach");
    return {};
  }
  if (!has_mach) mach.assign(values.size(), 0.0);
  if (!has_incidence) incidence.assign(values.size(), 0.0);
  if (!HaveEqualSizes(node, path, {&values, &mach, &incidence}, problems)) return {};

  Table2D table;
  const auto other_mach =
      std::find_if(mach.begin(), mach.end(), [&](double value) { return value != mach.front(); });
  const std::size_t columns = static_cast<std::size_t>(other_mach - mach.begin());
  for (std::size_t i = 0; i < values.size(); i += columns) table.x.push_back(mach[i]);
  table.y.assign(incidence.begin(), incidence.begin() + static_cast<std::ptrdiff_t>(columns));
  table.z = values;
  if (!has_incidence && columns == 1 && !CheckIncreasing(node, path, "mach", mach, problems)) return {};
  if (!has_mach && !CheckIncreasing(node, path, incidence_key, incidence, problems)) return {};
  for (std::size_t row = 0; row < values.size(); ++row) {
    const std::size_t column = row % columns;
    const bool mach_fits = column > 0 ? mach[row] == mach[row - 1] : row == 0 || mach[row] > mach[row - 1];
    const bool incidence_fits =
        incidence[row] == table.y[column] && (column == 0 || incidence[row] > incidence[row - 1]);
    if (mach_fits && incidence_fits && (row + 1 < values.size() || column + 1 == columns)) continue;
    AddProblem(problems, node.Find(name)->items[row], path, "the row does not continue the grid",
               "a full grid: rows of increasing mach, each mach with the same increasing incidences");
    return {};
  }
  Widen(table);
  return table;
}

// A number, or a table.
Coefficient DecodeCoefficient(MapReader& map, const std::string& name, bool over_incidence) {
  Coefficient coefficient;
  const InputNode* node = map.Optional(name);
  if (node == nullptr || node->file == nullptr) return coefficient;
  const std::string path = map.PathOf(name);
  if (node->kind == InputNode::Kind::kMap) {
    coefficient.table =
        DecodeGrid(*node, TablePath(*node, map.node(), path), name, over_incidence, map.problems());
  } else {
    coefficient.table = ConstantTable(ReadNumber(*node, path, map.problems()));
  }
  return coefficient;
}

void AddBreakpoints(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
  std::sort(to.begin(), to.end());
  to.erase(std::unique(to.begin(), to.end()), to.end());
}

// The same function on a finer grid: the engine looks ca, cn and xcp up at one place.
Table2D OnGrid(const Table2D& table, const std::vector<double>& x, const std::vector<double>& y) {
  Table2D fine{x, y, {}};
  for (const double at_x : x)
    for (const double at_y : y) fine.z.push_back(table(at_x, at_y));
  return fine;
}

void ShareGrid(BodyAerodynamics& body) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) {
    AddBreakpoints(c->table.x, x);
    AddBreakpoints(c->table.y, y);
  }
  for (Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) c->table = OnGrid(c->table, x, y);
}

void DecodeAerodynamics(const InputNode& node, const std::string& path, ScenarioStage& stage,
                        ProblemList& problems) {
  const std::size_t before = problems.size();
  BodyAerodynamics& body = stage.aerodynamics;
  MapReader map(node, path, problems);
  body.area_m2 = map.Quantity("reference_area", kArea, kPositive);
  body.moment_reference_station_m = map.Quantity("moment_reference_station", kLength, kAnyNumber, 0.0);
  body.minimum_airspeed_m_s = map.Quantity("minimum_airspeed", kSpeed, kNonNegative, 0.0);
  stage.inertial_damping_rates =
      map.Choice<bool>("damping_rates", {{"earth_relative", false}, {"inertial", true}}, false);
  body.ca = DecodeCoefficient(map, "ca", true);
  body.cn = DecodeCoefficient(map, "cn", true);
  body.xcp_station_m = DecodeCoefficient(map, "xcp_station_m", true);
  body.cd = DecodeCoefficient(map, "cd", true);
  body.cl = DecodeCoefficient(map, "cl", true);
  body.cm = DecodeCoefficient(map, "cm", true);
  body.clp = DecodeCoefficient(map, "clp", false);
  body.cmq = DecodeCoefficient(map, "cmq", false);
  body.cnr = DecodeCoefficient(map, "cnr", false);
  const std::optional<double> no_length;
  const std::optional<double> any_length = 0.0;
  body.length_m =
      map.Quantity("chord", kLength, kPositive, body.cm.empty() && body.cmq.empty() ? any_length : no_length);
  body.span_m =
      map.Quantity("span", kLength, kPositive, body.clp.empty() && body.cnr.empty() ? any_length : no_length);
  if (problems.size() > before) return;
  if (body.ca.empty() && body.cn.empty()) return;
  if (body.ca.empty()) body.ca.table = ConstantTable(0.0);
  if (body.cn.empty()) body.cn.table = ConstantTable(0.0);
  if (body.xcp_station_m.empty()) body.xcp_station_m.table = ConstantTable(body.moment_reference_station_m);
  ShareGrid(body);
}

// Products of inertia are integrals of xy dm; the tensor holds them with the other sign.
Matrix3 Tensor(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix3 tensor;
  tensor << xx, -xy, -xz, -xy, yy, -yz, -xz, -yz, zz;
  return tensor;
}

ScenarioMass DecodeConstantMass(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  ScenarioMass mass;
  mass.propellant_kg = {0.0};
  mass.mass_kg = {map.Quantity("mass", kMass, kPositive)};
  mass.cg_station_m = {map.Quantity("cg_station", kLength, kAnyNumber, 0.0)};
  const double xx = map.Quantity("ixx", kInertia, kAnyNumber);
  const double yy = map.Quantity("iyy", kInertia, kAnyNumber);
  const double zz = map.Quantity("izz", kInertia, kAnyNumber);
  const double xy = map.Quantity("ixy", kInertia, kAnyNumber, 0.0);
  const double xz = map.Quantity("ixz", kInertia, kAnyNumber, 0.0);
  const double yz = map.Quantity("iyz", kInertia, kAnyNumber, 0.0);
  mass.inertia_kg_m2 = {Tensor(xx, yy, zz, xy, xz, yz)};
  return mass;
}

ScenarioMass DecodeMassTable(const InputNode& node, const std::string& path, ProblemList& problems) {
  const std::size_t before = problems.size();
  ScenarioMass mass;
  std::vector<double> i[6];
  {
    MapReader map(node, path, problems);
    mass.propellant_kg = map.Quantities("propellant", kMass, kNonNegative, 2);
    mass.mass_kg = map.Quantities("mass", kMass, kPositive, 2);
    mass.cg_station_m = map.Quantities("cg_station", kLength, kAnyNumber, 2);
    i[0] = map.Quantities("ixx", kInertia, kAnyNumber, 2);
    i[1] = map.Quantities("iyy", kInertia, kAnyNumber, 2);
    i[2] = map.Quantities("izz", kInertia, kAnyNumber, 2);
    i[3] = map.Quantities("ixy", kInertia, kAnyNumber, 0);
    i[4] = map.Quantities("ixz", kInertia, kAnyNumber, 0);
    i[5] = map.Quantities("iyz", kInertia, kAnyNumber, 0);
  }
  const std::size_t rows = mass.propellant_kg.size();
  for (int product = 3; product < 6; ++product)
    if (i[product].empty()) i[product].assign(rows, 0.0);
  if (problems.size() > before || !HaveEqualSizes(node, path,
                                                  {&mass.propellant_kg, &mass.mass_kg, &mass.cg_station_m,
                                                   &i[0], &i[1], &i[2], &i[3], &i[4], &i[5]},
                                                  problems))
    return {};
  for (std::size_t row = 0; row < rows; ++row)
    mass.inertia_kg_m2.push_back(Tensor(i[0][row], i[1][row], i[2][row], i[3][row], i[4][row], i[5][row]));
  return mass;
}

ScenarioMass DecodeMass(const InputNode& node, const std::string& path, ProblemList& problems) {
  SayHeeds(path, {"propellant_kg"});
  const bool is_table = std::any_of(node.members.begin(), node.members.end(), [](const InputMember& member) {
    return member.key.starts_with("propellant");
  });
  return is_table ? DecodeMassTable(node, path, problems) : DecodeConstantMass(node, path, problems);
}

ScenarioMotor DecodeScenarioMotor(const InputNode& node, const std::string& path, double propellant_kg,
                          ProblemList& problems) {
  MapReader map(node, path, problems);
  ScenarioMotor motor;
  motor.ignition_time_s = map.Quantity("ignition_time", kTime, kNonNegative);
  motor.thrust_n = map.Quantity("thrust", kForce, kPositive);
  const auto flow = map.OptionalQuantity("flow", kMassFlow, kPositive);
  const auto burning_time = map.OptionalQuantity("burning_time", kTime, kPositive);
  if (!flow && !burning_time) map.NoteMissing({"flow_kg_s", "burning_time_s", "burning_time_ms"});
  if (flow.has_value() == burning_time.has_value()) {
    AddProblem(problems, node, path,
               flow ? "'flow_kg_s' and 'burning_time_s' are both given" : "the flow is not given",
               "one of flow_kg_s, burning_time_s");
  }
  motor.flow_kg_s = flow ? *flow : burning_time ? propellant_kg / *burning_time : 0.0;
  motor.nozzle_exit_area_m2 = map.Quantity("nozzle_exit_area", kArea, kNonNegative, 0.0);
  motor.nozzle_station_m = map.Quantity("nozzle_station", kLength, kAnyNumber);
  motor.nozzle_y_m = map.Quantity("nozzle_y", kLength, kAnyNumber, 0.0);
  motor.nozzle_z_m = map.Quantity("nozzle_z", kLength, kAnyNumber, 0.0);
  motor.jet_damping = map.Flag("jet_damping", false);
  motor.inertia_rate = map.Flag("inertia_rate", true);
  return motor;
}

ScenarioStage DecodeScenarioStage(const InputNode& node, const std::string& path, bool is_body,
                          ProblemList& problems) {
  const std::size_t before = problems.size();
  ScenarioStage stage;
  {
    MapReader map(node, path, problems);
    stage.name = map.Text("name", "body");
    const InputNode& mass = map.Required("mass_properties", "a map, or a CSV file");
    stage.mass = DecodeMass(mass, TablePath(mass, node, map.PathOf("mass_properties")), problems);
    const double propellant_kg = stage.mass.propellant_kg.empty() ? 0.0 : stage.mass.propellant_kg.back();
    if (const InputNode* aerodynamics = map.Optional("aerodynamics"))
      DecodeAerodynamics(*aerodynamics, map.PathOf("aerodynamics"), stage, problems);
    if (const InputNode* motor = map.Optional("motor"))
      stage.motor = DecodeScenarioMotor(*motor, map.PathOf("motor"), propellant_kg, problems);
    if (!is_body) stage.separation_time_s = map.OptionalQuantity("separation_time", kTime, kPositive);
  }
  if (problems.size() == before) AddStructProblems(Problems(stage), node, path, problems);
  return stage;
}

Earth DecodeEarth(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  const bool is_sphere = map.Choice<bool>("model", {{"wgs84", false}, {"sphere", true}});
  const bool rotating = map.Flag("rotating", true);
  const bool j2 = map.Flag("j2", !is_sphere);
  Earth earth = Wgs84();
  if (is_sphere) earth = SphericalEarth(map.Quantity("radius", kLength, kPositive), rotating);
  if (!rotating) earth.rotation_rate_rad_s = 0.0;
  earth.j2 = j2 ? Wgs84().j2 : 0.0;
  return earth;
}

WindNorthEast DecodeSteadyWind(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  if (map.Peek("north_m_s") != nullptr || map.Peek("east_m_s") != nullptr) {
    WindNorthEast wind;
    wind.north_m_s = map.Quantity("north", kSpeed, kAnyNumber);
    wind.east_m_s = map.Quantity("east", kSpeed, kAnyNumber);
    return wind;
  }
  const double speed_m_s = map.Quantity("speed", kSpeed, kNonNegative);
  return FromAzimuth(speed_m_s, map.Quantity("azimuth_from", kAngle, kAnyNumber));
}

WindTable DecodeWindTable(const InputNode& node, const std::string& path, ProblemList& problems) {
  const std::size_t before = problems.size();
  WindTable table;
  {
    MapReader map(node, path, problems);
    table.altitude_m = map.Numbers("altitude_m", kAnyNumber, 2);
    table.north_m_s = map.Numbers("north_m_s", kAnyNumber, 2);
    table.east_m_s = map.Numbers("east_m_s", kAnyNumber, 2);
  }
  if (problems.size() > before || node.file == nullptr) return table;
  if (HaveEqualSizes(node, path, {&table.altitude_m, &table.north_m_s, &table.east_m_s}, problems))
    CheckIncreasing(node, path, "altitude_m", table.altitude_m, problems);
  return table;
}

Gust DecodeGust(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Gust gust{};
  gust.speed_m_s = map.Quantity("speed", kSpeed, kAnyNumber);
  gust.start_altitude_m = map.Quantity("altitude", kLength, kAnyNumber);
  gust.length_m = map.Quantity("length", kLength, kPositive);
  gust.azimuth_from_rad = map.Quantity("azimuth_from", kAngle, kAnyNumber);
  return gust;
}

Wind DecodeWind(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  Wind wind;
  if (const InputNode* steady = map.Optional("steady"))
    wind.steady = DecodeSteadyWind(*steady, map.PathOf("steady"), problems);
  if (const InputNode* table = map.Optional("table"))
    wind.tables.push_back(DecodeWindTable(*table, TablePath(*table, node, map.PathOf("table")), problems));
  if (const InputNode* gust = map.Optional("gust"))
    wind.gusts.push_back(DecodeGust(*gust, map.PathOf("gust"), problems));
  return wind;
}

void DecodeInitial(const InputNode& node, const std::string& path, Scenario& scenario,
                   ProblemList& problems) {
  MapReader map(node, path, problems);
  scenario.place.latitude_rad = map.Quantity("latitude", kAngle, Between(-kQuarterTurn, kQuarterTurn));
  scenario.place.longitude_rad = map.Quantity("longitude", kAngle, Between(-kHalfTurn, kHalfTurn));
  scenario.place.altitude_m = map.Quantity("altitude", kLength, kAnyNumber);
  scenario.attitude.yaw = map.Quantity("yaw", kAngle, kAnyNumber, 0.0);
  scenario.attitude.pitch = map.Quantity("pitch", kAngle, Between(-kQuarterTurn, kQuarterTurn), 0.0);
  scenario.attitude.roll = map.Quantity("roll", kAngle, kAnyNumber, 0.0);
  scenario.v_EC_N.x() = map.Quantity("velocity_north", kSpeed, kAnyNumber, 0.0);
  scenario.v_EC_N.y() = map.Quantity("velocity_east", kSpeed, kAnyNumber, 0.0);
  scenario.v_EC_N.z() = map.Quantity("velocity_down", kSpeed, kAnyNumber, 0.0);
  scenario.rates_are_inertial = map.Choice<bool>("rates_relative_to", {{"inertial", true}, {"earth", false}});
  scenario.rates_rad_s.x() = map.Quantity("p", kAngularRate, kAnyNumber, 0.0);
  scenario.rates_rad_s.y() = map.Quantity("q", kAngularRate, kAnyNumber, 0.0);
  scenario.rates_rad_s.z() = map.Quantity("r", kAngularRate, kAnyNumber, 0.0);
}

}  // namespace

Scenario DecodeScenario(const InputNode& node, const std::string& path, ProblemList& problems) {
  const std::size_t before = problems.size();
  Scenario scenario;
  if (node.file == nullptr) return scenario;  // already reported
  if (!CheckSchema(node, kScenarioSchema, false, path, problems)) return scenario;
  {
    MapReader map(node, path, problems);
    map.Allow("schema");
    map.Text("description", "");
    scenario.name = map.Text("name");
    scenario.environment.earth = DecodeEarth(map.Required("earth", "a map"), map.PathOf("earth"), problems);
    if (const InputNode* wind = map.Optional("wind"))
      scenario.environment.wind = DecodeWind(*wind, map.PathOf("wind"), problems);
    DecodeInitial(map.Required("initial", "a map"), map.PathOf("initial"), scenario, problems);
    const InputNode* body = map.Optional("body");
    if (body != nullptr) scenario.stages.push_back(DecodeScenarioStage(*body, map.PathOf("body"), true, problems));
    map.Each("stages", 0, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      scenario.stages.push_back(DecodeScenarioStage(item, item_path, false, problems));
    });
    if (body == nullptr && node.Find("stages") == nullptr) map.NoteMissing({"body", "stages"});
    if ((body != nullptr) == (node.Find("stages") != nullptr)) {
      AddProblem(problems, node, path,
                 body != nullptr ? "'body' and 'stages' are both given" : "nothing is there to fly",
                 "either a body or a list of stages");
    }
    scenario.duration_s = map.Quantity("duration", kTime, kPositive);
    scenario.output_step_s = map.Quantity("output_step", kTime, kPositive);
    scenario.integration_step_s = map.Quantity("integration_step", kTime, kPositive);
  }
  if (problems.size() == before) AddStructProblems(Problems(scenario), node, path, problems);
  return scenario;
}

}  // namespace dispersa
