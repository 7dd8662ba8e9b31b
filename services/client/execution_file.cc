#include "services/client/execution_file.h"

#include <pwd.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/flight/engine_version.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

/// Who started the run; empty where the system has no name for him.
std::string UserName() {
  const passwd* user = getpwuid(geteuid());
  return user == nullptr ? "" : user->pw_name;
}

}  // namespace

void ExecutionFile::Write() const {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  Json pids = Json::array({getpid()});
  Json processes = Json::array();
  for (const WorkerProcess& worker : workers) {
    pids.push_back(worker.pid);
    processes.push_back({{"worker", worker.uuid},
                         {"pid", worker.pid},
                         {"started_utc", worker.started_utc},
                         {"ended_utc", OrNull(worker.ended_utc)},
                         {"end", worker.ended_utc ? Json(worker.how) : Json(nullptr)}});
  }
  const Json file = {{"schema", "dispersa/execution/1"},
                     {"engine", EngineVersion()},
                     {"host", host},
                     {"pid", getpid()},
                     {"pids", pids},
                     {"started_utc", started_utc},
                     {"ended_utc", OrNull(ended_utc)},
                     {"problem", OrNull(problem)},
                     {"domain", OrNull(domain)},
                     {"workers_wanted", workers_wanted},
                     {"workers", processes},
                     {"cases_before", cases_before},
                     {"cases_flown", cases_flown},
                     {"flying_s", flying_s},
                     {"user", UserName()},
                     {"vehicle_file", vehicle_file}};
  WriteFile(directory / "execution.json", file.dump(2) + "\n");
}

}  // namespace dispersa
