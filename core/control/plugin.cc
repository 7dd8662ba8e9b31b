#include "core/control/plugin.h"

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <set>

#include "core/control/law_here.h"

namespace dispersa {
namespace {

volatile PluginMark* mark = nullptr;

// Between two of these a call is under way.
void CountCall() {
  if (mark != nullptr) mark->calls = mark->calls + 1;
}

// An object is loaded from memory: no file of ours can be exchanged under a running flight.
void* Load(const std::string& bytes) {
  const int file = memfd_create("dispersa-control-law", MFD_CLOEXEC);
  if (file < 0) throw PluginError(std::string("cannot be kept in memory: ") + std::strerror(errno));
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t part = write(file, bytes.data() + written, bytes.size() - written);
    if (part <= 0) {
      close(file);
      throw PluginError(std::string("cannot be kept in memory: ") + std::strerror(errno));
    }
    written += static_cast<std::size_t>(part);
  }
  const std::string name = "/proc/self/fd/" + std::to_string(file);
  void* const handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  const char* const reason = handle == nullptr ? dlerror() : nullptr;
  close(file);
  if (handle == nullptr) {
    std::string text = reason != nullptr ? reason : "for an unknown reason";
    if (text.starts_with(name + ": ")) text.erase(0, name.size() + 2);
    throw PluginError("cannot be loaded: " + text);
  }
  return handle;
}

template <typename Function>
void Find(void* handle, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(handle, name));
  if (function == nullptr) throw PluginError(std::string("has no function '") + name + "'");
}

// Far beyond any limit, and far from what overflows in the filters behind a law.
constexpr double kLargestCommand_rad_s2 = 1e100;
// By axis.
constexpr const char* kNoFiniteCommand[] = {"the plug-in's roll command is no finite number",
                                            "the plug-in's pitch command is no finite number",
                                            "the plug-in's yaw command is no finite number"};
constexpr const char* kTooLargeCommand[] = {"the plug-in's roll command is beyond 1e100 rad/s^2",
                                            "the plug-in's pitch command is beyond 1e100 rad/s^2",
                                            "the plug-in's yaw command is beyond 1e100 rad/s^2"};

std::string Checked(const char* text) { return text == nullptr ? "" : text; }

}  // namespace

void MarkPluginCallsIn(volatile PluginMark* where) { mark = where; }

void PluginLaw::Open() const {
  if (description_ != nullptr) return;
  // In a child no lock may be taken that another thread of the parent held.
  const Functions* const here = mark == nullptr ? FunctionsHere(config_) : nullptr;
  if (here == nullptr && mark == nullptr)
    throw PluginError("is a plug-in, which flies in a child process; this command starts none");
  CountCall();
  if (here != nullptr) {
    functions_ = *here;
  } else {
    if (handle_ == nullptr) handle_ = Load(*config_.library);
    Find(handle_, "dispersa_law_describe", functions_.describe);
    Find(handle_, "dispersa_law_create", functions_.create);
    Find(handle_, "dispersa_law_start_stage", functions_.start_stage);
    Find(handle_, "dispersa_law_step", functions_.step);
  }
  const dispersa_law_description* const description = functions_.describe();
  CountCall();
  if (description == nullptr) throw PluginError("describes nothing");
  if (description->abi != DISPERSA_LAW_ABI) {
    throw PluginError("speaks version " + std::to_string(description->abi) +
                      " of the interface of control laws, this program version " +
                      std::to_string(DISPERSA_LAW_ABI));
  }
  if (description->memory_bytes > DISPERSA_LAW_MEMORY) {
    throw PluginError("asks for " + std::to_string(description->memory_bytes) +
                      " bytes of memory for a flight; at most " + std::to_string(DISPERSA_LAW_MEMORY));
  }
  if (description->command > DISPERSA_LAW_DEFLECTION)
    throw PluginError("commands neither angular accelerations nor deflections");
  if (description->parameter_count > 0 && description->parameters == nullptr)
    throw PluginError("does not name its parameters");
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < description->parameter_count; ++i)
    if (const std::string name = Checked(description->parameters[i]);
        name.empty() || !names.insert(name).second)
      throw PluginError("has a parameter without a name of its own");
  description_ = description;
}

PluginDescription PluginLaw::Describe() const {
  Open();
  PluginDescription text{Checked(description_->name), Checked(description_->version), {}};
  for (std::uint32_t i = 0; i < description_->parameter_count; ++i)
    text.parameters.push_back(Checked(description_->parameters[i]));
  return text;
}

std::vector<double> PluginLaw::OrderedParameters() const {
  std::vector<double> ordered;
  for (const std::string& name : Describe().parameters) {
    const auto given = std::find_if(config_.parameters.begin(), config_.parameters.end(),
                                    [&](const auto& parameter) { return parameter.first == name; });
    if (given == config_.parameters.end()) throw PluginError("lacks its parameter '" + name + "'");
    ordered.push_back(given->second);
  }
  return ordered;
}

namespace {

const PluginLaw& Opened(const PluginLaw& law) {
  law.Open();
  return law;
}

}  // namespace

PluginFlight::PluginFlight(const PluginLaw& law, double tick_s, std::size_t stages, unsigned axes,
                           std::uint64_t case_index)
    : law_(Opened(law)), axes_(axes), case_index_(case_index), memory_(law.description().memory_bytes) {
  if (law.functions().begin != nullptr) law.functions().begin(case_index, memory_.get());
  farewell_.memory = memory_.get();
  farewell_.end = law.functions().end;
  const std::vector<double> parameters = law.OrderedParameters();
  const dispersa_law_setup setup{tick_s, static_cast<std::uint32_t>(stages), axes, parameters.data()};
  Begin(0.0, -1);
  const int code = law.functions().create(&setup, memory_.get());
  End(0.0, -1);
  Succeeded(code, "the plug-in failed to create its law");
}

bool PluginFlight::StartStage(const dispersa_law_stage& stage, double time_s) {
  if (failure_ != nullptr) return false;
  Begin(time_s, static_cast<int>(stage.stage));
  const int code = law_.functions().start_stage(&stage, memory_.get());
  End(time_s, static_cast<int>(stage.stage));
  return Succeeded(code, "the plug-in failed to start a stage");
}

bool PluginFlight::Step(const dispersa_law_input& input, double* command_rad_s2) {
  if (failure_ != nullptr) return false;
  dispersa_law_output output{};
  Begin(input.time_s, static_cast<int>(input.stage));
  const int code = law_.functions().step(&input, &output, memory_.get());
  End(input.time_s, static_cast<int>(input.stage));
  if (!Succeeded(code, "the plug-in's step failed")) return false;
  const bool deflects = law_.description().command == DISPERSA_LAW_DEFLECTION;
  for (int axis = 0; axis < DISPERSA_LAW_AXES; ++axis) {
    if (!(axes_ >> axis & 1u)) continue;
    const double command = output.command[axis] * (deflects ? input.effectiveness_1_s2[axis] : 1.0);
    if (!std::isfinite(command)) return Succeeded(1, kNoFiniteCommand[axis]);
    if (std::fabs(command) > kLargestCommand_rad_s2) return Succeeded(1, kTooLargeCommand[axis]);
    command_rad_s2[axis] = command;
  }
  std::copy(output.telemetry, output.telemetry + kLawTelemetry, telemetry_.begin());
  return true;
}

bool PluginFlight::Succeeded(int code, const char* otherwise) {
  if (code != 0) failure_ = otherwise;
  return code == 0;
}

void PluginFlight::Begin(double time_s, int stage) {
  if (mark != nullptr) {
    mark->case_index = case_index_;
    mark->time_s = time_s;
    mark->stage = stage;
  }
  CountCall();
}

void PluginFlight::End(double time_s, int stage) {
  // Restores the rounding and exception mode of flights, which the law may have changed.
  _mm_setcsr(0x1f80);
  CountCall();
  // All that is watched may be a page: now and then.
  const bool is_sound = ++calls_ % 1024 == 0 || stage < 0 ? memory_.IsSound() : memory_.IsSoundNearby();
  if (is_sound) return;
  if (stage < 0) throw PluginError("wrote outside the memory of its flight when it was created");
  char text[128];
  std::snprintf(text, sizeof text,
                "wrote outside the memory of its flight, at %.3f s at the latest, in stage %d", time_s,
                stage + 1);
  throw PluginError(text);
}

}  // namespace dispersa
