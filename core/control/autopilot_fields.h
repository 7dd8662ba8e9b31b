// The keys of an autopilot's file, declared once.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/input/fields.h"

namespace dispersa {

/// Completes a plug-in of which digest and bytes (base64), or name and digest of a law in Python, were read:
/// what the law says of itself. Returns the names of its parameters, or nothing after a refusal; `fields`
/// are the plug-in's, or the Python law's.
using OpenPlugin = std::function<std::optional<std::vector<std::string>>(
    Fields& fields, const std::string& base64, PluginConfig& plugin)>;

/// The keys but for `schema`.
void Describe(Fields& fields, AutopilotConfig& autopilot, const OpenPlugin& open);

}  // namespace dispersa
