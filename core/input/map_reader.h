// Strict typed access to a tree: every problem is recorded with its place, and reading goes on.
//
// A getter that finds a problem returns a harmless value (0, empty, the first choice); whoever reads checks
// that no problem was recorded before it uses the result.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"
#include "core/input/range.h"
#include "core/input/units.h"

namespace dispersa {

void AddProblem(std::vector<InputProblem>& problems, const InputNode& at, std::string path,
                std::string message, std::string allowed = "");

/// The place of a member's key.
InputNode KeyOf(const InputMember& member);

/// A scalar that is a finite number in the range (which is in internal units), times `scale`.
double ReadNumber(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                  const Range& range = kAnyNumber, double scale = 1.0);

/// The keys of one map. Keys that nothing asked for are reported when the reader goes out of scope.
class MapReader {
 public:
  /// Records a problem if the node is no map; then every getter is silent.
  MapReader(const InputNode& node, std::string path, std::vector<InputProblem>& problems);
  ~MapReader();
  MapReader(const MapReader&) = delete;
  MapReader& operator=(const MapReader&) = delete;

  const InputNode& node() const { return *node_; }
  const std::string& path() const { return path_; }
  std::string PathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  std::vector<InputProblem>& problems() const { return problems_; }

  /// The value of a key that need not exist, or null.
  const InputNode* Optional(const std::string& key);
  /// The value of a key that decides what else is read, or null. It still has to be read.
  const InputNode* Peek(const std::string& key) const;
  /// The value of a key that must exist; a node of kind null, which other readers ignore, if it does not.
  const InputNode& Required(const std::string& key, const std::string& allowed);

  std::string Text(const std::string& key);
  std::string Text(const std::string& key, const std::string& absent);
  bool Flag(const std::string& key, bool absent);
  std::uint64_t Integer(const std::string& key, std::uint64_t low, std::uint64_t high,
                        std::optional<std::uint64_t> absent = {});
  /// A number without unit.
  double Number(const std::string& key, const Range& range, std::optional<double> absent = {});
  /// The key is stem + "_" + one of the dimension's units; range and result are in internal units.
  double Quantity(const std::string& stem, Dimension dimension, const Range& range,
                  std::optional<double> absent = {});
  /// The same if it is there; `key`, if given, receives the key that was.
  std::optional<double> OptionalQuantity(const std::string& stem, Dimension dimension, const Range& range,
                                         std::string* key = nullptr);
  /// The same with a list of `low_count` to `high_count` numbers.
  std::vector<double> Quantities(const std::string& stem, Dimension dimension, const Range& range,
                                 std::size_t low_count, std::size_t high_count = SIZE_MAX,
                                 std::string* key = nullptr);
  std::vector<double> Numbers(const std::string& key, const Range& range, std::size_t low_count,
                              std::size_t high_count = SIZE_MAX);
  /// The key is that of a Quantity; its value one number, which counts for both ends of something, or a list
  /// of two.
  std::array<double, 2> Ends(const std::string& stem, Dimension dimension, const Range& range);
  /// Whether a Quantity is there, in any unit. It still has to be read.
  bool Has(const std::string& stem, Dimension dimension) const;

  /// One of a list of words.
  template <typename Enum>
  Enum Choice(const std::string& key, const std::vector<std::pair<std::string, Enum>>& choices,
              std::optional<Enum> absent = {}) {
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    const std::optional<std::size_t> index = WordIndex(key, words, !absent.has_value());
    if (!index) return absent.value_or(choices.front().second);
    return choices[*index].second;
  }

  /// f(item, path) for each item of a list of `low_count` to `high_count`; an absent key is a problem unless
  /// low_count is 0.
  template <typename F>
  void Each(const std::string& key, std::size_t low_count, std::size_t high_count, F f) {
    const InputNode* list = List(key, low_count, high_count);
    if (list == nullptr) return;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      f(list->items[i], PathOf(key) + "[" + std::to_string(i) + "]");
    }
  }

  /// None of the keys, any of which would do, is there. Not reported if an unknown key evidently means one.
  void ReportMissing(std::vector<std::string> keys, const std::string& allowed);

  /// Says what is unknown or missing. Nothing is read afterwards; the destructor does it too.
  void Finish();

  /// A key that is legal and read by someone else.
  void Allow(const std::string& key) { Optional(key); }
  /// A key of which something was said already.
  void Ignore(const std::string& key) { known_.insert(key); }
  /// Nothing is said of the keys that `read` asks for: what decides whether they belong here was refused.
  void Spare(const std::function<void()>& read);

 private:
  struct Missing {
    std::vector<std::string> keys;
    std::string allowed;
  };

  const InputNode* List(const std::string& key, std::size_t low_count, std::size_t high_count);
  std::optional<std::size_t> WordIndex(const std::string& key, const std::vector<std::string>& words,
                                       bool required);
  // The member of a quantity and its unit, or null.
  const InputNode* FindQuantity(const std::string& stem, Dimension dimension, std::string* key, Unit* unit);

  const InputNode* node_;
  std::string path_;
  std::vector<InputProblem>& problems_;
  std::set<std::string> known_;
  std::vector<std::pair<std::string, std::vector<std::string>>> quantities_;  // stem, keys
  std::vector<Missing> missing_;
  bool is_finished_ = false;
};

/// The scalar as text; a number or a truth value must be quoted to be one.
std::string ReadText(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems);

/// "a, b, c"
std::string JoinWords(const std::vector<std::string>& words);
/// " (did you mean 'x'?)" for the nearest word within two edits, else empty.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& words);

}  // namespace dispersa
