// Verifies flights of the engine against NASA's 6DOF check cases (NASA/TM-2015-218675): campaigns/scenarios/
// nesc_case*.yaml flown as `dispersa fly` flies them, every quantity that the simulators report at every
// second:
//   |ours - median of the simulators| <= max(their range, floor).
//
// The floor of a quantity in a case is the largest of
// - half a unit in the twelfth digit of its largest value, for simulator 4 prints twelve digits; components
// of
//   one vector share the vector's; latitude and longitude have the position's, over the Earth's radius;
// - a tenth of the root mean square over time of the simulators' range: where two simulators' curves cross,
//   their range is nearly nothing for an instant, which says nothing about their accuracy (case 3, in which
//   simulator 4 damps inertial rates and the others Earth-relative ones, needs it twice, in yaw and its
//   moment);
// - for what follows from the air: 2.1e-5 of density, pressure, dynamic pressure, force and moment, 2e-6 of
//   speed of sound and Mach number: by so much the simulators round the constants of the US Standard
//   Atmosphere differently (nesc_environment_test.cc). The standard's own speed of sound lies above all
//   three.
//
// The table tests/data/nesc/differences.txt is made here. A cell is our largest difference from the median of
// the simulators / the largest range among them, over the 30 s and the components of a vector:
//   DISPERSA_REWRITE_GOLDENS=1 build/release/tests/verification_nesc_check_cases_test
#include "core/campaign_yaml/load.h"
#include "core/environment/atmosphere.h"
#include "core/flight/fly_scenario.h"
#include "core/flight/history_columns.h"
#include "core/math/constants.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::nesc_check_cases_test {
namespace {

constexpr double kFoot = 0.3048;
constexpr double kSlug = 14.5939029;
constexpr double kPound = 4.4482216;
constexpr double kPressure = kPound / (kFoot * kFoot);
constexpr double kKnot = 1852.0 / 3600.0;
constexpr double kAirError = 2.1e-5;
constexpr double kSoundError = 2e-6;

const std::vector<std::string>& CaseNumbers() {
  static const std::vector<std::string> numbers = {"01", "02", "03", "05", "07", "09"};
  return numbers;
}

using Columns = std::map<std::string, std::vector<double>>;

Columns ReadSimulator(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + path);
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  // A column that is given twice holds the same values twice.
  Columns columns;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::map<std::string, double> row;
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      row[name] = std::stod(cell);
    }
    for (const auto& [name, value] : row) columns[name].push_back(value);
  }
  return columns;
}

// The name of a quantity in the simulators and here, and how it is judged.
struct Component {
  std::string theirs;
  std::string ours;
};
struct Quantity {
  std::string name;
  std::string unit;
  std::vector<Component> components;
  double scale = 1.0;        // their unit in ours
  double air_error = 0.0;    // relative
  bool is_angle = false;     // compared modulo a turn
  bool is_position = false;  // an angle with the position's digits
};

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> quantities = {
      {"inertial position",
       "m",
       {{"eiPosition_ft_X", "eci_x_m"}, {"eiPosition_ft_Y", "eci_y_m"}, {"eiPosition_ft_Z", "eci_z_m"}},
       kFoot},
      {"Earth-fixed position",
       "m",
       {{"gePosition_ft_X", "ecef_x"}, {"gePosition_ft_Y", "ecef_y"}, {"gePosition_ft_Z", "ecef_z"}},
       kFoot},
      {"inertial velocity",
       "m/s",
       {{"eiVelocity_ft_s_X", "eci_vx_m_s"},
        {"eiVelocity_ft_s_Y", "eci_vy_m_s"},
        {"eiVelocity_ft_s_Z", "eci_vz_m_s"}},
       kFoot},
      {"Earth-relative velocity, NED",
       "m/s",
       {{"feVelocity_ft_s_X", "ned_v_n_m_s"},
        {"feVelocity_ft_s_Y", "ned_v_e_m_s"},
        {"feVelocity_ft_s_Z", "ned_v_d_m_s"}},
       kFoot},
      {"altitude", "m", {{"altitudeMsl_ft", "altitude_m"}}, kFoot},
      {"altitude rate", "m/s", {{"altitudeRateWrtMsl_ft_min", "altitude_rate"}}, kFoot / 60.0},
      {"latitude", "deg", {{"latitude_deg", "latitude_deg"}}, 1.0, 0.0, true, true},
      {"longitude", "deg", {{"longitude_deg", "longitude_deg"}}, 1.0, 0.0, true, true},
      {"yaw, pitch, roll",
       "deg",
       {{"eulerAngle_deg_Yaw", "yaw_deg"},
        {"eulerAngle_deg_Pitch", "pitch_deg"},
        {"eulerAngle_deg_Roll", "roll_deg"}},
       1.0,
       0.0,
       true},
      {"inertial body rates",
       "deg/s",
       {{"bodyAngularRateWrtEi_deg_s_Roll", "p_deg_s"},
        {"bodyAngularRateWrtEi_deg_s_Pitch", "q_deg_s"},
        {"bodyAngularRateWrtEi_deg_s_Yaw", "r_deg_s"}}},
      {"gravitation", "m/s²", {{"localGravity_ft_s2", "gravitation"}}, kFoot},
      {"air temperature", "K", {{"ambientTemperature_dgR", "temperature"}}, 1.0 / 1.8},
      {"air pressure", "Pa", {{"ambientPressure_lbf_ft2", "pressure"}}, kPressure, kAirError},
      {"air density",
       "kg/m³",
       {{"airDensity_slug_ft3", "density"}},
       kSlug / (kFoot * kFoot * kFoot),
       kAirError},
      {"speed of sound", "m/s", {{"speedOfSound_ft_s", "sound"}}, kFoot, kSoundError},
      {"airspeed", "m/s", {{"trueAirspeed_nmi_h", "airspeed"}}, kKnot},
      {"Mach number", "", {{"mach", "mach"}}, 1.0, kSoundError},
      {"dynamic pressure", "Pa", {{"dynamicPressure_lbf_ft2", "qbar_pa"}}, kPressure, kAirError},
      {"aerodynamic force",
       "N",
       {{"aero_bodyForce_lbf_X", "force_x"},
        {"aero_bodyForce_lbf_Y", "force_y"},
        {"aero_bodyForce_lbf_Z", "force_z"}},
       kPound,
       kAirError},
      {"aerodynamic moment",
       "N m",
       {{"aero_bodyMoment_ftlbf_L", "moment_x"},
        {"aero_bodyMoment_ftlbf_M", "moment_y"},
        {"aero_bodyMoment_ftlbf_N", "moment_z"}},
       kPound * kFoot,
       kAirError},
  };
  return quantities;
}

Scenario Load(const std::string& number) {
  return LoadScenario(DISPERSA_CAMPAIGNS "/scenarios/nesc_case" + number + ".yaml");
}

// The history's columns, and what only the samples hold.
Columns Fly(const Scenario& scenario) {
  const ScenarioFlight flight = FlyScenario(scenario);
  if (flight.outcome != Outcome::kCompleted) throw std::runtime_error(flight.reason);
  const Earth& earth = scenario.environment.earth;
  const std::vector<double> rows = HistoryRows(scenario, flight.samples);
  const std::vector<std::string>& names = KinematicColumnNames();
  Columns columns;
  for (std::size_t i = 0; i < flight.samples.size(); ++i) {
    const ScenarioSample& sample = flight.samples[i];
    for (std::size_t c = 0; c < names.size(); ++c) columns[names[c]].push_back(rows[i * names.size() + c]);
    const AirState air = StandardAtmosphere1976(sample.air.place.altitude_m);
    const Vector3 p_EoC_E = InertialToEarth(earth, sample.time_s, sample.state.p_EoC_I);
    columns["altitude_rate"].push_back(-columns["ned_v_d_m_s"].back());
    columns["gravitation"].push_back(Gravitation(earth, sample.state.p_EoC_I).norm());
    columns["temperature"].push_back(air.temperature_k);
    columns["pressure"].push_back(sample.air.pressure_pa);
    columns["density"].push_back(sample.air.density_kg_m3);
    columns["sound"].push_back(air.speed_of_sound_m_s);
    columns["airspeed"].push_back(sample.air.airspeed_m_s);
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      columns["ecef_" + axis].push_back(p_EoC_E[k]);
      columns["force_" + axis].push_back(sample.aerodynamic.force_n[k]);
      columns["moment_" + axis].push_back(sample.aerodynamic.moment_n_m[k]);
    }
  }
  return columns;
}

double HalfTwelfthDigit(double value) {
  return value > 0.0 ? 0.5 * std::pow(10.0, std::floor(std::log10(value)) - 11.0) : 0.0;
}

struct Instant {
  std::string column;
  double time_s;
  double difference;
  double range;
  double floor;
};

// A quantity of a case: each component at each second.
std::vector<Instant> Compare(const Quantity& quantity, const Columns& ours,
                             const std::vector<Columns>& simulators) {
  double largest = 0.0;
  double position_digits = 0.0;
  for (const Columns& simulator : simulators) {
    for (const Component& component : quantity.components)
      if (const auto found = simulator.find(component.theirs); found != simulator.end())
        for (const double value : found->second) largest = std::max(largest, std::fabs(value));
    position_digits = std::max(position_digits, HalfTwelfthDigit(simulator.at("eiPosition_ft_X")[0]));
  }
  const double digits = quantity.is_position
                            ? position_digits * kFoot / Wgs84().equatorial_radius_m * kDegPerRad
                            : HalfTwelfthDigit(largest) * quantity.scale;
  std::vector<Instant> instants;
  for (const Component& component : quantity.components) {
    const std::vector<double>& flown = ours.at(component.ours);
    const std::size_t first = instants.size();
    double squares = 0.0;
    double magnitude = 0.0;
    for (std::size_t i = 0; i < flown.size(); ++i) {
      std::vector<double> values;
      for (const Columns& simulator : simulators) {
        const auto found = simulator.find(component.theirs);
        if (found == simulator.end()) continue;
        const double value = found->second.at(i) * quantity.scale;
        values.push_back(quantity.is_angle ? flown[i] + std::remainder(value - flown[i], 360.0) : value);
      }
      std::sort(values.begin(), values.end());
      const std::size_t middle = values.size() / 2;
      const double median =
          values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
      const double range = values.back() - values.front();
      squares += range * range;
      magnitude = std::max(magnitude, std::fabs(median));
      instants.push_back({component.theirs, ours.at("time_s")[i], std::fabs(flown[i] - median), range,
                          std::max(digits, quantity.air_error * std::fabs(median))});
    }
    const double crossing = 0.1 * std::sqrt(squares / static_cast<double>(flown.size()));
    for (std::size_t i = first; i < instants.size(); ++i)
      instants[i].floor = std::max(instants[i].floor, crossing);
  }
  return instants;
}

std::vector<Columns> ReadSimulators(const std::string& number) {
  std::vector<Columns> simulators;
  for (const char* simulator : {"04", "05", "06"})
    simulators.push_back(
        ReadSimulator(DISPERSA_TEST_DATA "/nesc/Atmos_" + number + "_sim_" + simulator + ".csv"));
  return simulators;
}

class NescCheckCase : public ::testing::TestWithParam<std::string> {};

TEST_P(NescCheckCase, EveryQuantityAtEverySecond) {
  const Columns ours = Fly(Load(GetParam()));
  ASSERT_EQ(ours.at("time_s").size(), 31u);
  const std::vector<Columns> simulators = ReadSimulators(GetParam());
  for (const Quantity& quantity : Quantities())
    for (const Instant& instant : Compare(quantity, ours, simulators))
      EXPECT_LE(instant.difference, std::max(instant.range, instant.floor))
          << quantity.name << ", " << instant.column << " at " << instant.time_s << " s, in " << quantity.unit
          << "; range " << instant.range << ", floor " << instant.floor;
}

INSTANTIATE_TEST_SUITE_P(Nesc, NescCheckCase, ::testing::ValuesIn(CaseNumbers()),
                         [](const auto& test) { return "case_" + test.param; });

// Case 17, a two-stage rocket to orbit, of which one simulator's records can be had (06).
Columns FlyTwoStage(double area_m2, double inertia_rate, bool straight_up) {
  Scenario scenario = Load("17");
  for (ScenarioStage& stage : scenario.stages) {
    stage.aerodynamics.area_m2 = area_m2;
    stage.motor->inertia_rate = inertia_rate;
  }
  if (straight_up) scenario.v_EC_N = {0.0, 0.0, -0.1};
  return Fly(scenario);
}

double At(const Columns& flight, const std::string& column, double time_s) {
  const std::vector<double>& times = flight.at("time_s");
  for (std::size_t i = 0; i < times.size(); ++i)
    if (std::fabs(times[i] - time_s) < 1e-6) return flight.at(column)[i];
  throw std::runtime_error("no such instant");
}

// With that simulator's data. An implementation that shares nothing with ours departs from it by these feet,
// too: a difference that two independent programs have is the simulator's own.
TEST(NescTwoStage, DepartsFromASimulatorAsAnotherProgramDoes) {
  const Columns ours = FlyTwoStage(7.068583470577035, 0.5, true);
  const Columns theirs = ReadSimulator(DISPERSA_TEST_DATA "/nesc/Atmos_17_sim_06.csv");
  const auto altitude_less_theirs_ft = [&](int second) {
    return At(ours, "altitude_m", second) / kFoot - theirs.at("altitudeMsl_ft")[second];
  };
  // The tolerance is half of the last digit that is known of the other program. Above 86 km it has a table of
  // its own: without that air the flight would end 7200 ft higher, and 0.6 % and 0.2 % of what it does are
  // granted.
  EXPECT_NEAR(altitude_less_theirs_ft(20), -5.4, 0.15);
  EXPECT_NEAR(altitude_less_theirs_ft(37), -7.8, 0.15);
  EXPECT_NEAR(altitude_less_theirs_ft(60), -12.0, 0.5);
  EXPECT_NEAR(altitude_less_theirs_ft(134), -28.0, 1.0);
  EXPECT_NEAR(altitude_less_theirs_ft(175), -174.0, 10.0);
  EXPECT_NEAR(altitude_less_theirs_ft(200), -713.0, 15.0);
  for (int second = 0; second <= 134; ++second) {
    EXPECT_NEAR(At(ours, "pitch_deg", second), theirs.at("eulerAngle_deg_Pitch")[second], 0.045) << second;
    EXPECT_NEAR(At(ours, "ned_v_d_m_s", second) / kFoot, theirs.at("feVelocity_ft_s_Z")[second], 0.75)
        << second;
    EXPECT_NEAR(At(ours, "yaw_deg", second), 90.0, 1e-6);
  }
}

// Altitudes of the other program, in km, and its data: each of the two is seen.
TEST(NescTwoStage, EndsWhereAnotherProgramEnds) {
  const struct {
    double area_m2, inertia_rate;
    double altitude_km[4];
  } kOthers[] = {{7.0, 0.0, {26.801, 138.655, 228.386, 249.378}},
                 {7.0, 0.5, {26.760, 138.344, 228.111, 248.759}}};
  for (const auto& other : kOthers) {
    const Columns ours = FlyTwoStage(other.area_m2, other.inertia_rate, true);
    const double times_s[] = {37.4, 131.8, 193.0, 200.0};
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(At(ours, "altitude_m", times_s[i]) * 1e-3, other.altitude_km[i], i < 2 ? 6e-4 : 4e-3)
          << other.inertia_rate << " at " << times_s[i];
  }
  // As it ships: the description's start, 0.1 ft/s along the body.
  EXPECT_NEAR(At(Fly(Load("17")), "altitude_m", 200.0), 248441.6, 4.0);
}

std::string Short(double value) {
  if (value == 0.0) return "0";
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

std::string VerificationTable() {
  std::vector<std::string> rows;
  for (const Quantity& quantity : Quantities())
    rows.push_back("| " + quantity.name + (quantity.unit.empty() ? "" : ", " + quantity.unit) + " |");
  std::string header = "| quantity |";
  std::string rule = "|---|";
  for (const std::string& number : CaseNumbers()) {
    header += " case " + std::to_string(std::stoi(number)) + " |";
    rule += "---|";
    const Columns ours = Fly(Load(number));
    const std::vector<Columns> simulators = ReadSimulators(number);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double difference = 0.0;
      double range = 0.0;
      for (const Instant& instant : Compare(Quantities()[i], ours, simulators)) {
        difference = std::max(difference, instant.difference);
        range = std::max(range, instant.range);
      }
      rows[i] += " " + Short(difference) + " / " + Short(range) + " |";
    }
  }
  std::string table = header + "\n" + rule + "\n";
  for (const std::string& row : rows) table += row + "\n";
  return table;
}

TEST(NescCheckCases, TableOfDifferences) {
  const std::string path = DISPERSA_TEST_DATA "/nesc/differences.txt";
  const std::string table = VerificationTable();
  const char* rewrite = std::getenv("DISPERSA_REWRITE_GOLDENS");
  if (rewrite != nullptr && std::string(rewrite) == "1") {
    std::ofstream(path, std::ios::binary) << table;
    FAIL() << "rewrote " << path << "; look at the difference before it is committed";
  }
  EXPECT_EQ(TextOfFile(path), table);
}

}  // namespace
}  // namespace dispersa::nesc_check_cases_test
