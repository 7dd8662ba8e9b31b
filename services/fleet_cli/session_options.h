// Options of the commands that ask a coordinator.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "services/cli/command.h"
#include "services/fleet/session.h"

namespace dispersa {

/// Adds the options of a session to a command, and `run` as what it does.
void BindSession(CLI::App* command, Invocation& invocation,
                 std::function<ExitCode(Session&, const GlobalOptions&)> run);

/// The option that names a campaign by its id or the first characters of it.
std::shared_ptr<std::string> AddIdOption(CLI::App* command, bool required = true);

}  // namespace dispersa
