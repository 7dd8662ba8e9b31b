#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/control/autopilot_fields.h"
#include "core/input/field_reader.h"
#include "core/input/struct_problems.h"

namespace dispersa {

void DescribeAutopilotFile(Fields& fields, AutopilotConfig& autopilot, const Fields::ReadNode& plugin) {
  fields.Schema(kAutopilotSchema);
  Describe(fields, autopilot, plugin);
}

AutopilotConfig DecodeAutopilot(const InputNode& node, const std::string& path, int stages,
                                std::vector<InputProblem>& problems, PythonLaws laws) {
  const std::size_t before = problems.size();
  AutopilotConfig autopilot;
  if (node.file == nullptr) return autopilot;  // already reported
  if (!CheckSchema(node, kAutopilotSchema, !path.empty(), path, problems)) return autopilot;
  const auto read_plugin = [&](const InputNode& plugin, const std::string& plugin_path) {
    autopilot.plugin = DecodePlugin(plugin, plugin_path, laws, problems);
  };
  ReadFields(node, path, problems,
             [&](Fields& fields) { DescribeAutopilotFile(fields, autopilot, read_plugin); });
  if (stages == 0) stages = static_cast<int>(autopilot.pitch.gains.size());
  if (problems.size() == before) AddStructProblems(Problems(autopilot, stages), node, path, problems);
  return autopilot;
}

}  // namespace dispersa
