// A control law written in Python, behind the interface of laws from shared objects
// (core/control/control_law.h).
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/control/law_here.h"

namespace dispersa {

/// What a law is told at a tick, and what it may keep: one object for each flight, whose values change.
class LawTick {
 public:
  LawTick();

  struct Values {
    dispersa_law_input input{};
    dispersa_law_stage stage{};
    double telemetry[DISPERSA_LAW_TELEMETRY] = {};
  };
  Values& values() { return *values_; }
  /// Shape (3,) or, of telemetry, (4,): views of the values.
  const pybind11::array& Array(const char* name) const;
  const pybind11::dict& memory() const { return memory_; }

 private:
  void Add(const char* name, double* first, int count, bool writeable);

  std::shared_ptr<Values> values_ = std::make_shared<Values>();
  std::vector<std::pair<const char*, pybind11::array>> arrays_;
  pybind11::dict memory_;
};

/// Made and destroyed with the interpreter's lock; must outlive the flights under it, which take the lock at
/// every tick.
class PythonLaw {
 public:
  /// `law(tick)` commands angular accelerations, rad/s², of these axes (bits 1 << Axis): a sequence of three,
  /// or a number where there is one axis.
  PythonLaw(pybind11::object law, unsigned axes);
  ~PythonLaw();
  PythonLaw(const PythonLaw&) = delete;
  PythonLaw& operator=(const PythonLaw&) = delete;

  /// The campaign with this law on its axes. Throws InputError.
  Campaign Apply(Campaign campaign);
  /// Throws what the law raised, if it did: the flight that it ended means nothing.
  void RethrowProblem() const;

 private:
  static const PluginLaw::Functions& Functions();
  int Create(void* memory);
  struct Flight {
    PythonLaw* law;
    LawTick* tick;  ///< lives as long as its Python object
    pybind11::object object;
  };
  int Step(const dispersa_law_input& input, dispersa_law_output& output, Flight& flight);

  pybind11::object law_;
  unsigned axes_;
  LawHere here_{Functions()};
  std::vector<std::unique_ptr<Flight>> flights_;
  std::exception_ptr problem_;
};

void AddLawTick(pybind11::module_& module);

}  // namespace dispersa
