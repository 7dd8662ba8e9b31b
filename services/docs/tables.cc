// The tables of the docs site, from the program's own declarations: keys, units, metrics, inputs, exit codes.
//
//     docs_tables NAME...
//
// prints one JSON object with the Markdown of each named table: "keys vehicle.stages", "metrics", ... A map
// of keys whose name is given too is left out of the table around it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign/dispersion_table.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/flight/metrics.h"
#include "core/statistics/order_statistics.h"
#include "services/docs/key_tables.h"
#include "services/program/exit_code.h"

namespace dispersa {
namespace {

// The rows of each kind of file by its name, and of each group by its own.
std::map<std::string, std::vector<KeyRow>> AllKeys() {
  std::map<std::string, std::vector<KeyRow>> all;
  for (const FileKind kind : kFileKinds) {
    std::map<std::string, std::vector<KeyRow>> groups;
    KeyRows rows(groups);
    DescribeFile(kind, rows);
    all[NameOf(kind)] = std::move(rows.rows);
    all.merge(groups);
  }
  return all;
}

// "vehicle.stages.motor"
const std::vector<KeyRow>* Find(const std::map<std::string, std::vector<KeyRow>>& all,
                                const std::string& path) {
  std::size_t end = std::min(path.find('.'), path.size());
  const auto kind = all.find(path.substr(0, end));
  const std::vector<KeyRow>* rows = kind == all.end() ? nullptr : &kind->second;
  while (rows != nullptr && end < path.size()) {
    const std::size_t begin = end + 1;
    end = std::min(path.find('.', begin), path.size());
    const auto row = std::find_if(rows->begin(), rows->end(), [&](const KeyRow& one) {
      return one.key == path.substr(begin, end - begin);
    });
    rows = row == rows->end() ? nullptr : &row->inside;
  }
  return rows;
}

std::string UnitTable() {
  std::string table = "| dimension | ends of a key |\n|---|---|\n";
  for (const auto& [name, units] : kDimensions) {
    table += "| " + std::string(name) + " | ";
    for (const Unit& unit : units)
      table += (&unit == &units.front() ? "`" : ", `") + std::string(unit.suffix) + "`";
    table += " |\n";
  }
  return table;
}

const char* WorseWord(Worse worse) {
  return worse == Worse::kLarger    ? "larger"
         : worse == Worse::kSmaller ? "smaller"
         : worse == Worse::kNeither ? "–"
                                    : "farther from 0";
}

std::string NotesOf(const Metric& metric) {
  std::string notes;
  const auto add = [&](const std::string& note) { notes += (notes.empty() ? "" : "; ") + note; };
  if (metric.is_usual) add("in every report");
  if (std::any_of(Metrics().begin(), Metrics().end(),
                  [&](const Metric& other) { return other.title == metric.title + ", coast"; }))
    add("also by stage and of the coast");
  if (metric.of_law != nullptr) add("law of pitch: " + LawsWith(metric));
  if (metric.needs != MetricNeeds::kNothing && metric.needs != MetricNeeds::kControl)
    add("with " + NeedsOf(metric));
  if (!metric.is_digested) add("not in the digest");
  return notes;
}

std::string MetricTable() {
  std::string table = "| metric | unit | worse | definition |\n|---|---|---|---|\n";
  for (const char* group : kMetricGroupTitles) {
    if (TitleOf(MetricGroup::kOwn) == std::string(group)) continue;  // of campaigns
    table += "| **" + std::string(group) + "** | | | |\n";
    for (const Metric& metric : Metrics()) {
      if (metric.is_part || TitleOf(metric.group) != std::string(group)) continue;
      const std::string notes = NotesOf(metric);
      table += "| `" + metric.name + "`<br>" + EscapedCell(metric.symbol) + " | " + metric.unit + " | " +
               WorseWord(metric.worse) + " | **" + metric.title + "**" +
               (metric.definition.empty() ? "" : ": " + EscapedCell(metric.definition)) +
               "<br>*Defined over* " + metric.over + (notes.empty() ? "" : "; " + notes) + " |\n";
    }
  }
  return table;
}

void AddInputs(const DispersionRow& row, const std::string& key, std::string& table) {
  std::vector<std::string> patterns = row.columns;
  patterns.insert(patterns.end(), row.nozzle_columns.begin(), row.nozzle_columns.end());
  if (!patterns.empty()) {
    std::string columns;
    for (const std::string& pattern : patterns) columns += (columns.empty() ? "`" : ", `") + pattern + "`";
    table += "| `" + key + "` | " + columns + " | " + row.meaning + " |\n";
  }
  for (const DispersionRow& part : row.parts) AddInputs(part, key + "." + part.key, table);
}

std::string InputTable() {
  std::string table = "| key of `dispersions` | columns that take its draws | meaning |\n|---|---|---|\n";
  for (const DispersionRow& row : DispersionRows()) AddInputs(row, row.key, table);
  return table;
}

std::string ExitCodeTable() {
  std::string table = "| code | means |\n|---|---|\n";
  for (const ExitMeaning& one : ExitMeanings())
    table += "| " + std::to_string(one.code) + " | " + one.meaning + " |\n";
  return table;
}

// The least number of cases of one look at the end, by probability and risk, with no failure and with one.
std::string CasesTable() {
  constexpr double kRisks[] = {0.2, 0.1, 0.05, 0.01};
  std::string table = "| probability |", rule = "|---|";
  for (const double risk : kRisks) {
    table += fmt::format(" risk {:g} % |", 100.0 * risk);
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (const double probability : {0.5, 0.9, 0.95, 0.99, 0.9973, 0.999}) {
    table += fmt::format("| {:g} % |", 100.0 * probability);
    for (const double risk : kRisks)
      table += fmt::format(" {}, {} |", CasesNeeded(probability, risk, 0), CasesNeeded(probability, risk, 1));
    table += "\n";
  }
  return table;
}

// Throws std::invalid_argument for a name that is no table's, and for kinds of files that no name asks for.
nlohmann::ordered_json Tables(const std::vector<std::string>& names) {
  const std::string keys = "keys ";
  const auto is_named = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto all = AllKeys();
  for (const auto& [name, rows] : all)
    if (!is_named(keys + name))
      throw std::invalid_argument("no page has the table of keys of '" + name + "'");
  nlohmann::ordered_json tables;
  for (const std::string& name : names) {
    std::string& table = tables.emplace(name, "").first->get_ref<std::string&>();
    if (name == "units")
      table = UnitTable();
    else if (name == "metrics")
      table = MetricTable();
    else if (name == "inputs")
      table = InputTable();
    else if (name == "exit codes")
      table = ExitCodeTable();
    else if (name == "cases")
      table = CasesTable();
    else if (const std::vector<KeyRow>* rows =
                 name.starts_with(keys) ? Find(all, name.substr(keys.size())) : nullptr)
      table = KeyTable([&](const std::string& path) {
                return is_named(keys + path);
              }).Text(*rows, name.substr(keys.size()));
    else
      throw std::invalid_argument("a page has the table '" + name + "', which there is not");
  }
  return tables;
}

}  // namespace
}  // namespace dispersa

int main(int count, char** arguments) {
  try {
    std::printf("%s\n", dispersa::Tables({arguments + 1, arguments + count}).dump().c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "docs_tables: %s\n", error.what());
    return 1;
  }
}
