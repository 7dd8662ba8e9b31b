// Help texts of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace dispersa {

/// Help of a command ends its options with those of the whole program, which stand behind the command as
/// well.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
};

}  // namespace dispersa
