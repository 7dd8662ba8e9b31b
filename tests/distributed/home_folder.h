// A home folder for one test. Programs keep files there, and must not touch that of the user who runs the
// tests.
#pragma once

#include <stdlib.h>

#include <string>

#include "tests/temporary_folder.h"

namespace dispersa {

class HomeFolder : public TemporaryFolder {
 public:
  HomeFolder() {
    if (const char* home = getenv("HOME")) before_ = home;
    setenv("HOME", path().c_str(), 1);
  }
  ~HomeFolder() {
    if (before_.empty()) {
      unsetenv("HOME");
    } else {
      setenv("HOME", before_.c_str(), 1);
    }
  }

 private:
  std::string before_;
};

}  // namespace dispersa
