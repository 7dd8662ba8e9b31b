// dispersa-foreign: runs foreign code for one process, which starts it (core/containment/foreign_process.h).
// It knows one campaign.
#include <sys/stat.h>

#include <cstdio>
#include <memory>
#include <string>

#include "core/campaign_yaml/load.h"
#include "core/cases/flight_orders.h"
#include "core/cases/result_bytes.h"
#include "core/containment/foreign_process.h"
#include "core/flight/engine_version.h"

namespace dispersa {
namespace {

std::unique_ptr<const FlightsHere> OpenCampaign(const std::string& order) {
  Unpacker in(order);
  // Both programs may have been exchanged while the other one runs.
  if (const std::string engine = in.Text(); engine != EngineVersion())
    throw NoChild("dispersa-foreign has the engine " + EngineVersion() + " and the program that needs it " +
                  engine + ": start that again");
  HistoryColumns();  // made here, and not in every child
  MetricNames();
  return std::make_unique<FlightsHere>(ParseCampaign(in.Text(), "campaign"));
}

void Serve() {
  std::unique_ptr<const FlightsHere> flights;
  ServeOrders([&](const std::string& order, const Say& say, const StopCheck& should_stop) {
    const std::string rest = order.substr(1);
    if (order[0] == kDescribeOrder) {
      PluginConfig plugin;
      plugin.library = std::make_shared<const std::string>(rest);
      const PluginDescription description = DescribeContained(plugin);
      say(description.name);
      say(description.version);
      for (const std::string& name : description.parameters) say(name);
    } else if (order[0] == kCampaignOrder) {
      flights = OpenCampaign(rest);
    } else {
      RunContained([&](const Say& tell) { CarryOut(*flights, rest, tell); }, say, should_stop);
    }
  });
}

}  // namespace
}  // namespace dispersa

int main() {
  struct stat file {};
  if (fstat(3, &file) != 0 || !S_ISSOCK(file.st_mode)) {
    std::fputs(
        "dispersa-foreign is started by the other programs of dispersa, for control laws from shared "
        "objects\n",
        stderr);
    return 2;
  }
  dispersa::Serve();
}
