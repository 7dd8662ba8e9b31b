#include "services/cli/stream_beside.h"

#include "core/input/input_error.h"

namespace dispersa {

std::FILE* StreamBeside(const std::string& option, const std::string& path, const GlobalOptions& global) {
  if (path != "-") return stdout;
  if (global.json)
    throw InputError(option + ": '-' is standard output, where --json prints its object",
                     "a file, or no --json");
  return stderr;
}

}  // namespace dispersa
