// Interrupting a long call on request.
#pragma once

#include <functional>

namespace dispersa {

/// Asked while a long call runs: true stops it.
using StopCheck = std::function<bool()>;
/// Thrown by a call that was stopped.
struct Interrupted {};

}  // namespace dispersa
