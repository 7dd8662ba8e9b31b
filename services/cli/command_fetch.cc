// dispersa fetch: the result folder of a campaign that a coordinator has flown.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/report/output_file.h"
#include "services/cli/session.h"
#include "services/cli/writable.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void FetchFile(Session& session, const std::string& id, const std::string& path, std::uint64_t size,
               const fs::path& target) {
  fs::create_directories(target.parent_path());
  OutputFile file(target);
  for (std::uint64_t offset = 0; offset < size;) {
    const Reply part = session.Ask("read", {{"id", id}, {"path", path}, {"offset", offset}});
    if (part.data.empty())
      throw Failure{kExitInternalError, path + ": it became shorter while it was fetched"};
    file.Write(part.data);
    offset += part.data.size();
  }
  file.Commit();
}

// Into a folder beside the one that is asked for, which appears as a whole.
ExitCode Fetch(const std::string& id, const std::string& target, Session& session,
               const GlobalOptions& global) {
  const fs::path out = fs::path(target).has_filename() ? fs::path(target) : fs::path(target).parent_path();
  if (fs::exists(out) && !(fs::is_directory(out) && fs::is_empty(out))) {
    throw Failure{kExitBadInput, out.string() + ": not an empty folder, allowed: a new or an empty folder"};
  }
  RequireWritableFolder("--out", out);
  const fs::path incomplete = out.string() + ".dispersa-fetch";
  const Json answer = Json::parse(session.Ask("files", {{"id", id}}).text);
  fs::remove_all(incomplete);  // of a fetch that was killed
  fs::create_directories(incomplete);
  for (const Json& file : answer.at("files")) {
    const fs::path path = file.at("path").get<std::string>();
    // Whatever answers there: nothing is written outside of the folder.
    if (path.is_absolute() || path.lexically_normal() != path || *path.begin() == "..") {
      throw Failure{kExitInternalError, "the coordinator names a file outside of the result folder"};
    }
    FetchFile(session, answer.at("id"), path.generic_string(), file.at("size"), incomplete / path);
  }
  fs::rename(incomplete, out);
  if (global.json) {
    const Json object = {
        {"schema", "dispersa/fetch/1"}, {"id", answer.at("id")}, {"directory", out.string()}};
    fmt::print("{}\n", object.dump(2));
  } else {
    fmt::print("result: {}\n", out.string());
  }
  return kExitDone;
}

}  // namespace

void AddFetchCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("fetch", "copy the result folder of a campaign that has ended");
  const auto id = AddIdOption(command), out = std::make_shared<std::string>();
  command->add_option("--out", *out, "folder, new or empty")->required()->type_name(kFolderType);
  command->footer("Example: dispersa fetch 1a2b3c4d --out results/table3 --peer coordinator-host");
  BindSession(command, invocation, [id, out](Session& session, const GlobalOptions& global) {
    return Fetch(*id, *out, session, global);
  });
}

}  // namespace dispersa
