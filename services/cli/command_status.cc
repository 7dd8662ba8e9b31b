// dispersa list, status, cancel: what a coordinator's campaigns do.
#include <fmt/format.h>

#include "services/cli/campaign_text.h"
#include "services/cli/session_options.h"

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

ExitCode Cancel(const std::string& id, Session& session, const GlobalOptions& global) {
  const Json answer = Json::parse(session.Ask("cancel", {{"id", id}}).text);
  if (global.json) {
    const Json object = {{"schema", "dispersa/cancel/1"}, {"id", answer.at("id")}};
    fmt::print("{}\n", object.dump(2));
  } else {
    fmt::print("cancelled: {}\n", answer.at("id").get<std::string>());
  }
  return kExitDone;
}

}  // namespace

void AddStatusCommands(CLI::App& app, Invocation& invocation) {
  BindSession(
      app.add_subcommand("list", "the campaigns of a coordinator"), invocation,
      [](Session& session, const GlobalOptions& global) { return Show("list", "", session, global); });

  CLI::App* status = app.add_subcommand("status", "the campaigns and workers of a coordinator");
  BindSession(status, invocation,
              [id = AddIdOption(status, false)](Session& session, const GlobalOptions& global) {
                return Show("status", *id, session, global);
              });

  CLI::App* cancel = app.add_subcommand("cancel", "end a campaign; what it has flown is kept");
  BindSession(cancel, invocation, [id = AddIdOption(cancel)](Session& session, const GlobalOptions& global) {
    return Cancel(*id, session, global);
  });
}

}  // namespace dispersa
