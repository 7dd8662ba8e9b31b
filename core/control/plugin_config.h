// A control law from a shared object, as an autopilot file names it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dispersa {

/// What an autopilot file says of it. The object is its bytes: where they came from does not matter.
struct PluginConfig {
  std::shared_ptr<const std::string> library;
  std::string sha256;         ///< of the bytes
  std::string name, version;  ///< what it says of itself
  /// A function of Python's: `sha256` is that of what it does, and nothing but the process that has it
  /// (law_here.h) can fly it; `library` is null elsewhere.
  bool in_python = false;
  std::vector<std::pair<std::string, double>> parameters;
};

}  // namespace dispersa
