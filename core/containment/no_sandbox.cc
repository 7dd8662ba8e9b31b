// A build without the service: control laws from shared objects are refused, because nothing shuts them in.
#include "core/containment/sandbox.h"

namespace dispersa {

SandboxParts EnterSandbox(const SandboxParts&, void (*)(int), int* listener) {
  *listener = -1;
  return {false, false, false, false};
}

void AnswerPathCall(int) {}

std::string SystemCallName(int call) { return std::to_string(call); }

std::string WhyNoSandbox() {
  return "is a shared object, and this build has no sandbox for one (DISPERSA_SERVICE=OFF)";
}

}  // namespace dispersa
