#include "services/program/error_json.h"

#include <fmt/format.h>

namespace dispersa {

nlohmann::ordered_json ProblemJson(const InputProblem& problem) {
  return {{"file", problem.file}, {"line", problem.line},       {"column", problem.column},
          {"path", problem.path}, {"message", problem.message}, {"allowed", problem.allowed}};
}

void PrintErrorJson(ExitCode code, const std::vector<InputProblem>& problems) {
  auto errors = nlohmann::ordered_json::array();
  for (const InputProblem& problem : problems) errors.push_back(ProblemJson(problem));
  const nlohmann::ordered_json json = {
      {"schema", "dispersa/error/1"}, {"code", static_cast<int>(code)}, {"errors", std::move(errors)}};
  // A name on the command line need not be UTF-8.
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintErrorJson(ExitCode code, const std::string& message) {
  PrintErrorJson(code, {InputProblem{"", 0, 0, "", message, ""}});
}

}  // namespace dispersa
