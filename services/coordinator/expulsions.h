// Who may not fly here any more, and why: a process that returned a false result, and after repetition its
// host and its keys.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dispersa {

inline constexpr char kExpelledFile[] = "expelled.json";

struct Expulsion {
  std::string reason;
  std::string host = {};     ///< of a process that lied; others have none
  bool is_forgiven = false;  ///< a process that lied and counts no more; itself it stays outside

  bool operator==(const Expulsion&) const = default;
};

/// By the name of a process ("node1_5f3a..."), of keys on a host ("node1@rack7") or of keys ("node1"): see
/// IsMeantBy.
using ExpulsionMap = std::map<std::string, Expulsion>;

inline constexpr int kLiarsOfHost = 2, kLiarsOfKeys = 3;  ///< processes that lied, until all are expelled

/// The worker lied. Whom to expel for it: its process; with the second process of these keys on this host
/// all of them there; with the third process of these keys all that have them. Without keys only the process.
ExpulsionMap Sentence(const ExpulsionMap& expelled, const std::string& worker, const std::string& host,
                      const std::string& reason);

/// Why this worker may not fly; none: it may.
std::optional<std::string> WhyExpelled(const ExpulsionMap& expelled, const std::string& worker,
                                       const std::string& host);

/// Lets in again whoever `name` denotes, and forgives the processes that it denotes. The names that changed.
std::vector<std::string> Readmit(ExpulsionMap* expelled, const std::string& name);

/// Those that may not fly now.
std::size_t CountExpelled(const ExpulsionMap& expelled);

/// The text of expelled.json.
std::string SealedText(const ExpulsionMap& expelled);
/// Reads files of earlier versions too: {"node1": "reason"}. Throws std::runtime_error with words that follow
/// "it " if the text is damaged.
ExpulsionMap ReadExpulsions(const std::string& text);

}  // namespace dispersa
