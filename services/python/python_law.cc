#include "services/python/python_law.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "core/campaign/input_error.h"
#include "services/python/arrays.h"

namespace py = pybind11;

namespace dispersa {
namespace {

// The interface hands numbers to a law when it is created, so a law is known by one.
std::mutex mutex;
double next_number = 1.0;
std::map<double, PythonLaw*> laws;

}  // namespace

LawTick::LawTick() {
  Values& v = *values_;
  Add("angle_error_rad", v.input.angle_error_rad, 3, false);
  Add("rate_error_rad_s", v.input.rate_error_rad_s, 3, false);
  Add("rate_rad_s", v.input.rate_rad_s, 3, false);
  Add("effectiveness_1_s2", v.input.effectiveness_1_s2, 3, false);
  Add("program_rad_s2", v.input.program_rad_s2, 3, false);
  Add("saturation", v.input.saturation, 3, false);
  Add("kp_1_s2", v.stage.kp_1_s2, 3, false);
  Add("kd_1_s", v.stage.kd_1_s, 3, false);
  Add("telemetry", v.telemetry, DISPERSA_LAW_TELEMETRY, true);
}

void LawTick::Add(const char* name, double* first, int count, bool writeable) {
  py::array array = ArrayOver(first, {count}, values_);
  if (!writeable) array.attr("flags").attr("writeable") = false;
  arrays_.emplace_back(name, std::move(array));
}

const py::array& LawTick::Array(const char* name) const {
  return std::find_if(arrays_.begin(), arrays_.end(), [&](const auto& each) { return each.first == name; })
      ->second;
}

PythonLaw::PythonLaw(py::object law, unsigned axes) : law_(std::move(law)), axes_(axes) {}

PythonLaw::~PythonLaw() {
  const std::lock_guard lock(mutex);
  std::erase_if(laws, [this](const auto& each) { return each.second == this; });
}

Campaign PythonLaw::Apply(Campaign campaign) {
  AutopilotConfig& autopilot = campaign.autopilot;
  AxisConfig* const configs[] = {&autopilot.roll, &autopilot.pitch, &autopilot.yaw};
  for (unsigned axis = 0; axis < DISPERSA_LAW_AXES; ++axis) {
    if ((axes_ & 1u << axis) == 0) continue;
    configs[axis]->law = ControlLaw::kPlugin;
    configs[axis]->schedule.clear();
  }
  {
    const std::lock_guard lock(mutex);
    laws[next_number] = this;
    autopilot.plugin = here_.Config({{"law", next_number}});
    next_number += 1.0;
  }
  std::vector<InputProblem> problems;
  for (const AutopilotProblem& p : Problems(autopilot, static_cast<int>(campaign.vehicle.stages.size())))
    problems.push_back({"", 0, 0, "autopilot" + (p.path.empty() ? "" : "." + p.path), p.message, p.allowed});
  if (!problems.empty()) throw InputError(std::move(problems));
  return campaign;
}

void PythonLaw::RethrowProblem() const {
  if (problem_) std::rethrow_exception(problem_);
}

const PluginLaw::Functions& PythonLaw::Functions() {
  static const char* const parameters[] = {"law"};
  static const dispersa_law_description description = {
      DISPERSA_LAW_ABI, sizeof(Flight*), DISPERSA_LAW_ANGULAR_ACCELERATION, 1, "python", "", parameters};
  static const PluginLaw::Functions functions = {
      [] { return &description; },
      [](const dispersa_law_setup* setup, void* memory) {
        PythonLaw* law = nullptr;
        {
          const std::lock_guard lock(mutex);
          law = laws.at(setup->parameters[0]);
        }
        return law->Create(memory);
      },
      [](const dispersa_law_stage* stage, void* memory) {
        (*static_cast<Flight**>(memory))->tick->values().stage = *stage;
        return 0;
      },
      [](const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
        Flight* const flight = *static_cast<Flight**>(memory);
        return flight->law->Step(*input, *output, *flight);
      }};
  return functions;
}

int PythonLaw::Create(void* memory) {
  const py::gil_scoped_acquire lock;
  auto flight = std::make_unique<Flight>();
  flight->law = this;
  auto tick = std::make_unique<LawTick>();
  flight->tick = tick.get();
  flight->object = py::cast(std::move(tick));
  *static_cast<Flight**>(memory) = flight.get();
  flights_.push_back(std::move(flight));
  return 0;
}

int PythonLaw::Step(const dispersa_law_input& input, dispersa_law_output& output, Flight& flight) {
  const py::gil_scoped_acquire lock;
  if (problem_) return 1;
  try {
    LawTick::Values& values = flight.tick->values();
    values.input = input;
    const py::object command = law_(flight.object);
    if (PyFloat_Check(command.ptr()) || PyLong_Check(command.ptr())) {
      std::fill(output.command, output.command + DISPERSA_LAW_AXES, command.cast<double>());
    } else {
      const auto three = command.cast<std::array<double, DISPERSA_LAW_AXES>>();
      std::copy(three.begin(), three.end(), output.command);
    }
    std::memcpy(output.telemetry, values.telemetry, sizeof output.telemetry);
    return 0;
  } catch (const py::cast_error&) {
    problem_ =
        std::make_exception_ptr(py::type_error("a control law returns angular accelerations, rad/s^2: of "
                                               "roll, pitch and yaw, or a number for one axis"));
  } catch (...) {
    problem_ = std::current_exception();
  }
  return 1;
}

void AddLawTick(py::module_& module) {
  py::class_<LawTick> tick(module, "LawTick");
  for (const char* name : {"angle_error_rad", "rate_error_rad_s", "rate_rad_s", "effectiveness_1_s2",
                           "program_rad_s2", "saturation", "kp_1_s2", "kd_1_s", "telemetry"}) {
    tick.def_property_readonly(name, [name](const LawTick& t) { return t.Array(name); });
  }
  tick.def_property_readonly("time_s", [](LawTick& t) { return t.values().input.time_s; })
      .def_property_readonly("since_ignition_s", [](LawTick& t) { return t.values().input.since_ignition_s; })
      .def_property_readonly("stage", [](LawTick& t) { return t.values().input.stage + 1; })
      .def_property_readonly("limit_rad", [](LawTick& t) { return t.values().stage.limit_rad; })
      .def_property_readonly("memory", [](const LawTick& t) { return t.memory(); });
}

}  // namespace dispersa
