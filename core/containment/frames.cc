#include "core/containment/frames.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace dispersa {
namespace {

constexpr std::string_view kKinds = "sptaued";

bool WriteAll(int file, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t part = write(file, at, size);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return false;
    at += part;
    size -= static_cast<std::size_t>(part);
  }
  return true;
}

}  // namespace

bool WriteFrame(int file, char kind, const std::string& bytes) {
  const std::uint64_t size = bytes.size();
  return WriteAll(file, &kind, 1) && WriteAll(file, &size, sizeof size) &&
         WriteAll(file, bytes.data(), bytes.size());
}

bool FrameReader::ReadFrom(int file) {
  char part[65536];
  const ssize_t size = read(file, part, sizeof part);
  if (size > 0) {
    bytes_.erase(0, at_);
    at_ = 0;
    bytes_.append(part, static_cast<std::size_t>(size));
  }
  return size > 0 || (size < 0 && (errno == EINTR || errno == EAGAIN));
}

std::optional<Frame> FrameReader::Next() {
  std::uint64_t length = 0;
  if (is_spoilt_ || bytes_.size() - at_ < 1 + sizeof length) return std::nullopt;
  std::memcpy(&length, bytes_.data() + at_ + 1, sizeof length);
  const char kind = bytes_[at_];
  is_spoilt_ = length > most_bytes_ || kKinds.find(kind) == std::string_view::npos;
  if (is_spoilt_ || bytes_.size() - at_ - 1 - sizeof length < length) return std::nullopt;
  Frame frame{kind, bytes_.substr(at_ + 1 + sizeof length, length)};
  at_ += 1 + sizeof length + length;
  return frame;
}

std::string PackEnd(const PluginMark& at, const std::string& text) {
  static_assert(std::is_trivially_copyable_v<PluginMark>);
  return std::string(reinterpret_cast<const char*>(&at), sizeof at) + text;
}

PluginMark UnpackEnd(const std::string& bytes, std::string* text) {
  PluginMark at;
  std::memcpy(&at, bytes.data(), std::min(sizeof at, bytes.size()));
  *text = bytes.size() > sizeof at ? bytes.substr(sizeof at) : "";
  return at;
}

}  // namespace dispersa
