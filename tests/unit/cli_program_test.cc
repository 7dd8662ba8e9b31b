// The program as a user calls it: output, errors and exit codes of the commands that need no workers.
#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "core/flight/flight_inputs.h"
#include "core/flight/history_columns.h"
#include "core/flight/metrics.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::cli_program_test {
namespace {

struct Output {
  int code = -1;
  std::string text;   ///< stdout
  std::string error;  ///< stderr
};

// Runs `dispersa` with arguments in shell syntax.
Output Dispersa(const std::string& arguments) {
  const InputFiles folder;
  const std::string error_file = folder.Path("stderr");
  const std::string command = std::string(DISPERSA_BINARIES "/dispersa ") + arguments + " 2>" + error_file;
  Output output;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    output.text.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) output.code = WEXITSTATUS(status);
  output.error = TextOfFile(error_file);
  return output;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

const std::string kSmoke = DISPERSA_CAMPAIGNS "/smoke.yaml";

TEST(CliProgram, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(Dispersa("--help").code, 0);
  EXPECT_THAT(Dispersa("fly --help").text, HasSubstr("Example: dispersa fly "));
  const Output version = Dispersa("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.text, StartsWith("dispersa 0."));
}

TEST(CliProgram, BadUsageIsTwo) {
  const Output unknown = Dispersa("validat x.yaml");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(
      unknown.error,
      StartsWith("unknown command 'validat' (did you mean 'validate'?), allowed: validate, optimize, "));
  EXPECT_EQ(unknown.text, "");
  EXPECT_EQ(Dispersa("--quit").error,
            "unknown option '--quit' (did you mean '--quiet'?), allowed: --help, --version, --json, --quiet, "
            "--color\n");
  const std::vector<std::string> bad = {"", "validate", "fly", "fly --no-such-option x",
                                        "fly " + kSmoke + " --case x"};
  for (const std::string& arguments : bad) {
    const Output output = Dispersa(arguments);
    EXPECT_EQ(output.code, 2) << arguments;
    EXPECT_NE(output.error, "") << arguments;
    EXPECT_EQ(output.text, "") << arguments;
  }
}

TEST(CliProgram, ModesShowsHowAVehicleBends) {
  const InputFiles files;
  const Output text = Dispersa("modes " + files.Path("flexible.yaml") + " --out " + files.Path("plots"));
  EXPECT_EQ(text.code, 0) << text.error;
  EXPECT_THAT(text.text, HasSubstr("stage 1 and above, plane y, z\n"));
  EXPECT_THAT(text.text, HasSubstr("nozzle pivot"));
  EXPECT_EQ(Lines(text.text).back(), "page: " + files.Path("plots/modes.html"));
  EXPECT_THAT(TextOfFile(files.Path("plots/modes.html")), HasSubstr("Stack of first and all above"));

  const Output output = Dispersa("modes " + files.Path("flexible.yaml") + " --json --shapes");
  EXPECT_EQ(output.code, 0) << output.error;
  const auto json = nlohmann::json::parse(output.text);
  EXPECT_EQ(json["schema"], "dispersa/modes/1");
  ASSERT_EQ(json["stacks"].size(), 2u * 3u);  // stages, levels
  EXPECT_EQ(json["stacks"][2]["stage"], 1);
  EXPECT_EQ(json["stacks"][2]["propellant_kg"], 0.0);
  EXPECT_EQ(json["stacks"][2]["mass_kg"], 1500.0);
  const auto& modes = json["stacks"][2]["modes"];
  ASSERT_EQ(modes.size(), 2u * 3u);  // planes, modes
  EXPECT_EQ(modes[0]["plane"], "y");
  EXPECT_EQ(modes[3]["plane"], "z");
  EXPECT_GT(modes[1]["frequency_hz"], modes[0]["frequency_hz"]);
  EXPECT_GT(modes[0]["generalized_mass_kg"], 0.0);
  EXPECT_EQ(modes[0]["stations"][0]["name"], "gyro");
  EXPECT_EQ(modes[0]["shape"]["station_m"].size(), modes[0]["shape"]["slope_1_m"].size());
}

// Stack 1 has its boosters first, at levels over their burn and one behind the separation; then it has none.
TEST(CliProgram, ModesTellsAStackWithItsBoostersAndWithout) {
  const InputFiles files;
  std::string flexible = TextOfFile(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  const std::string base = "based_on: slv4.yaml";
  ASSERT_NE(flexible.find(base), std::string::npos);
  flexible.replace(flexible.find(base), base.size(), "based_on: " DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  std::ofstream(files.Path("boosted.yaml"))
      << flexible << "boosters:\n  count: 4\n  dry_mass_kg: 80\n  propellant_mass_kg: 270\n  radius_m: 0.97\n"
      << "  diameter_m: 0.62\n  top_station_m: 21\n  bottom_station_m: 26.5\n  nozzle_station_m: 26.4\n"
      << "  attachment_station_m: 23\n  separation_delay_s: 0.5\n"
      << "  motor: {thrust_kn: 25, burning_time_s: 30, ignition_rise_s: 0.2, tail_off_s: 0.4}\n"
      << "  grain: {top_station_m: 24, bottom_station_m: 24.7, outer_diameter_m: 0.6, inner_diameter_m: "
         "0.2}\n";
  const Output output = Dispersa("modes " + files.Path("boosted.yaml") + " --json");
  EXPECT_EQ(output.code, 0) << output.error;
  const auto stacks = nlohmann::json::parse(output.text)["stacks"];
  constexpr std::size_t kLevels = 11;
  ASSERT_EQ(stacks.size(), 1 + 5 * kLevels);
  const auto &with = stacks[0], &without = stacks[kLevels + 1];
  for (std::size_t i = 0; i <= kLevels; ++i) {
    EXPECT_EQ(stacks[i]["stage"], 1);
    EXPECT_EQ(stacks[i]["jettisoned"], false);
  }
  EXPECT_EQ(without["stage"], 1);
  EXPECT_EQ(without["jettisoned"], true);
  EXPECT_EQ(stacks[2 * kLevels + 1]["stage"], 2);
  EXPECT_EQ(with["propellant_kg"], without["propellant_kg"]);
  EXPECT_NEAR(double(with["mass_kg"]) - double(without["mass_kg"]), 4 * (80.0 + 270.0), 1e-6);
  EXPECT_GT(with["cg_station_m"], without["cg_station_m"]);
  // Mass without stiffness.
  EXPECT_LT(with["modes"][0]["frequency_hz"], without["modes"][0]["frequency_hz"]);
  // Their propellant leaves with the stage's: at their burnout 4 dry boosters are left.
  const double burnt_out = stacks[kLevels - 1]["propellant_kg"];
  double core_kg = without["mass_kg"];
  core_kg -= double(without["propellant_kg"]) - burnt_out;
  EXPECT_NEAR(double(stacks[kLevels - 1]["mass_kg"]), core_kg + 4 * 80.0, 0.1);
  EXPECT_LT(double(stacks[kLevels]["propellant_kg"]), burnt_out);
}

TEST(CliProgram, ModesShowsEachPlaneOfAStackThatIsStifferInOne) {
  const InputFiles files;
  std::string vehicle = TextOfFile(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  for (const auto& [from, to] : {std::pair{"based_on: ", "based_on: " DISPERSA_CAMPAIGNS "/vehicles/"},
                                 {"poisson_ratio: 0.3}", "poisson_ratio: 0.3, z_to_y_stiffness: 2}"}})
    vehicle.replace(vehicle.find(from), std::string(from).size(), to);
  files.Write("stiffer.yaml", vehicle);
  const std::vector<std::string> lines = Lines(Dispersa("modes " + files.Path("stiffer.yaml")).text);
  const auto first_hz = [&](const std::string& head) {
    const auto at = std::find(lines.begin(), lines.end(), head);
    if (lines.end() - at < 3) return 0.0;
    std::istringstream row(at[2]);
    double propellant_kg = 0.0, hz = 0.0;
    row >> propellant_kg >> hz;
    return hz;
  };
  EXPECT_GT(first_hz("stage 1 and above, plane y"), 1.0);
  EXPECT_GT(first_hz("stage 1 and above, plane z"), 1.02 * first_hz("stage 1 and above, plane y"));
}

TEST(CliProgram, ModesOfARigidOrWrongVehicleAreBadInput) {
  const InputFiles files;
  const Output rigid = Dispersa("modes " + files.Path("vehicle.yaml"));
  EXPECT_EQ(rigid.code, 2);
  EXPECT_EQ(rigid.text, "");
  EXPECT_EQ(rigid.error, files.Path("vehicle.yaml") +
                             ":1:1: the vehicle is rigid, allowed: a vehicle with a structure_beam\n");
  files.Edit("flexible.yaml", "thickness_mm: 4", "thickness_mm: 501");
  EXPECT_EQ(Dispersa("modes " + files.Path("flexible.yaml")).code, 2);
  EXPECT_EQ(Dispersa("modes " + files.Path("none.yaml")).code, 2);
  EXPECT_EQ(Dispersa("modes").code, 2);
  EXPECT_EQ(Dispersa("modes " + std::string(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml") +
                     " --out /dev/null/x")
                .code,
            2);
}

TEST(CliProgram, ValidateSaysWhatIsWrongAndWhere) {
  const InputFiles files;
  const Output valid =
      Dispersa("validate --quiet " + files.Path("autopilot.yaml") + " " + files.Path("reference.yaml"));
  EXPECT_EQ(valid.code, 0);
  EXPECT_EQ(valid.text, "");
  const std::string two = files.Path("campaign.yaml") + " " + files.Path("autopilot.yaml");
  EXPECT_THAT(Dispersa("validate " + two).text,
              testing::EndsWith(files.Path("campaign.yaml") + ": valid\n" + files.Path("autopilot.yaml") +
                                ": valid\n"));
  files.Edit("campaign.yaml", "cases: 100", "cases: many");
  const Output invalid = Dispersa("validate " + two);
  EXPECT_EQ(invalid.code, 2);
  EXPECT_EQ(invalid.text,
            files.Path("campaign.yaml") +
                ":6:40: sampling.cases: 'many' is not a number, allowed: a whole number from 1 to "
                "4294967295\n" +
                files.Path("autopilot.yaml") + ": valid\n");
}

const std::string kVehicle = DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml";

TEST(CliProgram, ValidateShowsWhatAVehicleAmountsTo) {
  const Output output = Dispersa("validate --strict " + kVehicle);
  EXPECT_EQ(output.code, 0) << output.text;
  EXPECT_THAT(output.text, StartsWith(kVehicle + ": valid\n\nslv4: 31340 kg, 27 m\n"));
  const std::vector<std::string> lines = Lines(output.text);
  ASSERT_LE(lines.size(), 24u) << "one screen";
  for (const std::string& line : lines) EXPECT_LE(line.size(), 120u);
  // Table 1's stage 4: 30 kN for 46.9 s from 540 kg, 370 kg left.
  EXPECT_EQ(
      lines[8],
      "stage4               910         540       370     0.407      30.0     46.9    265.7       2345      "
      "3.36     8.27");
  EXPECT_EQ(lines.back(),
            "limits: q_max_pa 120000, q_alpha_max_pa_rad 6000, axial_load_max_g 12, lateral_load_max_g 1.5");
  const auto json = nlohmann::json::parse(Dispersa("validate --json " + kVehicle).text);
  EXPECT_EQ(json["warnings"].size(), 0u);
  ASSERT_EQ(json["vehicles"].size(), 1u);
  EXPECT_NEAR(json["vehicles"][0]["stages"][3]["specific_impulse_s"], 30e3 * 46.9 / (540 * 9.80665), 1e-9);
}

TEST(CliProgram, ValidateWarnsAndStrictTakesItForAnError) {
  const InputFiles files;
  const std::string warning =
      "warning: " + files.Path("vehicle.yaml") +
      ":12:12: stages[0].grain: implies a propellant density of 663.1 kg/m3, usual: 1500 to 1950 "
      "kg/m3 (solid propellants: Sutton and Biblarz, table 12-1)\n";
  const Output output = Dispersa("validate " + files.Path("vehicle.yaml"));
  EXPECT_EQ(output.code, 0);
  EXPECT_THAT(output.text, StartsWith(warning));
  EXPECT_THAT(output.text, HasSubstr("vehicle.yaml: valid\n"));
  const Output strict = Dispersa("validate --strict " + files.Path("vehicle.yaml"));
  EXPECT_EQ(strict.code, 2);
  EXPECT_THAT(strict.text, StartsWith(warning));
  EXPECT_THAT(strict.text, Not(HasSubstr("valid\n")));
  const auto json =
      nlohmann::json::parse(Dispersa("validate --json --strict " + files.Path("vehicle.yaml")).text);
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["errors"].size(), 0u);
  EXPECT_EQ(json["warnings"].size(), 2u);
  EXPECT_EQ(json["warnings"][0]["line"], 12);
  // Commands that fly it print it once, on stderr.
  const Output plan = Dispersa("plan --cases 1 " + files.Path("campaign.yaml"));
  EXPECT_EQ(plan.code, 0) << plan.error;
  EXPECT_EQ(plan.error.find("warning: " + files.Path("vehicle.yaml") + ":12:12: "),
            plan.error.rfind("warning: " + files.Path("vehicle.yaml") + ":12:12: "));
  EXPECT_THAT(plan.error, HasSubstr("implies a propellant density of 663.1 kg/m3"));
}

TEST(CliProgram, TonsTypedForKilogramsAreRefusedByEveryCommand) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "liftoff_mass_ton: 3\n    propellant_mass_kg: 1500",
             "liftoff_mass_ton: 3\n    propellant_mass_kg: 1.5");
  for (const std::string command : {"plan", "fly", "optimize", "margins", "run --workers 0", "validate"}) {
    const Output output = Dispersa(command + " " + files.Path("campaign.yaml"));
    EXPECT_EQ(output.code, 2) << command;
    EXPECT_THAT(output.error + output.text,
                StartsWith(files.Path("vehicle.yaml") +
                           ":8:25: stages[0].propellant_mass_kg: implies with thrust and "
                           "burning time a specific impulse of 244732 s, which cannot be, "
                           "allowed: up to 1000 s ("))
        << command;
  }
}

TEST(CliProgram, ValidateDrawsAVehicleToScale) {
  const InputFiles files;
  const std::string picture = files.Path("slv4.svg");
  const Output output = Dispersa("validate --picture " + picture + " " + kVehicle);
  EXPECT_EQ(output.code, 0) << output.error;
  EXPECT_EQ(Lines(output.text).back(), "picture: " + picture);
  const std::string svg = TextOfFile(picture);
  EXPECT_THAT(svg, StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1200 "));
  // 27 m are 1080 px: stage 1's grain from 16.5 m, 9.56 m long, 1.26 m thick.
  EXPECT_THAT(
      svg, HasSubstr("<rect class=\"grain\" x=\"720.00\" y=\"78.80\" width=\"382.40\" height=\"50.40\"/>"));
  for (const char* name : {"stage1", "stage2", "stage3", "stage4"})
    EXPECT_THAT(svg, HasSubstr(">" + std::string(name) + "</text>"));
  EXPECT_EQ(Dispersa("validate --picture " + picture + " " + kSmoke).code, 0) << "a campaign's vehicle";
  const Output none = Dispersa("validate --picture " + picture + " " + files.Path("autopilot.yaml"));
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.error, "--picture: " + files.Path("autopilot.yaml") +
                            " has no vehicle to draw, allowed: a vehicle or a campaign\n");
}

TEST(CliProgram, OutputsAreTriedBeforeAnythingIsComputed) {
  const InputFiles files;
  const std::string nowhere = files.Path("none/out");
  const std::string why = " cannot be written: there is no folder " + files.Path("none") +
                          ", allowed: a file in a folder that exists\n";
  // Were it flown first, tuning and optimising would outlast the test.
  for (const auto& [command, option] : std::vector<std::pair<std::string, std::string>>{
           {"tune " DISPERSA_CAMPAIGNS "/table3.yaml --cases 10000 --out ", "--out"},
           {"search " + kSmoke + " --flights 1000000 --out ", "--out"},
           {"fly " + kSmoke + " --history ", "--history"},
           {"fly " DISPERSA_CAMPAIGNS "/scenarios/nesc_case09.yaml --history ", "--history"},
           {"validate " + kVehicle + " --picture ", "--picture"}}) {
    const Output output = Dispersa(command + nowhere);
    EXPECT_EQ(output.code, 2) << command;
    EXPECT_EQ(output.error, option + ": " + nowhere + why) << command;
    EXPECT_EQ(output.text, "") << command;
  }
  const Output optimize =
      Dispersa("optimize " DISPERSA_CAMPAIGNS "/slv4_500km.yaml --out " + nowhere + ".yaml");
  EXPECT_EQ(optimize.code, 2);
  EXPECT_EQ(optimize.error, "--out: " + nowhere + ".yaml" + why);
  const Output folder = Dispersa("tune " + kSmoke + " --out " + files.Path("."));
  EXPECT_EQ(folder.code, 2);
  EXPECT_EQ(folder.error,
            "--out: " + files.Path(".") + " cannot be written: it is a folder, allowed: a file\n");
  const Output paper = Dispersa("paper --out " + files.Path("vehicle.yaml/paper"));
  EXPECT_EQ(paper.code, 2);
  EXPECT_EQ(paper.error, "--out: " + files.Path("vehicle.yaml/paper") +
                             " cannot be written: " + files.Path("vehicle.yaml") +
                             ": Not a directory, allowed: an existing or new folder that can be written\n");
}

TEST(CliProgram, ASearchThatMissesItsTargetWritesWhatItFound) {
  const InputFiles files;
  std::string campaign = TextOfFile(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = campaign.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    campaign.replace(at, from.size(), to);
  };
  replace("vehicle: vehicles", "vehicle: " DISPERSA_CAMPAIGNS "/vehicles");
  replace("autopilot: autopilots", "autopilot: " DISPERSA_CAMPAIGNS "/autopilots");
  replace("velocity_m_s: 7612.6", "velocity_m_s: 9900");
  replace("population: 60", "population: 8");
  replace("generations: 60", "generations: 2");
  files.Write("far.yaml", campaign);
  const Output output = Dispersa("--quiet --json optimize " + files.Path("far.yaml") + " --out " +
                                 files.Path("far_reference.yaml"));
  EXPECT_EQ(output.code, 3) << output.error;
  const auto json = nlohmann::json::parse(output.text);
  EXPECT_EQ(json["reached"], false);
  EXPECT_EQ(json["reference"], files.Path("far_reference.yaml"));
  EXPECT_THAT(TextOfFile(files.Path("far_reference.yaml")), HasSubstr("\ntarget_missed: "));
  EXPECT_THAT(TextOfFile(files.Path("far_reference.html")), HasSubstr("The target is missed: "));
  EXPECT_EQ(Dispersa("validate " + files.Path("far_reference.yaml")).code, 0);
  std::string flown = TextOfFile(kSmoke);
  flown.replace(flown.find("references/"), std::string("references/slv4_500km.yaml").size(),
                files.Path("far_reference.yaml"));
  flown.replace(flown.find("vehicles/"), 0, DISPERSA_CAMPAIGNS "/");
  flown.replace(flown.find("autopilots/"), 0, DISPERSA_CAMPAIGNS "/");
  files.Write("flown.yaml", flown);
  const Output plan = Dispersa("plan --cases 1 " + files.Path("flown.yaml"));
  EXPECT_EQ(plan.code, 0) << plan.error;
  EXPECT_THAT(plan.error, HasSubstr("target_missed: the reference misses its own target: "));
}

TEST(CliProgram, ValidateAsJson) {
  const InputFiles files;
  EXPECT_EQ(
      Dispersa("--json validate " + files.Path("autopilot.yaml")).text,
      "{\n  \"schema\": \"dispersa/validate/1\",\n  \"valid\": true,\n  \"errors\": [],\n  \"warnings\": "
      "[],\n  \"vehicles\": []\n}\n");
  const Output missing = Dispersa("validate --json nothing.yaml");
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(
      missing.text,
      "{\n  \"schema\": \"dispersa/validate/1\",\n  \"valid\": false,\n  \"errors\": [\n    {\n"
      "      \"file\": \"nothing.yaml\",\n      \"line\": 1,\n      \"column\": 1,\n      \"path\": \"\",\n"
      "      \"message\": \"file not found\",\n"
      "      \"allowed\": \"a file that exists\"\n    }\n  ],\n  \"warnings\": [],\n  \"vehicles\": []\n}\n");
}

TEST(CliProgram, PlanPrintsTheInputsThatAFlightApplies) {
  const Output plan = Dispersa("plan --csv --cases 4 " + kSmoke);
  ASSERT_EQ(plan.code, 0) << plan.error;
  const std::vector<std::string> lines = Lines(plan.text);
  ASSERT_EQ(lines.size(), 5u);
  const std::vector<std::string> names = Cells(lines[0]);
  const std::vector<std::string> values = Cells(lines[4]);
  ASSERT_EQ(names.size(), 21u + 1) << "those that smoke.yaml sets";
  ASSERT_EQ(values.size(), names.size());
  EXPECT_EQ(names[0], "case_index");
  EXPECT_EQ(values[0], "3");
  const Output flight = Dispersa("fly --case 3 " + kSmoke);
  ASSERT_EQ(flight.code, 0) << flight.error;
  int dispersed = 0;
  for (const std::string& line : Lines(flight.text)) {
    if (!line.starts_with("input_")) continue;
    const std::string name = line.substr(0, line.find(' '));
    const std::string value = line.substr(line.rfind(' ') + 1);
    const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    ASSERT_LT(place, names.size()) << name;
    EXPECT_NEAR(std::stod(values[place]), std::stod(value), 1e-4 * std::fabs(std::stod(value))) << name;
    ++dispersed;
  }
  EXPECT_GT(dispersed, 10);
}

TEST(CliProgram, PlanShowsEveryCaseAndWhatWasDrawnOfEachInputInLinesOfATerminal) {
  const Output plan = Dispersa("plan --all --cases 200 " + kSmoke);
  ASSERT_EQ(plan.code, 0) << plan.error;
  const std::vector<std::string> lines = Lines(plan.text);
  EXPECT_THAT(lines[0], StartsWith("smoke: 200 cases, seed "));
  int blocks = 0, last_cases = 0, inputs = 0;
  for (const std::string& line : lines) {
    EXPECT_LE(line.size(), 110u) << line;
    blocks += line.starts_with("case ");
    last_cases += line.starts_with("case ") && line.ends_with(" 199");
    inputs += blocks == 0 && line.starts_with("  ");
  }
  EXPECT_GT(blocks, 10);
  EXPECT_EQ(last_cases, 1);
  EXPECT_GT(inputs, 10);
  EXPECT_THAT(plan.text, HasSubstr(" of all " + std::to_string(inputs) + " that can be judged.\n"));
  EXPECT_THAT(plan.text, Not(HasSubstr("DO NOT AGREE")));
}

TEST(CliProgram, ReportTakesItsEnvelopeFromAsManyFlightsAsItIsTold) {
  const InputFiles folder;
  const std::string out = folder.Path("result");
  ASSERT_EQ(Dispersa("run --workers 0 --no-histories --quiet --cases 9 --out " + out + " " + kSmoke).code, 4);
  const auto flights = [&](const std::string& envelope) {
    EXPECT_EQ(Dispersa("report --quiet --envelope " + envelope + " " + out).code, 4);
    return nlohmann::json::parse(TextOfFile(out + "/summary.json"))["envelope"]["flights"].get<int>();
  };
  EXPECT_EQ(flights("4"), 4);
  EXPECT_EQ(flights("all"), 9);
  EXPECT_THAT(Dispersa("replay --json --case 0 " + out).text,
              StartsWith("{\n  \"schema\": \"dispersa/replay/1\",\n"));
  EXPECT_EQ(Dispersa("report --envelope 0 " + out).code, 2);
  EXPECT_EQ(Dispersa("report --envelope many " + out).code, 2);
}

TEST(CliProgram, FlyRepeatsToTheLastBit) {
  const Output first = Dispersa("fly --json --case 1 " + kSmoke);
  ASSERT_EQ(first.code, 0) << first.error;
  EXPECT_THAT(first.text,
              StartsWith("{\n  \"schema\": \"dispersa/fly/1\",\n  \"outcome\": \"completed\",\n"));
  EXPECT_THAT(first.text, Not(HasSubstr("-0.0,")));
  for (const std::size_t i : MetricsUnder(kUsualStages, ControlLaw::kAdaptiveFuzzy))
    EXPECT_THAT(first.text, HasSubstr("\"" + MetricNames()[i] + "\": "));
  EXPECT_EQ(Dispersa("fly --json --case 1 " + kSmoke).text, first.text);
  EXPECT_NE(Dispersa("fly --json --case 1 --seed 5 " + kSmoke).text, first.text);
}

TEST(CliProgram, FlyWritesTheHistoryInTheOrderOfTheContract) {
  const InputFiles folder;
  const std::string file = folder.Path("history.csv");
  ASSERT_EQ(Dispersa("fly " + kSmoke + " --history " + file).code, 0);
  const std::vector<std::string> lines = Lines(TextOfFile(file));
  ASSERT_GT(lines.size(), 25000u);  // every tick of a flight of ten minutes: 100 a second, 20 while it coasts
  EXPECT_THAT(lines[0],
              StartsWith("time_s,eci_x_m,eci_y_m,eci_z_m,eci_vx_m_s,eci_vy_m_s,eci_vz_m_s,ned_v_n_m_s,"
                         "ned_v_e_m_s,ned_v_d_m_s,altitude_m,latitude_deg,longitude_deg,yaw_deg,pitch_deg,"
                         "roll_deg,p_deg_s,q_deg_s,r_deg_s,mach,qbar_pa,alpha_deg,beta_deg,mass_kg,"));
  const std::size_t columns = Cells(lines[0]).size();
  for (const std::string& line : lines) {
    ASSERT_EQ(Cells(line).size(), columns) << line;
    ASSERT_THAT(line, Not(HasSubstr("nan")));
    ASSERT_THAT(line, Not(HasSubstr(",-0,")));
  }
}

TEST(CliProgram, FlyScenario) {
  const InputFiles folder;
  const std::string scenario = DISPERSA_CAMPAIGNS "/scenarios/nesc_case09.yaml";
  const Output output = Dispersa("fly " + scenario + " --json --history " + folder.Path("history.csv"));
  EXPECT_EQ(output.code, 0) << output.error;
  EXPECT_THAT(output.text,
              StartsWith("{\n  \"schema\": \"dispersa/fly/1\",\n  \"scenario\": \"nesc_case09\",\n"
                         "  \"outcome\": \"completed\",\n  \"end_time_s\": 30.0,\n"));
  const std::vector<std::string> rows = Lines(TextOfFile(folder.Path("history.csv")));
  ASSERT_EQ(rows.size(), 32u);  // a header, and every second from 0 to 30
  EXPECT_EQ(Cells(rows[0]), KinematicColumnNames());
  EXPECT_EQ(Cells(rows[1])[0], "0");
  EXPECT_EQ(Cells(rows[31])[0], "30");
  // The metrics are the last row.
  EXPECT_THAT(output.text, HasSubstr("\"final_altitude_m\": " + Cells(rows[31])[10] + ","));

  const Output with_case = Dispersa("fly " + scenario + " --case 0");
  EXPECT_EQ(with_case.code, 2);
  EXPECT_EQ(with_case.error,
            "--case, --seed: a scenario has no cases, allowed: a campaign file with these options\n");
}

// Greensite's launch vehicle: what was published of it (tests/data/greensite/SOURCE.md).
TEST(CliProgram, MarginsOfAPublishedLauncher) {
  const std::string campaign = DISPERSA_TEST_DATA "/greensite/campaign.yaml";
  const auto at_end = [](const Output& output) {
    const auto json = nlohmann::json::parse(output.text);
    for (const auto& m : json["computed"])
      if (m["place"] == "stage 1 burnout" && m["axis"] == "pitch") return m["frozen"];
    return nlohmann::json();
  };
  const Output passed = Dispersa("margins " + campaign + " --frequency-band 0 --drift --cases 2 --json");
  EXPECT_EQ(passed.code, 0) << passed.error;
  const auto dispersed = nlohmann::json::parse(passed.text)["dispersed"];
  EXPECT_EQ(dispersed["cases"], 2);
  ASSERT_EQ(dispersed["least"].size(), 3u);  // axes of the one stage
  EXPECT_EQ(dispersed["least"][2]["stage"], 1);
  EXPECT_EQ(dispersed["least"][2]["axis"], "roll");
  EXPECT_EQ(nlohmann::json::parse(passed.text)["drift"], true);
  EXPECT_EQ(nlohmann::json::parse(passed.text)["frequency_band_percent"], 0.0);
  const auto notch = at_end(passed);
  EXPECT_NEAR(notch["gain_up_db"].get<double>(), 7.56, 0.02);
  EXPECT_NEAR(notch["phase_deg"].get<double>(), 30.0, 0.5);
  EXPECT_NEAR(notch["delay_ms"].get<double>(), 165.0, 1.0);

  // The notch stands on the mode's exact frequency.
  const Output band = Dispersa("margins " + campaign);
  EXPECT_EQ(band.code, 3);
  EXPECT_THAT(band.text, HasSubstr("15 % lower and higher, all together and each mode alone"));

  const Output bare =
      Dispersa("margins " + campaign +
               " --autopilot " DISPERSA_TEST_DATA "/greensite/no_filter_june.yaml --frequency-band 0 --json");
  EXPECT_EQ(bare.code, 3);
  EXPECT_EQ(at_end(bare)["stable"], false);
  EXPECT_NEAR(at_end(bare)["bending_peak_db"].get<double>(), 39.0, 0.5);
  EXPECT_EQ(Dispersa("margins " + campaign + " --frequency-band 80").code, 2);
}

TEST(CliProgram, TuneWritesAnAutopilotThatSaysWhereItComesFrom) {
  const InputFiles folder;
  const std::string file = folder.Path("tuned.yaml");
  // The smallest budget that there is.
  const std::string budget = " --seed 9 --cases 1 --evaluations 64";
  const Output tuned =
      Dispersa("--quiet tune " + kSmoke +
               " --autopilot " DISPERSA_CAMPAIGNS "/autopilots/adaptive_fuzzy.yaml --out " + file + budget);
  ASSERT_EQ(tuned.code, 0) << tuned.error;
  EXPECT_THAT(tuned.text, HasSubstr("generation  feasible  best rms deg"));
  EXPECT_THAT(tuned.text, HasSubstr("\nautopilot: " + file + "\n"));
  const std::string text = TextOfFile(file);
  EXPECT_THAT(text, HasSubstr("# Tuned by\n#   dispersa tune " + kSmoke + " --autopilot "));
  EXPECT_THAT(text, HasSubstr(" --out " + file + budget + "\n"));
  EXPECT_THAT(text, HasSubstr("\nname: adaptive_fuzzy\n"));
  for (const std::string& line : Lines(text)) {
    if (!line.starts_with("#   dispersa")) {
      EXPECT_LE(line.size(), 108u) << line;
    }
  }
  EXPECT_EQ(Dispersa("validate " + file).code, 0);
}

// Motors with transients and tail-off: SLV-4's with made-up curves.
TEST(CliProgram, MarginsAndTuneNameWhatTheySkip) {
  const std::string campaign = DISPERSA_TEST_DATA "/thrust_curves/campaign.yaml";
  EXPECT_EQ(Dispersa("validate " + campaign).code, 0);
  const Output margins = Dispersa("margins " + campaign);
  EXPECT_THAT(margins.text, HasSubstr("Skipped, with less than 20 % of full thrust:\n(between) "));
  EXPECT_THAT(margins.text, HasSubstr("stage 4 burnout"));
  EXPECT_THAT(margins.text, HasSubstr("\nRIGID-BODY MARGINS: no bending modes, no slosh.\n"));
  const InputFiles folder;
  const std::string file = folder.Path("tuned.yaml");
  const std::string tune = "tune " + campaign +
                           " --autopilot " DISPERSA_CAMPAIGNS
                           "/autopilots/pd.yaml --seed 9 --cases 1 --evaluations 64 --out " +
                           file;
  const Output tuned = Dispersa("--quiet " + tune);
  EXPECT_EQ(tuned.code, 0) << tuned.error << tuned.text;
  EXPECT_THAT(tuned.text, HasSubstr("No margins are required below 20 % of full thrust:\n"));
  EXPECT_THAT(TextOfFile(file), HasSubstr(" instants with less than 20 % of full thrust.\n"));
  const auto skipped = nlohmann::json::parse(Dispersa("--quiet --json " + tune).text)["skipped"];
  ASSERT_EQ(skipped.size(), 5u);
  EXPECT_EQ(skipped[0]["stage"], 1);
  EXPECT_NEAR(skipped[0]["thrust_percent"].get<double>(), 13.697, 1e-3);
}

// Pitch's nozzles answer after a third of a second.
TEST(CliProgram, TuneNamesTheGateThatItMisses) {
  const InputFiles folder;
  std::string vehicle = TextOfFile(DISPERSA_TEST_DATA "/thrust_curves/vehicle.yaml");
  for (std::size_t at = 0; (at = vehicle.find("delay_ticks: 1", at)) != std::string::npos; ++at)
    vehicle.replace(at, 14, "delay_ticks: 33");
  const auto point_to = [&](std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  point_to(vehicle, "../../../campaigns", DISPERSA_CAMPAIGNS);
  point_to(vehicle, "table: ", "table: " DISPERSA_TEST_DATA "/thrust_curves/");
  folder.Write("vehicle.yaml", vehicle);
  std::string campaign = TextOfFile(DISPERSA_TEST_DATA "/thrust_curves/campaign.yaml");
  point_to(campaign, "../../../campaigns", DISPERSA_CAMPAIGNS);
  folder.Write("campaign.yaml", campaign);
  const std::string file = folder.Path("tuned.yaml");
  const Output tuned = Dispersa("--quiet --json tune " + folder.Path("campaign.yaml") +
                                " --autopilot " DISPERSA_CAMPAIGNS
                                "/autopilots/pd.yaml --seed 9 --cases 1 --evaluations 64 --out " +
                                file);
  EXPECT_EQ(tuned.code, 3) << tuned.error;
  const auto json = nlohmann::json::parse(tuned.text);
  const std::string missed = json["stages"][0]["missed"];
  EXPECT_THAT(missed, testing::MatchesRegex("(gain|phase|delay) margin .* are needed: .*% of full thrust"));
  EXPECT_THAT(TextOfFile(file), HasSubstr("\n# Stage 1 misses by most: " + missed + "\n"));
}

TEST(CliProgram, TuneRefusesTheSeedOfTheVerdict) {
  const InputFiles folder;
  const std::string file = folder.Path("tuned.yaml");
  const Output output = Dispersa("tune " + kSmoke + " --out " + file + " --seed 20260101");
  EXPECT_EQ(output.code, 2);
  EXPECT_EQ(output.error,
            "seed: the tuning would fly the cases of campaign 'smoke', allowed: any but the campaign's own, "
            "20260101\n");
  EXPECT_EQ(TextOfFile(file), "");
}

}  // namespace
}  // namespace dispersa::cli_program_test
