// A control law from a shared object, as an autopilot file names it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dispersa {

/// A plug-in as the autopilot file names it. The object is identified by its bytes; the path does not matter.
struct PluginConfig {
  std::shared_ptr<const std::string> library;
  std::string sha256;         ///< of the bytes
  std::string name, version;  ///< as it describes itself
  /// A Python function. `sha256` is the hash of its code. Only the process that has it (law_here.h) can fly
  /// it; `library` is null elsewhere.
  bool in_python = false;
  std::vector<std::pair<std::string, double>> parameters;
};

}  // namespace dispersa
