// The keys of the input files' maps, declared once beside the structs that receive them.
//
// `Describe(fields, value)` of a struct names its keys, one call each. ReadFields (field_reader.h) fills the
// struct from a file by these calls. A description calls everything that a map may hold. Keys that depend on
// other keys are declared inside When() and Either(). Relations between several fields are declared by
// Check(). So other visitors, which list the keys, see every branch.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/input/input_node.h"
#include "core/input/range.h"
#include "core/input/units.h"

namespace dispersa {

/// A contradiction in a struct, with the path of the value: "stages[1].propellant_mass_kg".
struct StructProblem {
  std::string path;
  std::string message;  ///< what is wrong
  std::string allowed;  ///< what is allowed
};

/// Whether a map has a key, or at a key one of some words. An empty list counts as none.
struct Condition {
  std::string key;                 ///< of the map, or of a map in it: "motor.liquid"
  Dimension dimension = {};        ///< not empty: the key ends in any unit of it
  std::vector<std::string> words;  ///< empty: any value
  bool is_map = false;             ///< its value is a map
  bool is_list = false;            ///< its value is a list
  bool empty_counts = false;       ///< an empty list is one, too
};
inline Condition Has(std::string key) { return {std::move(key), {}, {}}; }
inline Condition Has(std::string stem, Dimension dimension) { return {std::move(stem), dimension, {}}; }
/// The same, an empty list too.
inline Condition HasList(std::string key) { return {std::move(key), {}, {}, false, false, true}; }
/// A quantity whose value is a list.
inline Condition IsList(std::string stem, Dimension dimension) {
  return {std::move(stem), dimension, {}, false, true};
}
inline Condition Is(std::string key, std::vector<std::string> words) {
  return {std::move(key), {}, std::move(words)};
}
inline Condition HasMap(std::string key) { return {std::move(key), {}, {}, true}; }

/// All maps for which no alternative before holds.
inline Condition Else() { return {}; }

/// The declaration of a key. Numbers, limits and defaults are in SI units and radians.
struct Key {
  const char* name;     ///< of a quantity its stem: an underscore and one of the dimension's units follow
  const char* meaning;  ///< one line for documentation
  bool needed = true;   ///< else the key need not be there
  const char* allowed = "";  ///< the expected value, in a message
};
/// A text, or one of some words.
struct TextKey : Key {
  std::optional<std::string> absent = {};  ///< the value where the key is not there
  std::vector<std::string> words = {};     ///< empty: any, or another file has them
  const char* name_of = nullptr;           ///< "a metric", of which the words are names
};
/// A whole number, or several.
struct WholeKey : Key {
  std::uint64_t low, high;
  std::optional<std::uint64_t> absent = {};
  const char* noun = nullptr;   ///< of each of several, for messages: "stage"
  const char* which = nullptr;  ///< "that this disperses"
};
struct NumberKey : Key {
  Dimension dimension;  ///< empty: without unit
  Range range;
  std::optional<double> absent;
};
/// A list of numbers.
struct NumbersKey : NumberKey {
  std::size_t low_count, high_count;
  bool or_one = false;   ///< one number may replace two
  bool or_file = false;  ///< or a CSV file's only column, of the key's name
};
/// A list of lists of numbers.
struct RowsKey : Key {
  struct Column {
    const char* name;
    double scale;  ///< value inside = value in the file * scale
  };
  std::size_t low_count, high_count;
  std::size_t width = 0;             ///< of each row (0: any)
  std::vector<Column> columns = {};  ///< which the key `columns` beside it names
};
struct MapKey : Key {
  enum class File { kNone, kTable, kBytes };
  const char* word = nullptr;  ///< may replace the map
  const char* what = nullptr;  ///< a value that is neither is refused as not this: "a direction"
  bool or_number = false;
  File file = File::kNone;  ///< of which the map may be made, by the columns of a table or of bytes
  bool or_list = false;     ///< of such maps
};
/// A value that is read by hand: what a file of another kind holds, or columns of numbers under any names.
struct NodeKey : Key {
  const char* schema = nullptr;  ///< of the other kind; null: columns
};
/// The value at the key of a map.
struct MapValue {
  bool is_there = false;
  bool is_word = false;
  std::optional<double> number = {};
};

/// A kind of file that may be based on another one of its kind. The keys `based_on`, a file's name, and
/// `without`, a list of that file's keys, say how. WriteOut (base_file.h) obeys them before a file is read.
struct BaseKeys {
  const char* schema;
  const char* what;                           ///< "a vehicle"
  std::vector<std::string_view> merged = {};  ///< maps of named entries, taken entry by entry
};
inline constexpr char kBasedOn[] = "based_on", kWithout[] = "without";
inline constexpr char kBasedOnMeaning[] = "a file of this kind that gives the keys missing here";
inline constexpr char kWithoutMeaning[] = "keys of that file that do not count here";

class Fields {
 public:
  using Part = std::function<void(Fields&)>;
  /// Reads a value by hand. `path` is its own in its file.
  using ReadNode = std::function<void(InputNode& value, const std::string& path)>;
  struct Alternative {
    Condition condition;
    std::function<void()> describe;
    bool is_so = false;  ///< the described value is of this alternative (for visitors that write)
  };
  struct OneQuantity {
    const char* stem;
    Dimension dimension;
    Range range;
    const char* meaning;
  };

  Fields() = default;
  virtual ~Fields() = default;
  Fields(const Fields&) = delete;
  Fields& operator=(const Fields&) = delete;

  // Each declares a key. `meaning` is its line in the documentation. With `absent` the key is optional, and
  // that is its value without the key.

  /// For a whole file: its kind, and the keys by which it is based on another one.
  virtual void File(const char* schema, const BaseKeys* base = nullptr) = 0;
  void Text(const char* key, std::string& value, const char* meaning,
            std::optional<std::string> absent = {}) {
    VisitText({{key, meaning, !absent}, std::move(absent)}, value);
  }
  virtual void Flag(const char* key, bool& value, bool absent, const char* meaning) = 0;
  /// Whole numbers, of any type, not below 0.
  template <class T>
  void Integer(const char* key, std::uint64_t low, std::uint64_t high, T& value, const char* meaning,
               std::type_identity_t<std::optional<T>> absent = {}) {
    std::vector<std::uint64_t> whole = {static_cast<std::uint64_t>(value)};
    VisitWhole({{key, meaning, !absent},
                low,
                high,
                absent ? std::optional(static_cast<std::uint64_t>(*absent)) : std::nullopt},
               whole);
    value = static_cast<T>(whole.front());
  }
  /// The key is `stem`, an underscore and one of the dimension's units.
  void Quantity(const char* stem, Dimension dimension, const Range& range, double& value, const char* meaning,
                std::optional<double> absent = {}) {
    std::optional<double> number = value;
    VisitNumber({{stem, meaning, !absent}, dimension, range, absent}, number);
    value = number.value_or(0.0);
  }
  /// One of which nothing is said where the key is absent.
  void OptionalQuantity(const char* stem, Dimension dimension, const Range& range,
                        std::optional<double>& value, const char* meaning) {
    VisitNumber({{stem, meaning, false}, dimension, range, {}}, value);
  }
  /// Numbers without unit.
  void Number(const char* key, const Range& range, double& value, const char* meaning,
              std::optional<double> absent = {}) {
    Quantity(key, {}, range, value, meaning, absent);
  }
  void OptionalNumber(const char* key, const Range& range, std::optional<double>& value,
                      const char* meaning) {
    OptionalQuantity(key, {}, range, value, meaning);
  }
  /// A list of `low_count` to `high_count` quantities. If `low_count` is 0 the key is optional.
  void Quantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                  std::size_t high_count, std::vector<double>& values, const char* meaning) {
    VisitNumbers({{{stem, meaning, low_count > 0}, dimension, range, {}}, low_count, high_count}, values);
  }
  void Numbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
               std::vector<double>& values, const char* meaning) {
    Quantities(key, {}, range, low_count, high_count, values, meaning);
  }
  /// The same, of which the key need not be there.
  void OptionalQuantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                          std::size_t high_count, std::vector<double>& values, const char* meaning) {
    VisitNumbers({{{stem, meaning, false}, dimension, range, {}}, low_count, high_count}, values);
  }
  void OptionalNumbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
                       std::vector<double>& values, const char* meaning) {
    OptionalQuantities(key, {}, range, low_count, high_count, values, meaning);
  }
  /// A list that may be a CSV file's only column, of the key's name.
  void Column(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
              std::vector<double>& values, const char* meaning) {
    VisitNumbers({{{stem, meaning}, dimension, range, {}}, low_count, SIZE_MAX, false, true}, values);
  }
  /// A number for both ends of something, or a list of two.
  void Ends(const char* stem, Dimension dimension, const Range& range, double& first, double& second,
            bool needed, const char* meaning) {
    std::vector<double> ends = {first, second};
    VisitNumbers({{{stem, meaning, needed}, dimension, range, {}}, 2, 2, true}, ends);
    if (ends.size() != 2) return;
    first = ends[0];
    second = ends[1];
  }
  /// Exactly one of several quantities. `which` is its position among them.
  virtual void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) = 0;
  /// A whole number, or a list of several, each once. The key is optional.
  void Several(const char* key, int low, int high, const char* noun, const char* which,
               std::vector<int>& values, const char* meaning) {
    std::vector<std::uint64_t> whole(values.begin(), values.end());
    VisitWhole({{key, meaning, false},
                static_cast<std::uint64_t>(low),
                static_cast<std::uint64_t>(high),
                {},
                noun,
                which},
               whole);
    values.assign(whole.begin(), whole.end());
  }
  /// A list of lists of numbers, of `width` each, or of any number.
  void Rows(const char* key, std::size_t low_count, std::size_t high_count, std::size_t width,
            std::vector<std::vector<double>>& rows, const char* allowed, const char* meaning) {
    VisitRows({{key, meaning, low_count > 0, allowed}, low_count, high_count, width}, rows);
  }
  /// The keys `columns`, a list of just these names, and `rows`, a list of lists of a number for each.
  void ColumnsAndRows(std::vector<RowsKey::Column> columns, std::size_t low_count,
                      std::vector<std::vector<double>>& rows, const char* meaning) {
    const std::size_t width = columns.size();
    VisitRows({{"rows", meaning}, low_count, SIZE_MAX, width, std::move(columns)}, rows);
  }
  /// In a map: numbers under any names, which are not read.
  virtual void AnyNumbers() {}
  void Texts(const char* key, std::size_t low_count, std::size_t high_count, std::vector<std::string>& values,
             const char* meaning) {
    VisitTexts({{key, meaning, low_count > 0}}, low_count, high_count, values);
  }
  /// The name of one of many things. `what` names their kind: "a metric". Without `names` another file has
  /// them.
  void Name(const char* key, const std::vector<std::string>& names, const char* what, std::string& value,
            const char* meaning) {
    VisitText({{key, meaning}, {}, names, what}, value);
  }
  /// A list of words, each one of `words`.
  void Words(const char* key, const std::vector<std::string>& words, std::vector<std::string>& values,
             const char* meaning) {
    VisitTexts({{key, meaning}, {}, words}, 1, SIZE_MAX, values);
  }
  /// One of a list of words.
  template <class Enum>
  void Choice(const char* key, const std::vector<std::pair<std::string, Enum>>& choices, Enum& value,
              const char* meaning, std::optional<Enum> absent = {}) {
    TextKey all{{key, meaning, !absent}};
    std::string word = choices.front().first;
    for (const auto& [name, choice] : choices) {
      all.words.push_back(name);
      if (choice == value) word = name;
      if (absent && choice == *absent) all.absent = name;
    }
    VisitText(all, word);
    for (const auto& [name, choice] : choices)
      if (name == word) value = choice;
  }

  /// A map that must be there.
  void Map(const char* key, const char* meaning, const Part& part) {
    MapValue value{true};
    VisitMap({{key, meaning, true, "a map"}}, value, part);
  }
  /// An optional map. `is_there` receives whether it is there.
  void OptionalMap(const char* key, bool& is_there, const char* meaning, const Part& part) {
    MapValue value{is_there};
    VisitMap({{key, meaning, false}}, value, part);
    is_there = value.is_there;
  }
  /// A word, or a map. Anything else is refused as not being `what`: "a direction".
  void WordOrMap(const char* key, const char* word, const char* what, const char* allowed, bool& is_word,
                 const char* meaning, const Part& part) {
    MapValue value{true, is_word};
    VisitMap({{key, meaning, true, allowed}, word, what}, value, part);
    is_word = value.is_word;
  }
  /// A number, or a table. The key is optional.
  void NumberOrTable(const char* key, std::optional<double>& number, const char* meaning, const Part& part) {
    MapValue value;
    VisitMap({{key, meaning, false}, nullptr, nullptr, true, MapKey::File::kTable}, value, part);
    number = value.number;
  }
  /// A map, or a list of such maps. The key is optional. `allowed` is the message for an empty list.
  void MapOrMaps(const char* key, const char* allowed, const char* meaning, const Part& part) {
    MapValue value;
    VisitMap({{key, meaning, false, allowed}, nullptr, nullptr, false, MapKey::File::kNone, true}, value,
             part);
  }
  /// The columns of a table, or the file of which they are made. `allowed` says which files.
  void Table(const char* key, const char* allowed, const char* meaning, const Part& part) {
    MapValue value{true};
    VisitMap({{key, meaning, true, allowed}, nullptr, nullptr, false, MapKey::File::kTable}, value, part);
  }
  void OptionalTable(const char* key, bool& is_there, const char* meaning, const Part& part) {
    MapValue value{is_there};
    VisitMap({{key, meaning, false}, nullptr, nullptr, false, MapKey::File::kTable}, value, part);
    is_there = value.is_there;
  }
  /// The bytes of a file, as a map, or its name. `allowed` says which files.
  void Bytes(const char* key, const char* allowed, const char* meaning, const Part& part) {
    MapValue value{true};
    VisitMap({{key, meaning, true, allowed}, nullptr, nullptr, false, MapKey::File::kBytes}, value, part);
  }
  /// Columns of numbers under any names, or the CSV file of them. The key is optional.
  void Columns(const char* key, const char* meaning, const ReadNode& read) {
    VisitNode({{key, meaning, false}}, read);
  }
  /// The content of a file of a kind, in place or by the file's name. The key is optional unless it is
  /// `needed`.
  void Document(const char* key, const char* schema, bool needed, const char* allowed, const char* meaning,
                const ReadNode& read) {
    VisitNode({{key, meaning, needed, allowed}, schema}, read);
  }
  /// A list of maps. If `low_count` is 0 the key is optional. Calls describe(fields, item) for each, or
  /// describe(fields, item, number of items).
  template <class T, class F>
  void List(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
            const char* meaning, F describe) {
    VisitMaps({key, meaning, low_count > 0}, low_count, high_count, ItemsOf(items, describe));
  }
  template <class T>
  void List(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
            const char* meaning) {
    List(key, low_count, high_count, items, meaning, [](Fields& fields, T& item) { Describe(fields, item); });
  }
  /// A list that is there in full, or a folder of files that make its items.
  template <class T>
  void ListOrFolder(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
                    const char* meaning) {
    const auto describe = [](Fields& fields, T& item) { Describe(fields, item); };
    Items all = ItemsOf(items, describe);
    all.or_folder = true;
    VisitMaps({key, meaning}, low_count, high_count, all);
  }
  /// An optional key. A list that is there has this number of items.
  template <class T, class F>
  void OptionalList(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
                    const char* meaning, F describe) {
    VisitMaps({key, meaning, false}, low_count, high_count, ItemsOf(items, describe));
  }

  /// Keys that several maps share. `name` is their kind, "distribution", and `of` their subject, "an angle".
  /// Two groups with the same name and `of` have the same keys.
  virtual void Group(const char* /*name*/, const std::string& /*of*/, const Part& part) { part(*this); }
  /// Keys of the first alternative whose condition holds. Conditions are about keys that are named before, or
  /// that alternatives have.
  virtual void Either(const std::vector<Alternative>& alternatives) = 0;
  /// Keys of maps for which the condition holds.
  void When(const Condition& condition, const std::function<void()>& describe) {
    Either({{condition, describe}});
  }
  /// Keys of maps for which it does not.
  void Unless(const Condition& condition, const std::function<void()>& describe) {
    Either({{condition, [] {}}, {Else(), describe}});
  }
  /// Exactly one of these keys must be there. They are declared before. A reader refuses others with its own
  /// text.
  virtual void ExactlyOne(const std::vector<std::string>& /*keys*/) {}
  /// One or more of these keys must be there. They are declared before or after. A reader refuses others with
  /// its own text.
  virtual void OneOrMore(const std::vector<std::string>& /*keys*/) {}
  /// In an alternative: one of these keys, which others have, is missing.
  virtual void Missing(const std::vector<std::string>& /*keys*/, const char* /*allowed*/) {}
  /// In an alternative: a key of another one, which this map must not have. In `message` {} stands for the
  /// key.
  virtual void Misplaced(const char* /*stem*/, Dimension /*dimension*/, const char* /*message*/,
                         const char* /*allowed*/) {}
  /// Before a Choice: a word that is allowed elsewhere. `message` says why it is not allowed here.
  virtual void NoChoice(const char* /*key*/, const std::string& /*word*/, const std::string& /*message*/,
                        const std::string& /*allowed*/) {}

  /// For maps with none of the `unclear` keys: people write these keys, but they say too little. {} in
  /// `message` stands for the key.
  virtual void Unclear(const std::vector<std::string>& /*unclear*/, const char* /*message*/,
                       const std::string& /*allowed*/, const std::function<void()>& describe) {
    describe();
  }

  // For readers only: other visitors have no file.

  /// Keys that decide something else than the map around them.
  virtual void Deciding(Decides /*what*/, const std::function<void()>& describe) { describe(); }

  /// Calls `relation` if the map, or the group of its keys, was read without a problem. It refuses
  /// contradicting values by Refuse().
  virtual void Check(const std::function<void()>& /*relation*/) {}
  /// Refuses the value of a key, such as "time[3]" or "at.delay". A quantity's key may lack its unit.
  virtual void Refuse(const std::string& /*key*/, const std::string& /*message*/,
                      const std::string& /*allowed*/) {}
  /// In a Check(): replaces a quantity's list of numbers, in the file's tree too. `values` receives what the
  /// tree's text gives.
  virtual void Replace(const char* /*stem*/, Dimension /*dimension*/, std::vector<double>& /*values*/) {}
  /// After a number: a refused number inside `mistaken` is probably its counterpart, `what`: "in percent".
  /// meant() gives it.
  virtual void Hint(const char* /*key*/, const Range& /*mistaken*/, const char* /*what*/,
                    double (* /*meant*/)(double)) {}
  /// The value of a key as the file writes it, to be quoted in a message.
  virtual std::string Quote(const std::string& /*key*/) const { return {}; }

 protected:
  /// The items of a list: how to set their number, and the content of item k.
  struct Items {
    std::size_t count;
    std::function<void(std::size_t)> resize;
    std::function<void(Fields&, std::size_t)> describe;
    bool or_folder = false;  ///< of which the list may be made
  };

  // Each visit gets the value, and leaves the read value in it.
  virtual void VisitText(const TextKey& key, std::string& value) = 0;
  virtual void VisitTexts(const TextKey& key, std::size_t low_count, std::size_t high_count,
                          std::vector<std::string>& values) = 0;
  /// Several are none without the key; else there is one.
  virtual void VisitWhole(const WholeKey& key, std::vector<std::uint64_t>& values) = 0;
  virtual void VisitNumber(const NumberKey& key, std::optional<double>& value) = 0;
  virtual void VisitNumbers(const NumbersKey& key, std::vector<double>& values) = 0;
  virtual void VisitRows(const RowsKey& key, std::vector<std::vector<double>>& rows) = 0;
  virtual void VisitNode(const NodeKey& key, const ReadNode& read) = 0;
  virtual void VisitMap(const MapKey& key, MapValue& value, const Part& part) = 0;
  virtual void VisitMaps(const Key& key, std::size_t low_count, std::size_t high_count,
                         const Items& items) = 0;

 private:
  template <class T, class F>
  static Items ItemsOf(std::vector<T>& items, F& describe) {
    return {items.size(), [&items](std::size_t count) { items.resize(count); },
            [&items, &describe](Fields& fields, std::size_t i) {
              if constexpr (std::is_invocable_v<F, Fields&, T&, std::size_t>)
                describe(fields, items[i], items.size());
              else
                describe(fields, items[i]);
            }};
  }
};

/// In a Check(): refuses the first value of a list that is not above the one before. Returns true if there is
/// none.
bool CheckIncreasing(Fields& fields, const std::string& stem, const std::vector<double>& values);

}  // namespace dispersa
