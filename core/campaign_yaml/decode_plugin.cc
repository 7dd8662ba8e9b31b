#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/text_problems.h"
#include "core/containment/contained.h"
#include "core/control/law_here.h"
#include "core/input/map_reader.h"

namespace dispersa {
namespace {

// The bytes of the library, or null.
std::shared_ptr<const std::string> DecodeLibrary(const InputNode& node, const std::string& path,
                                                 std::vector<InputProblem>& problems, std::string& sha256) {
  MapReader map(node, path, problems);
  const std::size_t before = problems.size();
  sha256 = map.Text("sha256");
  const std::string text = map.Text("base64");
  // What is missing is said at the end.
  if (problems.size() != before || node.Find("sha256") == nullptr || node.Find("base64") == nullptr)
    return nullptr;
  std::optional<std::string> bytes = FromBase64(text);
  if (!bytes) {
    AddProblem(problems, *node.Find("base64"), map.PathOf("base64"), "is not base64 (RFC 4648)");
  } else if (Sha256Hex(*bytes) != sha256) {
    AddProblem(problems, *node.Find("sha256"), map.PathOf("sha256"), "is not that of the bytes beside it",
               Sha256Hex(*bytes));
  } else {
    return std::make_shared<const std::string>(*std::move(bytes));
  }
  return nullptr;
}

bool IsUtf8(const PluginDescription& description) {
  std::string all = description.name + description.version;
  for (const std::string& name : description.parameters) all += name;
  std::vector<InputProblem> ignored;
  return CheckUtf8(all, "", ignored);
}

bool IsSha256(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// What a campaign that was flown under a law in Python says of it. No file of a user's own has it, so nobody
// who listens for keys hears of it.
PluginConfig DecodePythonLaw(const InputNode& node, const std::string& path, PythonLaws laws,
                             std::vector<InputProblem>& problems) {
  PluginConfig plugin;
  plugin.in_python = true;
  const std::size_t before = problems.size();
  {
    MapReader map(node, path, problems);
    plugin.name = map.Text("name");
    plugin.sha256 = map.Text("sha256");
  }
  if (problems.size() != before) return plugin;
  if (!IsSha256(plugin.sha256)) {
    AddProblem(problems, *node.Find("sha256"), path + ".sha256", "is no SHA-256", "64 hexadecimal digits");
  } else if (std::optional<PluginConfig> here = OfferedLaw(plugin.sha256)) {
    plugin.library = std::move(here->library);
    plugin.parameters = std::move(here->parameters);
  } else if (laws == PythonLaws::kMustBeHere) {
    AddProblem(problems, node, path,
               "flown with a Python law, '" + plugin.name +
                   "', which is not in the file: without it the campaign cannot be flown",
               "dispersa.run(..., workers=0, law=...) in Python, with that law");
  }
  return plugin;
}

}  // namespace

PluginConfig DecodePlugin(const InputNode& node, const std::string& path, PythonLaws laws,
                          std::vector<InputProblem>& problems) {
  if (const InputNode* python = node.Find("python"); python != nullptr && node.members.size() == 1)
    return DecodePythonLaw(*python, path + ".python", laws, problems);
  PluginConfig plugin;
  MapReader map(node, path, problems);
  const InputNode& library = map.Required("library", "the file name of a shared object");
  const InputNode* const parameters = map.Optional("parameters");
  if (library.kind == InputNode::Kind::kNull) return plugin;
  plugin.library = DecodeLibrary(library, map.PathOf("library"), problems, plugin.sha256);
  if (plugin.library == nullptr) return plugin;
  PluginDescription description;
  if (const std::string refusal = PluginRefusal(plugin.sha256); !refusal.empty()) {
    AddProblem(problems, library, map.PathOf("library"), "the control law " + refusal);
    return plugin;
  }
  try {
    description = DescribeContained(plugin);
  } catch (const std::runtime_error& error) {
    AddProblem(problems, library, map.PathOf("library"), std::string("the control law ") + error.what(),
               "a shared object with the functions of dispersa/control_law.h");
    return plugin;
  }
  if (!IsUtf8(description)) {
    AddProblem(problems, library, map.PathOf("library"),
               "the control law describes itself in bytes that are no UTF-8",
               "name, version, parameters in UTF-8");
    return plugin;
  }
  plugin.name = description.name;
  plugin.version = description.version;
  const InputNode empty = MapAt(node);
  MapReader values(parameters != nullptr ? *parameters : empty, map.PathOf("parameters"), problems);
  for (const std::string& name : description.parameters)
    plugin.parameters.emplace_back(name, values.Number(name, kAnyNumber));
  return plugin;
}

}  // namespace dispersa
