// dispersa list, status, watch, cancel: what a coordinator's campaigns do.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "services/cli/progress.h"
#include "services/cli/session.h"
#include "services/coordinator/stop_signal.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kWatchPeriod(500);

std::string ShortId(const Json& what) { return what.at("id").get<std::string>().substr(0, 12); }

/// "2 of 140 break pitch_error_peak_deg (fail so far)"
std::string StandingText(const Json& standing) {
  return fmt::format("{} of {} break {} ({} so far)", standing.at("failures").get<std::int64_t>(),
                     standing.at("n").get<std::int64_t>(), standing.at("metric").get<std::string>(),
                     standing.at("so_far").get<std::string>());
}

void PrintCampaign(const Json& campaign) {
  const auto done = campaign.at("done").get<std::uint64_t>(),
             total = campaign.at("total").get<std::uint64_t>();
  std::string line =
      fmt::format("{}  {:<10} {:>9}/{:<9} {}", ShortId(campaign), campaign.at("state").get<std::string>(),
                  done, total, campaign.at("name").get<std::string>());
  if (const double rate = campaign.at("rate_per_s"); rate > 0.0) line += fmt::format("  {:.1f}/s", rate);
  if (!campaign.at("eta_s").is_null()) line += "  " + DurationText(campaign.at("eta_s")) + " left";
  if (const auto given_up = campaign.at("quarantined").get<std::uint64_t>(); given_up > 0) {
    line += fmt::format("  {} quarantined", given_up);
  }
  if (!campaign.at("code").is_null()) line += fmt::format("  exit code {}", campaign.at("code").get<int>());
  if (!campaign.at("problem").is_null()) line += "  " + campaign.at("problem").get<std::string>();
  fmt::print("{}\n", line);
  for (const Json& standing : campaign.at("requirements")) fmt::print("  {}\n", StandingText(standing));
}

ExitCode Show(const char* method, const std::string& id, Session& session, const GlobalOptions& global) {
  const Json arguments = id.empty() ? Json::object() : Json{{"id", id}};
  const Json answer = Json::parse(session.Ask(method, arguments).text);
  if (global.json) {
    fmt::print("{}\n", answer.dump(2));
    return kExitDone;
  }
  for (const Json& campaign : answer.at("campaigns")) PrintCampaign(campaign);
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

// A coordinator that is away for a while is waited for: what was launched goes on when it is back.
ExitCode Watch(const std::string& id, Session& session, const GlobalOptions& global) {
  CatchStopSignals();
  std::optional<Progress> progress;
  std::string state;
  while (!StopRequested()) {
    const auto reply = session.Try("list", {{"id", id}});
    if (!reply) {
      spdlog::warn("{}; it is tried again", session.Silence());
      continue;
    }
    Json campaign = Json::parse(reply->text).at("campaigns").at(0);
    if (!campaign.at("code").is_null()) {
      progress.reset();
      const auto code = static_cast<ExitCode>(campaign.at("code").get<int>());
      if (global.json) {
        Json object = {{"schema", "dispersa/watch/1"}};
        object.update(campaign);
        fmt::print("{}\n", object.dump(2));
      } else {
        PrintCampaign(campaign);
      }
      return code;
    }
    if (!progress) progress.emplace(campaign.at("name").get<std::string>(), global.quiet);
    const std::string before = std::exchange(state, campaign.at("state").get<std::string>());
    std::string note = state;
    for (const Json& standing : campaign.at("requirements")) note += "; " + StandingText(standing);
    // What stands still is said once.
    if (state != before || state == "flying") progress->Show(campaign.at("done"), campaign.at("total"), note);
    std::this_thread::sleep_for(kWatchPeriod);
  }
  return kExitInterrupted;
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

  CLI::App* watch = app.add_subcommand("watch", "follow a campaign and end with its exit code when it ends");
  BindSession(watch, invocation, [id = AddIdOption(watch)](Session& session, const GlobalOptions& global) {
    return Watch(*id, session, global);
  });

  CLI::App* cancel = app.add_subcommand("cancel", "end a campaign; what it has flown is kept");
  BindSession(cancel, invocation, [id = AddIdOption(cancel)](Session& session, const GlobalOptions& global) {
    return Cancel(*id, session, global);
  });
}

}  // namespace dispersa
