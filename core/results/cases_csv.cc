#include "core/results/cases_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/flight/flight_inputs.h"
#include "core/results/text.h"

namespace dispersa {

CsvColumns StoredColumns(const ResultFolder& folder, const std::vector<DatedWeather>& soundings) {
  CsvColumns columns{std::vector<std::size_t>(folder.inputs().positions().size()), folder.metrics()};
  std::iota(columns.inputs.begin(), columns.inputs.end(), std::size_t{0});
  if (soundings.empty()) return columns;
  columns.sounding = folder.inputs().PlaceOf(static_cast<std::size_t>(FindInput("weather_sounding")));
  columns.soundings = {"mean,"};
  for (const DatedWeather& one : soundings) columns.soundings.push_back(CsvField(one.file) + "," + one.time);
  return columns;
}

CsvColumns VaryingColumns(const ResultFolder& folder, const std::vector<DatedWeather>& soundings) {
  const CsvColumns stored = StoredColumns(folder, soundings);
  std::optional<CaseResult> first;
  std::vector<bool> inputs(stored.inputs.size()), metrics(folder.metric_list().size());
  // Undefined equals undefined here: neither has a text.
  const auto differ = [](double a, double b) { return !(a == b) && !(std::isnan(a) && std::isnan(b)); };
  folder.ForEach([&](const CaseResult& result) {
    if (!first) first = result;
    for (const std::size_t i : stored.inputs)
      if (differ(result.inputs[i], first->inputs[i])) inputs[i] = true;
    for (const std::size_t i : stored.metrics)
      if (differ(result.metrics[i], first->metrics[i])) metrics[i] = true;
  });
  CsvColumns columns = stored;
  std::erase_if(columns.inputs, [&](std::size_t i) { return !inputs[i]; });
  std::erase_if(columns.metrics, [&](std::size_t i) { return !metrics[i]; });
  return columns;
}

std::string CasesCsvHeader(const RowInputs& inputs, const MetricList& list, const CsvColumns& columns) {
  std::string line = "case_index,outcome,end_time_s,end_stage,reason";
  for (const std::size_t i : columns.inputs) line += ",input_" + InputColumns()[inputs.positions()[i]].name;
  for (const std::size_t i : columns.metrics) line += ",metric_" + list.NameAt(i);
  if (columns.sounding) line += ",sounding_file,sounding_time";
  return line + ",digest\n";
}

std::string CasesCsvLine(const CaseResult& result, const CsvColumns& columns) {
  std::string line = fmt::format("{},{},{},{},{}", result.case_index, OutcomeName(result.outcome),
                                 ShortestText(result.end_time_s), result.end_stage, CsvField(result.reason));
  line.reserve(20 * (columns.inputs.size() + columns.metrics.size()));
  const auto add = [&line](double value) { AppendShortest(value, line += ','); };
  for (const std::size_t i : columns.inputs) add(result.inputs[i]);
  for (const std::size_t i : columns.metrics) add(result.metrics[i]);
  if (columns.sounding)
    line += "," + columns.soundings.at(static_cast<std::size_t>(result.inputs[*columns.sounding]));
  return line + "," + result.digest.Hex() + "\n";
}

CasesCsv::CasesCsv(const std::filesystem::path& file, const ResultFolder& folder, CsvColumns columns)
    : file_(file), columns_(std::move(columns)) {
  file_.Write(CasesCsvHeader(folder.inputs(), folder.metric_list(), columns_));
}

std::uint64_t CountCases(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t lines = 0;
  bool is_quoted = false;  // a reason may have line breaks
  for (std::string line; std::getline(stream, line);) {
    if (line.find('"') != std::string::npos && std::count(line.begin(), line.end(), '"') % 2 == 1)
      is_quoted = !is_quoted;
    if (!is_quoted && !stream.eof()) ++lines;
  }
  return lines == 0 ? 0 : lines - 1;  // without the header
}

void WriteCasesCsv(const ResultFolder& folder, const CsvColumns& columns, const std::filesystem::path& file) {
  CasesCsv csv(file, folder, columns);
  folder.ForEach([&csv](const CaseResult& result) { csv.Write(result); });
  csv.Commit();
}

}  // namespace dispersa
