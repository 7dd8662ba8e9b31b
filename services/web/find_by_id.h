// A campaign by the beginning of its id, as its user types it.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace dispersa {

/// Ids are "<64 digits>", and "<64 digits>-<engine>" of the same campaign as an earlier engine flew it.
/// `wanted` is the beginning of an id, or of both of its parts: "1a2b-3c4d". Without an engine it never
/// denotes an earlier flight: whoever deletes a campaign twice must not lose that one. The element of the map
/// that it denotes, if it is exactly one; else end().
template <typename Map>
auto FindById(const Map& by_id, std::string_view wanted) {
  const std::string_view begin = wanted.substr(0, wanted.find('-')), engine = wanted.substr(begin.size());
  auto found = by_id.end();
  if (begin.empty()) return found;
  for (auto each = by_id.lower_bound(std::string(begin)); each != by_id.end(); ++each) {
    const std::string_view id = each->first;
    if (!id.starts_with(begin)) break;
    const std::string_view its_engine = id.substr(std::min(id.size(), id.find('-')));
    if (its_engine.empty() != engine.empty() || !its_engine.starts_with(engine)) continue;
    if (found != by_id.end()) return by_id.end();
    found = each;
  }
  return found;
}

}  // namespace dispersa
