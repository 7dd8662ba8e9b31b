// Watches for a time without any flying worker: repeats a warning, and ends the program after a given time.
#pragma once

#include <optional>

namespace dispersa {

/// The attendance of the workers of one coordinator. Times in seconds.
class Attendance {
 public:
  /// `patience_s`: how long to do without workers; none: for ever.
  Attendance(int domain, std::optional<double> patience_s) : domain_(domain), patience_s_(patience_s) {}

  /// `attended`: there are some, or none is needed. Else logs so every 30 s. False: for longer than the
  /// patience.
  bool Check(bool attended, double now_s);

 private:
  int domain_;
  std::optional<double> patience_s_;
  double present_s_ = 0.0, said_s_ = 0.0;
};

}  // namespace dispersa
