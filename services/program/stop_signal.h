// Ctrl-C and other stop signals, as a flag that loops read.
#pragma once

namespace dispersa {

/// From now on SIGINT, SIGTERM and SIGHUP only set a flag.
void CatchStopSignals();
bool StopRequested();

}  // namespace dispersa
