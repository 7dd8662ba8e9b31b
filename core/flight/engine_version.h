// Which engine computed a result.
#pragma once

#include <string>

namespace dispersa {

/// "<project version>+<12 hexadecimal digits>", for instance "0.1.0+3f2a9c01b7de". The digits begin the
/// SHA-256 of every source file that can change a case's result (engine_version.cmake). Builds of equal
/// engine version fly a case to the same bits.
std::string EngineVersion();

}  // namespace dispersa
