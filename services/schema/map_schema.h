// The JSON Schema of one map of the input files, made from the description of its keys.
//
// Every branch of a description is visited. So the schema knows the keys of all branches, and which keys go
// together. It accepts everything that the reader accepts. Two things it cannot know, and leaves to the
// reader: relations between values (Fields::Check), and branches that depend on values already read.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/input/fields.h"

namespace dispersa {

class MapSchema : public Fields {
 public:
  using Json = nlohmann::ordered_json;
  /// The schemas that several maps refer to.
  class Shared {
   public:
    virtual ~Shared() = default;
    /// A reference to the schema of another kind of file, by the text of its key `schema`.
    virtual Json Document(const std::string& schema) = 0;
    /// A reference to the schema of `make`, which is called once for each name.
    virtual Json Named(const std::string& name, const std::function<Json()>& make) = 0;
  };

  explicit MapSchema(Shared& shared) : shared_(shared) {}

  /// The schema of everything described so far.
  Json Finish() const;

  void File(const char* schema, const BaseKeys* base) override;
  void Flag(const char* key, bool& value, bool absent, const char* meaning) override;
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) override;
  void AnyNumbers() override { is_open_ = true; }
  void Group(const char* name, const std::string& of, const Part& part) override;
  void Either(const std::vector<Alternative>& alternatives) override;
  void ExactlyOne(const std::vector<std::string>& keys) override;
  void OneOrMore(const std::vector<std::string>& keys) override;
  void Missing(const std::vector<std::string>& keys, const char* allowed) override;

 protected:
  void VisitText(const TextKey& key, std::string& value) override;
  void VisitTexts(const TextKey& key, std::size_t low_count, std::size_t high_count,
                  std::vector<std::string>& values) override;
  void VisitWhole(const WholeKey& key, std::vector<std::uint64_t>& values) override;
  void VisitNumber(const NumberKey& key, std::optional<double>& value) override;
  void VisitNumbers(const NumbersKey& key, std::vector<double>& values) override;
  void VisitRows(const RowsKey& key, std::vector<std::vector<double>>& rows) override;
  void VisitNode(const NodeKey& key, const ReadNode& read) override;
  void VisitMap(const MapKey& key, MapValue& value, const Part& part) override;
  void VisitMaps(const Key& key, std::size_t low_count, std::size_t high_count, const Items& items) override;

 private:
  /// The keys of a map, or of one alternative of it.
  struct Keys {
    Json values = Json::object();  ///< the schema of each
    Json required = Json::array();
    Json rules = Json::array();       ///< which keys go together
    std::set<std::string> groups;     ///< references to the keys of their groups
    std::set<std::string> of_groups;  ///< these keys

    /// Adds the conditions on a map with these keys.
    void AddTo(Json& schema) const;
  };

  void Add(const Key& key, Json value);
  // Adds one key for each unit in which it may end. `value` makes a key's schema from its scale and unit.
  void AddUnits(const NumberKey& key, const std::function<Json(const Unit& unit)>& value);
  std::string Pattern(const std::vector<std::string>& keys) const;
  /// Adds the keys to a map's schema.
  void AddProperties(const Json& values, Json& schema) const;
  std::map<std::string, std::map<std::string, std::string>> FurtherUnits(const Json& values,
                                                                         const Json& own) const;
  Json MapOf(const Part& part) const;
  std::vector<Json> Holds(const Condition& condition) const;
  bool IsNoneIfEmpty(const Condition& condition) const;

  struct QuantityKey {
    std::string stem;
    std::string units;  ///< "m|km"
  };

  Shared& shared_;
  Keys keys_;
  std::map<std::string, QuantityKey> quantities_;
  std::set<std::string> lists_;  ///< keys of lists, which count as absent if they are empty
  bool is_open_ = false;         ///< numbers under any names
  bool has_base_ = false;        ///< a base file may give missing keys
};

}  // namespace dispersa
