// The one exception type for bad user input: every problem that was found, each with its place.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace dispersa {

/// A fault that a user must mend. Line and column count from 1. 0: it has no place in the text (a folder, a
/// command-line value); `file` may then be empty.
struct InputProblem {
  std::string file;  ///< as the user named it
  int line = 0;
  int column = 0;
  std::string
      path;  ///< of the value in its file, e.g. "stages[1].motor.thrust_kn" (empty: the file as a whole)
  std::string message;   ///< what is wrong
  std::string allowed;   ///< allowed or usual values, may be empty
  bool unusual = false;  ///< a warning: the value is allowed, and `allowed` is the usual range

  /// "file:line:col: path: message, allowed: ..." (or "usual: ...") without the parts that are empty.
  std::string Text() const {
    std::string text;
    if (!file.empty()) {
      text += file + ":";
      if (line > 0) text += std::to_string(line) + ":" + std::to_string(column) + ":";
      text += " ";
    }
    if (!path.empty()) text += path + ": ";
    text += message;
    if (!allowed.empty()) text += (unusual ? ", usual: " : ", allowed: ") + allowed;
    return text;
  }
};

/// Bad usage or bad input: exit code 2. what() is every problem's Text(), one a line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<InputProblem> problems)
      : std::runtime_error(Join(problems)), problems_(std::move(problems)) {}
  /// A problem without a place in a file.
  explicit InputError(std::string message, std::string allowed = "")
      : InputError(std::vector<InputProblem>{{"", 0, 0, "", std::move(message), std::move(allowed)}}) {}

  const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  static std::string Join(const std::vector<InputProblem>& problems) {
    std::string text;
    for (const InputProblem& problem : problems) {
      if (!text.empty()) text += "\n";
      text += problem.Text();
    }
    return text;
  }

  std::vector<InputProblem> problems_;
};

}  // namespace dispersa
