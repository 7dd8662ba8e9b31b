#include "services/python/python_law.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/control/autopilot.h"
#include "core/input/input_error.h"
#include "services/python/arrays.h"

namespace py = pybind11;

namespace dispersa {
namespace {

// The interface hands numbers to a law when it is created, so a law is known by one.
constexpr char kNumber[] = "law";
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

PythonLaw::PythonLaw(py::object law, PythonObserver& observer) : law_(std::move(law)), observer_(observer) {
  const std::lock_guard lock(mutex);
  number_ = next_number++;
  laws[number_] = this;
}

PythonLaw::~PythonLaw() {
  const std::lock_guard lock(mutex);
  laws.erase(number_);
}

void PythonLaw::Offer(const std::string& sha256) {
  PluginConfig config = here_.Config({{kNumber, number_}});
  config.sha256 = sha256;
  here_.Offer(std::move(config));
}

namespace {

// The plug-in of an autopilot commands all axes that have one.
void RefuseOtherPlugin(const AutopilotConfig& autopilot, unsigned axes) {
  if ((PluginAxes(autopilot) & ~axes) != 0)
    throw InputError("axes: the autopilot has a plug-in on other axes", "all axes that it has");
}

}  // namespace

Campaign PythonLaw::OnAxes(Campaign campaign, unsigned axes) const {
  AutopilotConfig& autopilot = campaign.autopilot;
  RefuseOtherPlugin(autopilot, axes);
  AxisConfig* const configs[] = {&autopilot.roll, &autopilot.pitch, &autopilot.yaw};
  for (unsigned axis = 0; axis < DISPERSA_LAW_AXES; ++axis) {
    if ((axes & 1u << axis) == 0) continue;
    configs[axis]->law = ControlLaw::kPlugin;
    configs[axis]->schedule.clear();
  }
  autopilot.plugin = here_.Config({{kNumber, number_}});
  std::vector<InputProblem> problems;
  for (const StructProblem& p : Problems(autopilot, static_cast<int>(campaign.vehicle.stages.size())))
    problems.push_back({"", 0, 0, "autopilot" + (p.path.empty() ? "" : "." + p.path), p.message, p.allowed});
  if (!problems.empty()) throw InputError(std::move(problems));
  return campaign;
}

std::string WithPythonLaw(const Campaign& campaign, unsigned axes, const std::string& name,
                          const std::string& sha256) {
  RefuseOtherPlugin(campaign.autopilot, axes);
  std::vector<InputProblem> problems;
  InputNode root = ParseYaml(campaign.canonical_yaml, campaign.name, problems);
  InputNode& autopilot = *root.Find("autopilot");
  std::string title = campaign.autopilot.name + ";";
  for (unsigned axis = 0; axis < DISPERSA_LAW_AXES; ++axis) {
    if ((axes & 1u << axis) == 0) continue;
    InputNode& config = *autopilot.Find(kAxisNames[axis]);
    SetMember(config, "law", TextAt(config, InfoOf(ControlLaw::kPlugin).name));
    std::erase_if(config.members, [](const InputMember& member) { return member.key == "schedule"; });
    title += std::string(" ") + kAxisNames[axis];
  }
  // A reader of a report is not to take one for the other.
  SetMember(autopilot, "name", TextAt(autopilot, title + " by " + name + " in Python"));
  InputNode law = MapAt(autopilot);
  SetMember(law, "name", TextAt(law, name));
  SetMember(law, "sha256", TextAt(law, sha256));
  InputNode plugin = MapAt(autopilot);
  SetMember(plugin, "python", std::move(law));
  SetMember(autopilot, "plugin", std::move(plugin));
  return CanonicalText(root);
}

const PluginLaw::Functions& PythonLaw::Functions() {
  static const char* const parameters[] = {kNumber};
  static const dispersa_law_description description = {
      DISPERSA_LAW_ABI, sizeof(Memory), DISPERSA_LAW_ANGULAR_ACCELERATION, 1, "python", "", parameters};
  static const PluginLaw::Functions functions = {
      .describe = [] { return &description; },
      .create =
          [](const dispersa_law_setup* setup, void* memory) {
            PythonLaw* law = nullptr;
            {
              const std::lock_guard lock(mutex);
              law = laws.at(setup->parameters[0]);
            }
            law->Create(*setup, *static_cast<Memory*>(memory));
            return 0;
          },
      .start_stage =
          [](const dispersa_law_stage* stage, void* memory) {
            static_cast<Memory*>(memory)->flight->tick->values().stage = *stage;
            return 0;
          },
      .step =
          [](const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
            Flight& flight = *static_cast<Memory*>(memory)->flight;
            flight.law->Step(*input, *output, flight);
            return 0;
          },
      .begin = [](std::uint64_t case_index,
                  void* memory) { static_cast<Memory*>(memory)->case_index = case_index; },
      .end =
          [](void* memory) {
            const py::gil_scoped_acquire lock;
            delete static_cast<Memory*>(memory)->flight;
          }};
  return functions;
}

void PythonLaw::Create(const dispersa_law_setup& setup, Memory& memory) {
  const py::gil_scoped_acquire lock;
  auto tick = std::make_unique<LawTick>();
  LawTick* const values = tick.get();
  memory.flight = new Flight{this, memory.case_index, setup.axes, values, py::cast(std::move(tick))};
}

namespace {

[[noreturn]] void RaiseTypeError(const std::string& text) {
  PyErr_SetString(PyExc_TypeError, text.c_str());
  throw py::error_already_set();
}

std::string Shown(const py::handle& value) {
  constexpr py::ssize_t kMost = 60;
  py::object text = py::repr(value);
  const bool is_long = py::len(text) > kMost;
  if (is_long) text = text[py::slice(0, kMost, 1)];
  // Characters that UTF-8 cannot hold are written as escapes.
  const auto utf8 = text.attr("encode")("utf-8", "backslashreplace").cast<std::string>();
  return utf8 + (is_long ? " …" : "") + " (" + std::string(Py_TYPE(value.ptr())->tp_name) + ")";
}

// A real number of Python's or NumPy's; nothing that merely can be made one.
bool IsNumber(const py::handle& value) {
  if (PyFloat_Check(value.ptr())) return true;
  if (PyBool_Check(value.ptr())) return false;
  if (PyLong_Check(value.ptr())) return true;
  static const py::handle floating = py::object(py::module_::import("numpy").attr("floating")).release();
  static const py::handle integer = py::object(py::module_::import("numpy").attr("integer")).release();
  return py::isinstance(value, floating) || py::isinstance(value, integer);
}

double Number(const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred()) throw py::error_already_set();
  return number;
}

// The value that a law returned, as commands of all axes. Those that it does not command are ignored.
void TakeCommand(const py::object& returned, unsigned axes, double* command) {
  const bool commands_one = (axes & (axes - 1)) == 0;
  if (IsNumber(returned)) {
    if (!commands_one)
      RaiseTypeError(
          "a control law of several axes returns three angular accelerations, rad/s^2, of roll, pitch "
          "and yaw; this one returned one number, " +
          Shown(returned));
    std::fill(command, command + DISPERSA_LAW_AXES, Number(returned));
    return;
  }
  const bool is_array = py::isinstance<py::array>(returned);
  if ((PyList_Check(returned.ptr()) || PyTuple_Check(returned.ptr()) ||
       (is_array && py::reinterpret_borrow<py::array>(returned).ndim() == 1)) &&
      py::len(returned) == DISPERSA_LAW_AXES) {
    const auto items = py::reinterpret_borrow<py::sequence>(returned);
    bool numbers = true;
    for (unsigned axis = 0; numbers && axis < DISPERSA_LAW_AXES; ++axis) {
      const py::object item = items[axis];
      numbers = IsNumber(item);
      if (numbers) command[axis] = Number(item);
    }
    if (numbers) return;
  }
  RaiseTypeError(
      std::string("a control law returns angular accelerations, rad/s^2: ") +
      (commands_one ? "a number, or three, of roll, pitch and yaw" : "three, of roll, pitch and yaw") +
      "; this one returned " + Shown(returned));
}

}  // namespace

std::string PythonLaw::Place(const Flight& flight, double time_s) const {
  char time[48];
  std::snprintf(time, sizeof time, ", %.2f s after lift-off", time_s);
  const std::string who = flies_the_nominal_       ? "the nominal flight"
                          : flight.case_index == 0 ? "case 0 or the nominal flight"
                                                   : "case " + std::to_string(flight.case_index);
  return "raised by the control law in " + who + time;
}

void PythonLaw::Step(const dispersa_law_input& input, dispersa_law_output& output, Flight& flight) const {
  const py::gil_scoped_acquire lock;
  try {
    LawTick::Values& values = flight.tick->values();
    values.input = input;
    TakeCommand(law_(flight.object), flight.axes, output.command);
    std::memcpy(output.telemetry, values.telemetry, sizeof output.telemetry);
  } catch (py::error_already_set& error) {
    // Python before 3.11 has no notes.
    if (error.matches(PyExc_Exception) && py::hasattr(error.value(), "add_note"))
      error.value().attr("add_note")(Place(flight, input.time_s));
    observer_.StopWith(std::current_exception());
    throw Interrupted();
  }
}

namespace {

// A law may put its tick into the tick's own memory: the garbage collector is to see that ring. Clearing the
// memory, a dict, opens it.
void LetBeCollected(PyHeapTypeObject* heap_type) {
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    const auto* const tick = static_cast<const LawTick*>(
        reinterpret_cast<py::detail::instance*>(self)->get_value_and_holder().value_ptr());
    if (tick != nullptr) Py_VISIT(tick->memory().ptr());
    return 0;
  };
}

}  // namespace

void AddLawTick(py::module_& module) {
  py::class_<LawTick> tick(module, "LawTick", py::custom_type_setup(LetBeCollected));
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
