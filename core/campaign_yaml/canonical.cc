#include "core/campaign_yaml/canonical.h"

#include <algorithm>

#include "core/input/number_text.h"
#include "core/input/yaml_text.h"

namespace dispersa {
namespace {

std::string ScalarText(const InputNode& node) {
  if (node.kind == InputNode::Kind::kNull) return "null";
  if (!node.quoted) {
    // Integers keep all digits: a seed may exceed the 53 bits of a double.
    if (const auto integer = ParseInteger(node.text)) return std::to_string(*integer);
    if (const auto number = ParseNumber(node.text)) return FormatNumber(*number);
    if (node.text == "true" || node.text == "false") return node.text;
  }
  return TextScalar(node.text);
}

bool IsScalar(const InputNode& node) {
  return node.kind == InputNode::Kind::kScalar || node.kind == InputNode::Kind::kNull;
}

void Emit(const InputNode& node, const std::string& indent, std::string& out);

// The rest of a line that began with "key:" or "-", and the lines below it.
void EmitValue(const InputNode& node, const std::string& indent, std::string& out) {
  if (IsScalar(node)) {
    out += ' ';
    out += ScalarText(node);
    out += '\n';
  } else if (node.kind == InputNode::Kind::kMap && node.members.empty()) {
    out += " {}\n";
  } else if (node.kind == InputNode::Kind::kList &&
             std::all_of(node.items.begin(), node.items.end(), IsScalar)) {
    out += " [";
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      if (i > 0) out += ", ";
      out += ScalarText(node.items[i]);
    }
    out += "]\n";
  } else {
    out += "\n";
    Emit(node, indent + "  ", out);
  }
}

void Emit(const InputNode& node, const std::string& indent, std::string& out) {
  if (node.kind == InputNode::Kind::kList) {
    for (const InputNode& item : node.items) {
      const std::size_t begin = out.size();
      if (item.kind == InputNode::Kind::kMap && !item.members.empty()) {
        Emit(item, indent + "  ", out);
        out[begin + indent.size()] = '-';
      } else {
        out += indent + "-";
        EmitValue(item, indent, out);
      }
    }
    return;
  }
  std::vector<const InputMember*> members;
  for (const InputMember& member : node.members) members.push_back(&member);
  std::sort(members.begin(), members.end(),
            [](const InputMember* a, const InputMember* b) { return a->key < b->key; });
  for (const InputMember* member : members) {
    out += indent + TextScalar(member->key) + ":";
    EmitValue(member->value, indent, out);
  }
}

}  // namespace

std::string CanonicalText(const InputNode& map) {
  std::string out;
  Emit(map, "", out);
  return out;
}

}  // namespace dispersa
