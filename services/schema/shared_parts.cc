#include "services/schema/shared_parts.h"

#include <map>
#include <set>
#include <string>
#include <utility>

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

// A reference and its name take about so much.
constexpr std::size_t kLeastShared = 80;

bool IsKeyword(const std::string& key) {
  static const std::set<std::string> kKeywords = {
      "properties", "items", "additionalProperties", "anyOf", "oneOf", "allOf", "if", "then", "else"};
  return kKeywords.contains(key);
}

// A schema and not the map of a schema's properties, which no keyword of these types tells.
bool IsSchema(const Json& json) {
  const auto has = [&](const char* keyword, Json::value_t type) {
    const auto found = json.find(keyword);
    return found != json.end() && found->type() == type;
  };
  return json.is_object() && (has("type", Json::value_t::string) || has("anyOf", Json::value_t::array) ||
                              has("if", Json::value_t::object) || has("enum", Json::value_t::array) ||
                              has("oneOf", Json::value_t::array));
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
    for (const auto& [name, value] : named.items()) {
      uses_[name] = 1;
      CountChildren(value);
    }
    CountChildren(schema);
    ReplaceChildren(schema, "");
    for (auto& [name, value] : named.items()) ReplaceChildren(value, name);
    for (auto& [name, value] : defs_.items()) named[name] = std::move(value);
    if (!named.empty()) schema["$defs"] = std::move(named);
    return schema;
  }

 private:
  void CountChildren(const Json& json) {
    if (!json.is_structured()) return;
    for (const Json& child : json) {
      if (IsSchema(child)) {
        const std::string part = PartOf(child);
        if (part.size() >= kLeastShared && ++counts_[part] > 1) continue;
      }
      CountChildren(child);
    }
  }

  // `name`: of the key that holds it.
  void Replace(Json& json, const std::string& name) {
    const std::string part = IsSchema(json) ? PartOf(json) : "";
    const auto count = counts_.find(part);
    if (count == counts_.end() || count->second < 2) return ReplaceChildren(json, name);
    auto [found, is_new] = names_.try_emplace(part);
    if (is_new) {
      const int number = ++uses_[name];
      found->second = number == 1 ? name : name + "_" + std::to_string(number);
      const std::string own = found->second;
      Json shared = Json::parse(part);
      ReplaceChildren(shared, name);
      defs_[own] = std::move(shared);
    }
    Json reference = {{"$ref", "#/$defs/" + names_.at(part)}};
    if (json.contains("description"))  // nothing is read beside a $ref
      reference = {{"description", json["description"]}, {"allOf", Json::array({reference})}};
    json = std::move(reference);
  }
  void ReplaceChildren(Json& json, const std::string& name) {
    if (!json.is_structured()) return;
    if (json.is_array()) {
      for (Json& child : json) Replace(child, name);
      return;
    }
    for (auto& [key, child] : json.items()) Replace(child, IsKeyword(key) ? name : key);
  }

  std::map<std::string, int> counts_;         // of each part
  std::map<std::string, std::string> names_;  // of each shared part
  std::map<std::string, int> uses_;           // of each name
  Json defs_ = Json::object();
};

}  // namespace

Json WithSharedParts(Json schema) { return Sharing().Apply(std::move(schema)); }

}  // namespace dispersa
