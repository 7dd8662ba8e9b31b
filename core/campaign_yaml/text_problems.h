// Faults of a text before it is YAML or CSV: bytes that are not UTF-8, and tabs that indent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/input/input_error.h"

namespace dispersa {

/// Records the first byte that is not part of UTF-8 text. Returns true if there is none.
bool CheckUtf8(const std::string& text, const std::string& file, std::vector<InputProblem>& problems);

/// Records the first tab that indents a line up to `last_line`. Returns true if there is none. Tabs elsewhere
/// are harmless.
bool CheckIndentation(const std::string& text, const std::string& file, int last_line,
                      std::vector<InputProblem>& problems);

/// The text without the byte order mark that some programs, spreadsheets above all, write before UTF-8.
std::string_view WithoutByteOrderMark(const std::string& text);

/// Its lines, at most so many, without their ends.
std::vector<std::string_view> LinesOf(std::string_view text, std::size_t most = SIZE_MAX);

}  // namespace dispersa
