// A share of a campaign's cases, for schedulers that start the same command many times.
#pragma once

#include <cstdint>
#include <string>

namespace dispersa {

/// Cases first ... end - 1.
struct CaseRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;

  std::uint64_t size() const { return end - first; }
  bool Contains(std::uint64_t case_index) const { return case_index >= first && case_index < end; }
  bool operator==(const CaseRange&) const = default;
};

/// "case 5", "cases 10 to 19".
inline std::string CasesText(const CaseRange& cases) {
  if (cases.size() == 0) return "no case";
  const std::string first = std::to_string(cases.first);
  return cases.size() == 1 ? "case " + first : "cases " + first + " to " + std::to_string(cases.end - 1);
}

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
