// A control law with its functions in this process: a prototype. Nothing protects the process from it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/control/plugin.h"

namespace dispersa {

/// While it lives, its configuration offers these functions like those of a shared object. Flights under it
/// are flown in this process. The functions must outlive it.
class LawHere {
 public:
  explicit LawHere(const PluginLaw::Functions& functions);
  ~LawHere();
  LawHere(const LawHere&) = delete;
  LawHere& operator=(const LawHere&) = delete;

  /// The configuration for an autopilot's plug-in, with the parameters that it describes.
  PluginConfig Config(std::vector<std::pair<std::string, double>> parameters) const;
  /// From now on campaigns that this thread loads and that name a law in Python of this hash have this one.
  void Offer(PluginConfig config);

 private:
  std::shared_ptr<const std::string> library_;  ///< empty: its address is the law's name
};

/// The functions of a configuration in this process. Null: those of a shared object.
const PluginLaw::Functions* FunctionsHere(const PluginConfig& config);

/// Whether it is a law in Python that this process does not have: its flights can be looked at, not flown.
bool IsAbsent(const PluginConfig& config);

/// The configuration that this thread offers under a hash; empty if it offers none.
std::optional<PluginConfig> OfferedLaw(const std::string& sha256);

}  // namespace dispersa
