// A control law written in Python, behind the interface of laws from shared objects
// (core/control/control_law.h).
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/control/law_here.h"
#include "services/python/python_observer.h"

namespace dispersa {

/// The input of a law at a tick and its memory: one object for each flight, whose values change.
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

/// Make and destroy it with the interpreter's lock. Flights use it without the lock and take the lock at
/// every tick. It must outlive them.
class PythonLaw {
 public:
  /// `law(tick)` returns angular accelerations, rad/s²: three, for roll, pitch and yaw, or a number if it
  /// commands one axis. An exception in it ends the flights that `observer` watches.
  PythonLaw(pybind11::object law, PythonObserver& observer);
  ~PythonLaw();
  PythonLaw(const PythonLaw&) = delete;
  PythonLaw& operator=(const PythonLaw&) = delete;

  /// The campaign with this law on these axes (bits 1 << Axis). Throws InputError.
  Campaign OnAxes(Campaign campaign, unsigned axes) const;
  /// Campaigns that this thread loads and that name this hash have this law.
  void Offer(const std::string& sha256);
  /// The note to an exception names no case.
  void FliesTheNominal() { flies_the_nominal_ = true; }

 private:
  static const PluginLaw::Functions& Functions();
  /// Content of a flight's memory.
  struct Flight {
    PythonLaw* law;
    std::uint64_t case_index;
    unsigned axes;
    LawTick* tick;  ///< lives as long as its Python object
    pybind11::object object;
  };
  struct Memory {
    std::uint64_t case_index;
    Flight* flight;
  };
  void Create(const dispersa_law_setup& setup, Memory& memory);
  void Step(const dispersa_law_input& input, dispersa_law_output& output, Flight& flight) const;
  std::string Place(const Flight& flight, double time_s) const;

  pybind11::object law_;
  PythonObserver& observer_;
  double number_ = 0.0;
  LawHere here_{Functions()};
  bool flies_the_nominal_ = false;
};

/// The canonical text of a campaign under a Python law on these axes. It names this law in place of the
/// file's. Throws InputError.
std::string WithPythonLaw(const Campaign& campaign, unsigned axes, const std::string& name,
                          const std::string& sha256);

void AddLawTick(pybind11::module_& module);

}  // namespace dispersa
