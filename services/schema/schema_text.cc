#include "services/schema/schema_text.h"

#include <nlohmann/json.hpp>

#include "core/campaign_yaml/describe_file.h"
#include "services/schema/map_schema.h"
#include "services/schema/shared_parts.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 110;
constexpr std::size_t kDeepest =
    4;  // what lies deeper stands on one line: indenting it is a fifth of the file

// Indented, but what fits stands on one line.
void Print(const Json& json, std::size_t indent, std::string& out) {
  const std::string line = json.dump();
  if (!json.is_structured() || json.empty() || indent >= kDeepest || indent + line.size() <= kColumns) {
    out += line;
    return;
  }
  out += json.is_array() ? "[" : "{";
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    out += separator + std::string(indent + 1, ' ');
    if (json.is_object()) out += Json(key).dump() + ": ";
    Print(value, indent + 1, out);
    separator = ",\n";
  }
  out += "\n" + std::string(indent, ' ') + (json.is_array() ? "]" : "}");
}

// The schemas of the files that a file may hold in place.
class Documents {
 public:
  Json Of(const std::string& schema) {
    for (const FileKind kind : kFileKinds) {
      if (SchemaOf(kind) != schema) continue;
      if (!schemas_.contains(NameOf(kind))) {
        schemas_[NameOf(kind)] = nullptr;  // it is being made
        Json made = File(kind);
        schemas_[NameOf(kind)] = std::move(made);
      }
      return {{"$ref", "#/$defs/" + NameOf(kind)}};
    }
    return true;
  }

  Json File(FileKind kind) {
    MapSchema map([this](const std::string& schema) { return Of(schema); });
    DescribeFile(kind, map);
    return map.Finish();
  }

  const Json& schemas() const { return schemas_; }

 private:
  Json schemas_ = Json::object();
};

}  // namespace

std::string SchemaText(FileKind kind) {
  Documents documents;
  Json file = documents.File(kind);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "dispersa " + NameOf(kind) + " file"},
                 {"description",
                  "Written by `dispersa schema`. Only `dispersa validate` checks relations between values."}};
  for (auto& [key, value] : file.items()) schema[key] = std::move(value);
  // Inside another file the key may be missing.
  if (!schema.contains("required")) schema["required"] = Json::array();
  schema["required"].insert(schema["required"].begin(), "schema");
  schema["$defs"] = documents.schemas();
  std::string text;
  Print(WithSharedParts(std::move(schema)), 0, text);
  return text + "\n";
}

}  // namespace dispersa
