// Errors of a result folder that the user did not cause.
#pragma once

#include <stdexcept>
#include <string>

namespace dispersa {

/// A result folder cannot be read or written. The message is one sentence with the path. If the user named a
/// wrong folder, InputError is thrown instead.
class ResultError : public std::runtime_error {
 public:
  enum class Kind {
    kDiskFull,    ///< no space left, over quota, a file at its limit, no descriptor: the run can be resumed
    kFewer,       ///< fewer results than there should be: a fuller file was not replaced
    kConflict,    ///< a case returned twice with different digests: an internal error that is never ignored
    kFileSystem,  ///< the file system lacks locks or shared memory: the user chooses another folder
    kFile,        ///< any other failure of the disk or the database
  };

  ResultError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace dispersa
