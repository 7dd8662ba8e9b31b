#include "services/program/completion_words.h"

#include <algorithm>

#include "core/flight/metrics.h"
#include "services/program/option_values.h"

namespace dispersa {
namespace {

/// A command line up to its last word.
struct Place {
  const CLI::App* app;
  const CLI::Option* open = nullptr;  ///< an option that waits for its value
  std::size_t arguments = 0;          ///< of the command so far
  bool options_end = false;           ///< behind "--"
};

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

bool TakesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<std::string> Names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// Options of the command, then those of its parents: an option may follow any command.
std::vector<const CLI::Option*> OptionsOf(const CLI::App* app) {
  std::vector<const CLI::Option*> options;
  const CLI::App* const command = app;
  for (; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      const bool above = option == app->get_help_ptr() || option == app->get_version_ptr();
      if (option->nonpositional() && (app == command || !above)) options.push_back(option);
    }
  }
  return options;
}

const CLI::Option* FindOption(const CLI::App* app, const std::string& name) {
  for (const CLI::Option* option : OptionsOf(app))
    for (const std::string& one : Names(*option))
      if (one == name) return option;
  return nullptr;
}

const CLI::App* FindCommand(const CLI::App* app, const std::string& name) {
  for (const CLI::App* command : app->get_subcommands(nullptr))
    if (command->get_name() == name) return command;
  return nullptr;
}

void Advance(Place& place, const std::string& word) {
  if (word == "=") return;  // bash takes --option=value for three words
  if (place.open != nullptr) {
    place.open = nullptr;
  } else if (place.options_end || word.size() < 2 || word[0] != '-') {
    const CLI::App* command = place.options_end ? nullptr : FindCommand(place.app, word);
    if (command != nullptr) {
      place = {command};
    } else {
      ++place.arguments;
    }
  } else if (word == "--") {
    place.options_end = true;
  } else {
    const CLI::Option* option = FindOption(place.app, word);
    if (option != nullptr && TakesValue(*option)) place.open = option;
  }
}

/// The candidates that begin with what is there.
class Candidates {
 public:
  explicit Candidates(std::string begun) : begun_(std::move(begun)) {}

  void Add(const std::string& word, const std::string& what) {
    if (word.starts_with(begun_)) text_ += word + "\t" + FirstLine(what) + "\n";
  }
  void AddKind(const std::string& kind) { text_ += ":" + kind + "\n"; }

  /// Adds the values in the type as help texts show it. `before` precedes each value.
  void AddValues(const CLI::Option& option, const std::string& before) {
    const std::string type = option.get_type_name();
    const std::vector<std::string> values = ListedValues(option);
    for (const std::string& value : values) Add(before + value, "");
    if (!values.empty()) return;
    if (type.starts_with(kMetricType)) {
      for (const std::string& name : MetricNames()) Add(before + name, "");
    } else if (type.starts_with(kYamlType)) {
      AddKind("file\tyaml");
    } else if (type.starts_with(kFileType)) {
      AddKind("file");
    } else if (type.starts_with(kFolderType)) {
      AddKind("folder");
    }
  }

  const std::string& text() const { return text_; }

 private:
  std::string begun_, text_;
};

/// The argument that comes next; the last one may be there many times.
const CLI::Option* NextArgument(const Place& place) {
  std::size_t before = 0;
  for (const CLI::Option* option : place.app->get_options()) {
    if (!option->get_positional()) continue;
    before += static_cast<std::size_t>(std::max(option->get_items_expected_max(), 1));
    if (place.arguments < before) return option;
  }
  return nullptr;
}

}  // namespace

std::string CompletionWords(const CLI::App& app, const std::vector<std::string>& words) {
  Place place{&app};
  for (std::size_t i = 0; i + 1 < words.size(); ++i) Advance(place, words[i]);
  std::string begun = words.empty() ? "" : words.back();
  if (begun == "=" && place.open != nullptr) begun.clear();
  Candidates candidates(begun);
  const std::size_t equals = begun.find('=');
  if (place.open != nullptr) {
    candidates.AddValues(*place.open, "");
  } else if (!place.options_end && begun.starts_with("--") && equals != std::string::npos) {
    const CLI::Option* option = FindOption(place.app, begun.substr(0, equals));
    if (option != nullptr && TakesValue(*option)) candidates.AddValues(*option, begun.substr(0, equals + 1));
  } else if (!place.options_end && begun.starts_with("-")) {
    for (const CLI::Option* option : OptionsOf(place.app))
      for (const std::string& name : Names(*option)) candidates.Add(name, option->get_description());
  } else {
    if (!place.options_end)
      for (const CLI::App* command : place.app->get_subcommands(nullptr))
        if (!command->get_group().empty())  // help texts leave such a command out too
          candidates.Add(command->get_name(), command->get_description());
    if (const CLI::Option* argument = NextArgument(place)) candidates.AddValues(*argument, "");
  }
  return candidates.text();
}

}  // namespace dispersa
