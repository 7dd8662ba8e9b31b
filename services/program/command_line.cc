#include "services/program/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/read_value.h"
#include "services/log/log.h"
#include "services/program/completion_words.h"
#include "services/program/error_json.h"
#include "services/program/help_formatter.h"
#include "services/program/option_values.h"
#include "services/program/standard_output.h"
#include "services/program/version.h"

namespace dispersa {
namespace {

using Words = std::vector<std::string>;

bool Has(const Words& words, const char* word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

ExitCode BadUsage(const InputProblem& problem, bool json) {
  if (json) PrintErrorJson(kExitBadInput, {problem});
  return kExitBadInput;
}

/// The problem of a program's first word that is neither a command nor an option.
InputProblem UnknownWord(const CLI::App& app) {
  const std::string word = app.remaining().front();
  const bool is_option = word.starts_with("-");
  Words names;
  if (is_option) {
    for (const CLI::Option* option : app.get_options()) names.push_back("--" + option->get_lnames().front());
  } else {
    for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  }
  const std::string what = is_option ? "unknown option '" : "unknown command '";
  return {"", 0, 0, "", what + word + "'" + DidYouMean(word, names), JoinWords(names)};
}

/// Splits "--cases: message, allowed: range" into its parts.
InputProblem ProblemOf(const CLI::ParseError& error) {
  const std::string text = error.what();
  const std::string separator = ", allowed: ";
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return {"", 0, 0, "", text, ""};
  return {"", 0, 0, "", text.substr(0, at), text.substr(at + separator.size())};
}

// The words in the order in which CLI11 parses them, the last first. CLI11 takes the next word as the value
// of
// "--seed=".
Words Spelled(const Words& words) {
  Words spelled;
  for (const std::string& word : words) {
    const bool is_empty = word.starts_with("--") && word.find('=') == word.size() - 1;
    spelled.push_back(is_empty ? word.substr(0, word.size() - 1) : word);
    if (is_empty) spelled.emplace_back();
  }
  std::reverse(spelled.begin(), spelled.end());
  return spelled;
}

// CLI11 ends at --version and ignores all other options.
ExitCode PrintVersionJson() {
  try {
    return PrintAndEnd(VersionJson() + "\n");
  } catch (const std::invalid_argument& error) {
    Tell("{}\n", error.what());
    return BadUsage({"", 0, 0, "", error.what(), ""}, true);
  }
}

/// CLI11 from 2.4 on passes over a variable of the environment whose value its option refuses.
void TakeEnvironment(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string name = option->get_envname();
    const char* const text = name.empty() ? nullptr : std::getenv(name.c_str());
    if (text == nullptr || *text == '\0' || option->count() > 0) continue;
    option->add_result(text);
    option->run_callback();  // throws
  }
  for (CLI::App* command : app.get_subcommands()) TakeEnvironment(*command);
}

}  // namespace

bool AsksForJson(int argc, char** argv) { return Has(Words(argv + 1, argv + argc), "--json"); }

void BeginCommandLine(CLI::App& app, bool& json, const char* json_help) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h, --help", "print this help and end");
  app.set_version_flag("--version", VersionText(app.get_name()),
                       "print the version and end; with --json, one object");
  app.add_flag("--json", json, json_help);
}

void AddLogOption(CLI::App& app, std::string& log) {
  app.add_option("--log", log, "lines on standard error: text, or json: one JSON object each; default: text")
      ->check(CLI::IsMember({"text", "json"}));
}

std::optional<ExitCode> ParseCommandLine(CLI::App& app, int argc, char** argv) {
  const Words words(argv + 1, argv + argc);
  if (words.size() >= 2 && words[0] == "completion" && words[1] == "words") {
    // Not parsed: these are words of another command line.
    return PrintAndEnd(CompletionWords(app, Words(words.begin() + 2, words.end())));
  }
  CheckValues(app);
  const bool json = Has(words, "--json");
  if (json && Has(words, "--version")) return PrintVersionJson();
  try {
    app.parse(Spelled(words));
    TakeEnvironment(app);
  } catch (const CLI::ParseError& error) {
    // CLI11 says of an unknown command only that one is required.
    const bool is_required = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (is_required && app.get_subcommands().empty() && !app.remaining().empty() &&
        !app.get_subcommands(nullptr).empty()) {
      const InputProblem problem = UnknownWord(app);
      Tell("{}\n", problem.Text());
      return BadUsage(problem, json);
    }
    // Help and version are errors to CLI11, of code 0.
    std::ostringstream out;
    if (app.exit(error, out) == 0) return PrintAndEnd(out.str());
    return BadUsage(ProblemOf(error), json);
  }
  return std::nullopt;
}

}  // namespace dispersa
