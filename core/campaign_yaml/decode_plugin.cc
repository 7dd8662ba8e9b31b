#include "core/campaign/contained.h"
#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/yaml_reader.h"

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
  if (problems.size() != before || node.Find("sha256") == nullptr || node.Find("base64") == nullptr) return nullptr;
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

}  // namespace

PluginConfig DecodePlugin(const InputNode& node, const std::string& path,
                          std::vector<InputProblem>& problems) {
  PluginConfig plugin;
  MapReader map(node, path, problems);
  const InputNode& library = map.Required("library", "the file name of a shared object");
  const InputNode* const parameters = map.Optional("parameters");
  SayExpects(map.PathOf("parameters"), {.kind = Expectation::Kind::kNumbers});  // the library says which
  if (library.kind == InputNode::Kind::kNull) return plugin;
  plugin.library = DecodeLibrary(library, map.PathOf("library"), problems, plugin.sha256);
  if (plugin.library == nullptr) return plugin;
  PluginDescription description;
  if (!PluginRefusal().empty()) {
    AddProblem(problems, library, map.PathOf("library"), "the control law " + PluginRefusal());
    return plugin;
  }
  try {
    description = DescribeContained(plugin);
  } catch (const std::runtime_error& error) {
    AddProblem(problems, library, map.PathOf("library"), std::string("the control law ") + error.what(),
               "a shared object with the functions of dispersa/control_law.h");
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
