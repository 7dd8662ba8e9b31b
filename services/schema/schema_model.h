// What a file of each kind may hold, learned from its reader: there is no second list of keys to keep.
//
// The reader is given made-up trees and says of each what it looks for (input_observer.h). From that come
// larger trees, until nothing new is said. Which keys a choice, or another key, allows or demands is then
// found by setting one at a time in a map that has nothing else, and kept only if no other tree contradicts
// it. The model may so allow what the reader refuses (a rule between two maps, an order of numbers); it
// refuses nothing that the reader takes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/campaign_yaml/file_kind.h"
#include "core/input/input_observer.h"

namespace dispersa {

/// One of `keys` is in the map; if there are `words`, with one of them.
struct SchemaCondition {
  std::vector<std::string> keys;
  std::vector<std::string> words;
};

/// One thing that a map may hold, under any of its keys (its units), but one.
struct SchemaField {
  std::vector<std::string> keys;
  std::vector<SchemaCondition> only_if;  ///< one of them holds, if there are any
  std::vector<SchemaCondition> not_if;   ///< and none of these
};

/// The map has one of `keys`, if none of `unless` holds and, if there are `only_if`, one of them does.
struct SchemaRequirement {
  std::vector<std::string> keys;
  std::vector<SchemaCondition> unless;
  std::vector<SchemaCondition> only_if;
};

struct SchemaMap {
  std::vector<SchemaField> fields;  ///< in the order in which the reader looks for them
  std::vector<SchemaRequirement> requirements;
};

/// By path: "" is the whole file, "stages[]" each item of a list.
struct SchemaModel {
  std::map<std::string, std::vector<Expectation>> values;
  std::map<std::string, SchemaMap> maps;
};

/// Takes seconds.
SchemaModel LearnSchema(FileKind kind);

}  // namespace dispersa
