#include "core/input/input_node.h"

#include <utility>

namespace dispersa {
namespace {

InputNode NodeAt(const InputNode& place, InputNode::Kind kind) {
  InputNode node;
  node.kind = kind;
  node.file = place.file;
  node.line = place.line;
  node.column = place.column;
  return node;
}

}  // namespace

const InputNode* InputNode::Find(std::string_view key) const {
  for (const InputMember& member : members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

InputNode* InputNode::Find(std::string_view key) {
  return const_cast<InputNode*>(std::as_const(*this).Find(key));
}

std::string InputNode::Describe() const {
  switch (kind) {
    case Kind::kNull:
      return "nothing";
    case Kind::kList:
      return "a list";
    case Kind::kMap:
      return "a map";
    case Kind::kScalar:
      break;
  }
  return "'" + text + "'";
}

InputNode ScalarAt(const InputNode& place, std::string text) {
  InputNode node = NodeAt(place, InputNode::Kind::kScalar);
  node.text = std::move(text);
  return node;
}

InputNode TextAt(const InputNode& place, std::string text) {
  InputNode node = ScalarAt(place, std::move(text));
  node.quoted = true;
  return node;
}

InputNode ListAt(const InputNode& place) { return NodeAt(place, InputNode::Kind::kList); }

InputNode MapAt(const InputNode& place) { return NodeAt(place, InputNode::Kind::kMap); }

void SetMember(InputNode& map, const std::string& key, InputNode value) {
  if (InputNode* present = map.Find(key)) {
    *present = std::move(value);
  } else {
    const int line = value.line;
    const int column = value.column;
    map.members.push_back({key, line, column, std::move(value)});
  }
}

}  // namespace dispersa
