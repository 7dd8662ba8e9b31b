// Fills structs from a tree, by their descriptions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// The files that a tree names.
class FileSource {
 public:
  enum class Holds { kDocument, kTable, kBytes, kFolder };

  virtual ~FileSource() = default;
  /// Replaces a scalar, a file's or a folder's name, by what it holds; after a problem, by an absent node.
  /// `path` is the scalar's own.
  void Load(InputNode& name, const std::string& path, Holds holds, std::vector<InputProblem>& problems) {
    const std::size_t before = problems.size();
    Read(name, path, holds, problems);
    problems_ += problems.size() - before;
  }
  /// Number of problems in reading the files, without those of their values.
  std::size_t problems() const { return problems_; }

 private:
  virtual void Read(InputNode& name, const std::string& path, Holds holds,
                    std::vector<InputProblem>& problems) = 0;

  std::size_t problems_ = 0;
};

/// Reads the map at `node`. Every problem is recorded with its place, and reading goes on. The values count
/// only if there is no problem. `path` is the node's own in its file. With `files`, the names of files are
/// replaced by the files' contents. Without `files` they stay.
void ReadFields(InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                FileSource* files, const Fields::Part& describe);

}  // namespace dispersa
