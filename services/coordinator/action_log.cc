#include "services/coordinator/action_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/results/file_system.h"
#include "core/results/output_file.h"
#include "core/results/result_error.h"
#include "services/coordinator/dump_any_text.h"
#include "services/log/log.h"
#include "services/program/utc.h"

namespace dispersa {

ActionLog::ActionLog(std::filesystem::path file) : file_(std::move(file)) {
  const int descriptor = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600);
  const bool is_ours = descriptor >= 0 && fchmod(descriptor, 0600) == 0;
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  if (!is_ours) FailFile(file_.string(), "cannot be written", error);
}

void ActionLog::Note(const Action& action) {
  nlohmann::ordered_json line = {{"time", UtcNow()}, {"action", action.what}, {"by", nullptr}};
  if (!action.by.empty()) line["by"] = action.by;
  for (const auto& [key, value] :
       {std::pair("client", &action.client), std::pair("campaign", &action.campaign),
        std::pair("name", &action.name), std::pair("to", &action.to), std::pair("worker", &action.worker),
        std::pair("reason", &action.reason)})
    if (!value->empty()) line[key] = *value;
  waiting_.push_back(DumpAnyText(line));
  Retry();
}

void ActionLog::Retry() {
  try {
    WriteAll();
  } catch (const ResultError& error) {
    if (problem_.empty()) LogError("an action is not noted, it is tried again: {}", error.what());
    problem_ = error.what();
  }
}

void ActionLog::RequireWritten() { WriteAll(); }

void ActionLog::WriteAll() {
  for (; !waiting_.empty(); waiting_.pop_front()) AppendLine(file_, waiting_.front());
  problem_.clear();
}

}  // namespace dispersa
