#include "core/results/export.h"

#include <nlohmann/json.hpp>

#include "core/flight/flight_inputs.h"
#include "core/results/json_number.h"
#include "core/results/output_file.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

void ExportJsonLines(const ResultFolder& folder, const std::filesystem::path& file) {
  OutputFile output(file);
  folder.ForEach([&](const CaseResult& result) {
    Json line = {{"case_index", result.case_index},
                 {"outcome", OutcomeName(result.outcome)},
                 {"end_time_s", Number(result.end_time_s)},
                 {"end_stage", result.end_stage},
                 {"reason", result.reason}};
    for (std::size_t i = 0; i < result.inputs.size(); ++i)
      line["input_" + InputColumns()[folder.inputs().positions()[i]].name] = Number(result.inputs[i]);
    for (const std::size_t i : folder.metrics())
      line["metric_" + folder.metric_list().NameAt(i)] = Number(result.metrics[i]);
    line["digest"] = result.digest.Hex();
    output.Write(line.dump() + "\n");
  });
  output.Commit();
}

}  // namespace dispersa
