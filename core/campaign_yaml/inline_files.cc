#include "core/campaign_yaml/inline_files.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/parse_csv.h"
#include "core/campaign_yaml/parse_rasp.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/campaign_yaml/standard_input.h"
#include "core/input/map_reader.h"
#include "core/input/number_text.h"

namespace dispersa {
namespace {

// A campaign's text carries it to every worker.
constexpr std::size_t kLargestLibrary = std::size_t{32} << 20;

using Parse = std::function<InputNode(const std::string& text, const std::string& file)>;

// Replaces a scalar, a file's name, by what the file holds; leaves it if that is impossible.
void Replace(InputNode* value, const std::string& path, FileNames names, const Parse& parse,
             std::vector<InputProblem>& problems) {
  if (value == nullptr || value->kind != InputNode::Kind::kScalar) return;
  if (names == FileNames::kRefused) {
    AddProblem(problems, *value, path, "the file '" + value->text + "' is named in a text without files",
               "its contents in its place");
    *value = InputNode();
    return;
  }
  const std::string file =
      (std::filesystem::path(*value->file).parent_path() / value->text).lexically_normal().string();
  std::string text;
  std::string reason;
  if (value->text.empty()) {
    AddProblem(problems, *value, path, "the file name is empty", "a file name, relative to this file");
    *value = InputNode();
  } else if (!ReadFile(file, &text, &reason)) {
    AddProblem(problems, *value, path, "cannot read '" + file + "': " + reason,
               "a readable file, named relative to this one");
    *value = InputNode();
  } else {
    *value = parse(text, file);
  }
}

Parse YamlParser(std::vector<InputProblem>& problems) {
  return [&problems](const std::string& text, const std::string& file) {
    return ParseYaml(text, file, problems);
  };
}

Parse CsvParser(const std::vector<std::string>& columns, std::vector<InputProblem>& problems) {
  return [columns, &problems](const std::string& text, const std::string& file) {
    return ParseCsv(text, file, columns, problems);
  };
}

// A thrust curve is a CSV, or what hobby motors have: by the end of its name.
Parse ThrustCurveParser(std::vector<InputProblem>& problems) {
  return [&problems](const std::string& text, const std::string& file) {
    std::string end = std::filesystem::path(file).extension().string();
    for (char& c : end) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return end == ".eng" ? ParseRasp(text, file, problems)
                         : ParseCsv(text, file, kThrustCurveColumns, problems, {kFlowColumn});
  };
}

// The samples_* of an empirical distribution, anywhere among the dispersions, may be a file with that column.
void InlineSamples(InputNode& node, const std::string& path, FileNames names,
                   std::vector<InputProblem>& problems) {
  for (std::size_t i = 0; i < node.items.size(); ++i)
    InlineSamples(node.items[i], path + "[" + std::to_string(i) + "]", names, problems);
  for (InputMember& member : node.members) {
    const std::string member_path = path + "." + member.key;
    if (!member.key.starts_with("samples_")) {
      InlineSamples(member.value, member_path, names, problems);
    } else if (member.value.kind == InputNode::Kind::kScalar) {
      Replace(&member.value, member_path, names, CsvParser({member.key}, problems), problems);
      if (InputNode* column = member.value.Find(member.key)) {
        InputNode values = std::move(*column);
        member.value = std::move(values);
      }
    }
  }
}

// A coefficient or the mass properties of a scenario's stage may be a file's name.
void InlineStageFiles(InputNode& stage, const std::string& path, FileNames names,
                      std::vector<InputProblem>& problems) {
  Replace(stage.Find("mass_properties"), path + ".mass_properties", names,
          CsvParser(kMassTableColumns, problems), problems);
  InputNode* aerodynamics = stage.Find("aerodynamics");
  if (aerodynamics == nullptr) return;
  const auto replace = [&](const std::string& name, const std::vector<std::string>& columns) {
    InputNode* value = aerodynamics->Find(name);
    if (value == nullptr || value->kind != InputNode::Kind::kScalar || ParseNumber(value->text)) return;
    Replace(value, path + ".aerodynamics." + name, names, CsvParser(columns, problems), problems);
  };
  for (const char* name : {"ca", "cn", "xcp_station_m", "cd", "cl", "cm"})
    replace(name, {"mach", "incidence_deg", name});
  for (const char* name : {"clp", "cmq", "cnr"}) replace(name, {"mach", name});
}

// A vehicle that is based on another has the other's keys where it has none itself. It becomes an absent node
// if there is no other, so that nothing more is said about what it lacks.
void InlineBase(InputNode& vehicle, FileNames names, std::vector<InputProblem>& problems) {
  const auto is_base = [](const InputMember& member) { return member.key == "based_on"; };
  const auto found = std::find_if(vehicle.members.begin(), vehicle.members.end(), is_base);
  if (found == vehicle.members.end()) return;
  InputNode base = std::move(found->value);
  vehicle.members.erase(found);
  if (base.kind == InputNode::Kind::kScalar) {
    Replace(&base, "based_on", names, YamlParser(problems), problems);
    if (base.file == nullptr || !CheckSchema(base, kVehicleSchema, false, "", problems)) {
      vehicle = InputNode();
      return;
    }
  }
  if (base.kind != InputNode::Kind::kMap) {
    AddProblem(problems, base, "based_on", base.Describe() + " is not a vehicle",
               "the name of a vehicle file");
    vehicle = InputNode();
    return;
  }
  if (const InputNode* deeper = base.Find("based_on")) {
    AddProblem(problems, *deeper, "based_on", "the vehicle that another is based on is based on a third",
               "a vehicle file without based_on");
    vehicle = InputNode();
    return;
  }
  for (InputMember& member : base.members) {
    if (vehicle.Find(member.key) == nullptr) vehicle.members.push_back(std::move(member));
  }
}

}  // namespace

InputNode ReadYamlFile(const std::string& path, std::vector<InputProblem>& problems) {
  std::string text;
  std::string reason;
  // Without a folder, so that the names in it are relative to the current one.
  const std::string file = path == kStandardInput ? kStandardInputName : path;
  if (!(path == kStandardInput ? ReadStandardInput(&text, &reason) : ReadFile(path, &text, &reason))) {
    problems.push_back({file, 1, 1, "", "cannot be read: " + reason, "a readable file"});
    return {};
  }
  return ParseYaml(text, file, problems);
}

void InlineVehicleFiles(InputNode& vehicle, FileNames names, std::vector<InputProblem>& problems) {
  InlineBase(vehicle, names, problems);
  if (InputNode* beam = vehicle.Find("structure_beam"))
    Replace(beam->Find("modes_table"), "structure_beam.modes_table", names,
            CsvParser(kModeTableColumns, problems), problems);
  if (InputNode* stages = vehicle.Find("stages")) {
    for (std::size_t i = 0; i < stages->items.size(); ++i) {
      InputNode* motor = stages->items[i].Find("motor");
      InputNode* liquid = motor == nullptr ? nullptr : motor->Find("liquid");
      if (liquid != nullptr)
        Replace(liquid->Find("throttle"), "stages[" + std::to_string(i) + "].motor.liquid.throttle", names,
                CsvParser(kThrottleColumns, problems), problems);
      InputNode* curve = motor == nullptr ? nullptr : motor->Find("thrust_curve");
      if (curve != nullptr)
        Replace(curve->Find("table"), "stages[" + std::to_string(i) + "].motor.thrust_curve.table", names,
                ThrustCurveParser(problems), problems);
    }
  }
  InputNode* boosters = vehicle.Find("boosters");
  InputNode* boosting = boosters == nullptr ? nullptr : boosters->Find("motor");
  if (InputNode* curve = boosting == nullptr ? nullptr : boosting->Find("thrust_curve"))
    Replace(curve->Find("table"), "boosters.motor.thrust_curve.table", names, ThrustCurveParser(problems),
            problems);
  InputNode* aerodynamics = vehicle.Find("aerodynamics");
  InputNode* tables = aerodynamics == nullptr ? nullptr : aerodynamics->Find("tables");
  if (tables == nullptr) return;
  for (std::size_t i = 0; i < tables->items.size(); ++i) {
    Replace(tables->items[i].Find("table"), "aerodynamics.tables[" + std::to_string(i) + "].table", names,
            CsvParser(kAeroTableColumns, problems), problems);
  }
}

void InlineAutopilotFiles(InputNode& autopilot, const std::string& path, FileNames names,
                          std::vector<InputProblem>& problems) {
  InputNode* plugin = autopilot.Find("plugin");
  InputNode* library = plugin == nullptr ? nullptr : plugin->Find("library");
  if (library == nullptr) return;
  const InputNode place = *library;
  Replace(
      library, path + "plugin.library", names,
      [&](const std::string& bytes, const std::string& file) {
        if (bytes.empty() || bytes.size() > kLargestLibrary) {
          AddProblem(problems, place, path + "plugin.library",
                     "'" + file + "' " + (bytes.empty() ? "is empty" : "is larger than 32 MiB"),
                     "a shared object of at most 32 MiB");
          return InputNode();
        }
        InputNode inlined = MapAt(place);
        SetMember(inlined, "sha256", TextAt(place, Sha256Hex(bytes)));
        SetMember(inlined, "base64", TextAt(place, Base64(bytes)));
        return inlined;
      },
      problems);
}

void InlineCampaignFiles(InputNode& campaign, FileNames names, std::vector<InputProblem>& problems) {
  for (const char* key : {"vehicle", "reference", "autopilot"}) {
    Replace(campaign.Find(key), key, names, YamlParser(problems), problems);
  }
  if (InputNode* vehicle = campaign.Find("vehicle")) InlineVehicleFiles(*vehicle, names, problems);
  if (InputNode* autopilot = campaign.Find("autopilot"))
    InlineAutopilotFiles(*autopilot, "autopilot.", names, problems);
  if (InputNode* sampling = campaign.Find("sampling"))
    Replace(sampling->Find("table"), "sampling.table", names, CsvParser({}, problems), problems);
  InputNode* dispersions = campaign.Find("dispersions");
  if (dispersions != nullptr) InlineSamples(*dispersions, "dispersions", names, problems);
  InputNode* wind = dispersions == nullptr ? nullptr : dispersions->Find("wind_profile");
  if (wind == nullptr) return;
  Replace(wind->Find("table"), "dispersions.wind_profile.table", names,
          CsvParser(kWindTableColumns, problems), problems);
  Replace(wind->Find("statistics"), "dispersions.wind_profile.statistics", names,
          CsvParser(kWindStatisticsColumns, problems), problems);
}

void InlineScenarioFiles(InputNode& scenario, FileNames names, std::vector<InputProblem>& problems) {
  if (InputNode* wind = scenario.Find("wind"))
    Replace(wind->Find("table"), "wind.table", names, CsvParser(kWindTableColumns, problems), problems);
  if (InputNode* body = scenario.Find("body")) InlineStageFiles(*body, "body", names, problems);
  InputNode* stages = scenario.Find("stages");
  if (stages == nullptr) return;
  for (std::size_t i = 0; i < stages->items.size(); ++i)
    InlineStageFiles(stages->items[i], "stages[" + std::to_string(i) + "]", names, problems);
}

bool CheckSchema(const InputNode& node, const std::string& schema, bool inside, const std::string& path,
                 std::vector<InputProblem>& problems) {
  if (node.kind != InputNode::Kind::kMap) return true;  // its reader says so
  const InputNode* value = node.Find("schema");
  if (value == nullptr && inside) return true;
  const std::string allowed = "schema: " + schema;
  if (value == nullptr) {
    AddProblem(problems, node, path, "missing key 'schema'", allowed);
  } else if (value->text != schema) {
    AddProblem(problems, *value, path.empty() ? "schema" : path + ".schema",
               value->Describe() + " is not the schema of this kind of file", allowed);
  } else {
    return true;
  }
  return false;
}

}  // namespace dispersa
