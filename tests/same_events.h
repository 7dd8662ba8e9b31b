// Whether flights tell of the same events, to the last bit. Undefined equals undefined.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "core/flight/seen_event.h"

namespace dispersa {

inline bool AreSame(const std::vector<SeenEvent>& a, const std::vector<SeenEvent>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SeenEvent& x, const SeenEvent& y) {
    return x.name == y.name &&
           std::all_of(SeenEvent::kValues.begin(), SeenEvent::kValues.end(), [&](auto of) {
             return std::bit_cast<std::uint64_t>(x.*of) == std::bit_cast<std::uint64_t>(y.*of);
           });
  });
}

}  // namespace dispersa
