// A YAML or CSV document as a tree in which every value knows its place.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace dispersa {

struct InputMember;

/// A value of a document. Anchors, aliases and tags are resolved: a value is where it is used.
struct InputNode {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  std::string text;              ///< of a scalar
  bool quoted = false;           ///< a quoted scalar is text, even if it looks like a number
  std::vector<InputNode> items;  ///< of a list
  std::vector<InputMember>
      members;            ///< of a map, in file order; a key is there once, of a table its reader says so
  bool is_table = false;  ///< a map that was a table's file: its keys are columns
  std::shared_ptr<const std::string> file;
  int line = 1;
  int column = 1;

  /// The value of a key, or null.
  const InputNode* Find(std::string_view key) const;
  InputNode* Find(std::string_view key);
  /// The scalar as an error message quotes it. For the other kinds "a list", "a map", "nothing".
  std::string Describe() const;
};

/// What the value of a key decides. Its declaration says so (Fields::Deciding).
enum class Decides {
  kAsAround,    ///< what the map around it decides; in a file: the trajectory, and with it a flight
  kFlightOnly,  ///< a flight, but not the trajectory of a point mass, which a reference is
  kDraws,       ///< which values are drawn, in a design that stays
  kCount,       ///< how many cases are flown
  kVerdict,     ///< what is required, and how that is judged
  kNothing,     ///< words, and what has an id of its own
};

struct InputMember {
  std::string key;
  int line = 1;
  int column = 1;
  InputNode value;
  Decides decides = Decides::kAsAround;  ///< set when the map is read
};

/// A scalar, list or map at the place of another node.
InputNode ScalarAt(const InputNode& place, std::string text);
/// A scalar that is always text, also if it looks like a number.
InputNode TextAt(const InputNode& place, std::string text);
InputNode ListAt(const InputNode& place);
InputNode MapAt(const InputNode& place);
/// Sets a key of a map, replacing its value if it has one.
void SetMember(InputNode& map, const std::string& key, InputNode value);

}  // namespace dispersa
