#include "core/dynamics/integrator.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/dynamics/sundials.h"

namespace dispersa {

namespace {

// The classical Runge-Kutta method of order 4.
ARKodeButcherTable ClassicalTable() {
  sunrealtype c[] = {0.0, 0.5, 0.5, 1.0};
  sunrealtype a[] = {0.0, 0.0, 0.0, 0.0,  //
                     0.5, 0.0, 0.0, 0.0,  //
                     0.0, 0.5, 0.0, 0.0,  //
                     0.0, 0.0, 1.0, 0.0};
  sunrealtype b[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  return ARKodeButcherTable_Create(4, 4, 0, c, a, b, nullptr);
}

void Require(bool ok, const char* call) {
  if (!ok) throw std::runtime_error(std::string("SUNDIALS: ") + call + " failed");
}

}  // namespace

bool ParseScheme(const std::string& name, Scheme* scheme) {
  if (name == "simpson") {
    *scheme = Scheme::kSimpson;
    return true;
  }
  if (name == "erk4") {
    *scheme = Scheme::kRungeKutta4;
    return true;
  }
  if (name == "cvode") {
    *scheme = Scheme::kCvode;
    return true;
  }
  return false;
}

struct Integrator::Solver {
  Scheme scheme;
  int size;
  RightHandSide rhs;
  void* context;
  SUNContext sun = nullptr;
  N_Vector y = nullptr;
  N_Vector tolerance = nullptr;
  void* memory = nullptr;
  ARKodeButcherTable table = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;

  std::vector<double> start = {};  // CVODE: the state at the restart, and
  std::vector<double> whole = {};  // that plus its change since

  static int Call(sunrealtype t, N_Vector y, N_Vector dydt, void* user) {
    const auto* self = static_cast<const Solver*>(user);
    self->rhs(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dydt), self->context);
    return 0;
  }

  static int CallWithChange(sunrealtype t, N_Vector change, N_Vector dydt, void* user) {
    auto* self = static_cast<Solver*>(user);
    const double* moved = N_VGetArrayPointer(change);
    for (std::size_t i = 0; i < self->start.size(); ++i) self->whole[i] = self->start[i] + moved[i];
    self->rhs(t, self->whole.data(), N_VGetArrayPointer(dydt), self->context);
    return 0;
  }

  void CreateErk() {
    memory = ERKStepCreate(&Call, 0.0, y, sun);
    Require(memory != nullptr, "ERKStepCreate");
    table = ClassicalTable();
    Require(ERKStepSetTable(memory, table) == ARK_SUCCESS, "ERKStepSetTable");
    ARKodeSetUserData(memory, this);
    ARKodeSetMaxNumSteps(memory, -1);
    SilenceErkStep(memory);
  }

  void CreateCvode(const double* absolute_tolerance) {
    start.resize(static_cast<std::size_t>(size));
    whole.resize(static_cast<std::size_t>(size));
    memory = CVodeCreate(CV_ADAMS, sun);
    Require(memory != nullptr, "CVodeCreate");
    Require(CVodeInit(memory, &CallWithChange, 0.0, y) == CV_SUCCESS, "CVodeInit");
    tolerance = N_VNew_Serial(size, sun);
    for (int i = 0; i < size; ++i) NV_Ith_S(tolerance, i) = absolute_tolerance[i];
    Require(CVodeSVtolerances(memory, 1e-12, tolerance) == CV_SUCCESS, "CVodeSVtolerances");
    fixed_point = SUNNonlinSol_FixedPoint(y, 0, sun);
    Require(CVodeSetNonlinearSolver(memory, fixed_point) == CV_SUCCESS, "CVodeSetNonlinearSolver");
    CVodeSetUserData(memory, this);
    CVodeSetMaxNumSteps(memory, 1000000);
    SilenceCvode(memory);
  }

  ~Solver() {
    if (table) ARKodeButcherTable_Free(table);
    if (memory && scheme == Scheme::kRungeKutta4) ARKodeFree(&memory);
    if (memory && scheme == Scheme::kCvode) CVodeFree(&memory);
    if (fixed_point) SUNNonlinSolFree(fixed_point);
    if (tolerance) N_VDestroy(tolerance);
    if (y) N_VDestroy(y);
    if (sun) SUNContext_Free(&sun);
  }
};

Integrator::Integrator(Scheme scheme, int size, RightHandSide rhs, void* context,
                       const double* absolute_tolerance)
    : solver_(std::make_unique<Solver>()) {
  Require(scheme != Scheme::kSimpson, "choosing the engine's own step");
  Solver& s = *solver_;
  s.scheme = scheme;
  s.size = size;
  s.rhs = rhs;
  s.context = context;
  Require(MakeQuietContext(&s.sun), "SUNContext_Create");
  s.y = N_VNew_Serial(size, s.sun);
  Require(s.y != nullptr, "N_VNew_Serial");
  N_VConst(0.0, s.y);
  if (scheme == Scheme::kRungeKutta4)
    s.CreateErk();
  else
    s.CreateCvode(absolute_tolerance);
}

Integrator::~Integrator() = default;

bool Integrator::Advance(double from_s, double to_s, int steps, double* y) {
  Solver& s = *solver_;
  const bool changes = s.scheme == Scheme::kCvode;
  double* state = N_VGetArrayPointer(s.y);
  for (int i = 0; i < s.size; ++i) state[i] = changes ? 0.0 : y[i];
  double reached = from_s;
  if (changes) {
    s.start.assign(y, y + s.size);
    if (CVodeReInit(s.memory, from_s, s.y) != CV_SUCCESS) return false;
    CVodeSetStopTime(s.memory, to_s);
    if (CVode(s.memory, to_s, s.y, &reached, CV_NORMAL) < 0) return false;
    for (int i = 0; i < s.size; ++i) state[i] += s.start[static_cast<std::size_t>(i)];
  } else {
    // ERKStep reuses the derivative of the last stage as that of the next step's start if the stage lies at
    // the step's end. That is correct only for stiffly accurate tables. Without a reset at every step the
    // order falls to 3, and a derivative from before the jump of a held command would be reused.
    for (int i = 0; i < steps; ++i) {
      const double begin_s = i == 0 ? from_s : from_s + (to_s - from_s) * i / steps;
      const double end_s = i + 1 == steps ? to_s : from_s + (to_s - from_s) * (i + 1) / steps;
      if (ARKodeReset(s.memory, begin_s, s.y) != ARK_SUCCESS) return false;
      ARKodeSetFixedStep(s.memory, end_s - begin_s);
      ARKodeSetStopTime(s.memory, end_s);
      if (ARKodeEvolve(s.memory, end_s, s.y, &reached, ARK_NORMAL) < 0) return false;
    }
  }
  for (int i = 0; i < s.size; ++i) {
    if (!std::isfinite(state[i])) return false;
    y[i] = state[i];
  }
  return true;
}

}  // namespace dispersa
