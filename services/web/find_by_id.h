// A campaign by the beginning of its id, as its user types it.
#pragma once

#include <string>
#include <string_view>

namespace dispersa {

/// Ids are "<64 digits>", and "<64 digits>-<engine>" of the same campaign as an earlier engine flew it.
/// `wanted` is the beginning of an id, or of both of its parts: "1a2b-3c4d". Without an engine it rather
/// denotes the present flight. The element of the map that it denotes, if it is exactly one; else end().
template <typename Map>
auto FindById(const Map& by_id, std::string_view wanted) {
  const std::string_view begin = wanted.substr(0, wanted.find('-'));
  const bool names_engine = begin.size() < wanted.size();
  auto found = by_id.end(), earlier = by_id.end();
  int count = 0, count_earlier = 0;
  if (begin.empty()) return found;
  for (auto each = by_id.lower_bound(std::string(begin)); each != by_id.end(); ++each) {
    const std::string_view id = each->first;
    if (!id.starts_with(begin)) break;
    const auto dash = id.find('-');
    if (dash == std::string_view::npos) {
      if (names_engine) continue;
      ++count;
      found = each;
    } else if (!names_engine || id.substr(dash).starts_with(wanted.substr(begin.size()))) {
      ++count_earlier;
      earlier = each;
    }
  }
  if (count == 1) return found;
  return count == 0 && count_earlier == 1 ? earlier : by_id.end();
}

}  // namespace dispersa
