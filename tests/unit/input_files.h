// A copy of tests/data/yaml in a separate folder, for one test to edit.
#pragma once

#include "core/input/input_error.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa {

class InputFiles {
 public:
  InputFiles() {
    std::filesystem::copy(DISPERSA_TEST_DATA "/yaml", folder_.path(),
                          std::filesystem::copy_options::recursive);
  }

  std::string Path(const std::string& file) const { return (folder_ / file).string(); }

  void Write(const std::string& file, const std::string& text) const { std::ofstream(Path(file)) << text; }

  /// Replaces the first occurrence, which must exist.
  void Edit(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = TextOfFile(Path(file));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << "no '" << from << "' in " << file;
    Write(file, text.replace(at, from.size(), to));
  }

  /// The problems as a user reads them, one a line, without the folder.
  std::string Texts(const std::vector<InputProblem>& problems) const {
    const std::string prefix = folder_.path().string() + "/";
    std::string texts;
    for (const InputProblem& problem : problems) texts += problem.Text() + "\n";
    for (std::size_t at = 0; (at = texts.find(prefix)) != std::string::npos;) texts.erase(at, prefix.size());
    return texts;
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace dispersa
