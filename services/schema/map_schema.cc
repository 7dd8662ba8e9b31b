#include "services/schema/map_schema.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/input/unit_text.h"

namespace dispersa {
namespace {

using Json = MapSchema::Json;

// An empty list counts as none.
constexpr std::size_t kLeastOfAList = 1;

Json InUnit(double value, const Unit& unit) {
  return Json::parse(FormatScaled(value - unit.offset, unit.scale));
}

Json NumberIn(const Range& range, const Unit& unit) {
  Json number = {{"type", "number"}};
  if (std::isfinite(range.low))
    number[range.low_open ? "exclusiveMinimum" : "minimum"] = InUnit(range.low, unit);
  if (std::isfinite(range.high))
    number[range.high_open ? "exclusiveMaximum" : "maximum"] = InUnit(range.high, unit);
  return number;
}

// "km, above 0: meaning"
std::string Description(const Range& range, const Unit& unit, const std::string& meaning) {
  const std::string number = TextIn(unit, range).substr(kAnyNumber.Text().size());
  std::string text(UnitText(unit.suffix));
  if (text.empty()) text = unit.suffix;
  if (!number.empty()) text += text.empty() ? number.substr(1) : "," + number;
  return text.empty() || meaning.empty() ? text + meaning : text + ": " + meaning;
}

Json ListOf(Json item, std::size_t low_count, std::size_t high_count) {
  Json list = {{"type", "array"}, {"items", std::move(item)}};
  if (low_count > 0) list["minItems"] = low_count;
  if (high_count != SIZE_MAX) list["maxItems"] = high_count;
  return list;
}

Json Described(Json value, const std::string& meaning) {
  value["description"] = meaning;
  return value;
}

Json AText() { return {{"type", "string"}, {"minLength", 1}}; }

// Another one may stand in its place.
Json Or(Json other, Json value) { return {{"anyOf", Json::array({std::move(other), std::move(value)})}}; }

// "m|km"
std::string UnitsOf(Dimension dimension) {
  std::string units;
  for (const Unit& unit : dimension) units += (units.empty() ? "" : "|") + std::string(unit.suffix);
  return units;
}

Json Required(const std::string& key) { return {{"required", Json::array({key})}}; }

// The alternatives of a pattern: "(a|b)", or "a".
std::string Alternatives(const std::string& texts) {
  return texts.find('|') == std::string::npos ? texts : "(" + texts + ")";
}

// One of the schemas holds, or exactly one.
Json Combined(const char* how, std::vector<Json> schemas) {
  if (schemas.size() == 1) return std::move(schemas.front());
  return {{how, Json(std::move(schemas))}};
}

}  // namespace

// ---- Which keys a map has ----

void MapSchema::Keys::AddTo(Json& schema) const {
  if (schema.empty() && required.empty() && rules.size() == 1) {
    schema = rules.front();
    return;
  }
  if (!required.empty()) schema["required"] = required;
  if (!rules.empty()) schema["allOf"] = rules;
}

// Keys in further units, whose meaning stands with the first one, are said together where they are alike.
void MapSchema::AddProperties(const Json& values, Json& schema) const {
  std::map<std::string, std::map<std::string, std::vector<std::string>>> alike;  // stems by schema and units
  Json own = Json::object();
  for (const auto& [key, value] : values.items()) {
    const auto quantity = quantities_.find(key);
    if (quantity == quantities_.end() || !value.is_object() || value.contains("description"))
      own[key] = value;
  }
  for (const auto& [stem, units] : FurtherUnits(values, own))
    for (const auto& [text, suffixes] : units) alike[text][suffixes].push_back(stem);
  schema["properties"] = std::move(own);
  for (const auto& [text, by_units] : alike) {
    std::string pattern;
    for (const auto& [suffixes, stems] : by_units) {
      std::string names;
      for (const std::string& stem : stems) names += (names.empty() ? "" : "|") + stem;
      pattern += (pattern.empty() ? "" : "|") + Alternatives(names) + "_" + Alternatives(suffixes);
    }
    schema["patternProperties"]["^(" + pattern + ")$"] = Json::parse(text);
  }
}

// Of the values that are not in `own`: by stem and schema the endings, "km|mm".
std::map<std::string, std::map<std::string, std::string>> MapSchema::FurtherUnits(const Json& values,
                                                                                  const Json& own) const {
  std::map<std::string, std::map<std::string, std::string>> found;
  for (const auto& [key, value] : values.items()) {
    if (own.contains(key)) continue;
    const std::string& stem = quantities_.at(key).stem;
    std::string& suffixes = found[stem][value.dump()];
    suffixes += (suffixes.empty() ? "" : "|") + key.substr(stem.size() + 1);
  }
  return found;
}

MapSchema::Json MapSchema::Finish() const {
  Json schema = {{"type", "object"}};
  if (keys_.groups.empty()) {
    AddProperties(keys_.values, schema);
    schema["additionalProperties"] = is_open_ ? Json{{"type", "number"}} : Json(false);
  } else {  // names that a group has are said by it
    Json own = Json::object(), names = Json::array();
    for (const auto& [key, value] : keys_.values.items())
      if (!keys_.of_groups.contains(key)) own[key] = value;
    for (const auto& [key, value] : own.items()) names.push_back(key);
    Json any = Json::array();
    if (!names.empty()) any.push_back({{"enum", std::move(names)}});
    for (const std::string& group : keys_.groups) any.push_back({{"$ref", group}});
    AddProperties(own, schema);
    schema["propertyNames"] = any.size() == 1 ? any.front() : Json{{"anyOf", any}};
  }
  if (!has_base_) {
    keys_.AddTo(schema);
  } else {  // what is missing here stands in the other file
    Json rules = Json::object();
    keys_.AddTo(rules);
    schema["if"] = {{"not", Required(kBasedOn)}};
    rules["properties"][kWithout] = false;
    schema["then"] = std::move(rules);
  }
  return schema;
}

MapSchema::Json MapSchema::MapOf(const Part& part) const {
  MapSchema map(shared_);
  part(map);
  return map.Finish();
}

void MapSchema::Add(const Key& key, Json value) {
  if (value.contains("items")) lists_.insert(key.name);
  keys_.values[key.name] = *key.meaning == 0 ? std::move(value) : Described(std::move(value), key.meaning);
  if (key.needed) keys_.required.push_back(key.name);
}

void MapSchema::AddUnits(const NumberKey& key, const std::function<Json(const Unit& unit)>& value) {
  const Dimension dimension = key.dimension;
  if (dimension.empty()) return Add({key.name, "", key.needed}, value(kNoUnit));
  const std::string units = UnitsOf(dimension);
  std::vector<Json> any;
  std::vector<std::string> names;
  for (const Unit& unit : dimension) {
    const std::string name = key.name + ("_" + std::string(unit.suffix));
    names.push_back(name);
    Json number = value(unit);
    if (&unit != &dimension.front()) {  // said once; the key's ending is the unit
      number.erase("description");
      number.erase("default");
    }
    Add({name.c_str(), "", key.needed && dimension.size() == 1}, std::move(number));
    quantities_[name] = {key.name, units};
    any.push_back(Required(name));
  }
  if (dimension.size() == 1) return;
  if (!key.needed && dimension.size() == 2) {  // shorter than three rules: either key, or none
    keys_.rules.push_back({{"not", {{"required", names}}}});
    return;
  }
  if (!key.needed) {
    Json none = {{"not", Combined("anyOf", any)}};
    any.push_back(std::move(none));
  }
  keys_.rules.push_back(Combined("oneOf", std::move(any)));
}

// A pattern for exactly these keys. Quantities are given by their stems and units, which takes a tenth of the
// length of all their keys.
std::string MapSchema::Pattern(const std::vector<std::string>& keys) const {
  std::map<std::string, std::set<std::string>> stems;  // by units
  std::string names;
  for (const std::string& key : keys) {
    const auto quantity = quantities_.find(key);
    if (quantity == quantities_.end())
      names += (names.empty() ? "" : "|") + key;
    else
      stems[quantity->second.units].insert(quantity->second.stem);
  }
  for (const auto& [units, of] : stems) {
    std::string group;
    for (const std::string& stem : of) group += (group.empty() ? "" : "|") + stem;
    names += (names.empty() ? "" : "|") + Alternatives(group) + "_" + Alternatives(units);
  }
  return "^(" + names + ")$";
}

// ---- Single values ----

void MapSchema::File(const char* schema, const BaseKeys* base) {
  Add({"schema", "the kind of this file", false}, {{"const", schema}});
  has_base_ = base != nullptr;
  if (!has_base_) return;
  Add({kBasedOn, kBasedOnMeaning, false}, AText());
  Add({kWithout, kWithoutMeaning, false}, ListOf(AText(), 1, SIZE_MAX));
}
void MapSchema::VisitText(const TextKey& key, std::string&) {
  Json text = key.absent ? Json{{"type", "string"}} : AText();
  if (!key.words.empty()) text = {{"enum", key.words}};
  if (key.absent && !key.absent->empty()) text["default"] = *key.absent;
  Add(key, std::move(text));
}
void MapSchema::VisitTexts(const TextKey& key, std::size_t low_count, std::size_t high_count,
                           std::vector<std::string>&) {
  Json text = key.words.empty() ? Json{{"type", "string"}} : Json{{"enum", key.words}};
  Add(key, ListOf(std::move(text), low_count, high_count));
}
void MapSchema::Flag(const char* key, bool&, bool absent, const char* meaning) {
  Add({key, meaning, false}, {{"type", "boolean"}, {"default", absent}});
}
void MapSchema::VisitWhole(const WholeKey& key, std::vector<std::uint64_t>&) {
  Json number = {{"type", "integer"}, {"minimum", key.low}, {"maximum", key.high}};
  if (key.noun != nullptr) {
    Json several = ListOf(number, 1, SIZE_MAX);
    several["uniqueItems"] = true;
    return Add(key, Or(number, std::move(several)));
  }
  if (key.absent) number["default"] = *key.absent;
  const std::string text = "a whole number from " + std::to_string(key.low) + " to " +
                           std::to_string(key.high) + ": " + key.meaning;
  Add({key.name, text.c_str(), key.needed}, std::move(number));
}
void MapSchema::VisitNumber(const NumberKey& key, std::optional<double>&) {
  AddUnits(key, [&](const Unit& unit) {
    Json number = Described(NumberIn(key.range, unit), Description(key.range, unit, key.meaning));
    if (key.absent) number["default"] = InUnit(*key.absent, unit);
    return number;
  });
}
void MapSchema::OneOf(const std::vector<OneQuantity>& quantities, std::size_t&, double&) {
  std::vector<Json> one;
  for (const OneQuantity& quantity : quantities) {
    for (const Unit& unit : quantity.dimension) {
      const std::string name = quantity.stem + ("_" + std::string(unit.suffix));
      const bool is_first = &unit == &quantity.dimension.front();  // said once; the key's ending is the unit
      const std::string text = is_first ? Description(quantity.range, unit, quantity.meaning) : std::string();
      quantities_[name] = {quantity.stem, UnitsOf(quantity.dimension)};
      Add({name.c_str(), text.c_str(), false}, NumberIn(quantity.range, unit));
      one.push_back(Required(name));
    }
  }
  keys_.rules.push_back(Combined("oneOf", std::move(one)));
}

// ---- Lists ----

void MapSchema::VisitNumbers(const NumbersKey& key, std::vector<double>&) {
  AddUnits(key, [&](const Unit& unit) {
    std::string text = Description(key.range, unit, key.meaning);
    const Json number = NumberIn(key.range, unit);
    Json list = ListOf(number, key.low_count, key.high_count);
    if (key.or_one) {
      list = Or(number, std::move(list));
      text += "; a list of two: at either end";
    } else if (key.or_file) {
      list = Or(AText(), std::move(list));
      text += "; or a CSV file with this column";
    }
    return Described(std::move(list), text);
  });
}
void MapSchema::VisitRows(const RowsKey& key, std::vector<std::vector<double>>&) {
  std::vector<std::string> names;
  for (const RowsKey::Column& column : key.columns) names.emplace_back(column.name);
  if (!names.empty())
    Add({"columns", "these names, in this order"}, ListOf({{"enum", names}}, names.size(), names.size()));
  Json row = key.width > 0 ? ListOf({{"type", "number"}}, key.width, key.width)
                           : ListOf({{"type", "number"}}, 0, SIZE_MAX);
  Add(key, ListOf(std::move(row), key.low_count, key.high_count));
}

// ---- Maps ----

void MapSchema::VisitMap(const MapKey& key, MapValue&, const Part& part) {
  Json value = MapOf(part);
  if (key.or_list) {
    const Json one = shared_.Named(std::string("one_") + key.name, [&] { return std::move(value); });
    value = Or(one, ListOf(one, 1, SIZE_MAX));
  }
  if (key.word != nullptr) value = Or({{"const", key.word}}, std::move(value));
  if (key.file != MapKey::File::kNone) value = Or(AText(), std::move(value));
  const Json number = {{"type", "number"}};
  if (key.or_number) value["anyOf"].insert(value["anyOf"].begin(), number);
  Add(key, std::move(value));
}
void MapSchema::VisitMaps(const Key& key, std::size_t low_count, std::size_t high_count, const Items& items) {
  items.resize(1);
  Json item = MapOf([&](Fields& fields) { items.describe(fields, 0); });
  items.resize(0);  // how many there are decides nothing
  Json list = ListOf(std::move(item), low_count, high_count);
  Add(key, items.or_folder ? Or(AText(), std::move(list)) : std::move(list));
}
void MapSchema::VisitNode(const NodeKey& key, const ReadNode&) {
  const Json columns = {{"type", "object"},
                        {"additionalProperties", {{"type", "array"}, {"items", {{"type", "number"}}}}}};
  Add(key, Or(AText(), key.schema == nullptr ? columns : shared_.Document(key.schema)));
}

// ---- Which keys go together ----

// Names and schemas of the keys are said once, for all maps that have them.
void MapSchema::Group(const char* name, const std::string& of, const Part& part) {
  if (of.empty()) return part(*this);
  MapSchema group(shared_);
  part(group);
  const std::string full = std::string(name) + "_" + of, keys = "keys_of_" + full;
  std::vector<std::string> names;
  for (const auto& [key, value] : group.keys_.values.items()) {
    keys_.values[key] = true;
    keys_.of_groups.insert(key);
    names.push_back(key);
  }
  quantities_.insert(group.quantities_.begin(), group.quantities_.end());
  keys_.groups.insert(shared_.Named(keys, [&] { return Json{{"pattern", Pattern(names)}}; }).at("$ref"));
  keys_.rules.push_back(shared_.Named(full, [&] {
    Json schema = Json::object();
    group.AddProperties(group.keys_.values, schema);
    group.keys_.AddTo(schema);
    return schema;
  }));
}

// Schemas for a map that meets the condition; any of them suffices.
std::vector<MapSchema::Json> MapSchema::Holds(const Condition& condition) const {
  std::vector<std::string> path;
  for (std::size_t start = 0; start <= condition.key.size();) {
    const std::size_t dot = std::min(condition.key.find('.', start), condition.key.size());
    path.push_back(condition.key.substr(start, dot - start));
    start = dot + 1;
  }
  std::vector<Json> any;
  const auto add = [&](const std::string& key) {
    const bool is_needed = path.size() == 1 && std::find(keys_.required.begin(), keys_.required.end(), key) !=
                                                   keys_.required.end();
    Json holds = is_needed && !condition.words.empty() ? Json::object() : Required(key);
    if (!condition.words.empty()) {
      Json words = Json::array();
      for (const std::string& word : condition.words)
        words.push_back(word == "true" || word == "false" ? Json(word == "true") : Json(word));
      holds["properties"][key] = words.size() == 1 ? Json{{"const", words[0]}} : Json{{"enum", words}};
    } else if (condition.is_map || condition.is_list) {
      holds["properties"][key] = {{"type", condition.is_map ? "object" : "array"}};
    } else if (IsNoneIfEmpty(condition)) {
      holds["properties"][key] = {{"minItems", kLeastOfAList}};
    }
    for (std::size_t i = path.size() - 1; i-- > 0;) {
      Json outer = Required(path[i]);
      outer["properties"][path[i]] = std::move(holds);
      holds = std::move(outer);
    }
    any.push_back(std::move(holds));
  };
  if (condition.dimension.empty()) add(path.back());
  for (const Unit& unit : condition.dimension) add(path.back() + "_" + std::string(unit.suffix));
  return any;
}
bool MapSchema::IsNoneIfEmpty(const Condition& condition) const {
  return lists_.contains(condition.key) && !condition.empty_counts;
}

void MapSchema::Either(const std::vector<Alternative>& alternatives) {
  struct Branch {
    std::vector<Json> conditions;      // any of them; none: all maps
    std::vector<std::string> implied;  // keys that no map has for which the conditions do not hold
    Keys keys;
    Json rules;
  };
  std::vector<Branch> branches;
  Keys known = std::move(keys_);
  Json all = Json::object();  // keys of any alternative
  for (const Alternative& alternative : alternatives) {
    keys_ = {};
    alternative.describe();
    for (const auto& [key, value] : keys_.values.items())
      if (!all.contains(key))
        all[key] = value;
      else if (all[key] != value)
        all[key] = true;  // each alternative says for itself
    known.groups.insert(keys_.groups.begin(), keys_.groups.end());
    known.of_groups.insert(keys_.of_groups.begin(), keys_.of_groups.end());
    branches.push_back({{}, {}, std::move(keys_), {}});
  }
  keys_ = std::move(known);
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    const Condition& condition = alternatives[i].condition;
    if (condition.key.empty()) continue;
    branches[i].conditions = Holds(condition);
    if (condition.words.empty() && !condition.is_map && !condition.is_list && !IsNoneIfEmpty(condition)) {
      if (condition.dimension.empty()) branches[i].implied.push_back(condition.key);
      for (const Unit& unit : condition.dimension)
        branches[i].implied.push_back(condition.key + "_" + std::string(unit.suffix));
    }
  }
  if (branches.empty() || !branches.back().conditions.empty()) branches.emplace_back();  // all others
  // The conditions of a map to which a branch applies.
  std::set<std::string> absent;
  for (Branch& branch : branches) {
    Json& schema = branch.rules = Json::object();
    std::vector<std::string> foreign;
    for (const auto& [key, value] : all.items()) {
      if (!branch.keys.values.contains(key)) {
        if (!keys_.values.contains(key) && !absent.contains(key)) foreign.push_back(key);
      } else if (value != branch.keys.values[key]) {
        schema["properties"][key] = branch.keys.values[key];
      }
    }
    if (!foreign.empty()) schema["propertyNames"] = {{"not", {{"pattern", Pattern(foreign)}}}};
    branch.keys.AddTo(schema);
    absent.insert(branch.implied.begin(), branch.implied.end());
  }
  // From the last branch to the first: if its conditions hold, its rules, else those of the next. Neighbours
  // with the same rules are one.
  Json chain = std::move(branches.back().rules);
  std::vector<Json> conditions;
  for (std::size_t i = branches.size() - 1; i-- > 0;) {
    Branch& branch = branches[i];
    conditions.insert(conditions.begin(), branch.conditions.begin(), branch.conditions.end());
    if (i > 0 && branches[i - 1].rules == branch.rules) continue;
    const std::vector<Json> any = std::exchange(conditions, {});
    if (branch.rules == chain) continue;
    Json choice = {{"if", Combined("anyOf", any)}};
    if (!branch.rules.empty()) choice["then"] = std::move(branch.rules);
    if (!chain.empty()) choice["else"] = std::move(chain);
    chain = std::move(choice);
  }
  for (const auto& [key, value] : all.items())
    if (!keys_.values.contains(key)) keys_.values[key] = value;
  if (!chain.empty()) keys_.rules.push_back(std::move(chain));
}
void MapSchema::ExactlyOne(const std::vector<std::string>& keys) {
  std::vector<Json> one;
  for (const std::string& key : keys) one.push_back(Required(key));
  keys_.rules.push_back(Combined("oneOf", std::move(one)));
}
void MapSchema::OneOrMore(const std::vector<std::string>& keys) {
  std::vector<Json> any;
  for (const std::string& key : keys) any.push_back(Required(key));
  keys_.rules.push_back(Combined("anyOf", std::move(any)));
}
void MapSchema::Missing(const std::vector<std::string>& keys, const char*) { OneOrMore(keys); }

}  // namespace dispersa
