// Possible ends of an unfinished command line, by the definitions that parse the finished one.
//
// The scripts for bash, zsh and fish (services/cli/completion) call `PROGRAM completion words WORD...`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dispersa {

/// Types of values in help texts, by which completion works. Listed values are written "{one,another}".
inline constexpr char kFileType[] = "FILE", kFolderType[] = "DIR";
/// A campaign or another YAML file ("FILE" in help texts); a metric without its prefix.
inline constexpr char kYamlType[] = "YAML", kMetricType[] = "METRIC";

/// `words` are those after the program's name. The last one is unfinished and may be empty. One line for each
/// candidate: the word, a tab and its description. If the shell completes better itself: ":file" or
/// ":folder"; for YAML files only: ":file", a tab and "yaml".
std::string CompletionWords(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace dispersa
