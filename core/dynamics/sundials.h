// SUNDIALS of release 6 (Debian 12) or 7 (Debian 13), with the names of release 7. Internal to this folder.
#pragma once

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace dispersa {

#if SUNDIALS_VERSION_MAJOR >= 7
/// A context whose solvers print nothing: what failed, they return.
inline bool MakeQuietContext(SUNContext* made) {
  return SUNContext_Create(SUN_COMM_NULL, made) == SUN_SUCCESS &&
         SUNContext_ClearErrHandlers(*made) == SUN_SUCCESS;
}
inline void SilenceErkStep(void*) {}
inline void SilenceCvode(void*) {}
#else
inline constexpr auto* ARKodeSetUserData = &ERKStepSetUserData;
inline constexpr auto* ARKodeSetMaxNumSteps = &ERKStepSetMaxNumSteps;
inline constexpr auto* ARKodeSetFixedStep = &ERKStepSetFixedStep;
inline constexpr auto* ARKodeSetStopTime = &ERKStepSetStopTime;
inline constexpr auto* ARKodeReset = &ERKStepReset;
inline constexpr auto* ARKodeEvolve = &ERKStepEvolve;
inline constexpr auto* ARKodeFree = &ERKStepFree;

inline bool MakeQuietContext(SUNContext* made) { return SUNContext_Create(nullptr, made) == 0; }
// Each solver of this release prints by a function of its own.
inline void DropMessage(int, const char*, const char*, char*, void*) {}
inline void SilenceErkStep(void* memory) { ERKStepSetErrHandlerFn(memory, &DropMessage, nullptr); }
inline void SilenceCvode(void* memory) { CVodeSetErrHandlerFn(memory, &DropMessage, nullptr); }
#endif

}  // namespace dispersa
