// Watches for a time without any flying worker, and repeats a warning.
#pragma once

namespace dispersa {

/// The attendance of the workers of one coordinator. Times in seconds.
class Attendance {
 public:
  explicit Attendance(int domain) : domain_(domain) {}

  /// `attended`: there are some, or none is needed. Else logs so every 30 s.
  void Check(bool attended, double now_s);

 private:
  int domain_;
  double present_s_ = 0.0, said_s_ = 0.0;
};

}  // namespace dispersa
