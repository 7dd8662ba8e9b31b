// The tables of metrics and inputs in README files agree with their declarations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "core/campaign/dispersion_table.h"
#include "core/flight/metrics.h"
#include "core/results/metric_catalogue.h"

namespace dispersa::readme_tables_test {
namespace {

constexpr char kCommand[] =
    "DISPERSA_REWRITE_TABLES=1 build/release/tests/unit_tests --gtest_filter='ReadmeTables.*'";

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The lines between <!-- NAME:begin --> and <!-- NAME:end --> of a file of the repository.
void ExpectTable(const std::string& file, const std::string& name, const std::string& table) {
  const std::string path = DISPERSA_CAMPAIGNS "/../" + file;
  std::string text = ReadText(path);
  const std::string begin = "<!-- " + name + ":begin -->\n";
  const std::size_t first = text.find(begin), end = text.find("<!-- " + name + ":end -->");
  ASSERT_TRUE(first != std::string::npos && end != std::string::npos && first < end)
      << "no markers of '" << name << "' in " << file;
  const std::size_t from = first + begin.size();
  if (text.compare(from, end - from, table) == 0) return;
  const char* rewrite = std::getenv("DISPERSA_REWRITE_TABLES");
  if (rewrite != nullptr && std::string(rewrite) == "1") {
    std::ofstream(path, std::ios::binary) << text.replace(from, end - from, table);
    FAIL() << "rewrote the table '" << name << "' of " << file
           << "; look at the difference before it is committed";
  }
  FAIL() << file << ": the table '" << name << "' is not what the declarations say. This writes it:\n  "
         << kCommand << "\nIt should be:\n"
         << table;
}

std::string Escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

const char* WorseWord(Worse worse) {
  switch (worse) {
    case Worse::kLarger:
      return "larger";
    case Worse::kSmaller:
      return "smaller";
    case Worse::kFartherFromZero:
      return "farther from 0";
    case Worse::kNeither:
      return "–";
  }
  return "";
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

TEST(ReadmeTables, MetricsAreAsDeclared) {
  std::string table =
      "| metric | symbol | unit | worse | definition | defined over | |\n|---|---|---|---|---|---|---|\n";
  for (const char* group : kMetricGroupTitles) {
    if (TitleOf(MetricGroup::kOwn) == std::string(group)) continue;  // of campaigns
    table += "| **" + std::string(group) + "** | | | | | | |\n";
    for (const Metric& metric : Metrics())
      if (!metric.is_part && TitleOf(metric.group) == std::string(group))
        table += "| `" + metric.name + "` | " + Escaped(metric.symbol) + " | " + metric.unit + " | " +
                 WorseWord(metric.worse) + " | **" + metric.title + "**: " + Escaped(metric.definition) +
                 " | " + metric.over + " | " + NotesOf(metric) + " |\n";
  }
  ExpectTable("core/README.md", "metrics", table);
}

void AddRows(const DispersionRow& row, const std::string& key, std::string& table) {
  std::vector<std::string> patterns = row.columns;
  patterns.insert(patterns.end(), row.nozzle_columns.begin(), row.nozzle_columns.end());
  if (!patterns.empty()) {
    std::string columns;
    for (const std::string& pattern : patterns) columns += (columns.empty() ? "`" : ", `") + pattern + "`";
    table += "| `" + key + "` | " + columns + " | " + row.meaning + " |\n";
  }
  for (const DispersionRow& part : row.parts) AddRows(part, key + "." + part.key, table);
}

TEST(ReadmeTables, InputsAreAsDeclared) {
  std::string table = "| key of `dispersions` | columns that take its draws | meaning |\n|---|---|---|\n";
  for (const DispersionRow& row : DispersionRows()) AddRows(row, row.key, table);
  ExpectTable("core/results/README.md", "inputs", table);
}

// A unit at the end of a column's name is the one that people read; of an integral over time twice, the
// square of seconds is no acceleration's.
TEST(ReadmeTables, UnitsOfMetricsAreThoseOfTheirNames) {
  for (const Metric& metric : Metrics()) {
    if (metric.name == "pitch_error_itae_deg_s2")
      EXPECT_EQ(metric.unit, "° s²");
    else
      EXPECT_EQ(metric.unit, SplitUnit(metric.name).unit) << metric.name;
  }
  EXPECT_EQ(SplitUnit("bending_moment_max_n_m").unit, "N m");
  EXPECT_EQ(SplitUnit("bending_moment_max_n_m").stem, "bending_moment_max");
}

}  // namespace
}  // namespace dispersa::readme_tables_test
