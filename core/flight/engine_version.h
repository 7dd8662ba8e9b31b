// Which engine computed a result.
#pragma once

#include <string>

namespace dispersa {

/// "<project version>+<12 hexadecimal digits>", for instance "0.1.0+3f2a9c01b7de". The digits begin the
/// SHA-256 over every source file that can change the result of a case (engine_version.cmake): builds of
/// equal engine version fly a case to the same bits.
std::string EngineVersion();

}  // namespace dispersa
