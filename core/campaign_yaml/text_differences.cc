#include "core/campaign_yaml/text_differences.h"

#include <algorithm>
#include <set>

#include "core/campaign_yaml/parse_yaml.h"
#include "core/input/input_error.h"

namespace dispersa {
namespace {

using Kind = InputNode::Kind;

/// Number of items of a list that are shown.
constexpr std::size_t kShownItems = 6;

std::string Words(const InputNode* node) {
  if (node == nullptr) return "";
  switch (node->kind) {
    case Kind::kNull:
      return "null";
    case Kind::kScalar:
      return node->text;
    case Kind::kMap: {
      std::string words;
      for (const InputMember& member : node->members) {
        if (!words.empty()) words += ", ";
        words += member.key + ": " + Words(&member.value);
      }
      return "{" + words + "}";
    }
    case Kind::kList: {
      std::string words;
      for (std::size_t i = 0; i < std::min(kShownItems, node->items.size()); ++i) {
        if (i > 0) words += ", ";
        words += Words(&node->items[i]);
      }
      if (node->items.size() > kShownItems)
        words += ", … (" + std::to_string(node->items.size()) + " in all)";
      return "[" + words + "]";
    }
  }
  return "";
}

bool Equal(const InputNode& a, const InputNode& b) {
  if (a.kind != b.kind || a.text != b.text || a.quoted != b.quoted || a.items.size() != b.items.size() ||
      a.members.size() != b.members.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!Equal(a.items[i], b.items[i])) return false;
  // Canonical texts sort their keys.
  for (std::size_t i = 0; i < a.members.size(); ++i)
    if (a.members[i].key != b.members[i].key || !Equal(a.members[i].value, b.members[i].value)) return false;
  return true;
}

bool HoldsMaps(const InputNode& list) {
  return !list.items.empty() && std::all_of(list.items.begin(), list.items.end(),
                                            [](const InputNode& item) { return item.kind == Kind::kMap; });
}

void Collect(const std::string& path, const InputNode* a, const InputNode* b,
             std::vector<ValueDifference>& found) {
  if (a != nullptr && b != nullptr) {
    if (Equal(*a, *b)) return;
    if (a->kind == Kind::kMap && b->kind == Kind::kMap) {
      std::set<std::string> keys;
      for (const InputNode* node : {a, b})
        for (const InputMember& member : node->members) keys.insert(member.key);
      for (const std::string& key : keys)
        Collect(path.empty() ? key : path + "." + key, a->Find(key), b->Find(key), found);
      return;
    }
    if (a->kind == Kind::kList && b->kind == Kind::kList && a->items.size() == b->items.size() &&
        HoldsMaps(*a) && HoldsMaps(*b)) {
      for (std::size_t i = 0; i < a->items.size(); ++i)
        Collect(path + "[" + std::to_string(i) + "]", &a->items[i], &b->items[i], found);
      return;
    }
  }
  found.push_back({path, Words(a), Words(b)});
}

InputNode Parse(const std::string& text) {
  std::vector<InputProblem> problems;
  InputNode node = ParseYaml(text, "campaign.yaml", problems);
  if (!problems.empty()) throw InputError(problems);
  return node;
}

}  // namespace

std::vector<ValueDifference> DifferencesOf(const std::string& a, const std::string& b) {
  const InputNode of_a = Parse(a);
  const InputNode of_b = Parse(b);
  std::vector<ValueDifference> found;
  Collect("", &of_a, &of_b, found);
  return found;
}

}  // namespace dispersa
