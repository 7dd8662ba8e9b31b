// What the service adds to the Python package: worker processes, and coordinators.
#include <string>

#include "services/client/writable.h"
#include "services/fleet/remote_campaign.h"
#include "services/fleet/worker_flights.h"
#include "services/python/parts.h"
#include "services/python/python_observer.h"

namespace py = pybind11;

namespace dispersa {
namespace {

/// A campaign flown by a coordinator and fetched into a folder; its exit code.
int RunRemotely(const std::string& name, const std::string& text, const std::string& out, int domain,
                const std::string& peer, const std::string& address, const std::string& keys, bool insecure,
                int priority, const py::object& progress) {
  PythonObserver observer(progress);
  return observer.Watch([&] {
    RequireWritableFolder("out", out);
    const Campaign campaign = LoadCampaign(InputSource(name, text));
    SessionOptions options = {domain, peer, address, {}};
    options.admission.keys = keys;
    options.admission.insecure = insecure;
    Session session(options);
    LaunchCampaign(session, campaign, priority);
    const ExitCode code = FollowCampaign(session, campaign.id, observer);
    FetchCampaign(session, campaign.id, out);
    return static_cast<int>(code);
  });
}

}  // namespace

void AddService(py::module_& module) { module.def("run_remotely", &RunRemotely); }

FlyWithWorkers WorkersOfProgramAt(const std::string& worker_program) {
  return WorkersOfProgram(worker_program);
}

}  // namespace dispersa
