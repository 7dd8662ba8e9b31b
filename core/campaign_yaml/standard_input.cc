#include "core/campaign_yaml/standard_input.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace dispersa {
namespace {

// The parser refuses a longer text.
constexpr std::size_t kMost = std::size_t{65} << 20;

struct Input {
  std::string text;
  std::string reason;  ///< empty: it was read
};

Input ReadAll() {
  Input input;
  std::array<char, 65536> buffer;
  errno = 0;
  while (input.text.size() < kMost) {
    const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), stdin);
    if (n == 0) break;
    input.text.append(buffer.data(), n);
  }
  if (std::ferror(stdin) != 0) input.reason = std::strerror(errno != 0 ? errno : EIO);
  return input;
}

}  // namespace

bool ReadStandardInput(std::string* text, std::string* reason) {
  static const Input input = ReadAll();
  *text = input.text;
  *reason = input.reason;
  return reason->empty();
}

}  // namespace dispersa
