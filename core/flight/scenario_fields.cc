#include <algorithm>

#include "core/flight/scenario.h"
#include "core/input/fields.h"

namespace dispersa {
namespace {

constexpr const char* kFullGrid =
    "a full grid: rows of increasing mach, each mach with the same increasing incidences";

// In a Check().
bool CheckLengths(Fields& fields, std::initializer_list<const std::vector<double>*> columns) {
  for (const auto* column : columns) {
    if (column->size() == (*columns.begin())->size()) continue;
    fields.Refuse("", "the columns have different lengths", "one value a row in each column");
    return false;
  }
  return true;
}

Table2D ConstantTable(double value) { return {{0.0, 1.0}, {0.0, 1.0}, {value, value, value, value}}; }

// A grid needs two points of each argument. A constant argument gets a second point.
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

// One value a grid point, sorted by Mach, each Mach with the same incidences. Either argument may be absent.
struct CoefficientRows {
  std::vector<double> mach, incidence_rad, values;
};

// In a Check().
void FillGrid(Fields& fields, const std::string& name, bool over_incidence, CoefficientRows rows,
              Table2D& table) {
  auto& [mach, incidence, values] = rows;
  const bool has_mach = !mach.empty();
  const bool has_incidence = !incidence.empty();
  if (!has_mach && !has_incidence)
    return fields.Refuse("", "the table has no argument",
                         over_incidence ? "a column mach, incidence_deg or both" : "a column mach");
  if (!has_mach) mach.assign(values.size(), 0.0);
  if (!has_incidence) incidence.assign(values.size(), 0.0);
  if (!CheckLengths(fields, {&values, &mach, &incidence})) return;
  const auto other_mach =
      std::find_if(mach.begin(), mach.end(), [&](double value) { return value != mach.front(); });
  const std::size_t columns = static_cast<std::size_t>(other_mach - mach.begin());
  Table2D grid;
  for (std::size_t i = 0; i < values.size(); i += columns) grid.x.push_back(mach[i]);
  grid.y.assign(incidence.begin(), incidence.begin() + static_cast<std::ptrdiff_t>(columns));
  grid.z = values;
  if (!has_incidence && columns == 1 && !CheckIncreasing(fields, "mach", mach)) return;
  if (!has_mach && !CheckIncreasing(fields, "incidence", incidence)) return;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const std::size_t column = row % columns;
    const bool mach_fits = column > 0 ? mach[row] == mach[row - 1] : row == 0 || mach[row] > mach[row - 1];
    const bool incidence_fits =
        incidence[row] == grid.y[column] && (column == 0 || incidence[row] > incidence[row - 1]);
    if (mach_fits && incidence_fits && (row + 1 < values.size() || column + 1 == columns)) continue;
    return fields.Refuse(name + "[" + std::to_string(row) + "]", "the row does not continue the grid",
                         kFullGrid);
  }
  Widen(grid);
  table = std::move(grid);
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
  if (body.ca.empty() && body.cn.empty()) return;
  if (body.ca.empty()) body.ca.table = ConstantTable(0.0);
  if (body.cn.empty()) body.cn.table = ConstantTable(0.0);
  if (body.xcp_station_m.empty()) body.xcp_station_m.table = ConstantTable(body.moment_reference_station_m);
  std::vector<double> x;
  std::vector<double> y;
  for (const Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) {
    AddBreakpoints(c->table.x, x);
    AddBreakpoints(c->table.y, y);
  }
  for (Coefficient* c : {&body.ca, &body.cn, &body.xcp_station_m}) c->table = OnGrid(c->table, x, y);
}

// A length that some of the coefficients want.
void DescribeLength(Fields& fields, const char* stem, const char* of, const char* or_of, double& length_m,
                    const char* meaning) {
  const auto needed = [&] { fields.Quantity(stem, kLength, kPositive, length_m, meaning); };
  fields.Either({{Has(of), needed},
                 {Has(or_of), needed},
                 {Else(), [&] { fields.Quantity(stem, kLength, kPositive, length_m, meaning, 0.0); }}});
}

void DescribeAerodynamics(Fields& fields, ScenarioStage& stage) {
  BodyAerodynamics& body = stage.aerodynamics;
  fields.Quantity("reference_area", kArea, kPositive, body.area_m2, "of the coefficients");
  fields.Quantity("moment_reference_station", kLength, kAnyNumber, body.moment_reference_station_m,
                  "reference point of cm", 0.0);
  fields.Quantity("minimum_airspeed", kSpeed, kNonNegative, body.minimum_airspeed_m_s,
                  "no rate damping below it", 0.0);
  fields.Choice<bool>("damping_rates", {{"earth_relative", false}, {"inertial", true}},
                      stage.inertial_damping_rates, "rates in the damping moments", false);
  const auto coefficient = [&fields](const char* key, Coefficient& value, bool over_incidence,
                                     const char* meaning) {
    std::optional<double> number;
    fields.NumberOrTable(key, number, meaning, [&](Fields& table) {
      CoefficientRows rows;
      table.Numbers("mach", kNonNegative, 0, SIZE_MAX, rows.mach, "increasing");
      if (over_incidence)
        table.Quantities("incidence", kAngle, Between(0.0, kHalfTurn), 0, SIZE_MAX, rows.incidence_rad,
                         "increasing, the same for each Mach number");
      table.Numbers(key, kAnyNumber, 2, SIZE_MAX, rows.values, "one value per row");
      table.OneOrMore(over_incidence ? std::vector<std::string>{"mach", "incidence_deg", "incidence_rad"}
                                     : std::vector<std::string>{"mach"});
      table.Check([&table, key, over_incidence, rows, &value] {
        FillGrid(table, key, over_incidence, rows, value.table);
      });
    });
    if (number) value.table = ConstantTable(*number);
  };
  coefficient("ca", body.ca, true, "axial force");
  coefficient("cn", body.cn, true, "normal force");
  coefficient("xcp_station_m", body.xcp_station_m, true, "where the normal force acts");
  coefficient("cd", body.cd, true, "drag");
  coefficient("cl", body.cl, true, "lift");
  coefficient("cm", body.cm, true, "pitching moment");
  coefficient("clp", body.clp, false, "roll damping");
  coefficient("cmq", body.cmq, false, "pitch damping");
  coefficient("cnr", body.cnr, false, "yaw damping");
  DescribeLength(fields, "chord", "cm", "cmq", body.length_m, "of cm and cmq");
  DescribeLength(fields, "span", "clp", "cnr", body.span_m, "of clp and cnr");
  fields.Check([&body] { ShareGrid(body); });
}

// Products of inertia are integrals of xy dm. The tensor has them with the opposite sign.
Matrix3 Tensor(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix3 tensor;
  tensor << xx, -xy, -xz, -xy, yy, -yz, -xz, -yz, zz;
  return tensor;
}

constexpr const char* kMoments[] = {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};
constexpr const char* kOfMoment = "about the centre of gravity; a product is an integral such as x y dm";

void DescribeConstantMass(Fields& fields, ScenarioMass& mass) {
  double mass_kg = 0.0, cg_station_m = 0.0;
  double i[6] = {};
  fields.Quantity("mass", kMass, kPositive, mass_kg, "total");
  fields.Quantity("cg_station", kLength, kAnyNumber, cg_station_m, "of the centre of gravity", 0.0);
  for (int k = 0; k < 6; ++k)
    fields.Quantity(kMoments[k], kInertia, kAnyNumber, i[k], kOfMoment,
                    k < 3 ? std::nullopt : std::optional(0.0));
  mass = {{0.0}, {mass_kg}, {cg_station_m}, {Tensor(i[0], i[1], i[2], i[3], i[4], i[5])}};
}

void DescribeMassTable(Fields& fields, ScenarioMass& mass) {
  fields.Quantities("propellant", kMass, kNonNegative, 2, SIZE_MAX, mass.propellant_kg, "from 0, increasing");
  fields.Quantities("mass", kMass, kPositive, 2, SIZE_MAX, mass.mass_kg, "total");
  fields.Quantities("cg_station", kLength, kAnyNumber, 2, SIZE_MAX, mass.cg_station_m,
                    "of the centre of gravity");
  std::array<std::vector<double>, 6> i;
  for (std::size_t k = 0; k < 6; ++k)
    fields.Quantities(kMoments[k], kInertia, kAnyNumber, k < 3 ? 2 : 0, SIZE_MAX, i[k], kOfMoment);
  fields.Check([&fields, &mass, i]() mutable {
    const std::size_t rows = mass.propellant_kg.size();
    for (std::size_t product = 3; product < 6; ++product)
      if (i[product].empty()) i[product].assign(rows, 0.0);
    if (!CheckLengths(fields, {&mass.propellant_kg, &mass.mass_kg, &mass.cg_station_m, &i[0], &i[1], &i[2],
                               &i[3], &i[4], &i[5]}))
      return;
    for (std::size_t row = 0; row < rows; ++row)
      mass.inertia_kg_m2.push_back(Tensor(i[0][row], i[1][row], i[2][row], i[3][row], i[4][row], i[5][row]));
  });
}

void Describe(Fields& fields, ScenarioMotor& motor, double propellant_kg) {
  fields.Quantity("ignition_time", kTime, kNonNegative, motor.ignition_time_s, "since the start");
  fields.Quantity("thrust", kForce, kPositive, motor.thrust_n, "in vacuum");
  std::size_t which = 0;
  double value = 0.0;
  fields.OneOf({{"flow", kMassFlow, kPositive, "of the propellant"},
                {"burning_time", kTime, kPositive, "of all propellant"}},
               which, value);
  motor.flow_kg_s = which == 0 ? value : propellant_kg / value;
  fields.Quantity("nozzle_exit_area", kArea, kNonNegative, motor.nozzle_exit_area_m2,
                  "for the pressure term, p A_e", 0.0);
  fields.Quantity("nozzle_station", kLength, kAnyNumber, motor.nozzle_station_m, "where the thrust acts");
  fields.Quantity("nozzle_y", kLength, kAnyNumber, motor.nozzle_y_m, "off the axis to the right", 0.0);
  fields.Quantity("nozzle_z", kLength, kAnyNumber, motor.nozzle_z_m, "off the axis downwards", 0.0);
  fields.Flag("jet_damping", motor.jet_damping, false, "moment of the flow through a turning vehicle");
  fields.Number("inertia_rate", Between(0.0, 1.0), motor.inertia_rate,
                "share of the term -(dI/dt) w of Euler's equations", 1.0);
}

template <class T>
void CheckProblems(Fields& fields, const T& checked) {
  fields.Check([&fields, &checked] {
    for (const StructProblem& problem : Problems(checked))
      fields.Refuse(problem.path, problem.message, problem.allowed);
  });
}

void DescribeAnyStage(Fields& fields, ScenarioStage& stage) {
  fields.Text("name", stage.name, "of the stage", "body");
  fields.Table("mass_properties", "a map, or a CSV file", "of the whole vehicle in this stage",
               [&](Fields& mass) {
                 const auto table = [&] { DescribeMassTable(mass, stage.mass); };
                 mass.Either({{Has("propellant", kMass), table},
                              {IsList("mass", kMass), table},
                              {Else(), [&] { DescribeConstantMass(mass, stage.mass); }}});
               });
  const double propellant_kg = stage.mass.propellant_kg.empty() ? 0.0 : stage.mass.propellant_kg.back();
  bool is_there = false;
  fields.OptionalMap("aerodynamics", is_there, "default: no aerodynamic forces",
                     [&](Fields& map) { DescribeAerodynamics(map, stage); });
  fields.OptionalMap("motor", is_there, "constant thrust along the body axis",
                     [&](Fields& map) { Describe(map, stage.motor.emplace(), propellant_kg); });
}

void Describe(Fields& fields, ScenarioStage& stage, bool is_body) {
  fields.Group("body", "scenario", [&](Fields& group) { DescribeAnyStage(group, stage); });
  if (!is_body)
    fields.OptionalQuantity("separation_time", kTime, kPositive, stage.separation_time_s,
                            "default: at burnout; the last stage has none");
  CheckProblems(fields, stage);
}

void Describe(Fields& fields, Earth& earth) {
  bool is_sphere = false, is_rotating = true, has_j2 = true;
  double radius_m = 0.0;
  fields.Choice<bool>("model", {{"wgs84", false}, {"sphere", true}}, is_sphere, "its shape");
  fields.Flag("rotating", is_rotating, true, "about its axis");
  const auto j2 = [&](bool absent) { fields.Flag("j2", has_j2, absent, "gravity of the oblateness"); };
  fields.Either({{Is("model", {"sphere"}),
                  [&] {
                    fields.Quantity("radius", kLength, kPositive, radius_m, "of the sphere");
                    j2(false);
                  }},
                 {Else(), [&] { j2(true); }}});
  earth = is_sphere ? SphericalEarth(radius_m, is_rotating) : Wgs84();
  if (!is_rotating) earth.rotation_rate_rad_s = 0.0;
  earth.j2 = has_j2 ? Wgs84().j2 : 0.0;
}

void Describe(Fields& fields, Wind& wind) {
  bool is_there = false;
  fields.OptionalMap("steady", is_there, "at all altitudes", [&](Fields& map) {
    const auto components = [&] {
      map.Quantity("north", kSpeed, kAnyNumber, wind.steady.north_m_s, "towards north");
      map.Quantity("east", kSpeed, kAnyNumber, wind.steady.east_m_s, "towards east");
    };
    map.Either({{Has("north", kSpeed), components},
                {Has("east", kSpeed), components},
                {Else(), [&] {
                   double speed_m_s = 0.0, azimuth_rad = 0.0;
                   map.Quantity("speed", kSpeed, kNonNegative, speed_m_s, "over the ground");
                   map.Quantity("azimuth_from", kAngle, kAnyNumber, azimuth_rad,
                                "direction from which it blows");
                   wind.steady = FromAzimuth(speed_m_s, azimuth_rad);
                 }}});
  });
  fields.OptionalTable("table", is_there, "a CSV file of a profile, in m/s", [&](Fields& map) {
    Describe(map, wind.tables.emplace_back(), "one value a row in each column");
  });
  fields.OptionalMap("gust", is_there, "1 - cosine gust", [&](Fields& map) {
    Gust& gust = wind.gusts.emplace_back();
    map.Quantity("speed", kSpeed, kAnyNumber, gust.speed_m_s, "the largest");
    map.Quantity("altitude", kLength, kAnyNumber, gust.start_altitude_m, "altitude at which it begins");
    map.Quantity("length", kLength, kPositive, gust.length_m, "in altitude");
    map.Quantity("azimuth_from", kAngle, kAnyNumber, gust.azimuth_from_rad, "direction from which it blows");
  });
}

void DescribeInitial(Fields& fields, Scenario& scenario) {
  const auto quantity = [&fields](const char* stem, Dimension dimension, double& value, const char* meaning) {
    fields.Quantity(stem, dimension, kAnyNumber, value, meaning, 0.0);
  };
  constexpr Range kQuarter = Between(-kQuarterTurn, kQuarterTurn);
  fields.Quantity("latitude", kAngle, kQuarter, scenario.place.latitude_rad, "geodetic");
  fields.Quantity("longitude", kAngle, Between(-kHalfTurn, kHalfTurn), scenario.place.longitude_rad, "east");
  fields.Quantity("altitude", kLength, kAnyNumber, scenario.place.altitude_m, "above the ellipsoid");
  quantity("yaw", kAngle, scenario.attitude.yaw, "of the body against north, east, down");
  fields.Quantity("pitch", kAngle, kQuarter, scenario.attitude.pitch, "of the body against north, east, down",
                  0.0);
  quantity("roll", kAngle, scenario.attitude.roll, "of the body against north, east, down");
  quantity("velocity_north", kSpeed, scenario.v_EC_N.x(), "relative to the Earth");
  quantity("velocity_east", kSpeed, scenario.v_EC_N.y(), "relative to the Earth");
  quantity("velocity_down", kSpeed, scenario.v_EC_N.z(), "relative to the Earth");
  fields.Choice<bool>("rates_relative_to", {{"inertial", true}, {"earth", false}},
                      scenario.rates_are_inertial, "frame of the rates p, q and r");
  quantity("p", kAngularRate, scenario.rates_rad_s.x(), "about body x");
  quantity("q", kAngularRate, scenario.rates_rad_s.y(), "about body y");
  quantity("r", kAngularRate, scenario.rates_rad_s.z(), "about body z");
}

}  // namespace

void Describe(Fields& fields, Scenario& scenario) {
  std::string description;
  fields.Text("description", description, "free text", "");
  fields.Text("name", scenario.name, "of the scenario");
  fields.Map("earth", "its shape and gravity",
             [&](Fields& map) { Describe(map, scenario.environment.earth); });
  bool is_there = false;
  fields.OptionalMap("wind", is_there, "default: calm; the parts add up",
                     [&](Fields& map) { Describe(map, scenario.environment.wind); });
  fields.Map("initial", "at time 0", [&](Fields& map) { DescribeInitial(map, scenario); });
  bool is_body = false;
  ScenarioStage body;
  fields.OptionalMap("body", is_body, "vehicle in one piece",
                     [&](Fields& map) { Describe(map, body, true); });
  fields.List("stages", 0, SIZE_MAX, scenario.stages, "vehicle between two separations",
              [](Fields& map, ScenarioStage& stage) { Describe(map, stage, false); });
  fields.ExactlyOne({"body", "stages"});
  if (is_body == !scenario.stages.empty())
    fields.Refuse("", is_body ? "'body' and 'stages' are both given" : "nothing is there to fly",
                  "either a body or a list of stages");
  if (is_body) scenario.stages.assign(1, body);
  fields.Quantity("duration", kTime, kPositive, scenario.duration_s, "of the flight");
  fields.Quantity("output_step", kTime, kPositive, scenario.output_step_s, "between two samples");
  fields.Quantity("integration_step", kTime, kPositive, scenario.integration_step_s, "largest");
  CheckProblems(fields, scenario);
}

}  // namespace dispersa
