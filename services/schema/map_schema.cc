#include "services/schema/map_schema.h"

#include <cmath>
#include <map>

#include "core/input/number_text.h"

namespace dispersa {
namespace {

using Json = MapSchema::Json;

// How people write what a key's end says.
std::string UnitText(std::string_view unit) {
  static const std::map<std::string_view, std::string> kTexts = {
      {"um", "µm"},           {"m2", "m²"},
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
  return found == kTexts.end() ? std::string(unit) : found->second;
}

constexpr Unit kNoUnit = {"", 1.0};

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
  const std::string number = range.Less(unit.offset).Text(unit.scale).substr(std::string("a number").size());
  std::string text = unit.suffix.empty() ? "" : UnitText(unit.suffix);
  if (!number.empty()) text += text.empty() ? number.substr(1) : "," + number;
  return text.empty() ? meaning : text + ": " + meaning;
}

Json DescribedNumber(const Range& range, const Unit& unit, const char* meaning,
                     std::optional<double> absent) {
  Json number = NumberIn(range, unit);
  number["description"] = Description(range, unit, meaning);
  if (absent) number["default"] = InUnit(*absent, unit);
  return number;
}

Json ListOf(Json item, std::size_t low_count, std::size_t high_count) {
  Json list = {{"type", "array"}, {"items", std::move(item)}};
  if (low_count > 0) list["minItems"] = low_count;
  if (high_count != SIZE_MAX) list["maxItems"] = high_count;
  return list;
}

Json DescribedNumbers(const Range& range, const Unit& unit, std::size_t low_count, std::size_t high_count,
                      const char* meaning) {
  Json list = ListOf(NumberIn(range, unit), low_count, high_count);
  list["description"] = Description(range, unit, meaning);
  return list;
}

Json Described(Json value, const char* meaning) {
  value["description"] = meaning;
  return value;
}

Json ATextThat(const char* meaning) {
  return {{"type", "string"}, {"minLength", 1}, {"description", meaning}};
}

Json Required(const std::string& key) { return {{"required", Json::array({key})}}; }

// One of the schemas holds, or exactly one.
Json Combined(const char* how, std::vector<Json> schemas) {
  if (schemas.size() == 1) return std::move(schemas.front());
  return {{how, Json(std::move(schemas))}};
}

}  // namespace

// ---- Which keys a map has ----

void MapSchema::Keys::AddTo(Json& schema) const {
  if (!required.empty()) schema["required"] = required;
  if (!rules.empty()) schema["allOf"] = rules;
}

MapSchema::Json MapSchema::Finish() const {
  Json schema = {{"type", "object"}, {"properties", keys_.values}, {"additionalProperties", false}};
  if (base_.empty()) {
    keys_.AddTo(schema);
  } else {  // what is missing here stands in the other file
    Json rules = Json::object();
    keys_.AddTo(rules);
    schema["if"] = {{"not", Required(base_)}};
    schema["then"] = std::move(rules);
  }
  return schema;
}

MapSchema::Json MapSchema::MapOf(const Part& part) const {
  MapSchema map(document_);
  part(map);
  return map.Finish();
}

void MapSchema::Add(const char* key, Json value, bool needed) {
  if (value.contains("items")) lists_.insert(key);
  keys_.values[key] = std::move(value);
  if (needed) keys_.required.push_back(key);
}

void MapSchema::AddUnits(const char* stem, Dimension dimension, bool needed,
                         const std::function<Json(const Unit& unit)>& value) {
  std::string units;
  for (const Unit& unit : dimension) units += (units.empty() ? "" : "|") + std::string(unit.suffix);
  std::vector<Json> any;
  for (const Unit& unit : dimension) {
    const std::string key = stem + ("_" + std::string(unit.suffix));
    Add(key.c_str(), value(unit), needed && dimension.size() == 1);
    quantities_[key] = {stem, units};
    any.push_back(Required(key));
  }
  if (dimension.size() == 1) return;
  if (!needed) {
    Json none = {{"not", Combined("anyOf", any)}};
    any.push_back(std::move(none));
  }
  keys_.rules.push_back(Combined("oneOf", std::move(any)));
}

// No key of these; quantities by their stems and units, which is a tenth as long as all their keys.
MapSchema::Json MapSchema::None(const std::vector<std::string>& keys) const {
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
    for (const std::string& stem : of) group += (group.empty() ? "(" : "|") + stem;
    names += (names.empty() ? "" : "|") + group + ")_(" + units + ")";
  }
  return {{"not", {{"pattern", "^(" + names + ")$"}}}};
}

// ---- Single values ----

void MapSchema::Schema(const char* name) {
  Add("schema", {{"const", name}, {"description", "the kind of this file"}}, false);
}
void MapSchema::Base(const char* key, const char* meaning) {
  Add(key, ATextThat(meaning), false);
  base_ = key;
}
void MapSchema::Text(const char* key, std::string&, const char* meaning, std::optional<std::string> absent) {
  Json text = absent ? Json{{"type", "string"}, {"description", meaning}} : ATextThat(meaning);
  if (absent && !absent->empty()) text["default"] = *absent;
  Add(key, std::move(text), !absent);
}
void MapSchema::Flag(const char* key, bool&, bool absent, const char* meaning) {
  Add(key, {{"type", "boolean"}, {"description", meaning}, {"default", absent}}, false);
}
void MapSchema::Whole(const char* key, std::uint64_t low, std::uint64_t high, std::uint64_t&,
                      const char* meaning, std::optional<std::uint64_t> absent) {
  Json number = {{"type", "integer"}, {"minimum", low}, {"maximum", high}};
  number["description"] =
      "a whole number from " + std::to_string(low) + " to " + std::to_string(high) + ": " + meaning;
  if (absent) number["default"] = *absent;
  Add(key, std::move(number), !absent);
}
void MapSchema::Number(const char* key, const Range& range, double&, const char* meaning,
                       std::optional<double> absent) {
  Add(key, DescribedNumber(range, kNoUnit, meaning, absent), !absent);
}
void MapSchema::Quantity(const char* stem, Dimension dimension, const Range& range, double&,
                         const char* meaning, std::optional<double> absent) {
  AddUnits(stem, dimension, !absent,
           [&](const Unit& unit) { return DescribedNumber(range, unit, meaning, absent); });
}
void MapSchema::OptionalNumber(const char* key, const Range& range, std::optional<double>&,
                               const char* meaning) {
  Add(key, DescribedNumber(range, kNoUnit, meaning, {}), false);
}
void MapSchema::OptionalQuantity(const char* stem, Dimension dimension, const Range& range,
                                 std::optional<double>&, const char* meaning) {
  AddUnits(stem, dimension, false,
           [&](const Unit& unit) { return DescribedNumber(range, unit, meaning, {}); });
}
void MapSchema::OneOf(const std::vector<OneQuantity>& quantities, std::size_t&, double&) {
  std::vector<Json> one;
  for (const OneQuantity& quantity : quantities) {
    for (const Unit& unit : quantity.dimension) {
      const std::string key = quantity.stem + ("_" + std::string(unit.suffix));
      Add(key.c_str(), DescribedNumber(quantity.range, unit, quantity.meaning, {}), false);
      one.push_back(Required(key));
    }
  }
  keys_.rules.push_back(Combined("oneOf", std::move(one)));
}
void MapSchema::Name(const char* key, const std::vector<std::string>& names, const char*, std::string&,
                     const char* meaning) {
  Add(key, names.empty() ? ATextThat(meaning) : Json{{"enum", names}, {"description", meaning}}, true);
}
void MapSchema::Word(const char* key, const Choices& choices, const char* meaning,
                     std::optional<std::size_t> absent) {
  Json word = {{"enum", choices.words}, {"description", meaning}};
  if (absent) word["default"] = choices.words[*absent];
  Add(key, std::move(word), !absent);
}

// ---- Lists ----

void MapSchema::Numbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
                        std::vector<double>&, const char* meaning) {
  Add(key, DescribedNumbers(range, kNoUnit, low_count, high_count, meaning), low_count > 0);
}
void MapSchema::Quantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                           std::size_t high_count, std::vector<double>&, const char* meaning) {
  AddUnits(stem, dimension, low_count > 0,
           [&](const Unit& unit) { return DescribedNumbers(range, unit, low_count, high_count, meaning); });
}
void MapSchema::OptionalQuantities(const char* stem, Dimension dimension, const Range& range,
                                   std::size_t low_count, std::size_t high_count, std::vector<double>&,
                                   const char* meaning) {
  AddUnits(stem, dimension, false,
           [&](const Unit& unit) { return DescribedNumbers(range, unit, low_count, high_count, meaning); });
}
void MapSchema::Column(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                       std::vector<double>&, const char* meaning) {
  AddUnits(stem, dimension, true, [&](const Unit& unit) {
    return Json{{"anyOf", Json::array({Json{{"type", "string"}, {"minLength", 1}},
                                       ListOf(NumberIn(range, unit), low_count, SIZE_MAX)})},
                {"description", Description(range, unit, meaning) + "; or a CSV file with this column"}};
  });
}
void MapSchema::Several(const char* key, int low, int high, const char*, const char*, std::vector<int>&,
                        const char* meaning) {
  const Json one = {{"type", "integer"}, {"minimum", low}, {"maximum", high}};
  Json several = ListOf(one, 1, SIZE_MAX);
  several["uniqueItems"] = true;
  Add(key, {{"anyOf", Json::array({one, std::move(several)})}, {"description", meaning}}, false);
}
void MapSchema::OptionalNumbers(const char* key, const Range& range, std::size_t low_count,
                                std::size_t high_count, std::vector<double>&, const char* meaning) {
  Add(key, DescribedNumbers(range, kNoUnit, low_count, high_count, meaning), false);
}
void MapSchema::TwoByTwo(const char* key, std::array<std::array<double, 2>, 2>&, const char*,
                         const char* meaning) {
  Add(key, Described(ListOf(ListOf({{"type", "number"}}, 2, 2), 2, 2), meaning), true);
}
void MapSchema::AnyNumbers(const char* key, const char* meaning) {
  Add(key, {{"type", "object"}, {"additionalProperties", {{"type", "number"}}}, {"description", meaning}},
      false);
}
void MapSchema::Rows(const char* key, std::size_t low_count, std::size_t high_count,
                     std::vector<std::vector<double>>&, const char* meaning) {
  Json row = {{"type", "array"}, {"items", {{"type", "number"}}}};
  Add(key, Described(ListOf(std::move(row), low_count, high_count), meaning), low_count > 0);
}
void MapSchema::ColumnsAndRows(const std::vector<std::string>& columns, std::size_t low_count,
                               std::vector<std::vector<double>>&, const char* meaning) {
  const std::size_t count = columns.size();
  Add("columns", Described(ListOf({{"enum", columns}}, count, count), "these names, in this order"), true);
  Add("rows", Described(ListOf(ListOf({{"type", "number"}}, count, count), low_count, SIZE_MAX), meaning),
      true);
}
void MapSchema::Ends(const char* stem, Dimension dimension, const Range& range, double&, double&, bool needed,
                     const char* meaning) {
  AddUnits(stem, dimension, needed, [&](const Unit& unit) {
    const Json number = NumberIn(range, unit);
    return Json{{"anyOf", Json::array({number, ListOf(number, 2, 2)})},
                {"description", Description(range, unit, meaning) + "; a list of two: at either end"}};
  });
}
void MapSchema::Texts(const char* key, std::size_t low_count, std::size_t high_count,
                      std::vector<std::string>&, const char* meaning) {
  Add(key, Described(ListOf({{"type", "string"}}, low_count, high_count), meaning), low_count > 0);
}
void MapSchema::Words(const char* key, const std::vector<std::string>& words, std::vector<std::size_t>&,
                      const char* meaning) {
  Add(key, Described(ListOf({{"enum", words}}, 1, SIZE_MAX), meaning), true);
}

// ---- Maps ----

void MapSchema::Map(const char* key, const char* meaning, const Part& part) {
  Add(key, Described(MapOf(part), meaning), true);
}
void MapSchema::OptionalMap(const char* key, bool&, const char* meaning, const Part& part) {
  Add(key, Described(MapOf(part), meaning), false);
}
void MapSchema::Maps(const char* key, bool needed, std::size_t low_count, std::size_t high_count,
                     const Items& items, const char* meaning) {
  items.resize(1);
  Json item = MapOf([&](Fields& fields) { items.describe(fields, 0); });
  items.resize(0);  // how many there are decides nothing
  Add(key, Described(ListOf(std::move(item), low_count, high_count), meaning), needed);
}
void MapSchema::WordOrMap(const char* key, const char* word, const char*, const char*, bool&,
                          const char* meaning, const Part& part) {
  Add(key, {{"anyOf", Json::array({Json{{"const", word}}, MapOf(part)})}, {"description", meaning}}, true);
}
void MapSchema::NumberOrTable(const char* key, std::optional<double>&, const char* meaning,
                              const Part& part) {
  Add(key,
      {{"anyOf",
        Json::array({Json{{"type", "number"}}, Json{{"type", "string"}, {"minLength", 1}}, MapOf(part)})},
       {"description", meaning}},
      false);
}
void MapSchema::MapOrMaps(const char* key, const char*, const char* meaning, const Part& part) {
  const Json one = MapOf(part);
  Add(key, {{"anyOf", Json::array({one, ListOf(one, 1, SIZE_MAX)})}, {"description", meaning}}, false);
}
void MapSchema::AddTable(const char* key, const char* meaning, bool needed, const Part& part) {
  Add(key,
      {{"anyOf", Json::array({Json{{"type", "string"}, {"minLength", 1}}, MapOf(part)})},
       {"description", meaning}},
      needed);
}
void MapSchema::Table(const char* key, const char*, const char* meaning, const Part& part) {
  AddTable(key, meaning, true, part);
}
void MapSchema::OptionalTable(const char* key, bool&, const char* meaning, const Part& part) {
  AddTable(key, meaning, false, part);
}
void MapSchema::MapByHand(const char* key, const char* meaning, const Part& part, const ReadNode&) {
  Add(key, Described(MapOf(part), meaning), false);
}
void MapSchema::Columns(const char* key, const char* meaning, const ReadNode&) {
  const Json column = {{"type", "array"}, {"items", {{"type", "number"}}}};
  const Json columns = {{"type", "object"}, {"additionalProperties", column}};
  Add(key,
      {{"anyOf", Json::array({Json{{"type", "string"}, {"minLength", 1}}, columns})},
       {"description", meaning}},
      false);
}
void MapSchema::Document(const char* key, const char* schema, bool needed, const char*, const char* meaning,
                         const ReadNode&) {
  Add(key,
      {{"anyOf", Json::array({Json{{"type", "string"}, {"minLength", 1}}, document_(schema)})},
       {"description", meaning}},
      needed);
}

// ---- Which keys go together ----

MapSchema::Json MapSchema::Holds(const Condition& condition) const {
  std::vector<std::string> path;
  for (std::size_t start = 0; start <= condition.key.size();) {
    const std::size_t dot = std::min(condition.key.find('.', start), condition.key.size());
    path.push_back(condition.key.substr(start, dot - start));
    start = dot + 1;
  }
  std::vector<Json> any;
  const auto add = [&](const std::string& key) {
    Json holds = Required(key);
    if (!condition.words.empty()) {
      Json words = Json::array();
      for (const std::string& word : condition.words)
        words.push_back(word == "true" || word == "false" ? Json(word == "true") : Json(word));
      holds["properties"][key] = {{"enum", std::move(words)}};
    } else if (condition.is_map) {
      holds["properties"][key] = {{"type", "object"}};
    } else if (path.size() == 1 && lists_.contains(key) && !condition.empty_counts) {
      holds["properties"][key] = {{"minItems", kLeastOfAList}};
    }
    any.push_back(std::move(holds));
  };
  if (condition.dimension.empty()) add(path.back());
  for (const Unit& unit : condition.dimension) add(path.back() + "_" + std::string(unit.suffix));
  Json holds = Combined("anyOf", std::move(any));
  for (std::size_t i = path.size() - 1; i-- > 0;) {
    Json outer = Required(path[i]);
    outer["properties"][path[i]] = std::move(holds);
    holds = std::move(outer);
  }
  return holds;
}

void MapSchema::Either(const std::vector<Alternative>& alternatives) {
  std::vector<Keys> branches;
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
    branches.push_back(std::move(keys_));
  }
  keys_ = std::move(known);
  // The conditions of a map to which this alternative applies.
  const auto rules = [&](const Keys& branch) {
    Json schema = Json::object();
    std::vector<std::string> foreign;
    for (const auto& [key, value] : all.items()) {
      if (!branch.values.contains(key)) {
        if (!keys_.values.contains(key)) foreign.push_back(key);
      } else if (value != branch.values[key]) {
        schema["properties"][key] = branch.values[key];
      }
    }
    if (!foreign.empty()) schema["propertyNames"] = None(foreign);
    branch.AddTo(schema);
    return schema;
  };
  // From the last alternative to the first: if its condition holds, its rules, else those of the next.
  Json chain = rules(Keys{});
  for (std::size_t i = alternatives.size(); i-- > 0;) {
    Json own = rules(branches[i]);
    if (alternatives[i].condition.key.empty()) {
      chain = std::move(own);
      continue;
    }
    Json choice = {{"if", Holds(alternatives[i].condition)}};
    if (!own.empty()) choice["then"] = std::move(own);
    if (!chain.empty()) choice["else"] = std::move(chain);
    chain = choice.size() > 1 ? std::move(choice) : Json::object();
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
