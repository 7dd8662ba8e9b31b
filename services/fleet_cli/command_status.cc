// dispersa list, status, cancel, delete, give, repair, readmit: what a coordinator's campaigns do.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "services/fleet_cli/campaign_text.h"
#include "services/fleet_cli/session_options.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

ExitCode Show(const char* method, const std::string& id, Session& session, const GlobalOptions& global) {
  const Json arguments = id.empty() ? Json::object() : Json{{"id", id}};
  const Json answer = Json::parse(session.Ask(method, arguments).text);
  if (global.json) {
    fmt::print("{}\n", answer.dump(2));
    return kExitDone;
  }
  for (const Json& campaign : answer.at("campaigns")) fmt::print("{}", CampaignStatusText(campaign));
  if (const auto more = answer.at("unlisted").get<std::uint64_t>(); more > 0)
    fmt::print("and {} more that have ended or wait\n", more);
  if (!answer.contains("workers")) return kExitDone;
  for (const Json& worker : answer.at("workers")) {
    fmt::print("worker {}  {:<8} {} slots on {}, {} flown\n", ShortId(worker),
               worker.at("state").get<std::string>(), worker.at("slots").get<int>(),
               worker.at("host").get<std::string>(), worker.at("flown").get<std::uint64_t>());
  }
  if (answer.at("workers").empty()) fmt::print("no workers\n");
  return kExitDone;
}

/// Asks for what is done to one campaign. `done`: what then was.
ExitCode Do(const std::string& method, const Json& arguments, const char* done, Session& session,
            const GlobalOptions& global) {
  const Json answer = Json::parse(session.Ask(method, arguments).text);
  const std::string its_id = answer.at("id");
  return Answer(global, {{"schema", "dispersa/" + method + "/1"}, {"id", its_id}},
                fmt::format("{}: {}\n", done, its_id));
}

ExitCode Readmit(const std::string& name, Session& session, const GlobalOptions& global) {
  const Json answer = Json::parse(
      session.Ask(name.empty() ? "expelled" : "readmit", name.empty() ? Json::object() : Json{{"name", name}})
          .text);
  if (global.json) {
    Json object = {{"schema", "dispersa/readmit/1"}};
    object.update(answer);
    fmt::print("{}\n", object.dump(2));
  } else if (!name.empty()) {
    fmt::print("readmitted: {}\n", name);
  } else {
    for (const Json& each : answer.at("expelled"))
      fmt::print("{}  {}\n", each.at("name").get<std::string>(), each.at("reason").get<std::string>());
    if (answer.at("expelled").empty()) fmt::print("nobody is expelled\n");
  }
  return kExitDone;
}

/// The full id, so that a request repeated after a lost answer names the same campaign.
std::string FullId(Session& session, const std::string& id) {
  return Json::parse(session.Ask("list", {{"id", id}}).text).at("campaigns").at(0).at("id");
}

}  // namespace

void AddStatusCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* list = app.add_subcommand("list", "list the campaigns of a coordinator");
  list->footer("Example: dispersa list --peer coordinator-host");
  BindSession(list, invocation, [](Session& session, const GlobalOptions& global) {
    return Show("list", "", session, global);
  });

  CLI::App* status = app.add_subcommand("status", "show the campaigns and workers of a coordinator");
  status->footer(
      "Example: dispersa status 5f3a --peer coordinator-host\n"
      "Without an id: all campaigns and workers.");
  BindSession(status, invocation,
              [id = AddIdOption(status, false)](Session& session, const GlobalOptions& global) {
                return Show("status", *id, session, global);
              });

  CLI::App* cancel = app.add_subcommand("cancel", "end a campaign; its stored results stay");
  cancel->footer("Example: dispersa cancel 5f3a --peer coordinator-host");
  BindSession(cancel, invocation, [id = AddIdOption(cancel)](Session& session, const GlobalOptions& global) {
    return Do("cancel", {{"id", *id}}, "cancelled", session, global);
  });

  CLI::App* remove = app.add_subcommand("delete", "delete a campaign that has ended, with its results");
  remove->footer(
      "Example: dispersa delete 5f3a --peer coordinator-host\n"
      "The coordinator's deleted.jsonl keeps one line about it.");
  BindSession(remove, invocation, [id = AddIdOption(remove)](Session& session, const GlobalOptions& global) {
    return Do("delete", {{"id", FullId(session, *id)}}, "deleted", session, global);
  });

  CLI::App* give = app.add_subcommand("give", "hand a campaign over to another owner");
  const auto owner = std::make_shared<std::string>();
  give->add_option("--to", *owner, "name of the keys, or the local user, to own it")->required();
  give->footer(
      "Example: dispersa give 5f3a --to bob --peer coordinator-host --keys client-ops\n"
      "For keys that may administer. The campaign then counts for the quota of its new owner.");
  BindSession(give, invocation,
              [id = AddIdOption(give), owner](Session& session, const GlobalOptions& global) {
                return Do("give", {{"id", FullId(session, *id)}, {"to", *owner}}, "given", session, global);
              });

  CLI::App* repair =
      app.add_subcommand("repair", "remove a worker's results from a campaign and fly those cases again");
  const auto worker = std::make_shared<std::string>();
  repair->add_option("--worker", *worker, "name of the worker, or of its keys")->required();
  repair->footer(
      "Example: dispersa repair 5f3a --worker node1 --peer coordinator-host && dispersa watch 5f3a\n"
      "results.sqlite names the worker of each case in its table `execution`.");
  BindSession(repair, invocation,
              [id = AddIdOption(repair), worker](Session& session, const GlobalOptions& global) {
                return Do("repair", {{"id", *id}, {"worker", *worker}}, "flown again", session, global);
              });

  CLI::App* readmit = app.add_subcommand("readmit", "let workers fly again that returned false results");
  const auto name = std::make_shared<std::string>();
  readmit->add_option("name", *name,
                      "keys (node1), keys on a host (node1@rack7), or a process; without: list them");
  readmit->footer(
      "Example: dispersa readmit node1 --peer coordinator-host\n"
      "Find and mend the cause first: memory, processor, build. Their processes have ended; start them "
      "again.");
  BindSession(readmit, invocation, [name](Session& session, const GlobalOptions& global) {
    return Readmit(*name, session, global);
  });
}

}  // namespace dispersa
