// What the maps of the input files hold, declared once beside the structs that receive it.
//
// `Describe(fields, value)` of a struct names its keys, one call each; ReadFields (field_reader.h) fills the
// struct from a file by them. A description calls everything that a map may hold. What depends on other keys
// it says by When() and Either(), and what holds between several fields in Check(): so whoever else visits
// it, to list the keys, sees every branch.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/input/range.h"
#include "core/input/units.h"

namespace dispersa {

struct InputNode;

/// Whether a map has a key, or at a key one of some words. An empty list counts as none.
struct Condition {
  std::string key;                 ///< of the map, or of a map in it: "motor.liquid"
  Dimension dimension = {};        ///< not empty: the key ends in any unit of it
  std::vector<std::string> words;  ///< empty: whatever its value
  bool is_map = false;             ///< its value is a map
  bool empty_counts = false;       ///< an empty list is one, too
};
inline Condition Has(std::string key) { return {std::move(key), {}, {}}; }
inline Condition Has(std::string stem, Dimension dimension) { return {std::move(stem), dimension, {}}; }
/// The same, an empty list too.
inline Condition HasList(std::string key) { return {std::move(key), {}, {}, false, true}; }
inline Condition Is(std::string key, std::vector<std::string> words) {
  return {std::move(key), {}, std::move(words)};
}
inline Condition HasMap(std::string key) { return {std::move(key), {}, {}, true}; }

/// All maps for which no alternative before holds.
inline Condition Else() { return {}; }

class Fields {
 public:
  using Part = std::function<void(Fields&)>;
  /// Reads a value by hand; `path` is its own in its file.
  using ReadNode = std::function<void(const InputNode& value, const std::string& path)>;
  /// A list's items: how to have a number of them, and what item k holds.
  struct Items {
    std::function<void(std::size_t)> resize;
    std::function<void(Fields&, std::size_t)> describe;
  };
  struct Choices {
    std::vector<std::string> words;
    std::function<void(std::size_t)> set;
  };
  struct Alternative {
    Condition condition;
    std::function<void()> describe;
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

  // A key each. `meaning` is what documentation says of it, one line. With `absent` the key need not be
  // there, and its value is then that. Numbers are inside in SI and radians, limits and `absent` too.

  /// Of a whole file: the kind of file that it is.
  virtual void Schema(const char* name) = 0;
  /// Of a whole file: the key of another one of its kind, whose keys stand where this one has none.
  virtual void Base(const char* key, const char* meaning) = 0;
  virtual void Text(const char* key, std::string& value, const char* meaning,
                    std::optional<std::string> absent = {}) = 0;
  virtual void Flag(const char* key, bool& value, bool absent, const char* meaning) = 0;
  /// Whole numbers, of any type, not below 0.
  template <class T>
  void Integer(const char* key, std::uint64_t low, std::uint64_t high, T& value, const char* meaning,
               std::type_identity_t<std::optional<T>> absent = {}) {
    auto whole = static_cast<std::uint64_t>(value);
    Whole(key, low, high, whole, meaning,
          absent ? std::optional(static_cast<std::uint64_t>(*absent)) : std::nullopt);
    value = static_cast<T>(whole);
  }
  /// A number without unit.
  virtual void Number(const char* key, const Range& range, double& value, const char* meaning,
                      std::optional<double> absent = {}) = 0;
  /// The key is `stem`, an underscore and one of the dimension's units.
  virtual void Quantity(const char* stem, Dimension dimension, const Range& range, double& value,
                        const char* meaning, std::optional<double> absent = {}) = 0;
  /// One of which nothing is said where the key is absent.
  virtual void OptionalNumber(const char* key, const Range& range, std::optional<double>& value,
                              const char* meaning) = 0;
  virtual void OptionalQuantity(const char* stem, Dimension dimension, const Range& range,
                                std::optional<double>& value, const char* meaning) = 0;
  /// A list of so many of them; if `low_count` is 0 the key need not be there.
  virtual void Numbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
                       std::vector<double>& values, const char* meaning) = 0;
  virtual void Quantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                          std::size_t high_count, std::vector<double>& values, const char* meaning) = 0;
  /// The same, of which the key need not be there.
  virtual void OptionalQuantities(const char* stem, Dimension dimension, const Range& range,
                                  std::size_t low_count, std::size_t high_count, std::vector<double>& values,
                                  const char* meaning) = 0;
  /// A list that may be a CSV file's only column, of the key's name.
  virtual void Column(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                      std::vector<double>& values, const char* meaning) {
    Quantities(stem, dimension, range, low_count, SIZE_MAX, values, meaning);
  }
  /// A whole number, or a list of several, each once; the key need not be there. `noun` and `which` say of
  /// what, in the words of a message: "stage", "that this disperses".
  virtual void Several(const char* key, int low, int high, const char* noun, const char* which,
                       std::vector<int>& values, const char* meaning) = 0;
  /// A list of so many numbers, of which the key need not be there.
  virtual void OptionalNumbers(const char* key, const Range& range, std::size_t low_count,
                               std::size_t high_count, std::vector<double>& values, const char* meaning) = 0;
  /// A list of two rows of two numbers; `allowed` shows one.
  virtual void TwoByTwo(const char* key, std::array<std::array<double, 2>, 2>& rows, const char* allowed,
                        const char* meaning) = 0;
  /// Numbers under any names; the key need not be there. Whoever reads the map by hand knows the names.
  virtual void AnyNumbers(const char* key, const char* meaning) = 0;
  /// A list of lists of numbers.
  virtual void Rows(const char* key, std::size_t low_count, std::size_t high_count,
                    std::vector<std::vector<double>>& rows, const char* meaning) = 0;
  /// The keys `columns`, a list of just these names, and `rows`, a list of lists of a number for each.
  virtual void ColumnsAndRows(const std::vector<std::string>& columns, std::size_t low_count,
                              std::vector<std::vector<double>>& rows, const char* meaning) = 0;
  /// A number for both ends of something, or a list of two.
  virtual void Ends(const char* stem, Dimension dimension, const Range& range, double& first, double& second,
                    bool needed, const char* meaning) = 0;
  /// Exactly one of several quantities; `which` is its place among them.
  virtual void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) = 0;
  virtual void Texts(const char* key, std::size_t low_count, std::size_t high_count,
                     std::vector<std::string>& values, const char* meaning) = 0;
  /// The name of one of many things; `what` says of which: "a metric". Without `names` another file has them.
  virtual void Name(const char* key, const std::vector<std::string>& names, const char* what,
                    std::string& value, const char* meaning) = 0;
  /// A list of words, each one of `words`; `values` are their places.
  virtual void Words(const char* key, const std::vector<std::string>& words, std::vector<std::size_t>& values,
                     const char* meaning) = 0;
  /// One of a list of words.
  template <class Enum>
  void Choice(const char* key, const std::vector<std::pair<std::string, Enum>>& choices, Enum& value,
              const char* meaning, std::optional<Enum> absent = {}) {
    const auto index_of = [&](Enum wanted) {
      std::size_t index = 0;
      while (index + 1 < choices.size() && choices[index].second != wanted) ++index;
      return index;
    };
    Choices all{{}, [&](std::size_t i) { value = choices[i].second; }};
    for (const auto& choice : choices) all.words.push_back(choice.first);
    Word(key, all, meaning, absent ? std::optional(index_of(*absent)) : std::nullopt);
  }

  /// A map that must be there.
  virtual void Map(const char* key, const char* meaning, const Part& part) = 0;
  /// A map that need not be there; `is_there` receives whether it is.
  virtual void OptionalMap(const char* key, bool& is_there, const char* meaning, const Part& part) = 0;
  /// A word, or a map. What is neither is refused as not `what`: "a direction".
  virtual void WordOrMap(const char* key, const char* word, const char* what, const char* allowed,
                         bool& is_word, const char* meaning, const Part& part) = 0;
  /// A number, or a table; the key need not be there.
  virtual void NumberOrTable(const char* key, std::optional<double>& number, const char* meaning,
                             const Part& part) = 0;
  /// A map, or a list of such maps; the key need not be there. `allowed` says what an empty list should be.
  virtual void MapOrMaps(const char* key, const char* allowed, const char* meaning, const Part& part) = 0;
  /// The columns of a table: a map of lists, or the CSV file of which it was made; `allowed` says which.
  virtual void Table(const char* key, const char* allowed, const char* meaning, const Part& part) = 0;
  virtual void OptionalTable(const char* key, bool& is_there, const char* meaning, const Part& part) = 0;
  /// A map that need not be there, and is read by hand; `part` names its keys to those who have no file.
  virtual void MapByHand(const char* key, const char* meaning, const Part& part, const ReadNode& read) = 0;
  /// Columns of numbers under any names, or the CSV file of them; the key need not be there.
  virtual void Columns(const char* key, const char* meaning, const ReadNode& read) = 0;
  /// What a file of a kind holds, in place or by the file's name. If it is not `needed` the key need not be
  /// there.
  virtual void Document(const char* key, const char* schema, bool needed, const char* allowed,
                        const char* meaning, const ReadNode& read) = 0;
  /// A list of maps; if `low_count` is 0 the key need not be there. describe(fields, item) of each, or
  /// describe(fields, item, number of items).
  template <class T, class F>
  void List(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
            const char* meaning, F describe) {
    Maps(key, low_count > 0, low_count, high_count, ItemsOf(items, describe), meaning);
  }
  template <class T>
  void List(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
            const char* meaning) {
    List(key, low_count, high_count, items, meaning, [](Fields& fields, T& item) { Describe(fields, item); });
  }
  /// The key need not be there; a list that is there has so many.
  template <class T, class F>
  void OptionalList(const char* key, std::size_t low_count, std::size_t high_count, std::vector<T>& items,
                    const char* meaning, F describe) {
    Maps(key, false, low_count, high_count, ItemsOf(items, describe), meaning);
  }

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
  /// Exactly one of these keys, which are named before, is there; a reader refuses others in words of its
  /// own.
  virtual void ExactlyOne(const std::vector<std::string>& /*keys*/) {}
  /// One or more of these keys, which are named before or after, are there; likewise.
  virtual void OneOrMore(const std::vector<std::string>& /*keys*/) {}
  /// In an alternative: one of these keys, which others have, is missing.
  virtual void Missing(const std::vector<std::string>& /*keys*/, const char* /*allowed*/) {}
  /// In an alternative: a key of another one, which this map must not have. In `message` {} stands for the
  /// key.
  virtual void Misplaced(const char* /*stem*/, Dimension /*dimension*/, const char* /*message*/,
                         const char* /*allowed*/) {}

  /// Keys of maps that have none of `unclear`: people write these, but they say too little. In `message` {}
  /// stands for the key.
  virtual void Unclear(const std::vector<std::string>& /*unclear*/, const char* /*message*/,
                       const std::string& /*allowed*/, const std::function<void()>& describe) {
    describe();
  }

  // What only a reader does: the others have no file.

  /// `relation` is called when the whole map was read without a problem, and says by Refuse() what does not
  /// fit together.
  virtual void Check(const std::function<void()>& /*relation*/) {}
  /// Refuses the value of a key, such as "time[3]" or "at.delay"; a quantity's unit need not be named.
  virtual void Refuse(const std::string& /*key*/, const std::string& /*message*/,
                      const std::string& /*allowed*/) {}
  /// After a number: one that was refused and lies in `mistaken` is its counterpart, "in percent"; meant()
  /// gives it.
  virtual void Hint(const char* /*key*/, const Range& /*mistaken*/, const char* /*what*/,
                    double (* /*meant*/)(double)) {}
  /// The value of a key as the file writes it, to be quoted in a message.
  virtual std::string Quote(const std::string& /*key*/) const { return {}; }

 protected:
  virtual void Whole(const char* key, std::uint64_t low, std::uint64_t high, std::uint64_t& value,
                     const char* meaning, std::optional<std::uint64_t> absent) = 0;
  virtual void Word(const char* key, const Choices& choices, const char* meaning,
                    std::optional<std::size_t> absent) = 0;
  virtual void Maps(const char* key, bool needed, std::size_t low_count, std::size_t high_count,
                    const Items& items, const char* meaning) = 0;

 private:
  template <class T, class F>
  static Items ItemsOf(std::vector<T>& items, F& describe) {
    return {[&items](std::size_t count) { items.resize(count); },
            [&items, &describe](Fields& fields, std::size_t i) {
              if constexpr (std::is_invocable_v<F, Fields&, T&, std::size_t>)
                describe(fields, items[i], items.size());
              else
                describe(fields, items[i]);
            }};
  }
};

/// In a Check(): refuses the first of a list's values that is not above the one before; true if there is
/// none.
bool CheckIncreasing(Fields& fields, const std::string& stem, const std::vector<double>& values);

}  // namespace dispersa
