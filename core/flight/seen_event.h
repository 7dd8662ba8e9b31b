// What happened in a flight, and how the vehicle was right after it.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

/// NaN: undefined, as the dynamic pressure of a body that falls as a point.
struct SeenEvent {
  std::string name;         ///< "lift_off", "max_q", "stage_1_burnout", "jettison_1", ...
  double time_s = 0.0;      ///< since lift-off
  double altitude_m = 0.0;  ///< geodetic
  double speed_m_s = 0.0;   ///< over the rotating Earth
  double qbar_pa = 0.0;     ///< dynamic pressure
  double mass_kg = 0.0;     ///< without what has left

  static const std::array<double SeenEvent::*, 5> kValues;
  bool operator==(const SeenEvent&) const = default;
};
inline constexpr std::array<double SeenEvent::*, 5> SeenEvent::kValues = {
    &SeenEvent::time_s, &SeenEvent::altitude_m, &SeenEvent::speed_m_s, &SeenEvent::qbar_pa,
    &SeenEvent::mass_kg};
inline constexpr std::array<const char*, 5> kEventValueNames = {"time_s", "altitude_m", "speed_m_s",
                                                                "qbar_pa", "mass_kg"};

/// The event of this name; null: it did not happen.
inline const SeenEvent* FindEvent(const std::vector<SeenEvent>& events, std::string_view name) {
  const auto found =
      std::find_if(events.begin(), events.end(), [&](const SeenEvent& event) { return event.name == name; });
  return found == events.end() ? nullptr : &*found;
}

/// Whether a text has the form of an event's name, whoever wrote it.
inline bool IsEventName(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return !text.empty() && text.size() <= kLongest && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace dispersa
