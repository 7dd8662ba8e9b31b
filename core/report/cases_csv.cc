#include "core/report/cases_csv.h"

#include <fmt/format.h>

#include <string>

#include "core/flight/flight_inputs.h"
#include "core/report/text.h"

namespace dispersa {

std::string CasesCsvHeader(std::size_t stages) {
  std::string line = "case_index,outcome,end_time_s,end_stage,reason";
  for (std::size_t i = 0; i < InputCount(stages); ++i) line += ",input_" + InputColumns()[i].name;
  for (std::size_t i = 0; i < MetricCount(stages); ++i) line += ",metric_" + MetricNames()[i];
  return line + ",digest\n";
}

std::string CasesCsvLine(const CaseResult& result) {
  std::string line = fmt::format("{},{},{},{},{}", result.case_index, OutcomeName(result.outcome),
                                 ShortestText(result.end_time_s), result.end_stage, CsvField(result.reason));
  for (const double value : result.inputs) line += "," + ShortestText(value);
  for (const double value : result.metrics) line += "," + ShortestText(value);
  return line + "," + result.digest.Hex() + "\n";
}

CasesCsv::CasesCsv(const std::filesystem::path& file, std::size_t stages) : file_(file) {
  file_.Write(CasesCsvHeader(stages));
}

void WriteCasesCsv(const ResultFolder& folder, const std::filesystem::path& file) {
  CasesCsv csv(file, folder.stages());
  folder.ForEach([&csv](const CaseResult& result) { csv.Write(result); });
  csv.Commit();
}

}  // namespace dispersa
