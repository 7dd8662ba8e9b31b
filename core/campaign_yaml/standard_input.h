// A file named "-": standard input.
#pragma once

#include <string>

namespace dispersa {

inline constexpr char kStandardInput[] = "-";
inline constexpr char kStandardInputName[] = "<stdin>";  ///< in messages

/// All that standard input holds. It is read once; whoever asks again gets the same. False with the reason,
/// as the system words it, if it cannot be read. Not for several threads.
bool ReadStandardInput(std::string* text, std::string* reason);

}  // namespace dispersa
