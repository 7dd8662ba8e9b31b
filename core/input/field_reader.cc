#include "core/input/field_reader.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/input/base_file.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/input/struct_problems.h"

namespace dispersa {
namespace {

using Kind = InputNode::Kind;

bool Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string Quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : " or '") + word + "'";
  return text;
}

std::string CountText(std::size_t low, std::size_t high) {
  if (low == high) return "a list of " + std::to_string(low);
  if (high == SIZE_MAX) return "a list of " + std::to_string(low) + " or more";
  return "a list of " + std::to_string(low) + " to " + std::to_string(high);
}

// {} stands for the key.
std::string About(std::string message, const std::string& key) {
  if (const std::size_t at = message.find("{}"); at != std::string::npos) message.replace(at, 2, key);
  return message;
}

std::string Item(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

// The key among `keys` that a unit written otherwise stands for, or empty.
std::string MeantKey(const std::string& stem, std::string suffix, const std::vector<std::string>& keys) {
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::vector<std::string> candidates = {stem + "_" + suffix};
  for (const UnitSpelling& spelling : kUnitSpellings)
    if (spelling.written == suffix) candidates.push_back(stem + "_" + std::string(spelling.meant));
  for (const std::string& candidate : candidates)
    if (std::find(keys.begin(), keys.end(), candidate) != keys.end()) return candidate;
  return "";
}

class FieldReader : public Fields {
 public:
  FieldReader(InputNode& node, std::string path, std::vector<InputProblem>& problems, FileSource* files)
      : node_(&node), path_(std::move(path)), problems_(problems), files_(files), before_(problems.size()) {
    if (node.file != nullptr && node.kind != Kind::kMap)
      AddProblem(problems_, node, path_, node.Describe() + " is not a map", "a map of keys and values");
  }

  // ---- the whole file ----

  void File(const char* schema, const BaseKeys* base) override {
    Optional("schema");
    if (!HasSchema(*node_, path_, schema, problems_)) node_ = &absent_;
    if (base == nullptr) return;
    if (Optional(kBasedOn) != nullptr)
      Refuse(kBasedOn, "a file is named in a text without files", "the keys of " + std::string(base->what));
    if (Optional(kWithout) != nullptr) Refuse(kWithout, "is given without 'based_on'", "based_on: FILE");
  }

  // ---- single values ----

  void Flag(const char* key, bool& value, bool absent, const char*) override {
    value = absent;
    const InputNode* node = Optional(key);
    if (node == nullptr) return;
    if (node->kind == Kind::kScalar && !node->quoted && IsTruthValue(node->text))
      value = node->text == "true";
    else
      AddProblem(problems_, *node, PathOf(key), node->Describe() + " is not a truth value", "true or false");
  }
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) override {
    std::vector<std::string> keys;  // in the first unit each
    for (const OneQuantity& one : quantities)
      keys.push_back(one.stem + ("_" + std::string(one.dimension.front().suffix)));
    std::string given;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      const OneQuantity& one = quantities[i];
      const Found found = FindQuantity(one.stem, one.dimension);
      if (found.node == nullptr) continue;
      const double number = ReadNumber(*found.node, PathOf(found.key), problems_, one.range, found.unit);
      if (!given.empty()) {
        Refuse(found.key, "'" + given + "' and '" + found.key + "' are both given",
               "one of " + JoinWords(keys));
        continue;
      }
      given = found.key;
      which = i;
      value = number;
    }
    if (given.empty()) ReportMissing(keys, "one of them");
  }

  void AnyNumbers() override { is_open_ = true; }

  // ---- which keys go together ----

  void Group(const char*, const std::string&, const Part& part) override {
    const std::size_t problems = problems_.size(), missing = missing_.size(), first = relations_.size();
    part(*this);
    const std::vector<std::function<void()>> own(relations_.begin() + static_cast<std::ptrdiff_t>(first),
                                                 relations_.end());
    relations_.resize(first);
    if (problems_.size() > problems || missing_.size() > missing) return;
    for (const auto& relation : own) relation();
  }
  void Either(const std::vector<Alternative>& alternatives) override {
    if (IsUndecided(alternatives)) {
      for (const Alternative& alternative : alternatives) Spare(alternative.describe);
      return;
    }
    for (const Alternative& alternative : alternatives)
      if (Holds(alternative.condition)) return alternative.describe();
  }
  void Missing(const std::vector<std::string>& keys, const char* allowed) override {
    ReportMissing(keys, allowed);
  }
  void Misplaced(const char* stem, Dimension dimension, const char* message, const char* allowed) override {
    const Found found = FindQuantity(stem, dimension);
    if (found.node != nullptr) Refuse(found.key, About(message, found.key), allowed);
  }
  void NoChoice(const char* key, const std::string& word, const std::string& message,
                const std::string& allowed) override {
    no_choices_[{key, word}] = {message, allowed};
  }
  void Unclear(const std::vector<std::string>& unclear, const char* message, const std::string& allowed,
               const std::function<void()>& describe) override {
    bool is_clear = true;
    for (const InputMember& member : node_->members) {
      if (std::find(unclear.begin(), unclear.end(), member.key) == unclear.end()) continue;
      is_clear = false;
      spoken_of_.insert(member.key);
      AddProblem(problems_, KeyOf(member), PathOf(member.key), About(message, member.key), allowed);
    }
    is_clear ? describe() : Spare(describe);
  }

  // ---- what keys decide ----

  void Deciding(Decides what, const std::function<void()>& describe) override {
    const Decides around = std::exchange(decides_, what);
    describe();
    decides_ = around;
  }

  // ---- what does not fit ----

  void Check(const std::function<void()>& relation) override {
    if (node_->kind == Kind::kMap) relations_.push_back(relation);
  }
  void Refuse(const std::string& key, const std::string& message, const std::string& allowed) override {
    if (node_->kind != Kind::kMap) return;  // refused as a whole
    std::string path;
    const InputNode& at = FindField(*node_, key, &path);
    AddProblem(problems_, at, path.empty() ? path_ : PathOf(path), message, allowed);
  }
  void Replace(const char* stem, Dimension dimension, std::vector<double>& values) override {
    const auto is_named = [&](const Unit& unit) {
      return node_->Find(stem + ("_" + std::string(unit.suffix))) != nullptr;
    };
    const auto unit = std::find_if(dimension.begin(), dimension.end(), is_named);
    InputNode& list = *node_->Find(stem + ("_" + std::string(unit->suffix)));
    const InputNode place = list.items.front();
    list.items.clear();
    for (double& value : values) {
      list.items.push_back(ScalarAt(place, FormatScaled(value, unit->scale)));
      value = ReadNumber(list.items.back(), "", problems_, kAnyNumber, *unit);
    }
  }
  void Hint(const char* key, const Range& mistaken, const char* what, double (*meant)(double)) override {
    const InputNode* node = node_->Find(key);
    if (node == nullptr || problems_.empty() || problems_.back().path != PathOf(key)) return;
    const std::optional<double> value = ParseNumber(node->text);
    if (value && mistaken.Contains(*value))
      problems_.back().message +=
          std::string(", it is ") + what + " (did you mean " + FormatNumber(meant(*value)) + "?)";
  }
  std::string Quote(const std::string& key) const override {
    std::string path;
    return FindField(*node_, key, &path).Describe();
  }

  void Finish() {
    for (const Known& known : known_)
      if (known.decides != Decides::kAsAround)
        for (InputMember& member : node_->members)
          if (std::find(known.keys.begin(), known.keys.end(), member.key) != known.keys.end())
            member.decides = known.decides;
    if (node_->kind == Kind::kMap) {
      const std::set<std::string> explained = ReportUnknown();
      for (const MissingKeys& missing : missing_) {
        if (std::any_of(missing.keys.begin(), missing.keys.end(),
                        [&](const std::string& key) { return explained.contains(key); }))
          continue;
        if (node_->is_table)
          AddProblem(problems_, *node_, path_, "missing column '" + missing.keys.front() + "'",
                     ColumnNames());
        else
          AddProblem(problems_, *node_, path_, "missing key " + Quoted(missing.keys), missing.allowed);
      }
    }
    if (node_->file == nullptr || problems_.size() > before_) return;  // absent or refused
    for (const auto& relation : relations_) relation();
  }

 protected:
  void VisitText(const TextKey& key, std::string& value) override {
    if (!key.words.empty() && key.name_of == nullptr) return ReadChoice(key, value);
    const InputNode* node =
        Find(key, key.name_of == nullptr ? "text" : std::string("the name of ") + key.name_of);
    value = node == nullptr ? key.absent.value_or("") : ReadText(*node, PathOf(key.name), problems_);
    if (node == nullptr || key.words.empty() || node->kind != Kind::kScalar ||
        Contains(key.words, node->text))
      return;
    AddProblem(problems_, *node, PathOf(key.name),
               node->Describe() + " is not " + key.name_of + DidYouMean(node->text, key.words),
               "one of " + JoinWords(key.words));
  }
  void VisitTexts(const TextKey& key, std::size_t low_count, std::size_t high_count,
                  std::vector<std::string>& values) override {
    InputNode* list = Find(key, CountText(low_count, high_count));
    if (list == nullptr) return;
    Items(*list, PathOf(key.name), low_count, high_count,
          [&](const InputNode& item, const std::string& path) {
            if (key.words.empty()) return values.push_back(ReadText(item, path, problems_));
            if (!Contains(key.words, item.text))
              AddProblem(problems_, item, path, item.Describe() + " is not a choice",
                         "one of " + JoinWords(key.words));
            values.push_back(item.text);
          });
  }
  void VisitWhole(const WholeKey& key, std::vector<std::uint64_t>& values) override {
    if (key.noun != nullptr) return ReadSeveral(key, values);
    std::uint64_t& value = values.front();
    const std::string allowed =
        "a whole number from " + std::to_string(key.low) + " to " + std::to_string(key.high);
    const InputNode* node = Find(key, allowed);
    value = node == nullptr && key.absent ? *key.absent : key.low;
    if (node == nullptr) return;
    const bool is_plain = node->kind == Kind::kScalar && !node->quoted;
    const std::optional<std::uint64_t> number = is_plain ? ParseInteger(node->text) : std::nullopt;
    if (number && *number >= key.low && *number <= key.high) {
      value = *number;
      return;
    }
    const bool is_number = is_plain && ParseNumber(node->text);
    AddProblem(problems_, *node, PathOf(key.name),
               number ? node->text + " is out of range"
                      : node->Describe() + (is_number ? " is not a whole number" : " is not a number"),
               allowed);
  }
  void VisitNumber(const NumberKey& key, std::optional<double>& value) override {
    const Found found = FindNumber(key);
    known_.back().is_column = false;
    if (found.node != nullptr)
      value = ReadNumber(*found.node, PathOf(found.key), problems_, key.range, found.unit);
    else if (key.needed)
      value = 0.0;
    else
      value = key.absent;
  }
  void VisitNumbers(const NumbersKey& key, std::vector<double>& values) override {
    if (!key.or_one) values.clear();
    const Found found = FindNumber(key, key.or_one ? "" : CountText(key.low_count, key.high_count));
    if (found.node == nullptr) return;
    const std::string path = PathOf(found.key);
    if (key.or_one && found.node->kind != Kind::kList) {
      values.assign(2, ReadNumber(*found.node, path, problems_, key.range, found.unit));
      return;
    }
    if (key.or_file) LoadColumn(*found.node, found.key);
    if (found.node->file == nullptr) return;
    std::vector<double> read;
    Items(*found.node, path, key.low_count, key.high_count,
          [&](const InputNode& item, const std::string& item_path) {
            read.push_back(ReadNumber(item, item_path, problems_, key.range, found.unit));
          });
    values = std::move(read);
  }
  void VisitRows(const RowsKey& key, std::vector<std::vector<double>>& rows) override {
    std::vector<std::string> names;
    for (const RowsKey::Column& column : key.columns) names.emplace_back(column.name);
    if (!names.empty()) {
      std::size_t next = 0;
      Each("columns", true, names.size(), names.size(), [&](const InputNode& item, const std::string& path) {
        const std::string& expected = names[next++];
        if (item.text != expected)
          AddProblem(problems_, item, path, item.Describe() + " is not the column", expected);
      });
    }
    rows.clear();
    Each(key.name, key.needed, key.low_count, key.high_count,
         [&](const InputNode& row, const std::string& path) {
           std::vector<double>& numbers = rows.emplace_back();
           if (row.kind != Kind::kList || (key.width > 0 && row.items.size() != key.width)) {
             const std::string count = key.width > 0 ? std::to_string(key.width) + " numbers" : "numbers";
             AddProblem(problems_, row, path, row.Describe() + " is not a row of " + count,
                        names.empty() ? key.allowed : "a list of " + count + ": " + JoinWords(names));
             return;
           }
           for (std::size_t c = 0; c < row.items.size(); ++c)
             numbers.push_back(ReadNumber(row.items[c], Item(path, c), problems_, kAnyNumber,
                                          {"", names.empty() ? 1.0 : key.columns[c].scale}));
         });
  }
  void VisitNode(const NodeKey& key, const ReadNode& read) override {
    InputNode* value = Find(key, key.allowed);
    if (value == nullptr) return;
    const std::string path =
        Load(*value, PathOf(key.name),
             key.schema == nullptr ? FileSource::Holds::kTable : FileSource::Holds::kDocument);
    if (value->file != nullptr) read(*value, path);
  }
  void VisitMap(const MapKey& key, MapValue& value, const Part& part) override {
    InputNode* const found = Find(key, key.allowed);
    value.is_there = found != nullptr;
    if (found == nullptr && !key.needed) return;
    InputNode& node = found == nullptr ? absent_ : *found;
    std::string path = PathOf(key.name);
    if (key.or_list && node.kind == Kind::kList) {
      if (node.items.empty()) AddProblem(problems_, node, path, "the list is empty", key.allowed);
      for (std::size_t i = 0; i < node.items.size(); ++i)
        ReadFields(node.items[i], Item(path, i), problems_, files_, part);
      return;
    }
    const bool is_number = key.or_number && node.kind == Kind::kScalar && ParseNumber(node.text);
    if (key.file != MapKey::File::kNone && !is_number)
      path = Load(node, path,
                  key.file == MapKey::File::kTable ? FileSource::Holds::kTable : FileSource::Holds::kBytes);
    if (key.or_number && node.kind != Kind::kMap) {
      if (node.file != nullptr) value.number = ReadNumber(node, path, problems_);
      return;
    }
    value.is_word = key.word != nullptr && node.kind == Kind::kScalar;
    if (!value.is_word)
      ReadFields(node, path, problems_, files_, part);
    else if (node.text != key.word)
      AddProblem(problems_, node, path, node.Describe() + " is not " + key.what, key.allowed);
  }
  void VisitMaps(const Key& key, std::size_t low_count, std::size_t high_count,
                 const Fields::Items& items) override {
    InputNode* list = Find(key, CountText(low_count, high_count));
    if (list == nullptr) return;
    items.resize(0);
    if (items.or_folder) Load(*list, PathOf(key.name), FileSource::Holds::kFolder);
    if (list->file == nullptr) return;
    std::size_t count = 0;
    Items(*list, PathOf(key.name), low_count, high_count, [&](InputNode& item, const std::string& path) {
      items.resize(count + 1);
      ReadFields(item, item.file == list->file ? path : "", problems_, files_,
                 [&](Fields& fields) { items.describe(fields, count); });
      ++count;
    });
  }

 private:
  void ReadChoice(const TextKey& key, std::string& value) {
    const std::string allowed = "one of " + JoinWords(key.words);
    const InputNode* node = Find(key, allowed);
    value = key.absent.value_or(key.words.front());
    if (node == nullptr) {
      if (key.needed) undecided_.insert(key.name);
      return;
    }
    if (node->kind == Kind::kScalar && Contains(key.words, node->text)) {
      value = node->text;
      return;
    }
    undecided_.insert(key.name);
    if (const auto reason = no_choices_.find({key.name, node->text}); reason != no_choices_.end())
      AddProblem(problems_, *node, PathOf(key.name), reason->second.first, reason->second.second);
    else
      AddProblem(problems_, *node, PathOf(key.name),
                 node->Describe() + " is not a choice" +
                     (node->kind == Kind::kScalar ? DidYouMean(node->text, key.words) : ""),
                 allowed);
  }
  void ReadSeveral(const WholeKey& key, std::vector<std::uint64_t>& values) {
    const InputNode* node = Optional(key.name);
    if (node == nullptr) return;
    const std::string noun = key.noun, path = PathOf(key.name);
    const std::string allowed = key.low > key.high    ? "no " + noun
                                : key.low == key.high ? std::to_string(key.low)
                                                      : "one of " + std::to_string(key.low) + " to " +
                                                            std::to_string(key.high) + ", or a list of them";
    const auto read = [&](const InputNode& item, const std::string& item_path) {
      const bool is_plain = item.kind == Kind::kScalar && !item.quoted;
      const auto number = is_plain ? ParseInteger(item.text) : std::nullopt;
      if (!number || *number < key.low || *number > key.high)
        AddProblem(problems_, item, item_path, item.Describe() + " is no " + noun + " " + key.which, allowed);
      else if (std::find(values.begin(), values.end(), *number) != values.end())
        AddProblem(problems_, item, item_path, noun + " " + item.text + " is given twice",
                   "each " + noun + " once");
      else
        values.push_back(*number);
    };
    if (node->kind != Kind::kList) return read(*node, path);
    if (node->items.empty()) AddProblem(problems_, *node, path, "the list is empty", allowed);
    for (std::size_t i = 0; i < node->items.size(); ++i) read(node->items[i], Item(path, i));
    std::sort(values.begin(), values.end());
  }

  // A key that was asked for.
  struct Known {
    std::string stem;
    std::vector<std::string> keys;  ///< in each unit, or the key itself
    bool has_units = false;
    bool needed = true;
    bool is_column = true;  ///< a single number is none
    Decides decides = Decides::kAsAround;
  };
  struct Found {
    InputNode* node = nullptr;
    std::string key;
    Unit unit = kNoUnit;
  };
  struct MissingKeys {
    std::vector<std::string> keys;
    std::string allowed;
  };

  std::string PathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  Known& Knows(const std::string& stem, Dimension dimension = {}) {
    Known known{stem, {}, !dimension.empty()};
    for (const Unit& unit : dimension) known.keys.push_back(stem + "_" + std::string(unit.suffix));
    if (dimension.empty()) known.keys.push_back(stem);
    known.decides = decides_;
    return known_.emplace_back(std::move(known));
  }
  InputNode* Optional(const std::string& key) {
    Knows(key).needed = false;
    return node_->Find(key);
  }
  // The value of a key that was named needed or not, or null.
  InputNode* Find(const Key& key, const std::string& allowed) {
    Knows(key.name).needed = key.needed;
    InputNode* node = node_->Find(key.name);
    if (node == nullptr && key.needed) ReportMissing({key.name}, allowed);
    return node;
  }
  // The value of a quantity in any unit.
  Found FindQuantity(const std::string& stem, Dimension dimension, bool needed = false) {
    const std::vector<std::string> keys = [&] {
      Known& known = Knows(stem, dimension);
      known.needed = needed;
      return known.keys;
    }();
    Found found;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      InputNode* value = node_->Find(keys[i]);
      if (value == nullptr) continue;
      if (found.node != nullptr)
        AddProblem(problems_, *value, PathOf(keys[i]), "'" + found.key + "' is given too", "one of the two");
      else
        found = {value, keys[i], dimension.empty() ? kNoUnit : dimension[i]};
    }
    return found;
  }
  // One that is needed or not; `allowed`: what a list should be.
  Found FindNumber(const NumberKey& key, const std::string& allowed = "") {
    const Found found = FindQuantity(key.name, key.dimension, key.needed);
    if (found.node != nullptr || !key.needed) return found;
    std::string number = TextIn(key.dimension.empty() ? kNoUnit : key.dimension.front(), key.range);
    // If any number is allowed, only the meaning of the key says which one is needed.
    if (number == kAnyNumber.Text() && *key.meaning != 0) number += std::string(": ") + key.meaning;
    ReportMissing(known_.back().keys, allowed.empty() ? number : allowed);
    return found;
  }
  bool Has(const std::string& stem, Dimension dimension) const {
    return std::any_of(dimension.begin(), dimension.end(), [&](const Unit& unit) {
      return node_->Find(stem + "_" + std::string(unit.suffix)) != nullptr;
    });
  }

  // Calls f(item, path) for each item of a list with an allowed length.
  template <typename F>
  void Items(InputNode& list, const std::string& path, std::size_t low_count, std::size_t high_count, F f) {
    const std::size_t count = list.items.size();
    if (list.kind != Kind::kList)
      AddProblem(problems_, list, path, list.Describe() + " is not a list", CountText(low_count, high_count));
    else if (count < low_count || count > high_count)
      AddProblem(problems_, list, path,
                 count == 0 ? "the list is empty" : "the list has " + std::to_string(count),
                 CountText(low_count, high_count));
    else
      for (std::size_t i = 0; i < count; ++i) f(list.items[i], Item(path, i));
  }
  template <typename F>
  void Each(const char* key, bool needed, std::size_t low_count, std::size_t high_count, F f) {
    if (InputNode* list = Find({key, "", needed}, CountText(low_count, high_count)))
      Items(*list, PathOf(key), low_count, high_count, f);
  }

  // Returns the value's path in its file: what was read from a file of its own has paths of its own.
  std::string Load(InputNode& value, const std::string& path, FileSource::Holds holds) {
    if (files_ == nullptr || value.kind != Kind::kScalar) return path;
    const auto file = value.file;
    files_->Load(value, path, holds, problems_);
    return value.file == file ? path : "";
  }
  void LoadColumn(InputNode& value, const std::string& key) {
    const bool is_named = value.kind == Kind::kScalar;
    Load(value, PathOf(key), FileSource::Holds::kTable);
    if (!is_named || value.kind != Kind::kMap) return;
    InputNode column;
    ReadFields(value, "", problems_, files_, [&](Fields& fields) {
      auto& table = static_cast<FieldReader&>(fields);
      if (InputNode* found = table.Find({key.c_str(), ""}, "")) column = std::move(*found);
    });
    value = std::move(column);
  }
  // The word that decides was refused, or there is no map.
  bool IsUndecided(const std::vector<Alternative>& alternatives) const {
    return node_->kind != Kind::kMap ||
           std::any_of(alternatives.begin(), alternatives.end(), [&](const Alternative& alternative) {
             return undecided_.contains(alternative.condition.key);
           });
  }
  bool Holds(const Condition& condition) const {
    if (condition.key.empty()) return true;
    const InputNode* map = node_;
    std::string key = condition.key;
    if (const std::size_t dot = key.find('.'); dot != std::string::npos) {
      map = node_->Find(key.substr(0, dot));
      key = key.substr(dot + 1);
    }
    const InputNode* value = map == nullptr ? nullptr : map->Find(key);
    for (const Unit& unit : condition.dimension)
      if (map != nullptr && value == nullptr) value = map->Find(key + "_" + std::string(unit.suffix));
    if (value == nullptr) return false;
    if (condition.is_list) return value->kind == Kind::kList;
    if (!condition.dimension.empty()) return true;
    if (value->kind == Kind::kList && value->items.empty()) return condition.empty_counts;
    if (condition.is_map) return value->kind == Kind::kMap;
    return condition.words.empty() ||
           std::find(condition.words.begin(), condition.words.end(), value->text) != condition.words.end();
  }
  // Nothing is said of the keys that are described: what decides whether they belong here was refused.
  void Spare(const std::function<void()>& describe) {
    InputNode* const node = std::exchange(node_, &absent_);
    describe();
    node_ = node;
  }

  // None of the keys, any of which would do, is there. Not said if an unknown key evidently means one.
  void ReportMissing(std::vector<std::string> keys, const std::string& allowed) {
    if (node_->kind == Kind::kMap) missing_.push_back({std::move(keys), allowed});
  }
  // The columns that a table may have, in the order of the description.
  std::string ColumnNames() const {
    std::vector<std::string> needed, optional;
    for (const Known& known : known_) {
      if (!known.is_column) continue;
      std::vector<std::string>& of = known.needed ? needed : optional;
      if (std::find(of.begin(), of.end(), known.keys.front()) == of.end()) of.push_back(known.keys.front());
    }
    return "the columns " + JoinWords(needed) +
           (optional.empty() ? "" : ", and " + JoinWords(optional) + " if there is one");
  }
  // Returns the keys that an unknown one evidently stands for.
  std::set<std::string> ReportUnknown() {
    std::set<std::string> all = spoken_of_, explained;
    for (const Known& known : known_) all.insert(known.keys.begin(), known.keys.end());
    const std::vector<std::string> keys(all.begin(), all.end());
    for (const InputMember& member : node_->members) {
      const auto add = [&](const std::string& message, const std::string& allowed) {
        AddProblem(problems_, KeyOf(member), node_->is_table ? path_ : PathOf(member.key), message, allowed);
      };
      if (is_open_) continue;
      if (all.contains(member.key)) {
        if (&member.value != node_->Find(member.key))
          add("the column '" + member.key + "' is given twice", ColumnNames());
        continue;
      }
      std::string meant;
      const auto quantity = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
        if (!known.has_units) return false;
        if (member.key == known.stem) meant = known.keys.front();
        if (!member.key.starts_with(known.stem + "_")) return member.key == known.stem;
        const std::string suffix = member.key.substr(known.stem.size() + 1);
        meant = MeantKey(known.stem, suffix, known.keys);
        return !meant.empty() ||
               std::find(std::begin(kUnitLike), std::end(kUnitLike), suffix) != std::end(kUnitLike);
      });
      if (quantity != known_.end()) {
        add((member.key == quantity->stem ? "missing unit"
                                          : "the unit of '" + member.key + "' is not known here") +
                (meant.empty() ? "" : " (did you mean '" + meant + "'?)"),
            JoinWords(quantity->keys));
        explained.insert(quantity->keys.begin(), quantity->keys.end());
        continue;
      }
      const auto other = std::find_if(
          keys.begin(), keys.end(), [&](const std::string& key) { return IsInAnotherUnit(member.key, key); });
      if (other != keys.end()) {
        add("the unit of '" + member.key + "' is not known here", *other);
        explained.insert(*other);
        continue;
      }
      explained.insert(Nearest(member.key, keys));
      add((node_->is_table ? "unknown column '" : "unknown key '") + member.key + "'" +
              DidYouMean(member.key, keys),
          node_->is_table ? ColumnNames() : JoinWords(keys));
    }
    return explained;
  }

  InputNode absent_;
  InputNode* node_;
  std::string path_;
  std::vector<InputProblem>& problems_;
  FileSource* const files_;
  const std::size_t before_;              // so many problems before this map
  Decides decides_ = Decides::kAsAround;  // of the keys that are declared now
  bool is_open_ = false;                  // any other key may be there
  std::vector<Known> known_;
  std::vector<MissingKeys> missing_;
  std::set<std::string> spoken_of_;  // keys of which something was said already
  std::set<std::string> undecided_;  // keys whose words were refused
  std::map<std::pair<std::string, std::string>, std::pair<std::string, std::string>> no_choices_;
  std::vector<std::function<void()>> relations_;
};

}  // namespace

void ReadFields(InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                FileSource* files, const Fields::Part& describe) {
  FieldReader reader(node, path, problems, files);
  describe(reader);
  reader.Finish();
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
