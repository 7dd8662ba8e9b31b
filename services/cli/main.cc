// The program of a build without the service. Where the package dispersa-cluster is installed beside it, that
// one's program takes over, with the same commands and more.
#include <unistd.h>

#include <filesystem>

#include "services/cli/program.h"

int main(int argc, char** argv) {
  const auto whole = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dispersa-fleet";
  execv(whole.c_str(), argv);  // returns only if it is not there
  return dispersa::RunProgram(argc, argv, nullptr);
}
