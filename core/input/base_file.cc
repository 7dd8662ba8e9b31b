#include "core/input/base_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/input/read_value.h"

namespace dispersa {
namespace {

using Kind = InputNode::Kind;
using ProblemList = std::vector<InputProblem>;

std::string PathOf(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

InputNode Take(InputNode& map, std::string_view key) {
  const auto found = std::find_if(map.members.begin(), map.members.end(),
                                  [&](const InputMember& member) { return member.key == key; });
  if (found == map.members.end()) return {};
  InputNode value = std::move(found->value);
  map.members.erase(found);
  return value;
}

// Names two texts of one file alike.
std::string Canonical(const std::string& file) {
  std::error_code error;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file), error).string();
}

class Writer {
 public:
  Writer(const BaseKeys& keys, ProblemList& problems, FileSource* files)
      : keys_(keys), problems_(problems), files_(files) {}

  void Write(InputNode& node, const std::string& path) {
    if (node.kind != Kind::kMap || node.Find(kBasedOn) == nullptr || files_ == nullptr) return;
    const std::size_t before = problems_.size();
    InputNode base = Take(node, kBasedOn);
    const InputNode without = Take(node, kWithout);
    Read(base, *node.file, PathOf(path, kBasedOn));
    if (problems_.size() == before) LeaveOut(without, PathOf(path, kWithout), base);
    if (problems_.size() > before)
      node = InputNode();
    else
      Complete(node, std::move(base));
  }

 private:
  // The file that `base` names, written out.
  void Read(InputNode& base, const std::string& file, const std::string& path) {
    const InputNode name = base;
    if (name.kind != Kind::kScalar)
      return AddProblem(problems_, name, path, name.Describe() + " is not a file name", FileText());
    files_->Load(base, path, FileSource::Holds::kDocument, problems_);
    if (base.file == nullptr) return;
    read_.push_back(Canonical(file));
    if (std::find(read_.begin(), read_.end(), Canonical(*base.file)) != read_.end())
      return AddProblem(problems_, name, path, "'" + *base.file + "' is based on this file itself",
                        FileText() + " that is not based on this one");
    if (base.kind != Kind::kMap)
      return AddProblem(problems_, base, "", base.Describe() + " is not " + keys_.what, FileText());
    if (HasSchema(base, "", keys_.schema, problems_)) Write(base, "");
  }
  std::string FileText() const { return std::string("the name of ") + keys_.what + " file"; }

  // Removes "key", or "map.entry" of a map that is taken entry by entry.
  void LeaveOut(const InputNode& without, const std::string& path, InputNode& base) const {
    if (without.file == nullptr) return;
    if (without.kind != Kind::kList || without.items.empty())
      return AddProblem(problems_, without, path, without.Describe() + " is not a list of keys",
                        "a list of keys of the file that this one is based on");
    for (std::size_t i = 0; i < without.items.size(); ++i) {
      const InputNode& item = without.items[i];
      InputNode* map = &base;
      std::string key = item.text;
      for (const std::string_view merged : keys_.merged) {
        if (!key.starts_with(std::string(merged) + ".")) continue;
        if (InputNode* inside = base.Find(merged)) map = inside, key.erase(0, merged.size() + 1);
        break;
      }
      if (key != "schema" && Take(*map, key).file != nullptr) continue;
      const std::vector<std::string> names = NamesOf(base);
      AddProblem(problems_, item, path + "[" + std::to_string(i) + "]",
                 item.Describe() + " is not a key of '" + *base.file + "'" + DidYouMean(item.text, names),
                 "one of " + JoinWords(names));
    }
  }
  std::vector<std::string> NamesOf(const InputNode& base) const {
    std::vector<std::string> names;
    for (const InputMember& member : base.members) {
      if (member.key != "schema") names.push_back(member.key);
      if (IsMerged(member.key))
        for (const InputMember& entry : member.value.members) names.push_back(member.key + "." + entry.key);
    }
    return names;
  }

  bool IsMerged(const std::string& key) const {
    return std::find(keys_.merged.begin(), keys_.merged.end(), key) != keys_.merged.end();
  }
  void Complete(InputNode& node, InputNode base) const {
    for (InputMember& member : base.members) {
      InputNode* own = node.Find(member.key);
      if (own == nullptr)
        node.members.push_back(std::move(member));
      else if (IsMerged(member.key) && own->kind == Kind::kMap && member.value.kind == Kind::kMap)
        Complete(*own, std::move(member.value));
    }
  }

  const BaseKeys& keys_;
  ProblemList& problems_;
  FileSource* const files_;
  std::vector<std::string> read_;  // the files that are based on the one that is read
};

}  // namespace

bool HasSchema(const InputNode& node, const std::string& path, const std::string& schema,
               ProblemList& problems) {
  if (node.kind != Kind::kMap) return true;  // refused as what it is
  const InputNode* value = node.Find("schema");
  const std::string allowed = "schema: " + schema;
  if (value == nullptr && path.empty())
    AddProblem(problems, node, path, "missing key 'schema'", allowed);
  else if (value != nullptr && value->text != schema)
    AddProblem(problems, *value, PathOf(path, "schema"),
               value->Describe() + " is not the schema of this kind of file", allowed);
  else
    return true;
  return false;
}

void WriteOut(InputNode& node, const BaseKeys& keys, const std::string& path, ProblemList& problems,
              FileSource* files) {
  ProblemList ignored;
  if (HasSchema(node, path, keys.schema, ignored)) Writer(keys, problems, files).Write(node, path);
}

}  // namespace dispersa
