// dispersa keys: an authority, and what it issues to coordinators, workers, clients and observers.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "services/cli/command.h"
#include "services/program/option_values.h"
#include "services/transport/authority.h"

namespace dispersa {
namespace {

constexpr int kAuthorityDays = 3650;
constexpr int kIssuedDays = 365;
constexpr int kMostDays = 36500;

struct KeysOptions {
  std::string directory, role, name, may, serial;
  int days = 0;
};

ExitCode TellMade(const std::string& what, const std::string& directory, const GlobalOptions& global) {
  return Answer(global, {{"schema", "dispersa/keys/1"}, {"directory", directory}},
                what + ": " + directory + "\n");
}

ExitCode Init(const KeysOptions& options, const GlobalOptions& global) {
  MakeAuthority(options.directory, ValidFor(options.days));
  return TellMade("authority", options.directory, global);
}

ExitCode Issue(const KeysOptions& options, const GlobalOptions& global) {
  const Role role = *ParseRole(options.role);
  if (!options.may.empty() && role != Role::kClient)
    throw InputError("--may " + options.may + " with --role " + options.role, "--may with --role client");
  const auto folder = IssueKeys(options.directory, role, options.name, ValidFor(options.days),
                                ParseRight(options.may).value_or(Right::kRun));
  return TellMade("issued", folder.string(), global);
}

ExitCode Revoke(const KeysOptions& options, const GlobalOptions& global) {
  const auto file = RevokeKeys(options.directory, *ParseRole(options.role), options.name, options.serial);
  return TellMade("revoked; copy this list into the folders of all coordinators' and workers' keys",
                  file.string(), global);
}

ExitCode Renew(const KeysOptions& options, const GlobalOptions& global) {
  const auto former = RenewAuthority(options.directory, ValidFor(options.days));
  return TellMade("renewed; copy identity_ca.pem and permissions_ca.pem of " + options.directory +
                      "/authority into the folders of all keys; the former authority is in",
                  former.string(), global);
}

ExitCode Retire(const KeysOptions& options, const GlobalOptions& global) {
  const auto former = RetireAuthority(options.directory);
  return TellMade("retired; copy identity_ca.pem and permissions_ca.pem of " + options.directory +
                      "/authority into the folders of all keys; the former authority is in",
                  former.string(), global);
}

ExitCode List(const KeysOptions& options, const GlobalOptions& global) {
  nlohmann::ordered_json listed = nlohmann::ordered_json::array();
  std::string text;
  for (const IssuedKeys& keys : ListKeys(options.directory)) {
    text += fmt::format("{:<11}  {:<31}  {:<16}  {:<10}{}\n", Name(keys.role), keys.name, keys.serial,
                        keys.until, keys.is_revoked ? "  revoked" : "");
    listed.push_back({{"role", Name(keys.role)},
                      {"name", keys.name},
                      {"serial", keys.serial},
                      {"until", keys.until},
                      {"revoked", keys.is_revoked}});
  }
  return Answer(global, {{"schema", "dispersa/keys-list/1"}, {"keys", listed}}, text);
}

void AddRoleAndName(CLI::App* command, const std::shared_ptr<KeysOptions>& options,
                    const std::string& name_help) {
  std::vector<std::string> roles;
  for (const Role role : kRoles) roles.emplace_back(Name(role));
  command->add_option("--role", options->role, "what it may do")->required()->check(CLI::IsMember(roles));
  command->add_option("--name", options->name, name_help)->required();
}

/// Returns the command and its options, to which more may be added. `days`: 0 where nothing is made that is
/// valid.
std::pair<CLI::App*, std::shared_ptr<KeysOptions>> AddCommand(
    CLI::App* keys, Invocation& invocation, const std::string& name, const std::string& what, int days,
    ExitCode (*run)(const KeysOptions&, const GlobalOptions&)) {
  auto options = std::make_shared<KeysOptions>();
  options->days = days;
  CLI::App* command = keys->add_subcommand(name, what);
  command->add_option("directory", options->directory, "folder of the authority")
      ->required()
      ->type_name(kFolderType);
  if (days > 0) {
    command->add_option("--days", options->days, fmt::format("days until the keys expire; default {}", days))
        ->transform(WholeNumber(1, kMostDays));
  }
  Bind(command, invocation, options, run);
  return {command, options};
}

}  // namespace

void AddKeysCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* keys =
      app.add_subcommand("keys", "make the keys by which daemons and clients recognise each other");
  keys->require_subcommand(1);
  keys->fallthrough();
  keys->footer(
      "Examples: dispersa keys init authority\n"
      "          dispersa keys issue authority --role coordinator --name main\n"
      "          dispersa keys issue authority --role worker --name node1\n"
      "          dispersa keys issue authority --role client --name ann --may administer\n"
      "          dispersa-worker --keys authority/issued/worker-node1 --peer coordinator-host\n"
      "          dispersa keys revoke authority --role worker --name node1\n"
      "          dispersa keys renew authority\n"
      "The folder `authority` stays on the machine where it was made. Every other machine gets only its own "
      "issued folder.");
  AddCommand(keys, invocation, "init", "make an authority", kAuthorityDays, Init);
  const auto [issue, issued] =
      AddCommand(keys, invocation, "issue", "make the keys of one participant", kIssuedDays, Issue);
  AddRoleAndName(issue, issued, "its name: letters, digits, '-'; often that of its machine");
  std::vector<std::string> rights;
  for (const Right right : kRights) rights.emplace_back(Name(right));
  issue
      ->add_option("--may", issued->may,
                   "what a client may do: read: list, watch, fetch; run: launch too, and change its own "
                   "campaigns;\nadminister: change all campaigns; default: run")
      ->check(CLI::IsMember(rights));
  const auto [revoke, revoked] =
      AddCommand(keys, invocation, "revoke", "no longer accept keys that were issued", 0, Revoke);
  AddRoleAndName(revoke, revoked, "its name");
  revoke->add_option(
      "--serial", revoked->serial,
      "the keys with this serial alone; -: those of an earlier version; default: all of the name");
  AddCommand(keys, invocation, "list", "list the keys that were issued, with serial and end", 0, List);
  AddCommand(keys, invocation, "renew", "let a new authority issue keys, beside those of before",
             kAuthorityDays, Renew);
  AddCommand(keys, invocation, "retire", "no longer accept keys of before `dispersa keys renew`", 0, Retire);
}

}  // namespace dispersa
