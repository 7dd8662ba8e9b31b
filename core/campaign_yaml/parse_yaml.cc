#include "core/campaign_yaml/parse_yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/campaign_yaml/text_problems.h"

namespace dispersa {
namespace {

// Limits far above every real file. Below them no text, also from strangers, takes long or much memory.
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxKeys = 1000;
constexpr std::size_t kMaxKeyBytes = 200;

/// Ends the reading: what follows is not looked at.
struct TooMuch {
  YAML::Mark mark;
  std::string message;
  std::string allowed;
};

// Builds the tree from the parser's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::shared_ptr<const std::string> file, std::vector<InputProblem>& problems)
      : file_(std::move(file)), problems_(problems) {}

  InputNode Take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Refuse(mark, "", anchor);
    Place(NodeAt(mark, InputNode::Kind::kNull));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    Add(mark, "an alias ('*name') is not supported", "the value itself");
    Place(NodeAt(mark, InputNode::Kind::kNull));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Refuse(mark, tag, anchor);
    InputNode node = NodeAt(mark, InputNode::Kind::kScalar);
    node.text = value;
    node.quoted = tag == "!";  // yaml-cpp's mark of a scalar that is not plain
    Place(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, InputNode::Kind::kList);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, InputNode::Kind::kMap);
  }
  void OnMapEnd() override { Close(); }

 private:
  // A list or map that is being filled; `key` is set between a key and its value.
  struct Level {
    InputNode node;
    bool has_key = false;
    bool is_new = false;  // that key
    InputMember member;
    std::set<std::string> keys;
  };

  InputNode NodeAt(const YAML::Mark& mark, InputNode::Kind kind) const {
    InputNode node;
    node.kind = kind;
    node.file = file_;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  void Add(const YAML::Mark& mark, const std::string& message, const std::string& allowed) {
    problems_.push_back({*file_, mark.line + 1, mark.column + 1, "", message, allowed});
  }

  void Refuse(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) Add(mark, "an anchor ('&name') is not supported", "the value itself");
    if (!tag.empty() && tag != "?" && tag != "!")
      Add(mark, "the tag '" + tag + "' is not supported", "no tag");
  }

  void Open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, InputNode::Kind kind) {
    Refuse(mark, tag, anchor);
    if (levels_.size() >= kMaxDepth) {
      throw TooMuch{mark, "nested too deeply", "up to " + std::to_string(kMaxDepth) + " levels"};
    }
    levels_.push_back({NodeAt(mark, kind), false, false, {}, {}});
  }

  void Close() {
    InputNode node = std::move(levels_.back().node);
    levels_.pop_back();
    Place(std::move(node));
  }

  void Place(InputNode node) {
    if (levels_.empty()) {
      root_ = std::move(node);
      return;
    }
    Level& level = levels_.back();
    if (level.node.kind == InputNode::Kind::kList) {
      level.node.items.push_back(std::move(node));
    } else if (!level.has_key) {
      level.has_key = true;
      const YAML::Mark mark = MarkOf(node);
      if (level.keys.size() >= kMaxKeys) {
        throw TooMuch{mark, "the map has too many keys", "up to " + std::to_string(kMaxKeys)};
      }
      if (node.text.size() > kMaxKeyBytes) {
        throw TooMuch{mark, "the key is too long", "up to " + std::to_string(kMaxKeyBytes) + " bytes"};
      }
      level.member = {node.text, node.line, node.column, {}};
      level.is_new = level.keys.insert(node.text).second;
      if (node.kind != InputNode::Kind::kScalar) {
        Add(mark, "the key is " + node.Describe(), "a name as key");
      } else if (!level.is_new) {
        Add(mark, "the key '" + node.text + "' is given twice", "each key once in a map");
      }
    } else {
      level.has_key = false;
      level.member.value = std::move(node);
      if (level.is_new) level.node.members.push_back(std::move(level.member));
    }
  }

  static YAML::Mark MarkOf(const InputNode& node) {
    YAML::Mark mark;
    mark.line = node.line - 1;
    mark.column = node.column - 1;
    return mark;
  }

  std::shared_ptr<const std::string> file_;
  std::vector<InputProblem>& problems_;
  std::vector<Level> levels_;
  InputNode root_;
};

}  // namespace

InputNode ParseYaml(const std::string& text, const std::string& file, std::vector<InputProblem>& problems) {
  if (text.size() > kMaxBytes) {
    problems.push_back({file, 1, 1, "", "the file is too large", "up to 64 MiB"});
    return {};
  }
  if (!CheckUtf8(text, file, problems)) return {};
  const auto shared_file = std::make_shared<const std::string>(file);
  TreeBuilder builder(shared_file, problems);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) {
      problems.push_back({file, 1, 1, "", "the file is empty", "a map with a 'schema' key"});
      return {};
    }
    TreeBuilder rest(shared_file, problems);
    if (parser.HandleNextDocument(rest)) {
      const InputNode second = rest.Take();
      problems.push_back({file, second.line, second.column, "", "a second document", "one document a file"});
    }
    return builder.Take();
  } catch (const TooMuch& limit) {
    problems.push_back({file, limit.mark.line + 1, limit.mark.column + 1, "", limit.message, limit.allowed});
    return {};
  } catch (const YAML::Exception& error) {
    // The parser's own words are of what the tab led to.
    if (!CheckIndentation(text, file, error.mark.line + 1, problems)) return {};
    problems.push_back({file, error.mark.line + 1, error.mark.column + 1, "", "not YAML: " + error.msg, ""});
    return {};
  }
}

bool ReadFile(const std::string& path, std::string* text, std::string* reason) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (error) {
    *reason = error.message();
    return false;
  }
  if (!std::filesystem::exists(status)) {
    *reason = std::strerror(ENOENT);
    return false;
  }
  if (!std::filesystem::is_regular_file(status)) {
    *reason = std::filesystem::is_directory(status) ? std::strerror(EISDIR) : "Not a regular file";
    return false;
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream contents;
  if (stream) contents << stream.rdbuf();
  if (!stream || stream.bad() || contents.fail()) {
    // An empty file sets failbit on the target without an error.
    if (stream.is_open() && std::filesystem::file_size(path, error) == 0 && !error) {
      text->clear();
      return true;
    }
    *reason = std::strerror(errno != 0 ? errno : EIO);
    return false;
  }
  *text = std::move(contents).str();
  return true;
}

}  // namespace dispersa
