#include "services/schema/shared_parts.h"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

// Sizes in characters: of a reference, of a reference with a description, and of the name under "$defs".
constexpr std::size_t kReference = 30, kDescribed = 45, kName = 16;

// Calls visit(part, key) of every schema directly inside a schema; `key`: of the properties, else empty.
void VisitParts(Json& schema, const std::function<void(Json&, const std::string&)>& visit) {
  if (!schema.is_object()) return;
  for (const char* keyword : {"properties", "$defs"})
    if (const auto parts = schema.find(keyword); parts != schema.end())
      for (auto& [key, part] : parts->items()) visit(part, key);
  if (const auto parts = schema.find("patternProperties"); parts != schema.end())
    for (auto& [pattern, part] : parts->items()) visit(part, "");
  for (const char* keyword : {"anyOf", "oneOf", "allOf"})
    if (const auto parts = schema.find(keyword); parts != schema.end())
      for (Json& part : *parts) visit(part, "");
  for (const char* keyword : {"items", "additionalProperties", "propertyNames", "not", "if", "then", "else"})
    if (const auto part = schema.find(keyword); part != schema.end()) visit(*part, "");
}

// Its text without the description, which depends on its place.
std::string PartOf(const Json& json) {
  Json part = json;
  part.erase("description");
  return part.dump();
}

class Sharing {
 public:
  Json Apply(Json schema) {
    Json named = std::move(schema["$defs"]);
    schema.erase("$defs");
    for (const auto& [name, value] : named.items()) uses_[name] = 1;
    // First all that there are, then without those inside others that are shared.
    for (int pass = 0; pass < 2; ++pass) {
      const Counts before = std::exchange(counts_, {});
      for (auto& [name, value] : named.items()) CountParts(value, before);
      CountParts(schema, before);
    }
    ReplaceParts(schema, "");
    for (auto& [name, value] : named.items()) ReplaceParts(value, name);
    for (auto& [name, value] : defs_.items()) named[name] = std::move(value);
    if (!named.empty()) schema["$defs"] = std::move(named);
    return schema;
  }

 private:
  using Counts = std::map<std::string, std::size_t>;

  // It takes less.
  static bool IsShared(const Counts& counts, const std::string& text, std::size_t reference) {
    const auto count = counts.find(text);
    if (count == counts.end()) return false;
    return count->second * text.size() > text.size() + kName + count->second * reference;
  }

  void CountParts(Json& schema, const Counts& before) {
    VisitParts(schema, [&](Json& child, const std::string&) {
      if (!child.is_object()) return;
      const std::string whole = child.dump(), part = PartOf(child);
      const bool is_known = ++counts_[part] > 1 && IsShared(before, part, kDescribed);
      if (whole != part) {
        ++counts_[whole];
        if (IsShared(counts_, whole, kReference)) wholes_[part].insert(whole);
      }
      if (!is_known) CountParts(child, before);
    });
  }

  // `name`: of the key that holds it.
  void Replace(Json& json, const std::string& name) {
    if (!json.is_object()) return;
    std::string part = json.dump();
    const bool is_whole = IsShared(counts_, part, kReference);
    if (!is_whole) part = PartOf(json);
    if (!is_whole && !IsShared(counts_, part, kDescribed)) return ReplaceParts(json, name);
    Json reference = {{"$ref", "#/$defs/" + NameOf(part, name)}};
    json = !is_whole && json.contains("description") ? Beside(json["description"], reference) : reference;
  }

  // Nothing is read beside a $ref.
  static Json Beside(const Json& description, const Json& reference) {
    return {{"description", description}, {"allOf", Json::array({reference})}};
  }

  // The name under "$defs" of the part with this text.
  std::string NameOf(const std::string& text, const std::string& name) {
    if (const auto known = names_.find(text); known != names_.end()) return known->second;
    const int number = ++uses_[name];
    const std::string own = number == 1 ? name : "part_" + std::to_string(++parts_);
    names_[text] = own;
    Json shared = Json::parse(text);
    // Several that differ in their descriptions alone have the rest in common.
    const std::string part = PartOf(shared);
    const auto wholes = part == text ? wholes_.end() : wholes_.find(part);
    if (wholes != wholes_.end() && IsShared({{part, wholes->second.size()}}, part, kDescribed))
      shared = Beside(shared["description"], {{"$ref", "#/$defs/" + NameOf(part, name)}});
    else
      ReplaceParts(shared, name);
    defs_[own] = std::move(shared);
    return own;
  }
  void ReplaceParts(Json& schema, const std::string& name) {
    VisitParts(schema, [&](Json& part, const std::string& key) { Replace(part, key.empty() ? name : key); });
  }

  Counts counts_;  // of each schema, and of what it says whoever holds it
  std::map<std::string, std::set<std::string>>
      wholes_;                                // shared schemas by what they say without a description
  std::map<std::string, std::string> names_;  // of each shared part
  std::map<std::string, int> uses_;           // of each name
  int parts_ = 0;                             // so many whose name was taken
  Json defs_ = Json::object();
};

// A single rule needs no list. Nothing is read beside a reference, so one replaces only a schema without
// other keywords.
void Simplify(Json& schema) {
  VisitParts(schema, [](Json& part, const std::string&) { Simplify(part); });
  const auto rules = schema.find("allOf");
  if (rules == schema.end() || rules->size() != 1) return;
  const Json rule = rules->front();
  if (schema.size() > 1 && rule.contains("$ref")) return;
  for (const auto& [keyword, value] : rule.items())
    if (keyword != "allOf" && schema.contains(keyword)) return;
  schema.erase("allOf");
  schema.update(rule);
}

}  // namespace

Json WithSharedParts(Json schema) {
  schema = Sharing().Apply(std::move(schema));
  Simplify(schema);
  return schema;
}

}  // namespace dispersa
