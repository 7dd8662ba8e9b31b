#include "core/report/cases_csv.h"

#include <fmt/format.h>

#include <string>

#include "core/flight/flight_inputs.h"
#include "core/report/text.h"

namespace dispersa {

std::string CasesCsvHeader() {
  std::string line = "case_index,outcome,end_time_s,end_stage,reason";
  for (const InputColumn& input : InputColumns()) line += ",input_" + input.name;
  for (const std::string& metric : MetricNames()) line += ",metric_" + metric;
  return line + ",digest\n";
}

std::string CasesCsvLine(const CaseResult& result) {
  std::string line = fmt::format("{},{},{},{},{}", result.case_index, OutcomeName(result.outcome),
                                 ShortestText(result.end_time_s), result.end_stage, CsvField(result.reason));
  for (const double value : result.inputs) line += "," + ShortestText(value);
  for (const double value : result.metrics) line += "," + ShortestText(value);
  return line + "," + result.digest.Hex() + "\n";
}

CasesCsv::CasesCsv(const std::filesystem::path& file) : file_(file) { file_.Write(CasesCsvHeader()); }

void WriteCasesCsv(const ResultFolder& folder, const std::filesystem::path& file) {
  CasesCsv csv(file);
  folder.ForEach([&csv](const CaseResult& result) { csv.Write(result); });
  csv.Commit();
}

}  // namespace dispersa
