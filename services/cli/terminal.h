// The terminal that a person reads.
#pragma once

#include <cstddef>
#include <string>

namespace dispersa {

/// Columns of the terminal behind a file descriptor; `otherwise` if it has none or does not say.
std::size_t TerminalWidth(int file, std::size_t otherwise);

/// The beginning of a UTF-8 text that fits into `columns`, with "…" at the end of a text that was cut. A
/// character counts as one column.
std::string FitColumns(const std::string& text, std::size_t columns);

}  // namespace dispersa
