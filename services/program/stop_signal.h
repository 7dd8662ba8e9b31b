// Ctrl-C and its relatives, as a question that loops ask.
#pragma once

namespace dispersa {

/// From now on SIGINT, SIGTERM and SIGHUP only set a flag.
void CatchStopSignals();
bool StopRequested();

}  // namespace dispersa
