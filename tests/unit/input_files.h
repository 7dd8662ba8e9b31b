// A copy of tests/data/yaml in a separate folder, for one test to edit.
#pragma once

#include "core/input/input_error.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa {

/// A file's text with the first of each `from`, which must be there, replaced.
inline std::string Edited(const std::string& path,
                          const std::vector<std::pair<std::string, std::string>>& edits) {
  std::string text = TextOfFile(path);
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("no '" + from + "' in " + path);
    text.replace(at, from.size(), to);
  }
  return text;
}

class InputFiles {
 public:
  InputFiles() {
    std::filesystem::copy(DISPERSA_TEST_DATA "/yaml", folder_.path(),
                          std::filesystem::copy_options::recursive);
  }

  std::string Path(const std::string& file) const { return (folder_ / file).string(); }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(Path(file)).parent_path());
    std::ofstream(Path(file)) << text;
  }

  /// Replaces the first occurrence, which must exist.
  void Edit(const std::string& file, const std::string& from, const std::string& to) const {
    Write(file, Edited(Path(file), {{from, to}}));
  }

  /// The problems as a user reads them, one a line, without the folder.
  std::string Texts(const std::vector<InputProblem>& problems) const {
    const std::string prefix = folder_.path().string() + "/";
    std::string texts;
    for (const InputProblem& problem : problems) texts += problem.Text() + "\n";
    for (std::size_t at = 0; (at = texts.find(prefix)) != std::string::npos;) texts.erase(at, prefix.size());
    return texts;
  }

  /// Those that an action throws.
  std::string ErrorsOf(const std::function<void()>& action) const {
    try {
      action();
    } catch (const InputError& error) {
      return Texts(error.problems());
    }
    return "";
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace dispersa
