// What readers of input files ask for and expect, told to whoever listens: the JSON Schemas are made of it.
//
// Nobody listens in normal use, and then nothing is said. Readers tell of every key that they look for,
// whether it is there or not, under the paths that their messages have.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/input/input_node.h"

namespace dispersa {

/// What a value must be. Several may be expected of one value; then any of them will do.
struct Expectation {
  enum class Kind {
    kNumber,   ///< from `low` to `high`, in the file's unit
    kInteger,  ///< the same, whole
    kText,
    kFlag,
    kWords,  ///< one of `words`
    kList,   ///< of `low_count` to `high_count` items
    kMap,
    kFile,      ///< a file's name
    kDocument,  ///< what a file of the kind `words[0]`, a name of a schema, holds
    kColumns,   ///< a map of lists of numbers, of any names
    kNumbers,   ///< a map of numbers, of any names
  };
  Kind kind = Kind::kText;
  std::string low = "", high = "";  ///< decimal numbers; empty: no limit
  bool low_open = false, high_open = false;
  std::string unit = "";
  std::vector<std::string> words = {};
  bool open = false;  ///< words that are only examples, because another file decides
  std::size_t low_count = 0, high_count = SIZE_MAX;
  std::optional<std::string> absent = {};  ///< what it is if the key is not there
};

class InputObserver {
 public:
  InputObserver() = default;
  virtual ~InputObserver() = default;
  InputObserver(const InputObserver&) = delete;
  InputObserver& operator=(const InputObserver&) = delete;

  /// A map is about to be read.
  virtual void Reads(const std::string& path, const InputNode& node) = 0;
  /// The map may have one of these keys: the spellings of one thing in several units.
  virtual void Knows(const std::string& path, const std::vector<std::string>& keys) = 0;
  /// Whether the map has one of the keys decides what else it may have.
  virtual void Heeds(const std::string& path, const std::vector<std::string>& keys) = 0;
  /// The map must have one of the keys and has none.
  virtual void Misses(const std::string& path, const std::vector<std::string>& keys) = 0;
  /// What the value at `path` must be; "key[]" stands for every item of a list.
  virtual void Expects(const std::string& path, const Expectation& expectation) = 0;
};

/// Who listens in this thread, or null.
InputObserver* Listener();

/// Listens while it lives.
class Listening {
 public:
  explicit Listening(InputObserver& observer);
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
};

// For what is read by hand; each says nothing if nobody listens.
void SayKnows(const std::string& path, const std::vector<std::string>& keys);
void SayHeeds(const std::string& path, const std::vector<std::string>& keys);
void SayMisses(const std::string& path, const std::vector<std::string>& keys);
void SayExpects(const std::string& path, const Expectation& expectation);

}  // namespace dispersa
