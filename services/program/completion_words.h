// What may stand at the end of an unfinished command line, by the definitions that parse the finished one.
//
// The scripts that bash, zsh and fish load (services/cli/completion) ask `PROGRAM completion words WORD...`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dispersa {

/// What an option's value or an argument is, in help texts; completion goes by it. Values that are listed are
/// written "{one,another}".
inline constexpr char kFileType[] = "FILE", kFolderType[] = "DIR";
/// A campaign or another file of YAML, "FILE" in help texts; a metric without its prefix.
inline constexpr char kYamlType[] = "YAML", kMetricType[] = "METRIC";

/// `words` are those behind the program's name, the last one unfinished and possibly empty. One line a
/// candidate: the word, a tab and what it is; or ":file" or ":folder", where the shell itself knows best;
/// ":file", a tab and "yaml" where only such files are meant.
std::string CompletionWords(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace dispersa
