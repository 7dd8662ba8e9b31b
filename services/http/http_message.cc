#include "services/http/http_message.h"

#include <algorithm>
#include <optional>

namespace dispersa {
namespace {

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> Decoded(std::string_view text, bool plus_is_space) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
      const int low = high < 0 ? -1 : HexDigit(text[i + 2]);
      if (low < 0) return std::nullopt;
      decoded += static_cast<char>(16 * high + low);
      i += 2;
    } else {
      decoded += plus_is_space && text[i] == '+' ? ' ' : text[i];
    }
  }
  return decoded;
}

}  // namespace

std::string HttpRequest::Parameter(std::string_view name, std::size_t n) const {
  for (const auto& [key, value] : parameters) {
    if (key == name && n-- == 0) return value;
  }
  return "";
}

bool HttpRequest::HasParameter(std::string_view name) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const auto& each) { return each.first == name; });
}

std::string HttpRequest::Header(std::string_view name) const {
  const auto found =
      std::find_if(headers.begin(), headers.end(), [&](const auto& each) { return each.first == name; });
  return found == headers.end() ? "" : found->second;
}

bool HttpRequest::NamesThisMachine() const {
  if (std::count_if(headers.begin(), headers.end(), [](const auto& each) { return each.first == "host"; }) !=
      1)
    return false;
  const std::string host = Header("host"), name = host.substr(0, host.find(':'));
  return name == "127.0.0.1" || name == "localhost";
}

std::string HttpRequest::Cookie(std::string_view name) const {
  const std::string all = Header("cookie"), wanted = std::string(name) + "=";
  std::size_t at = 0;
  while (at < all.size()) {
    const std::size_t end = std::min(all.find(';', at), all.size());
    while (at < end && all[at] == ' ') ++at;
    if (all.compare(at, wanted.size(), wanted) == 0)
      return all.substr(at + wanted.size(), end - at - wanted.size());
    at = end + 1;
  }
  return "";
}

HttpAnswer RedirectTo(const std::string& target, int status) {
  HttpAnswer answer;
  answer.status = status;
  answer.headers.emplace_back("Location", target);
  return answer;
}

bool ReadForm(std::string_view text, HttpPairs* parameters) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('&', at), text.size());
    const std::string_view part = text.substr(at, end - at);
    const std::size_t equal = std::min(part.find('='), part.size());
    auto name = Decoded(part.substr(0, equal), true);
    auto value = Decoded(part.substr(std::min(equal + 1, part.size())), true);
    if (!name || !value) return false;
    if (!part.empty()) parameters->emplace_back(*std::move(name), *std::move(value));
    at = end + 1;
  }
  return true;
}

bool ReadTarget(const std::string& target, HttpRequest* request) {
  const std::string_view text = target;
  const std::size_t question = std::min(text.find('?'), text.size());
  auto path = Decoded(text.substr(0, question), false);
  if (!path || !path->starts_with('/')) return false;
  request->target = target;
  request->path = *std::move(path);
  return ReadForm(text.substr(std::min(question + 1, text.size())), &request->parameters);
}

}  // namespace dispersa
