#include "services/schema/schema_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/schema/schema_model.h"

namespace dispersa {
namespace {

using JsonText = nlohmann::ordered_json;

// How people write what a key's end says.
std::string UnitText(const std::string& unit) {
  static const std::map<std::string, std::string> kTexts = {{"um", "µm"},           {"m2", "m²"},
                                                            {"kg_s", "kg/s"},       {"kg_m2", "kg m²"},
                                                            {"kg_m", "kg/m"},       {"gpa", "GPa"},
                                                            {"mpa", "MPa"},         {"pa", "Pa"},
                                                            {"kpa", "kPa"},         {"n", "N"},
                                                            {"kn", "kN"},           {"n_m2", "N m²"},
                                                            {"kn_m2", "kN m²"},     {"mn_m2", "MN m²"},
                                                            {"n_m", "N m"},         {"kn_m", "kN m"},
                                                            {"pa_rad", "Pa rad"},   {"kpa_rad", "kPa rad"},
                                                            {"pa_deg", "Pa °"},     {"w_m2", "W/m²"},
                                                            {"kw_m2", "kW/m²"},     {"m_s", "m/s"},
                                                            {"km_s", "km/s"},       {"km_h", "km/h"},
                                                            {"deg", "°"},           {"deg_s", "°/s"},
                                                            {"rad_s", "rad/s"},     {"hz", "Hz"},
                                                            {"deg_s2", "°/s²"},     {"rad_s2", "rad/s²"},
                                                            {"1_s", "1/s"},         {"1_s2", "1/s²"},
                                                            {"per_km", "1/km"},     {"per_m", "1/m"},
                                                            {"per_m_s", "s/m"},     {"kg_m3", "kg/m³"},
                                                            {"percent", "%"},       {"k", "K"},
                                                            {"per_deg", "1/°"},     {"per_rad", "1/rad"},
                                                            {"ton", "t (1000 kg)"}, {"percent_per_k", "%/K"}};
  const auto found = kTexts.find(unit);
  return found == kTexts.end() ? unit : found->second;
}

// "km, a number above 0"
std::string Hint(const Expectation& number) {
  std::string text = number.kind == Expectation::Kind::kInteger ? "a whole number" : "a number";
  if (!number.low.empty() && !number.high.empty() && !number.low_open && !number.high_open) {
    text += " from " + number.low + " to " + number.high;
  } else {
    if (!number.low.empty()) text += (number.low_open ? " above " : " not below ") + number.low;
    if (!number.high.empty())
      text += std::string(number.low.empty() ? "" : " and") + (number.high_open ? " below " : " not above ") +
              number.high;
  }
  return number.unit.empty() ? text : UnitText(number.unit) + ", " + text;
}

JsonText Number(const Expectation& number) {
  JsonText json = {{"type", number.kind == Expectation::Kind::kInteger ? "integer" : "number"}};
  if (!number.low.empty())
    json[number.low_open ? "exclusiveMinimum" : "minimum"] = JsonText::parse(number.low);
  if (!number.high.empty())
    json[number.high_open ? "exclusiveMaximum" : "maximum"] = JsonText::parse(number.high);
  json["description"] = Hint(number);
  if (number.absent && !number.absent->empty()) json["default"] = JsonText::parse(*number.absent);
  return json;
}

// One of the schemas.
JsonText AnyOf(std::vector<JsonText> schemas) {
  if (schemas.size() == 1) return std::move(schemas.front());
  JsonText any = {{"anyOf", JsonText::array()}};
  for (JsonText& schema : schemas) any["anyOf"].push_back(std::move(schema));
  return any;
}

JsonText Holds(const SchemaCondition& condition) {
  std::vector<JsonText> any;
  for (const std::string& key : condition.keys) {
    JsonText has = JsonText::object();
    if (!condition.words.empty()) {
      JsonText words = JsonText::array();
      for (const std::string& word : condition.words) {
        if (word == "true" || word == "false")
          words.push_back(word == "true");
        else
          words.push_back(word);
      }
      has["properties"] = {{key, {{"enum", std::move(words)}}}};
    }
    has["required"] = JsonText::array({key});
    any.push_back(std::move(has));
  }
  return AnyOf(std::move(any));
}

JsonText HoldsAny(const std::vector<SchemaCondition>& conditions) {
  std::vector<JsonText> any;
  for (const SchemaCondition& condition : conditions) any.push_back(Holds(condition));
  return AnyOf(std::move(any));
}

class SchemaWriter {
 public:
  JsonText Write(FileKind kind) {
    JsonText root = File(kind, true);
    JsonText schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                       {"title", fmt::format("dispersa {} file", NameOf(kind))},
                       {"description",
                        "Written by `dispersa schema` from the reader of these files. What two maps say "
                        "together only `dispersa validate` knows."}};
    for (auto& [key, value] : root.items()) schema[key] = std::move(value);
    schema["definitions"] = std::move(documents_);
    return Shared(std::move(schema));
  }

 private:
  // A whole file; where it stands in another, without need of the key `schema`.
  JsonText File(FileKind kind, bool alone) {
    static std::map<FileKind, SchemaModel> learned;  // several files hold a vehicle
    const auto [entry, is_new] = learned.try_emplace(kind);
    if (is_new) entry->second = LearnSchema(kind);
    const SchemaModel& model = entry->second;
    JsonText json = Map(model, "");
    json["properties"]["schema"] = {{"const", SchemaOf(kind)}, {"description", "the kind of this file"}};
    if (alone) {
      if (!json.contains("required")) json["required"] = JsonText::array();
      json["required"].insert(json["required"].begin(), "schema");
    }
    return json;
  }

  JsonText Document(const std::string& schema) {
    for (const FileKind kind : kFileKinds) {
      if (SchemaOf(kind) != schema) continue;
      if (!documents_.contains(NameOf(kind))) {
        documents_[NameOf(kind)] = nullptr;
        documents_[NameOf(kind)] = File(kind, false);
      }
      return {{"$ref", "#/definitions/" + NameOf(kind)}};
    }
    return true;
  }

  JsonText Value(const SchemaModel& model, const std::string& path) {
    std::vector<JsonText> any;
    const auto found = model.values.find(path);
    if (found == model.values.end()) return true;
    const auto expects = [&](Expectation::Kind kind) {
      return std::any_of(found->second.begin(), found->second.end(),
                         [&](const Expectation& e) { return e.kind == kind; });
    };
    const bool is_document = expects(Expectation::Kind::kDocument);
    for (const Expectation& one : found->second) {
      switch (one.kind) {
        case Expectation::Kind::kNumber:
        case Expectation::Kind::kInteger:
          any.push_back(Number(one));
          break;
        case Expectation::Kind::kText:
          if (!expects(Expectation::Kind::kWords)) any.push_back({{"type", "string"}, {"minLength", 1}});
          break;
        case Expectation::Kind::kFlag:
          any.push_back({{"type", "boolean"}});
          if (one.absent && !one.absent->empty()) any.back()["default"] = *one.absent == "true";
          break;
        case Expectation::Kind::kWords:
          if (one.open)
            any.push_back({{"type", "string"}, {"minLength", 1}, {"examples", one.words}});
          else
            any.push_back({{"enum", one.words}});
          if (one.absent && !one.absent->empty()) any.back()["default"] = *one.absent;
          break;
        case Expectation::Kind::kList:
          any.push_back(List(model, path, one));
          break;
        case Expectation::Kind::kMap:
          if (!is_document && !expects(Expectation::Kind::kColumns) && !expects(Expectation::Kind::kNumbers))
            any.push_back(Map(model, path));
          break;
        case Expectation::Kind::kFile:
          any.push_back(
              {{"type", "string"}, {"minLength", 1}, {"description", "a file, named relative to this one"}});
          break;
        case Expectation::Kind::kDocument:
          any.push_back(Document(one.words.front()));
          break;
        case Expectation::Kind::kNumbers:
          any.push_back({{"type", "object"}, {"additionalProperties", {{"type", "number"}}}});
          break;
        case Expectation::Kind::kColumns:
          any.push_back({{"type", "object"},
                         {"additionalProperties", {{"type", "array"}, {"items", {{"type", "number"}}}}}});
          break;
      }
    }
    if (!expects(Expectation::Kind::kList) && model.values.contains(path + "[]")) {
      Expectation list{.kind = Expectation::Kind::kList};
      list.low_count = 1;
      any.push_back(List(model, path, list));
    }
    return AnyOf(std::move(any));
  }

  JsonText List(const SchemaModel& model, const std::string& path, const Expectation& list) {
    JsonText json = {{"type", "array"}, {"items", Value(model, path + "[]")}};
    if (list.low_count > 0) json["minItems"] = list.low_count;
    if (list.high_count != SIZE_MAX) json["maxItems"] = list.high_count;
    return json;
  }

  JsonText Map(const SchemaModel& model, const std::string& path) {
    JsonText json = {{"type", "object"}, {"properties", JsonText::object()}, {"additionalProperties", false}};
    JsonText required = JsonText::array(), all_of = JsonText::array(), dependencies = JsonText::object();
    const SchemaMap& map = model.maps.at(path);
    for (const SchemaField& field : map.fields) {
      for (std::size_t i = 0; i < field.keys.size(); ++i) {
        const std::string& key = field.keys[i];
        json["properties"][key] = Value(model, path.empty() ? key : path + "." + key);
        JsonText beside = JsonText::object();
        if (!field.only_if.empty()) beside["allOf"].push_back(HoldsAny(field.only_if));
        if (!field.not_if.empty()) beside["allOf"].push_back({{"not", HoldsAny(field.not_if)}});
        // One unit of one thing.
        std::vector<JsonText> others;
        for (std::size_t j = 0; j < i; ++j)
          others.push_back({{"required", JsonText::array({field.keys[j]})}});
        if (!others.empty()) beside["allOf"].push_back({{"not", AnyOf(std::move(others))}});
        if (beside.empty()) continue;
        dependencies[key] = beside["allOf"].size() == 1 ? beside["allOf"][0] : beside;
      }
    }
    for (const SchemaRequirement& requirement : map.requirements) {
      std::vector<JsonText> any;
      for (const std::string& key : requirement.keys) any.push_back({{"required", JsonText::array({key})}});
      if (any.size() == 1 && requirement.unless.empty() && requirement.only_if.empty()) {
        required.push_back(requirement.keys.front());
        continue;
      }
      for (const SchemaCondition& condition : requirement.unless) any.push_back(Holds(condition));
      if (requirement.only_if.empty())
        all_of.push_back(AnyOf(std::move(any)));
      else
        all_of.push_back({{"if", HoldsAny(requirement.only_if)}, {"then", AnyOf(std::move(any))}});
    }
    if (!required.empty()) json["required"] = std::move(required);
    if (!dependencies.empty()) json["dependencies"] = std::move(dependencies);
    if (!all_of.empty()) json["allOf"] = std::move(all_of);
    return json;
  }

  // ---- What stands more than once is written once, among the definitions ----

  static bool IsShareable(const JsonText& json) {
    return json.is_object() && json.contains("additionalProperties");
  }

  static void Count(const JsonText& json, std::map<std::string, int>& counts) {
    if (IsShareable(json) && ++counts[json.dump()] > 1) return;
    if (json.is_structured())
      for (const JsonText& value : json) Count(value, counts);
  }

  void Replace(JsonText& json, const std::string& name, const std::map<std::string, int>& counts) {
    if (!json.is_structured()) return;
    const bool is_shared = IsShareable(json) && counts.at(json.dump()) > 1;
    if (is_shared) {
      const std::string text = json.dump();
      if (!names_.contains(text)) {
        const int number = ++uses_[name];
        names_[text] = number == 1 ? name : fmt::format("{}_{}", name, number);
        for (auto& [key, value] : json.items()) Replace(value, key == "items" ? name : key, counts);
        shared_[names_[text]] = std::move(json);
      }
      json = {{"$ref", "#/definitions/" + names_[text]}};
      return;
    }
    if (json.is_array()) {
      for (JsonText& value : json) Replace(value, name, counts);
    } else {
      const bool is_keyword = IsKeyword(name);
      for (auto& [key, value] : json.items())
        Replace(value, IsKeyword(key) && !is_keyword ? name : key, counts);
    }
  }
  static bool IsKeyword(const std::string& name) {
    static const std::set<std::string> kKeywords = {"properties", "items", "anyOf",       "allOf",
                                                    "if",         "then",  "dependencies"};
    return kKeywords.contains(name);
  }

  JsonText Shared(JsonText schema) {
    std::map<std::string, int> counts;
    for (const JsonText& value : schema) Count(value, counts);
    for (auto& [key, value] : schema["definitions"].items()) uses_[key] = 1;
    for (auto& [key, value] : schema.items()) {
      if (key != "definitions") {
        Replace(value, key, counts);
        continue;
      }
      for (auto& [name, document] : value.items())
        for (auto& [within, part] : document.items()) Replace(part, within, counts);
    }
    for (auto& [name, shared] : shared_.items()) schema["definitions"][name] = std::move(shared);
    if (schema["definitions"].empty()) schema.erase("definitions");
    return schema;
  }

  JsonText documents_ = JsonText::object();
  JsonText shared_ = JsonText::object();
  std::map<std::string, std::string> names_;
  std::map<std::string, int> uses_;
};

}  // namespace

JsonText SchemaJson(FileKind kind) { return SchemaWriter().Write(kind); }

}  // namespace dispersa
