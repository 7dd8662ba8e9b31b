#include "core/input/field_reader.h"

#include <algorithm>
#include <set>

#include "core/input/number_text.h"
#include "core/input/struct_problems.h"

namespace dispersa {
namespace {

class FieldReader : public Fields {
 public:
  FieldReader(const InputNode& node, std::string path, std::vector<InputProblem>& problems)
      : map_(node, std::move(path), problems) {}

  void Schema(const char*) override { map_.Allow("schema"); }  // it decided who reads this
  void Base(const char*, const char*) override {}              // its keys stand here already
  void Text(const char* key, std::string& value, const char*, std::optional<std::string> absent) override {
    value = absent ? map_.Text(key, *absent) : map_.Text(key);
  }
  void Flag(const char* key, bool& value, bool absent, const char*) override {
    value = map_.Flag(key, absent);
  }
  void Number(const char* key, const Range& range, double& value, const char*,
              std::optional<double> absent) override {
    value = map_.Number(key, range, absent);
  }
  void Quantity(const char* stem, Dimension dimension, const Range& range, double& value, const char*,
                std::optional<double> absent) override {
    value = map_.Quantity(stem, dimension, range, absent);
  }
  void OptionalNumber(const char* key, const Range& range, std::optional<double>& value,
                      const char*) override {
    const double number = map_.Number(key, range, 0.0);
    if (map_.node().Find(key) != nullptr) value = number;
  }
  void OptionalQuantity(const char* stem, Dimension dimension, const Range& range,
                        std::optional<double>& value, const char*) override {
    value = map_.OptionalQuantity(stem, dimension, range);
  }
  void Numbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
               std::vector<double>& values, const char*) override {
    values = map_.Numbers(key, range, low_count, high_count);
  }
  void Quantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                  std::size_t high_count, std::vector<double>& values, const char*) override {
    values = map_.Quantities(stem, dimension, range, low_count, high_count);
  }

  void OptionalQuantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                          std::size_t high_count, std::vector<double>& values, const char*) override {
    if (map_.Has(stem, dimension))
      values = map_.Quantities(stem, dimension, range, low_count, high_count);
    else
      map_.OptionalQuantity(stem, dimension, range);
  }
  void Several(const char* key, int low, int high, const char* noun, const char* which,
               std::vector<int>& values, const char*) override {
    const InputNode* node = map_.Optional(key);
    if (node == nullptr) return;
    const std::string allowed = low > high    ? "no " + std::string(noun)
                                : low == high ? std::to_string(low)
                                              : "one of " + std::to_string(low) + " to " +
                                                    std::to_string(high) + ", or a list of them";
    const auto read = [&](const InputNode& item, const std::string& path) {
      const bool plain = item.kind == InputNode::Kind::kScalar && !item.quoted;
      const auto number = plain ? ParseInteger(item.text) : std::nullopt;
      if (!number || *number < static_cast<std::uint64_t>(low) ||
          *number > static_cast<std::uint64_t>(high)) {
        AddProblem(map_.problems(), item, path, item.Describe() + " is no " + noun + " " + which, allowed);
      } else if (std::find(values.begin(), values.end(), static_cast<int>(*number)) != values.end()) {
        AddProblem(map_.problems(), item, path, noun + (" " + item.text) + " is given twice",
                   "each " + std::string(noun) + " once");
      } else {
        values.push_back(static_cast<int>(*number));
      }
    };
    if (node->kind != InputNode::Kind::kList) return read(*node, map_.PathOf(key));
    if (node->items.empty())
      AddProblem(map_.problems(), *node, map_.PathOf(key), "the list is empty", allowed);
    for (std::size_t i = 0; i < node->items.size(); ++i)
      read(node->items[i], map_.PathOf(key) + "[" + std::to_string(i) + "]");
    std::sort(values.begin(), values.end());
  }
  void OptionalNumbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
                       std::vector<double>& values, const char*) override {
    if (map_.Optional(key) != nullptr) values = map_.Numbers(key, range, low_count, high_count);
  }
  void TwoByTwo(const char* key, std::array<std::array<double, 2>, 2>& rows, const char* allowed,
                const char*) override {
    std::size_t count = 0;
    map_.Each(key, 2, 2, [&](const InputNode& row, const std::string& path) {
      std::array<double, 2>& numbers = rows[std::min<std::size_t>(count++, 1)];
      if (row.kind != InputNode::Kind::kList || row.items.size() != 2) {
        AddProblem(map_.problems(), row, path, row.Describe() + " is not a row of two numbers", allowed);
        return;
      }
      for (std::size_t i = 0; i < 2; ++i)
        numbers[i] = ReadNumber(row.items[i], path + "[" + std::to_string(i) + "]", map_.problems());
    });
  }
  void AnyNumbers(const char* key, const char*) override { map_.Allow(key); }
  void Rows(const char* key, std::size_t low_count, std::size_t high_count,
            std::vector<std::vector<double>>& rows, const char*) override {
    map_.Each(key, low_count, high_count, [&](const InputNode& row, const std::string& path) {
      std::vector<double>& numbers = rows.emplace_back();
      for (const InputNode& number : row.items) numbers.push_back(ReadNumber(number, path, map_.problems()));
    });
  }
  void ColumnsAndRows(const std::vector<std::string>& columns, std::size_t low_count,
                      std::vector<std::vector<double>>& rows, const char*) override {
    const std::size_t count = columns.size();
    std::size_t column = 0;
    map_.Each("columns", count, count, [&](const InputNode& item, const std::string& path) {
      const std::string& expected = columns[column++];
      if (item.text != expected)
        AddProblem(map_.problems(), item, path, item.Describe() + " is not the column", expected);
    });
    map_.Each("rows", low_count, SIZE_MAX, [&](const InputNode& row, const std::string& path) {
      std::vector<double>& numbers = rows.emplace_back();
      if (row.kind != InputNode::Kind::kList || row.items.size() != count) {
        AddProblem(map_.problems(), row, path, row.Describe() + " is not a row",
                   "a list of " + std::to_string(count) + " numbers: " + JoinWords(columns));
        return;
      }
      for (std::size_t c = 0; c < count; ++c)
        numbers.push_back(ReadNumber(row.items[c], path + "[" + std::to_string(c) + "]", map_.problems()));
    });
  }
  void Ends(const char* stem, Dimension dimension, const Range& range, double& first, double& second,
            bool needed, const char*) override {
    if (!needed && !map_.Has(stem, dimension)) {
      map_.OptionalQuantity(stem, dimension, range);
      return;
    }
    const auto ends = map_.Ends(stem, dimension, range);
    first = ends[0];
    second = ends[1];
  }
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) override {
    std::vector<std::string> keys;  // in the first unit each
    for (const OneQuantity& one : quantities)
      keys.push_back(one.stem + ("_" + std::string(one.dimension.front().suffix)));
    std::string given;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      const OneQuantity& one = quantities[i];
      std::string key;
      const auto found = map_.OptionalQuantity(one.stem, one.dimension, one.range, &key);
      if (!found) continue;
      if (!given.empty()) {
        Refuse(key, "'" + given + "' and '" + key + "' are both given", "one of " + JoinWords(keys));
        continue;
      }
      given = key;
      which = i;
      value = *found;
    }
    if (given.empty()) map_.ReportMissing(keys, "one of them");
  }
  void Texts(const char* key, std::size_t low_count, std::size_t high_count, std::vector<std::string>& values,
             const char*) override {
    map_.Each(key, low_count, high_count, [&](const InputNode& item, const std::string& path) {
      values.push_back(ReadText(item, path, map_.problems()));
    });
  }
  void Name(const char* key, const std::vector<std::string>& names, const char* what, std::string& value,
            const char*) override {
    const InputNode& node = map_.Required(key, std::string("the name of ") + what);
    value = ReadText(node, map_.PathOf(key), map_.problems());
    if (names.empty()) return;
    if (node.kind == InputNode::Kind::kScalar &&
        std::find(names.begin(), names.end(), node.text) == names.end())
      AddProblem(map_.problems(), node, map_.PathOf(key),
                 node.Describe() + " is not " + what + DidYouMean(node.text, names),
                 "one of " + JoinWords(names));
  }
  void Words(const char* key, const std::vector<std::string>& words, std::vector<std::size_t>& values,
             const char*) override {
    map_.Each(key, 1, SIZE_MAX, [&](const InputNode& item, const std::string& path) {
      const auto found = std::find(words.begin(), words.end(), item.text);
      if (found == words.end())
        AddProblem(map_.problems(), item, path, item.Describe() + " is not a choice",
                   "one of " + JoinWords(words));
      values.push_back(found == words.end() ? 0 : static_cast<std::size_t>(found - words.begin()));
    });
  }

  void Map(const char* key, const char*, const Part& part) override {
    ReadFields(map_.Required(key, "a map"), PathOfValue(key), map_.problems(), part);
  }
  void OptionalMap(const char* key, bool& is_there, const char*, const Part& part) override {
    const InputNode* value = map_.Optional(key);
    is_there = value != nullptr;
    if (is_there) ReadFields(*value, PathOfValue(key), map_.problems(), part);
  }
  void WordOrMap(const char* key, const char* word, const char* what, const char* allowed, bool& is_word,
                 const char*, const Part& part) override {
    const InputNode& value = map_.Required(key, allowed);
    is_word = value.kind == InputNode::Kind::kScalar;
    if (!is_word)
      ReadFields(value, PathOfValue(key), map_.problems(), part);
    else if (value.text != word)
      AddProblem(map_.problems(), value, map_.PathOf(key), value.Describe() + " is not " + what, allowed);
  }
  void NumberOrTable(const char* key, std::optional<double>& number, const char*, const Part& part) override {
    const InputNode* value = map_.Optional(key);
    if (value == nullptr || value->file == nullptr) return;
    if (value->kind == InputNode::Kind::kMap)
      ReadFields(*value, PathOfValue(key), map_.problems(), part);
    else
      number = ReadNumber(*value, map_.PathOf(key), map_.problems());
  }
  void MapOrMaps(const char* key, const char* allowed, const char*, const Part& part) override {
    const InputNode* value = map_.Optional(key);
    if (value == nullptr) return;
    if (value->kind != InputNode::Kind::kList)
      return ReadFields(*value, PathOfValue(key), map_.problems(), part);
    if (value->items.empty())
      AddProblem(map_.problems(), *value, map_.PathOf(key), "the list is empty", allowed);
    for (std::size_t i = 0; i < value->items.size(); ++i)
      ReadFields(value->items[i], map_.PathOf(key) + "[" + std::to_string(i) + "]", map_.problems(), part);
  }
  void Table(const char* key, const char* allowed, const char*, const Part& part) override {
    ReadFields(map_.Required(key, allowed), PathOfValue(key), map_.problems(), part);
  }
  void OptionalTable(const char* key, bool& is_there, const char* meaning, const Part& part) override {
    OptionalMap(key, is_there, meaning, part);
  }

  void MapByHand(const char* key, const char*, const Part&, const ReadNode& read) override {
    if (const InputNode* value = map_.Optional(key)) read(*value, map_.PathOf(key));
  }
  void Columns(const char* key, const char*, const ReadNode& read) override {
    const InputNode* value = map_.Optional(key);
    if (value != nullptr && value->file != nullptr) read(*value, PathOfValue(key));
  }
  void Document(const char* key, const char*, bool needed, const char* allowed, const char*,
                const ReadNode& read) override {
    const InputNode* value = needed ? &map_.Required(key, allowed) : map_.Optional(key);
    if (value != nullptr && value->file != nullptr) read(*value, PathOfValue(key));
  }

  void Either(const std::vector<Alternative>& alternatives) override {
    if (IsUndecided(alternatives)) {
      for (const Alternative& alternative : alternatives) map_.Spare(alternative.describe);
      return;
    }
    for (const Alternative& alternative : alternatives)
      if (Holds(alternative.condition)) return alternative.describe();
  }
  void Missing(const std::vector<std::string>& keys, const char* allowed) override {
    map_.ReportMissing(keys, allowed);
  }
  void Misplaced(const char* stem, Dimension dimension, const char* message, const char* allowed) override {
    std::string key = stem;
    if (!dimension.empty())
      map_.OptionalQuantity(stem, dimension, kAnyNumber, &key);
    else if (map_.Optional(stem) == nullptr)
      key.clear();
    if (key.empty()) return;
    Refuse(key, About(message, key), allowed);
  }

  void Unclear(const std::vector<std::string>& unclear, const char* message, const std::string& allowed,
               const std::function<void()>& describe) override {
    bool is_clear = true;
    for (const InputMember& member : map_.node().members) {
      if (std::find(unclear.begin(), unclear.end(), member.key) == unclear.end()) continue;
      is_clear = false;
      map_.Ignore(member.key);
      AddProblem(map_.problems(), KeyOf(member), map_.PathOf(member.key), About(message, member.key),
                 allowed);
    }
    is_clear ? describe() : map_.Spare(describe);
  }

  void Check(const std::function<void()>& relation) override { relations_.push_back(relation); }
  void Refuse(const std::string& key, const std::string& message, const std::string& allowed) override {
    if (map_.node().kind != InputNode::Kind::kMap) return;  // refused as a whole
    std::string path;
    const InputNode& at = FindField(map_.node(), key, &path);
    AddProblem(map_.problems(), at, path.empty() ? map_.path() : map_.PathOf(path), message, allowed);
  }
  void Hint(const char* key, const Range& mistaken, const char* what, double (*meant)(double)) override {
    std::vector<InputProblem>& problems = map_.problems();
    const InputNode* node = map_.node().Find(key);
    if (node == nullptr || problems.empty() || problems.back().path != map_.PathOf(key)) return;
    const std::optional<double> value = ParseNumber(node->text);
    if (value && mistaken.Contains(*value))
      problems.back().message +=
          std::string(", it is ") + what + " (did you mean " + FormatNumber(meant(*value)) + "?)";
  }
  std::string Quote(const std::string& key) const override {
    std::string path;
    return FindField(map_.node(), key, &path).Describe();
  }

  void Finish() { map_.Finish(); }
  const std::vector<std::function<void()>>& relations() const { return relations_; }

 protected:
  void Whole(const char* key, std::uint64_t low, std::uint64_t high, std::uint64_t& value, const char*,
             std::optional<std::uint64_t> absent) override {
    value = map_.Integer(key, low, high, absent);
  }
  void Word(const char* key, const Choices& choices, const char*,
            std::optional<std::size_t> absent) override {
    std::vector<std::pair<std::string, std::size_t>> words;
    for (std::size_t i = 0; i < choices.words.size(); ++i) words.emplace_back(choices.words[i], i);
    const std::size_t before = map_.problems().size();
    choices.set(map_.Choice<std::size_t>(key, words, absent));
    if (map_.problems().size() > before || (!absent && map_.node().Find(key) == nullptr))
      undecided_.insert(key);
  }
  void Maps(const char* key, bool needed, std::size_t low_count, std::size_t high_count, const Items& items,
            const char*) override {
    if (!needed && map_.Optional(key) == nullptr) return;
    items.resize(0);
    std::size_t count = 0;
    map_.Each(key, low_count, high_count, [&](const InputNode& item, const std::string& path) {
      items.resize(count + 1);
      ReadFields(item, path, map_.problems(), [&](Fields& fields) { items.describe(fields, count); });
      ++count;
    });
  }

 private:
  // A value that was read from a file of its own has paths of its own.
  std::string PathOfValue(const char* key) const {
    const InputNode* value = map_.node().Find(key);
    return value == nullptr || value->file == map_.node().file ? map_.PathOf(key) : "";
  }
  // {} stands for the key.
  static std::string About(std::string message, const std::string& key) {
    if (const std::size_t at = message.find("{}"); at != std::string::npos) message.replace(at, 2, key);
    return message;
  }
  // The word that decides was refused, or there is no map.
  bool IsUndecided(const std::vector<Alternative>& alternatives) const {
    return map_.node().kind != InputNode::Kind::kMap ||
           std::any_of(alternatives.begin(), alternatives.end(), [&](const Alternative& alternative) {
             return undecided_.contains(alternative.condition.key);
           });
  }
  bool Holds(const Condition& condition) const {
    if (condition.key.empty()) return true;
    const std::size_t dot = condition.key.find('.');
    if (!condition.dimension.empty() && dot == std::string::npos)
      return map_.Has(condition.key, condition.dimension);
    const InputNode* value = map_.Peek(condition.key.substr(0, dot));
    if (value != nullptr && dot != std::string::npos) {
      const std::string key = condition.key.substr(dot + 1);
      for (const Unit& unit : condition.dimension)
        if (value->Find(key + "_" + std::string(unit.suffix)) != nullptr) return true;
      value = value->Find(key);
    }
    if (value == nullptr) return false;
    if (value->kind == InputNode::Kind::kList && value->items.empty()) return condition.empty_counts;
    if (condition.is_map) return value->kind == InputNode::Kind::kMap;
    return condition.words.empty() ||
           std::find(condition.words.begin(), condition.words.end(), value->text) != condition.words.end();
  }

  MapReader map_;
  std::set<std::string> undecided_;  // keys whose words were refused
  std::vector<std::function<void()>> relations_;
};

}  // namespace

void ReadFields(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                const Fields::Part& describe) {
  const std::size_t before = problems.size();
  FieldReader reader(node, path, problems);
  describe(reader);
  reader.Finish();
  if (node.file == nullptr || problems.size() > before) return;  // absent or refused
  for (const auto& relation : reader.relations()) relation();
}

bool CheckIncreasing(Fields& fields, const std::string& stem, const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) continue;
    fields.Refuse(stem + "[" + std::to_string(i) + "]", "is not above the one before",
                  "values strictly increasing");
    return false;
  }
  return true;
}

}  // namespace dispersa
