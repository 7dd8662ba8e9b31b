// Integration from one event to the next, through SUNDIALS.
#pragma once

#include <memory>
#include <string>

namespace dispersa {

/// dy/dt = f(t, y). `context` belongs to the caller.
using RightHandSide = void (*)(double time_s, const double* y, double* dydt, void* context);

enum class Scheme {
  kSimpson,      ///< the engine's own step (core/flight/simpson_step.h) for flights, not an Integrator
  kRungeKutta4,  ///< ERKStep with the classical fourth-order table and fixed steps: scenarios, and a judge
  /// CVODE Adams: the independent check. It solves for the change of the state since the restart. So the
  /// relative tolerance of 1e-12 refers to the metres moved within a tick. Relative to the distance from the
  /// Earth's centre it would admit errors of 1e-5 m and 1e-8 m/s at every restart.
  kCvode,
};
/// "simpson", "erk4", "cvode".
bool ParseScheme(const std::string& name, Scheme* scheme);

/// Advances a state of fixed size. Every Advance restarts: no derivative, step size or history is kept over
/// an event. So a result depends on the arguments alone. Not thread-safe: make one for each flight.
class Integrator {
 public:
  /// scheme: ERKStep's or CVODE's. absolute_tolerance, shape (size): only CVODE reads it.
  Integrator(Scheme scheme, int size, RightHandSide rhs, void* context, const double* absolute_tolerance);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Replaces y(from) by y(to) in `steps` equal steps (at least 1; CVODE chooses its own). Returns false if
  /// the solver fails or the state is not finite.
  bool Advance(double from_s, double to_s, int steps, double* y);

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace dispersa
