// A file named "-": standard input.
#pragma once

#include <string>

namespace dispersa {

inline constexpr char kStandardInput[] = "-";
inline constexpr char kStandardInputName[] = "<stdin>";  ///< in messages

/// The whole standard input. It is read once, and later calls get the same text. Returns false, with the
/// system's reason, if it cannot be read. Not for several threads.
bool ReadStandardInput(std::string* text, std::string* reason);

}  // namespace dispersa
