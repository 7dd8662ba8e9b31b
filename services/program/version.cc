#include "services/program/version.h"

#include <nlohmann/json.hpp>

#include "core/flight/engine_version.h"
#include "core/flight/lane_engine.h"

namespace dispersa {

std::string VersionText(const std::string& program) { return program + " " + std::string(EngineVersion()); }

std::string VersionJson() {
  const std::string engine(EngineVersion());
  const nlohmann::ordered_json json = {{"schema", "dispersa/version/1"},
                                       {"version", engine.substr(0, engine.find('+'))},
                                       {"engine", engine},
                                       {"isa", ChosenEngine().isa},
                                       {"lanes", ChosenEngine().lanes}};
  return json.dump(2);
}

}  // namespace dispersa
