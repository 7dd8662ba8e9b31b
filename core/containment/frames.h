// Messages between a process and its child, which may write anything: a byte, the size as 8 bytes, the bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/control/plugin.h"

namespace dispersa {

/// Kinds of messages.
enum : char {
  kSaid = 's',     ///< a part of the answer
  kProblem = 'p',  ///< the text of a PluginError
  kThrew = 't',    ///< the text of another exception
  kAsked = 'a',    ///< the number of a system call that was refused
  kUnheld = 'u',   ///< why there is no process or sandbox now
  kEnded = 'e',    ///< a PluginMark, and how the child ended
  kDone = 'd',     ///< the answer is complete
};

struct Frame {
  char kind = kDone;
  std::string bytes;
};

/// Writes a message. False if nobody listens any more, or not to the end.
bool WriteFrame(int file, char kind, const std::string& bytes);

/// Puts together what arrives in parts.
class FrameReader {
 public:
  /// A larger message is none.
  explicit FrameReader(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Reads what has arrived. False at the end, or if the file cannot be read.
  bool ReadFrom(int file);
  /// The next one that is whole.
  std::optional<Frame> Next();
  /// Whether something else than messages arrived.
  bool is_spoilt() const { return is_spoilt_; }

 private:
  std::size_t most_bytes_;
  std::string bytes_;
  std::size_t at_ = 0;
  bool is_spoilt_ = false;
};

/// The position of a call and a text behind it, as the bytes of a kEnded.
std::string PackEnd(const PluginMark& at, const std::string& text);
PluginMark UnpackEnd(const std::string& bytes, std::string* text);

}  // namespace dispersa
