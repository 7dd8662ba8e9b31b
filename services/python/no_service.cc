// A build without the service (services/fleet_python/service.cc has the other one).
#include "services/python/parts.h"

namespace dispersa {

void AddService(pybind11::module_&) {}

FlyWithWorkers WorkersOfProgramAt(const std::string&) { return nullptr; }

}  // namespace dispersa
