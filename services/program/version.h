// The version text of every program.
#pragma once

#include <string>

namespace dispersa {

/// "dispersa-worker 0.1.0+0123456789ab": the program's name and its engine version, by which results are
/// comparable.
std::string VersionText(const std::string& program);

/// The same of all programs of a build, as one object, and the code that this processor flies with. Throws
/// std::invalid_argument as ChosenEngine.
std::string VersionJson();

}  // namespace dispersa
