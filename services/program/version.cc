#include "services/program/version.h"

#include <nlohmann/json.hpp>

#include "core/containment/contained.h"
#include "core/flight/engine_version.h"
#include "core/flight/lane_engine.h"

namespace dispersa {

std::string VersionText(const std::string& program) { return program + " " + std::string(EngineVersion()); }

std::string VersionJson() {
  const std::string engine(EngineVersion());
  const SandboxParts sandbox = SandboxHere();
  const nlohmann::ordered_json json = {{"schema", "dispersa/version/1"},
                                       {"version", engine.substr(0, engine.find('+'))},
                                       {"engine", engine},
                                       {"isa", ChosenEngine().isa},
                                       {"lanes", ChosenEngine().lanes},
                                       {"sandbox",
                                        {{"seccomp", sandbox.seccomp},
                                         {"landlock", sandbox.landlock},
                                         {"paths", sandbox.paths},
                                         {"namespaces", sandbox.namespaces}}}};
  return json.dump(2);
}

}  // namespace dispersa
