#include "services/schema/schema_text.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/campaign_yaml/describe_file.h"
#include "services/schema/map_schema.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 110;
constexpr std::size_t kDeepest =
    1;  // what lies deeper stands on one line: indenting it is a fifth of the file

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

// The schemas that a file's schema refers to.
class SharedSchemas : public MapSchema::Shared {
 public:
  explicit SharedSchemas(SchemaSet set) : set_(set) {}

  Json Document(const std::string& schema) override {
    for (const FileKind kind : kFileKinds) {
      if (SchemaOf(kind) != schema) continue;
      if (set_ == SchemaSet::kSplit) return InItsFile(kind);
      return Named(NameOf(kind), [&] { return File(kind); });
    }
    return true;
  }
  Json Named(const std::string& name, const std::function<Json()>& make) override {
    if (const auto elsewhere = elsewhere_.find(name); elsewhere != elsewhere_.end())
      return {{"$ref", elsewhere->second}};
    if (!schemas_.contains(name)) {
      schemas_[name] = nullptr;  // it is being made
      Json made = make();
      schemas_[name] = std::move(made);
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  Json File(FileKind kind) {
    MapSchema map(*this);
    DescribeFile(kind, map);
    return map.Finish();
  }

  const Json& schemas() const { return schemas_; }

 private:
  // What that file has in common with this one is said there.
  Json InItsFile(FileKind kind) {
    const std::string file = NameOf(kind) + ".json";
    SharedSchemas other(set_);
    other.File(kind);
    for (const auto& [name, schema] : other.schemas().items())
      if (!schemas_.contains(name)) elsewhere_[name] = file + "#/$defs/" + name;
    return {{"$ref", file}};
  }

  const SchemaSet set_;
  std::map<std::string, std::string> elsewhere_;  // references to schemas in other files
  Json schemas_ = Json::object();
};

}  // namespace

std::string SchemaText(FileKind kind, SchemaSet set) {
  SharedSchemas shared(set);
  Json file = shared.File(kind);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "dispersa " + NameOf(kind) + " file"},
                 {"description",
                  "Written by `dispersa schema`. Only `dispersa validate` checks relations between values."}};
  for (auto& [key, value] : file.items()) schema[key] = std::move(value);
  // Inside another file the key may be missing.
  if (!schema.contains("required")) schema["required"] = Json::array();
  schema["required"].insert(schema["required"].begin(), "schema");
  schema["$defs"] = shared.schemas();
  std::string text;
  Print(schema, 0, text);
  return text + "\n";
}

}  // namespace dispersa
