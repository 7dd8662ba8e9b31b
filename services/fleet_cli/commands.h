// The commands that need a coordinator or its keys.
#pragma once

#include "services/cli/command.h"

namespace dispersa {

void AddLaunchCommand(CLI::App& app, Invocation& invocation);
void AddStatusCommand(CLI::App& app, Invocation& invocation);
void AddWatchCommand(CLI::App& app, Invocation& invocation);
void AddFetchCommand(CLI::App& app, Invocation& invocation);
void AddKeysCommand(CLI::App& app, Invocation& invocation);

inline void AddFleetCommands(CLI::App& app, Invocation& invocation) {
  for (const auto add :
       {AddLaunchCommand, AddStatusCommand, AddWatchCommand, AddFetchCommand, AddKeysCommand})
    add(app, invocation);
}

}  // namespace dispersa
