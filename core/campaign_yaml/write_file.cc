#include "core/campaign_yaml/describe_file.h"
#include "core/campaign_yaml/load.h"
#include "core/input/field_writer.h"

namespace dispersa {

std::string WriteReference(const Reference& reference) {
  const FileLayout layout = {.on_one_line = {"target", "weights", "orbit", "errors", "provenance"},
                             .always = {"constraints", "enforced"},
                             .length_unit = "km",
                             .quotes_all_texts = true};  // names come from other files and may hold anything
  Reference written = reference;
  // If the target does not name these, no reader needs them.
  if (!reference.problem.target_node_rad) written.orbit.node_longitude_rad = 0.0;
  if (!reference.problem.target_argument_of_perigee_rad) written.orbit.argument_of_latitude_rad = 0.0;
  return WriteFields(layout, [&](Fields& fields) { DescribeReferenceFile(fields, written); });
}

std::string WriteAutopilot(const AutopilotConfig& autopilot) {
  const FileLayout layout = {.on_one_line = {"feed_forward", "rules", "reaction_control"},
                             .always = {"weight"}};
  AutopilotConfig written = autopilot;
  return WriteFields(layout, [&](Fields& fields) { DescribeAutopilotFile(fields, written, {}); });
}

}  // namespace dispersa
