#include "services/program/help_formatter.h"

#include "services/program/completion_words.h"

namespace dispersa {

HelpFormatter::HelpFormatter() {
  label("REQUIRED", "(required)");
  label(kYamlType, kFileType);
}

// The text after a command's own options.
std::string HelpFormatter::make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const {
  const CLI::App* root = app;
  while (root->get_parent() != nullptr) root = root->get_parent();
  std::string text;
  if (root != app) {
    text = make_group("Options of every command", false, root->get_options([&](const CLI::Option* option) {
      return option->nonpositional() && option != root->get_help_ptr() && option != root->get_version_ptr();
    }));
  }
  return text + CLI::Formatter::make_subcommands(app, mode);
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool is_positional) const {
  std::string name = CLI::Formatter::make_option_name(option, is_positional);
  if (const std::size_t comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
  return name;
}

}  // namespace dispersa
