#include "core/input/struct_problems.h"

#include <algorithm>
#include <cctype>

#include "core/input/number_text.h"
#include "core/input/units.h"

namespace dispersa {
namespace {

// The name without its unit: the longest suffix that is one.
std::string_view Stem(std::string_view name) {
  std::size_t longest = 0;
  for (const std::string_view unit : kUnitLike) {
    if (name.size() > unit.size() + 1 && name.ends_with(unit) && name[name.size() - unit.size() - 1] == '_') {
      longest = std::max(longest, unit.size() + 1);
    }
  }
  return name.substr(0, name.size() - longest);
}

const InputMember* FindMember(const InputNode& map, std::string_view name) {
  for (const InputMember& member : map.members) {
    if (member.key == name) return &member;
  }
  for (const InputMember& member : map.members) {
    if (Stem(member.key) == Stem(name)) return &member;
  }
  return nullptr;
}

}  // namespace

bool IsInAnotherUnit(std::string_view a, std::string_view b) {
  return a != b && Stem(a) == Stem(b) && Stem(a).size() < std::min(a.size(), b.size());
}

const InputNode& FindField(const InputNode& node, const std::string& field_path, std::string* found_path) {
  const InputNode* at = &node;
  found_path->clear();
  std::string_view rest = field_path;
  while (!rest.empty()) {
    if (rest.front() == '.') rest.remove_prefix(1);
    if (rest.starts_with('[')) {
      const std::size_t close = std::min(rest.find(']'), rest.size());
      const auto index = ParseInteger(rest.substr(1, close - 1));
      if (!index || *index >= at->items.size()) return *at;
      *found_path += "[" + std::to_string(*index) + "]";
      at = &at->items[*index];
      rest.remove_prefix(std::min(close + 1, rest.size()));
      continue;
    }
    const std::size_t end = std::min(rest.find_first_of(".["), rest.size());
    const InputMember* member = FindMember(*at, rest.substr(0, end));
    if (member == nullptr) return *at;
    if (!found_path->empty()) *found_path += ".";
    *found_path += member->key;
    at = &member->value;
    rest.remove_prefix(end);
  }
  return *at;
}

}  // namespace dispersa
