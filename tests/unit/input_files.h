// A copy of tests/data/yaml in a separate folder, for one test to edit.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/input/input_error.h"

namespace dispersa {

inline std::string ReadWholeFile(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class InputFiles {
 public:
  InputFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "dispersa-yaml-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
    std::filesystem::copy(DISPERSA_TEST_DATA "/yaml", folder_, std::filesystem::copy_options::recursive);
  }
  ~InputFiles() { std::filesystem::remove_all(folder_); }
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  std::string Path(const std::string& file) const { return (folder_ / file).string(); }

  void Write(const std::string& file, const std::string& text) const { std::ofstream(Path(file)) << text; }

  /// Replaces the first occurrence, which must exist.
  void Edit(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = ReadWholeFile(Path(file));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << "no '" << from << "' in " << file;
    Write(file, text.replace(at, from.size(), to));
  }

  /// The problems as a user reads them, one a line, without the folder.
  std::string Texts(const std::vector<InputProblem>& problems) const {
    const std::string prefix = folder_.string() + "/";
    std::string texts;
    for (const InputProblem& problem : problems) texts += problem.Text() + "\n";
    for (std::size_t at = 0; (at = texts.find(prefix)) != std::string::npos;) texts.erase(at, prefix.size());
    return texts;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace dispersa
