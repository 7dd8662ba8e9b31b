// Help texts of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace dispersa {

/// The help of a command ends with the options of the whole program, which may follow the command as well.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
};

}  // namespace dispersa
