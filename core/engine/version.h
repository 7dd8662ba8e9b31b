#pragma once

#include <string>

namespace dispersa {

// "<project version>+<12 hex digits>", for instance "0.1.0+3f2a9c01b7de". The digits are the start of a
// SHA-256 over every source file that can change a case's result (see engine_version.cmake), so two builds
// with the same engine version fly a case to the same bits.
std::string EngineVersion();

}  // namespace dispersa
