// A control law from a shared object (control_law.h): its file, its functions, and the memory of a flight.
//
// Nothing here protects this process from the object: core/containment/contained.h does.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/control/control_law.h"
#include "core/control/law_memory.h"
#include "core/control/plugin_config.h"

namespace dispersa {

inline constexpr int kLawTelemetry = DISPERSA_LAW_TELEMETRY;

/// A plug-in that cannot be used, in words for the user.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A plug-in's description of itself.
struct PluginDescription {
  std::string name;
  std::string version;
  std::vector<std::string> parameters;
};

/// The functions of a law, and their constant arguments.
class PluginLaw {
 public:
  explicit PluginLaw(const PluginConfig& config) : config_(config) {}
  /// A loaded library stays loaded: unloading would run its code where no guard watches it.
  PluginLaw(const PluginLaw&) = delete;
  PluginLaw& operator=(const PluginLaw&) = delete;

  const PluginConfig& config() const { return config_; }
  /// Loads the object at the first call, which runs code of it. Allowed only in a process with marked calls
  /// (MarkPluginCallsIn), so that another process watches it. Throws PluginError. Not thread-safe until it
  /// has returned once.
  void Open() const;
  /// Opens it.
  PluginDescription Describe() const;

  struct Functions {
    const dispersa_law_description* (*describe)(void) = nullptr;
    int (*create)(const dispersa_law_setup*, void*) = nullptr;
    int (*start_stage)(const dispersa_law_stage*, void*) = nullptr;
    int (*step)(const dispersa_law_input*, dispersa_law_output*, void*) = nullptr;
    /// For a law in this process: called before it is created for a case, and after its flight. Null: no
    /// call.
    void (*begin)(std::uint64_t case_index, void* memory) = nullptr;
    void (*end)(void* memory) = nullptr;
  };
  /// The functions of an open plug-in.
  const Functions& functions() const { return functions_; }
  const dispersa_law_description& description() const { return *description_; }
  /// In the order of the description. Throws PluginError.
  std::vector<double> OrderedParameters() const;

 private:
  PluginConfig config_;
  mutable void* handle_ = nullptr;
  mutable Functions functions_;
  mutable const dispersa_law_description* description_ = nullptr;
};

/// Position of a call into a plug-in, for a watching process. Written before and after each call.
struct PluginMark {
  std::uint64_t case_index = 0;
  std::uint64_t calls = 0;  ///< odd while a call is under way
  double time_s = 0.0;      ///< since lift-off
  std::int32_t stage = -1;  ///< from 0, and -1 before the first
};
/// Sets where this process writes its mark. At first it writes none (null).
void MarkPluginCallsIn(volatile PluginMark* mark);

/// The law of one flight.
class PluginFlight {
 public:
  /// Opens the law. `axes`: bits of those that it commands.
  PluginFlight(const PluginLaw& law, double tick_s, std::size_t stages, unsigned axes,
               std::uint64_t case_index);
  PluginFlight(const PluginFlight&) = delete;
  PluginFlight& operator=(const PluginFlight&) = delete;

  /// Returns false if the law fails, as Step does: then it is not called any more. Both throw PluginError if
  /// the law has written beside the flight's memory.
  bool StartStage(const dispersa_law_stage& stage, double time_s);
  /// Sets the commanded angular accelerations, rad/s². They may have any value.
  bool Step(const dispersa_law_input& input, double* command_rad_s2);

  /// Why the flight ends, as a string literal; null while it goes on.
  const char* failure() const { return failure_; }
  const std::array<double, kLawTelemetry>& telemetry() const { return telemetry_; }

 private:
  bool Succeeded(int code, const char* otherwise);
  void Begin(double time_s, int stage);
  void End(double time_s, int stage);

  // Tells a law of this process that its flight is over.
  struct Farewell {
    void (*end)(void* memory);
    void* memory;
    ~Farewell() {
      if (end != nullptr) end(memory);
    }
  };

  const PluginLaw& law_;
  const unsigned axes_;
  const std::uint64_t case_index_;
  LawMemory memory_;
  Farewell farewell_{nullptr, nullptr};
  std::uint64_t calls_ = 0;
  std::array<double, kLawTelemetry> telemetry_{};
  const char* failure_ = nullptr;
};

}  // namespace dispersa
