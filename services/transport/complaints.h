// Warnings about useless data from others. Their rate is limited, so that no sender can fill the log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace dispersa {

/// A program that somebody set up wrong says the same for weeks. Its complaint is due after 1 s, 2 s, 4 s and
/// so on, at last once a minute. Not thread-safe.
class RepeatedComplaints {
 public:
  static constexpr double kLongest_s = 60.0;
  bool IsDue(const std::string& complaint, double now_s);
  std::size_t remembered() const { return said_.size(); }

 private:
  struct Said {
    double at_s, pause_s;
  };
  std::map<std::string, Said> said_;
};

/// Logs a warning about something of `kind` ("datagram", a topic) from `sender`, with all text made
/// printable. At most one warning a second is logged for each kind, and the same one ever less often. The
/// others are counted, and the next warning tells the count. Thread-safe.
void Complain(const std::string& kind, const std::string& sender, const std::string& what);

/// Number of complaints of all kinds since the start of the process.
std::uint64_t Complaints();

}  // namespace dispersa
