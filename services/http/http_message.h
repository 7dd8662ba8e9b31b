// A request to an HTTP server, and its answer.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dispersa {

using HttpPairs = std::vector<std::pair<std::string, std::string>>;

struct HttpRequest {
  std::string method;    ///< "GET" for HEAD too: the server drops the body of the answer
  std::string target;    ///< "/trend?metric=M"
  std::string path;      ///< "/trend", decoded
  HttpPairs headers;     ///< names in small letters
  HttpPairs parameters;  ///< of the target and of a form, decoded

  /// Empty if there is none. `n`: of several with this name, from 0.
  std::string Parameter(std::string_view name, std::size_t n = 0) const;
  bool HasParameter(std::string_view name) const;
  /// Empty if there is none. `name` in small letters.
  std::string Header(std::string_view name) const;
  /// Whether there is one Host, and it is 127.0.0.1 or localhost, with any port. A page from elsewhere whose
  /// name is pointed to 127.0.0.1 has another one.
  bool NamesThisMachine() const;
  /// Empty if there is none.
  std::string Cookie(std::string_view name) const;
};

inline constexpr char kHtmlType[] = "text/html; charset=utf-8";

struct HttpAnswer {
  int status = 200;
  std::string body;
  std::string type = kHtmlType;
  HttpPairs headers;
  std::chrono::milliseconds delay{0};  ///< before it is sent
};

/// To another address: `status` 302, or 303 after a form.
HttpAnswer RedirectTo(const std::string& target, int status = 302);

/// Sets path and parameters by the target, and adds those of a form. False: an escape (%XX) is wrong.
bool ReadTarget(const std::string& target, HttpRequest* request);
bool ReadForm(std::string_view text, HttpPairs* parameters);

}  // namespace dispersa
