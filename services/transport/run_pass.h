// The secret that `dispersa run` gives its workers through a pipe that no other process can read.
#pragma once

#include <set>
#include <string>

#include "services/transport/seal.h"

namespace dispersa {

struct RunPass {
  Secret secret{};                ///< of this run; senders without it are ignored
  std::set<std::string> plugins;  ///< SHA-256 of the shared objects that the run's campaign names
};

std::string ToText(const RunPass& pass);
/// Reads it from a text. Throws NetworkError if it is none.
RunPass ParseRunPass(const std::string& text);
/// All that comes through a pipe, which is closed then. Throws NetworkError.
RunPass TakeRunPass(int descriptor);

}  // namespace dispersa
