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
  /// The schema of another kind of file, by the text of its key `schema`.
  using DocumentSchema = std::function<Json(const std::string& schema)>;

  explicit MapSchema(DocumentSchema document) : document_(std::move(document)) {}

  /// Of what was described so far.
  Json Finish() const;

  void Schema(const char* name) override;
  void Base(const char* key, const char* meaning) override;
  void Text(const char* key, std::string& value, const char* meaning,
            std::optional<std::string> absent) override;
  void Flag(const char* key, bool& value, bool absent, const char* meaning) override;
  void Number(const char* key, const Range& range, double& value, const char* meaning,
              std::optional<double> absent) override;
  void Quantity(const char* stem, Dimension dimension, const Range& range, double& value, const char* meaning,
                std::optional<double> absent) override;
  void OptionalNumber(const char* key, const Range& range, std::optional<double>& value,
                      const char* meaning) override;
  void OptionalQuantity(const char* stem, Dimension dimension, const Range& range,
                        std::optional<double>& value, const char* meaning) override;
  void Numbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
               std::vector<double>& values, const char* meaning) override;
  void Quantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                  std::size_t high_count, std::vector<double>& values, const char* meaning) override;
  void OptionalQuantities(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
                          std::size_t high_count, std::vector<double>& values, const char* meaning) override;
  void Column(const char* stem, Dimension dimension, const Range& range, std::size_t low_count,
              std::vector<double>& values, const char* meaning) override;
  void Several(const char* key, int low, int high, const char* noun, const char* which,
               std::vector<int>& values, const char* meaning) override;
  void OptionalNumbers(const char* key, const Range& range, std::size_t low_count, std::size_t high_count,
                       std::vector<double>& values, const char* meaning) override;
  void TwoByTwo(const char* key, std::array<std::array<double, 2>, 2>& rows, const char* allowed,
                const char* meaning) override;
  void AnyNumbers(const char* key, const char* meaning) override;
  void Rows(const char* key, std::size_t low_count, std::size_t high_count,
            std::vector<std::vector<double>>& rows, const char* meaning) override;
  void ColumnsAndRows(const std::vector<std::string>& columns, std::size_t low_count,
                      std::vector<std::vector<double>>& rows, const char* meaning) override;
  void Ends(const char* stem, Dimension dimension, const Range& range, double& first, double& second,
            bool needed, const char* meaning) override;
  void OneOf(const std::vector<OneQuantity>& quantities, std::size_t& which, double& value) override;
  void Texts(const char* key, std::size_t low_count, std::size_t high_count, std::vector<std::string>& values,
             const char* meaning) override;
  void Name(const char* key, const std::vector<std::string>& names, const char* what, std::string& value,
            const char* meaning) override;
  void Words(const char* key, const std::vector<std::string>& words, std::vector<std::size_t>& values,
             const char* meaning) override;
  void Map(const char* key, const char* meaning, const Part& part) override;
  void OptionalMap(const char* key, bool& is_there, const char* meaning, const Part& part) override;
  void WordOrMap(const char* key, const char* word, const char* what, const char* allowed, bool& is_word,
                 const char* meaning, const Part& part) override;
  void NumberOrTable(const char* key, std::optional<double>& number, const char* meaning,
                     const Part& part) override;
  void MapOrMaps(const char* key, const char* allowed, const char* meaning, const Part& part) override;
  void Table(const char* key, const char* allowed, const char* meaning, const Part& part) override;
  void OptionalTable(const char* key, bool& is_there, const char* meaning, const Part& part) override;
  void MapByHand(const char* key, const char* meaning, const Part& part, const ReadNode& read) override;
  void Columns(const char* key, const char* meaning, const ReadNode& read) override;
  void Document(const char* key, const char* schema, bool needed, const char* allowed, const char* meaning,
                const ReadNode& read) override;
  void Either(const std::vector<Alternative>& alternatives) override;
  void ExactlyOne(const std::vector<std::string>& keys) override;
  void OneOrMore(const std::vector<std::string>& keys) override;
  void Missing(const std::vector<std::string>& keys, const char* allowed) override;

 protected:
  void Whole(const char* key, std::uint64_t low, std::uint64_t high, std::uint64_t& value,
             const char* meaning, std::optional<std::uint64_t> absent) override;
  void Word(const char* key, const Choices& choices, const char* meaning,
            std::optional<std::size_t> absent) override;
  void Maps(const char* key, bool needed, std::size_t low_count, std::size_t high_count, const Items& items,
            const char* meaning) override;

 private:
  /// Of a map, or of one alternative of it.
  struct Keys {
    Json values = Json::object();  ///< the schema of each
    Json required = Json::array();
    Json rules = Json::array();  ///< which keys go together

    /// Adds the conditions on a map with these keys.
    void AddTo(Json& schema) const;
  };

  void Add(const char* key, Json value, bool needed);
  // Adds one key for each unit in which it may end. `value` makes a key's schema from its scale and unit.
  void AddUnits(const char* stem, Dimension dimension, bool needed,
                const std::function<Json(const Unit& unit)>& value);
  Json None(const std::vector<std::string>& keys) const;
  void AddTable(const char* key, const char* meaning, bool needed, const Part& part);
  Json MapOf(const Part& part) const;
  Json Holds(const Condition& condition) const;

  struct QuantityKey {
    std::string stem;
    std::string units;  ///< "m|km"
  };

  DocumentSchema document_;
  Keys keys_;
  std::map<std::string, QuantityKey> quantities_;
  std::set<std::string> lists_;  ///< keys of lists, which count as absent if they are empty
  std::string base_;  ///< the key of another file whose keys stand where this one has none, or empty
};

}  // namespace dispersa
