// The keys of the input files as Markdown tables of the docs site, from their descriptions.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "services/docs/dimensions.h"

namespace dispersa {

struct KeyRow {
  std::string key, value, absent, meaning;
  std::set<std::string> when;       ///< conditions, any of which will do; empty: always
  std::vector<KeyRow> inside = {};  ///< of a map, or a list of maps
  std::vector<std::string> groups =
      {};  ///< keys that stand in several maps, of which a table of their own tells
};

/// Collects the rows of one map.
class KeyRows : public Fields {
 public:
  /// `all` receives the keys of each group, by its name.
  explicit KeyRows(std::map<std::string, std::vector<KeyRow>>& all) : all_groups_(all) {}

  std::vector<KeyRow> rows;
  std::vector<std::string> groups;

  void File(const char* schema, const BaseKeys* base) override {
    Add("schema", "`" + std::string(schema) + "`", "needed in a file of its own", "the kind of this file");
    if (base == nullptr) return;
    Add(kBasedOn, "file", "none", kBasedOnMeaning);
    Add(kWithout, "list of texts", "none", kWithoutMeaning);
  }
  void Flag(const char* key, bool&, bool absent, const char* meaning) override {
    Add(key, "`true`, `false`", absent ? "`true`" : "`false`", meaning);
  }
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t&, double&) override {
    for (const OneQuantity& one : quantities)
      Add(one.stem + std::string("_*"), NumberText(one.dimension, one.range), "one of these is needed",
          one.meaning);
  }
  void Group(const char* name, const std::string& of, const Part& part) override {
    if (of.empty()) return part(*this);
    groups.push_back(name);
    KeyRows group(all_groups_);
    part(group);
    all_groups_.try_emplace(name, std::move(group.rows));
  }
  void Either(const std::vector<Alternative>& alternatives) override {
    const std::string outer = when_;
    std::vector<std::string> without;
    for (const Alternative& alternative : alternatives) {
      KeyRows own(all_groups_);
      own.when_ = outer;
      std::swap(rows, own.rows);  // what it describes, by this visitor
      alternative.describe();
      std::swap(rows, own.rows);
      const Condition& condition = alternative.condition;
      const std::string key = condition.key + (condition.dimension.empty() ? "" : "_*");
      const bool is_own =
          std::any_of(own.rows.begin(), own.rows.end(), [&](const KeyRow& row) { return row.key == key; });
      std::string when;
      if (condition.key.empty())
        when = without.empty() ? "" : "without " + Joined(without, ", ");
      else if (!is_own)
        when = condition.words.empty() ? "with `" + key + "`"
                                       : "with `" + key + ": " + Joined(condition.words, "`, `") + "`";
      if (!condition.key.empty() && condition.words.empty()) without.push_back("`" + key + "`");
      for (KeyRow& row : own.rows) {
        if (!when.empty()) row.when = {when};
        if (is_own && row.absent == "needed") row.absent = "none";
        Merge(std::move(row));
      }
    }
  }

 protected:
  void VisitText(const TextKey& key, std::string&) override {
    const std::string absent = key.absent && !key.absent->empty() ? "`" + *key.absent + "`" : "none";
    Add(key, key.name_of != nullptr ? "name" : key.words.empty() ? "text" : WordsText(key.words), absent);
  }
  void VisitTexts(const TextKey& key, std::size_t low, std::size_t high, std::vector<std::string>&) override {
    Add(key, key.words.empty() ? CountText(low, high) + " of texts" : "list of " + WordsText(key.words),
        "none");
  }
  void VisitWhole(const WholeKey& key, std::vector<std::uint64_t>&) override {
    if (key.noun != nullptr) return Add(key, "whole number, or list of them", "all");
    constexpr std::uint64_t kManyEnough = 1u << 31;  // a limit of the machine alone
    std::string value = "whole number";
    if (key.high < kManyEnough)
      value += ", " + std::to_string(key.low) + " to " + std::to_string(key.high);
    else if (key.low > 0)
      value += ", from " + std::to_string(key.low) + " on";
    Add(key, value, key.absent ? std::to_string(*key.absent) : "none");
  }
  void VisitNumber(const NumberKey& key, std::optional<double>&) override {
    const Unit unit = UnitOf(key.dimension);
    std::string absent = "none";
    if (key.absent)
      absent = *key.absent == 0.0 ? "0"
                                  : FormatScaled(*key.absent - unit.offset, unit.scale) +
                                        (unit.suffix.empty() ? "" : " " + std::string(unit.suffix));
    AddNumber(key, NumberText(key.dimension, key.range), absent);
  }
  void VisitNumbers(const NumbersKey& key, std::vector<double>&) override {
    const std::string number = NumberText(key.dimension, key.range);
    AddNumber(key,
              key.or_one ? number + "; or `[first, last]`"
                         : CountText(key.low_count, key.high_count) + ": " + number +
                               (key.or_file ? "; or CSV file" : ""),
              "none");
  }
  void VisitRows(const RowsKey& key, std::vector<std::vector<double>>&) override {
    std::vector<std::string> names;
    for (const RowsKey::Column& column : key.columns) names.emplace_back(column.name);
    if (!names.empty()) Add("columns", "list of " + WordsText(names), "needed", "these names, in this order");
    Add(key, CountText(key.low_count, key.high_count) + " of rows", "none");
  }
  void VisitNode(const NodeKey& key, const ReadNode&) override {
    Add(key, key.schema == nullptr ? "CSV file, or map of lists" : "file, or what it holds", "none");
  }
  void VisitMap(const MapKey& key, MapValue&, const Part& part) override {
    std::string value = key.or_list ? "map, or list of maps" : "map";
    if (key.word != nullptr) value = "`" + std::string(key.word) + "`, or map";
    if (key.file == MapKey::File::kTable) value = "CSV file, or map of lists";
    if (key.file == MapKey::File::kBytes) value = "file, or map";
    if (key.or_number) value = "number, CSV file, or map of lists";
    AddMap(key, value, part);
  }
  void VisitMaps(const Key& key, std::size_t low, std::size_t high, const Items& items) override {
    items.resize(1);
    AddMap(key, (items.or_folder ? "folder, or " : "") + CountText(low, high) + " of maps",
           [&](Fields& fields) { items.describe(fields, 0); });
    items.resize(0);
  }

 private:
  static Unit UnitOf(Dimension dimension) { return dimension.empty() ? kNoUnit : dimension.front(); }
  static std::string Needed(bool needed) { return needed ? "needed" : "none"; }
  static std::string Joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
  }
  static std::string WordsText(const std::vector<std::string>& words) {
    return "`" + Joined(words, "`, `") + "`";
  }
  static std::string CountText(std::size_t low, std::size_t high) {
    const std::string from = std::to_string(low);
    if (low == high) return "list of " + from;
    if (high == SIZE_MAX) return low > 1 ? "list of " + from + " or more" : "list";
    return low > 0 ? "list of " + from + " to " + std::to_string(high)
                   : "list of up to " + std::to_string(high);
  }
  // "length, above 0", "angle, from -90 to 90 deg"
  static std::string NumberText(Dimension dimension, const Range& range) {
    const Unit unit = UnitOf(dimension);
    const std::string limits = TextIn(unit, range).substr(kAnyNumber.Text().size());
    std::string text = dimension.empty() ? "number" : DimensionName(dimension);
    if (limits.empty()) return text;
    text += "," + limits;
    const bool is_of_zero = limits == " above 0" || limits == " not below 0";
    return is_of_zero || dimension.empty() ? text : text + " " + std::string(unit.suffix);
  }

  void AddNumber(const NumberKey& key, const std::string& value, const std::string& absent) {
    Add(key.name + std::string(key.dimension.empty() ? "" : "_*"), value, key.needed ? "needed" : absent,
        key.meaning);
  }
  void Add(const Key& key, const std::string& value, const std::string& absent) {
    Add(key.name, value, key.needed ? "needed" : absent, key.meaning);
  }
  void Add(std::string key, std::string value, std::string absent, std::string meaning) {
    Merge({std::move(key), std::move(value), std::move(absent), std::move(meaning), {}});
  }
  void AddMap(const Key& key, const std::string& value, const Part& part) {
    KeyRows inside(all_groups_);
    part(inside);
    Merge({key.name,
           value,
           Needed(key.needed),
           key.meaning,
           {},
           std::move(inside.rows),
           std::move(inside.groups)});
  }
  // Alternatives may have the same key.
  void Merge(KeyRow row) {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const KeyRow& other) { return other.key == row.key; });
    if (found == rows.end()) {
      rows.push_back(std::move(row));
    } else {
      if (found->absent != row.absent) found->absent += " or " + row.absent;
      if (row.when.empty() || found->when.empty())
        found->when.clear();
      else
        found->when.insert(row.when.begin(), row.when.end());
    }
  }

  std::map<std::string, std::vector<KeyRow>>& all_groups_;
  std::string when_;
};

/// The text of a cell of a table.
inline std::string EscapedCell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

/// The table of a map. Maps in it that have a table of their own, as `has_table` says of a path, are one row.
class KeyTable {
 public:
  using HasTable = std::function<bool(const std::string& path)>;
  explicit KeyTable(HasTable has_table) : has_table_(std::move(has_table)) {}

  std::string Text(const std::vector<KeyRow>& rows, const std::string& path) {
    text_ = "| key | value | default | meaning |\n|---|---|---|---|\n";
    AddRows(rows, path, "");
    return text_;
  }

 private:
  static std::string Spaced(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
  }
  void AddRows(const std::vector<KeyRow>& rows, const std::string& path, const std::string& depth) {
    for (const KeyRow& row : rows) {
      const std::string inner = path + "." + row.key;
      const bool is_told = has_table_(inner);
      std::string value = row.value;
      for (const std::string& group : row.groups) value += ", with a *" + Spaced(group) + "*";
      if (is_told) value += ", below";
      std::string when;
      for (const std::string& condition : row.when) when += (when.empty() ? "" : "; ") + condition;
      text_ += "| " + depth + "`" + row.key + "` | " + EscapedCell(value) + " | " + EscapedCell(row.absent) +
               " | " + EscapedCell(row.meaning) + (when.empty() ? "" : " (" + EscapedCell(when) + ")") +
               " |\n";
      if (!is_told) AddRows(row.inside, inner, depth + "· ");
    }
  }
  const HasTable has_table_;
  std::string text_;
};

}  // namespace dispersa
