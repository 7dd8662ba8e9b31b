// The program of a build with the service: all commands, and flights in worker processes.
#include <filesystem>

#include "services/cli/command.h"
#include "services/cli/program.h"
#include "services/fleet/data_check.h"
#include "services/fleet/worker_flights.h"
#include "services/fleet_cli/commands.h"

int main(int argc, char** argv) {
  const auto beside = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const dispersa::Service service = {dispersa::AddFleetCommands,
                                     dispersa::WorkersOfProgram(beside / "dispersa-worker"),
                                     dispersa::CheckDataFolder};
  return dispersa::RunProgram(argc, argv, &service);
}
