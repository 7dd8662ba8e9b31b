#include "services/transport/run_pass.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <sstream>

#include "core/campaign_yaml/sha256.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

constexpr char kPassHead[] = "dispersa-run/1";
constexpr std::size_t kMaxPass = 64 << 10;

[[noreturn]] void RefusePass() { throw NetworkError("--run-pass: the data is not from `dispersa run`"); }

}  // namespace

std::string ToText(const RunPass& pass) {
  std::string text = std::string(kPassHead) + "\n";
  for (const std::uint8_t byte : pass.secret) text += fmt::format("{:02x}", byte);
  text += "\n";
  for (const std::string& plugin : pass.plugins) text += plugin + "\n";
  return text;
}

RunPass ParseRunPass(const std::string& text) {
  std::istringstream lines(text);
  std::string head, secret, plugin;
  RunPass pass;
  if (!std::getline(lines, head) || head != kPassHead || !std::getline(lines, secret) || !IsSha256Hex(secret))
    RefusePass();
  for (std::size_t i = 0; i < pass.secret.size(); ++i)
    std::from_chars(secret.data() + 2 * i, secret.data() + 2 * i + 2, pass.secret[i], 16);
  while (std::getline(lines, plugin)) {
    if (!IsSha256Hex(plugin)) RefusePass();
    pass.plugins.insert(plugin);
  }
  return pass;
}

RunPass TakeRunPass(int descriptor) {
  std::string text;
  char part[4096];
  ssize_t size = 0;
  while (text.size() < kMaxPass &&
         ((size = read(descriptor, part, sizeof part)) > 0 || (size < 0 && errno == EINTR))) {
    if (size > 0) text.append(part, static_cast<std::size_t>(size));
  }
  close(descriptor);
  return ParseRunPass(text);
}

}  // namespace dispersa
