#include "core/campaign_yaml/canonical.h"

#include <algorithm>
#include <cstdio>

#include "core/input/number_text.h"

namespace dispersa {
namespace {

// Text that YAML reads back as itself without quotes. Narrow on purpose: letters first, then letters, digits
// and what file names and schemas need.
bool IsPlainText(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_other = [](char c) {
    return (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' || c == '/';
  };
  if (text.empty() || !is_letter(text[0])) return false;
  if (!std::all_of(text.begin(), text.end(), [&](char c) { return is_letter(c) || is_other(c); }))
    return false;
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower != "true" && lower != "false" && lower != "null" && !ParseNumber(lower);
}

std::string WithEscapes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(byte));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

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
    out += indent + (IsPlainText(member->key) ? member->key : WithEscapes(member->key)) + ":";
    EmitValue(member->value, indent, out);
  }
}

}  // namespace

std::string CanonicalText(const InputNode& map) {
  std::string out;
  Emit(map, "", out);
  return out;
}

std::string TextScalar(const std::string& text) { return IsPlainText(text) ? text : WithEscapes(text); }

}  // namespace dispersa
