#include "core/results/cases_csv.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>

#include "core/flight/flight_inputs.h"
#include "core/results/text.h"

namespace dispersa {

std::string CasesCsvHeader(const MetricList& list, const std::vector<std::size_t>& metrics) {
  std::string line = "case_index,outcome,end_time_s,end_stage,reason";
  for (std::size_t i = 0; i < InputCount(list.stages()); ++i) line += ",input_" + InputColumns()[i].name;
  for (const std::size_t i : metrics) line += ",metric_" + list.NameAt(i);
  return line + ",digest\n";
}

std::string CasesCsvLine(const CaseResult& result, const std::vector<std::size_t>& metrics) {
  std::string line = fmt::format("{},{},{},{},{}", result.case_index, OutcomeName(result.outcome),
                                 ShortestText(result.end_time_s), result.end_stage, CsvField(result.reason));
  for (const double value : result.inputs) line += "," + ShortestText(value);
  for (const std::size_t i : metrics) line += "," + ShortestText(result.metrics[i]);
  return line + "," + result.digest.Hex() + "\n";
}

CasesCsv::CasesCsv(const std::filesystem::path& file, const ResultFolder& folder)
    : file_(file), metrics_(folder.metrics()) {
  file_.Write(CasesCsvHeader(folder.metric_list(), metrics_));
}

std::uint64_t CountCases(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t lines = 0;
  bool is_quoted = false;  // a reason may have line breaks
  std::array<char, 1 << 16> part;
  while (stream.read(part.data(), part.size()), stream.gcount() > 0) {
    for (std::streamsize i = 0; i < stream.gcount(); ++i) {
      const char c = part[static_cast<std::size_t>(i)];
      if (c == '"') is_quoted = !is_quoted;
      if (c == '\n' && !is_quoted) ++lines;
    }
  }
  return lines == 0 ? 0 : lines - 1;  // without the header
}

void WriteCasesCsv(const ResultFolder& folder, const std::filesystem::path& file) {
  CasesCsv csv(file, folder);
  folder.ForEach([&csv](const CaseResult& result) { csv.Write(result); });
  csv.Commit();
}

}  // namespace dispersa
