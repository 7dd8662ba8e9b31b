#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/sha256.h"
#include "core/containment/foreign_process.h"
#include "core/control/law_here.h"
#include "core/input/struct_problems.h"

namespace dispersa {
namespace {

// What a campaign that was flown under a law in Python says of it. No file of a user's own has it.
void OpenPythonLaw(Fields& fields, PythonLaws laws, PluginConfig& plugin) {
  if (!IsSha256Hex(plugin.sha256)) {
    fields.Refuse("sha256", "is no SHA-256", "64 hexadecimal digits");
  } else if (std::optional<PluginConfig> here = OfferedLaw(plugin.sha256)) {
    plugin.library = std::move(here->library);
    plugin.parameters = std::move(here->parameters);
  } else if (laws == PythonLaws::kMustBeHere) {
    fields.Refuse("",
                  "flown with a Python law, '" + plugin.name +
                      "', which is not in the file: without it the campaign cannot be flown",
                  "dispersa.run(..., workers=0, law=...) in Python, with that law");
  }
}

// What is wrong with the object, or what it says of itself.
std::optional<PluginDescription> DescribeLibrary(Fields& fields, PluginConfig& plugin) {
  const auto refuse = [&fields](const std::string& why, const char* allowed = "") {
    fields.Refuse("library", "the control law " + why, allowed);
    return std::nullopt;
  };
  if (const std::string refusal = PluginRefusal(plugin.sha256); !refusal.empty()) return refuse(refusal);
  try {
    return DescribePlugin(plugin);
  } catch (const std::runtime_error& error) {
    return refuse(error.what(), "a shared object with the functions of dispersa/control_law.h");
  }
}

// Asks a plug-in, in a process of its own, what it says of itself.
OpenPlugin PluginOpener(PythonLaws laws) {
  return [laws](Fields& fields, const std::string& base64,
                PluginConfig& plugin) -> std::optional<std::vector<std::string>> {
    if (plugin.in_python) {
      OpenPythonLaw(fields, laws, plugin);
      return std::nullopt;
    }
    if (base64.empty()) return std::nullopt;  // a file that could not be read
    std::optional<std::string> bytes = FromBase64(base64);
    if (!bytes) {
      fields.Refuse("library.base64", "is not base64 (RFC 4648)", "");
      return std::nullopt;
    }
    if (const std::string sha256 = Sha256Hex(*bytes); sha256 != plugin.sha256) {
      fields.Refuse("library.sha256", "is not that of the bytes beside it", sha256);
      return std::nullopt;
    }
    plugin.library = std::make_shared<const std::string>(*std::move(bytes));
    const std::optional<PluginDescription> description = DescribeLibrary(fields, plugin);
    if (!description) return std::nullopt;
    plugin.name = description->name;
    plugin.version = description->version;
    return description->parameters;
  };
}

}  // namespace

AutopilotConfig DecodeAutopilot(InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems, FileSource* files, PythonLaws laws) {
  const std::size_t before = problems.size();
  AutopilotConfig autopilot;
  if (node.file == nullptr) return autopilot;  // already reported
  ReadFields(node, path, problems, files,
             [&](Fields& fields) { DescribeAutopilotFile(fields, autopilot, PluginOpener(laws)); });
  if (stages == 0) stages = static_cast<int>(autopilot.pitch.gains.size());
  if (problems.size() == before) AddStructProblems(Problems(autopilot, stages), node, path, problems);
  return autopilot;
}

}  // namespace dispersa
