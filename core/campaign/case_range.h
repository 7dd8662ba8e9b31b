// A share of a campaign's cases, for schedulers that start the same command many times.
#pragma once

#include <cstdint>

namespace dispersa {

/// Cases first ... end - 1.
struct CaseRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;

  std::uint64_t size() const { return end - first; }
  bool Contains(std::uint64_t case_index) const { return case_index >= first && case_index < end; }
  bool operator==(const CaseRange&) const = default;
};

/// What one of several folders holds of a round of cases.
struct CaseShare {
  CaseRange cases;
  std::uint64_t round_end = 0;  ///< of all its shares

  bool operator==(const CaseShare&) const = default;
};

/// One of `count` blocks of a range, index < count. They follow one another, and their sizes differ by one at
/// most. `all` has fewer than 2^32 cases, and `count` is below 2^32.
inline CaseRange BlockOf(const CaseRange& all, std::uint64_t index, std::uint64_t count) {
  return {all.first + all.size() * index / count, all.first + all.size() * (index + 1) / count};
}

}  // namespace dispersa
