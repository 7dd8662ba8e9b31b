// Draws the figures of core/README.md into core/images/, rewrites its tables of atmosphere, aerodynamics,
// work and precision, and writes a page with all of it:
//   physics_plots PAGE.html
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "core/pages/embedded.h"
#include "core/pages/html_parts.h"
#include "core/results/output_file.h"
#include "core/results/text.h"
#include "tests/tools/sheets.h"

namespace dispersa {
namespace {

std::string WorkPrecisionTable(const std::vector<WorkPoint>& points) {
  std::string table =
      "| flight | tick, ms | scheme | CPU, ms | altitude, m | velocity, m/s | pitch error, ° | RMS, ° | "
      "peak, ° |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const WorkPoint& p : points) {
    if (p.flight == "nominal" && p.tick_s != kShippedTick_s) continue;  // the page has them all
    const bool exact = p.scheme == Scheme::kCvode;
    const std::string scheme = p.scheme == Scheme::kSimpson ? "Simpson" : "ERK4";
    const auto difference = [&](double value) {
      return exact ? std::string("–") : fmt::format("{:.1e}", value);
    };
    table += fmt::format(
        "| {} | {:g} | {} | {:.0f} | {} | {} | {} | {:.5f} | {:.4f} |\n", p.flight, 1e3 * p.tick_s,
        exact          ? "CVODE"
        : IsShipped(p) ? "**Simpson, 1 step (shipped)**"
                       : fmt::format("{}, {} step{}", scheme, p.steps, p.steps > 1 ? "s" : ""),
        1e3 * p.cpu_s, difference(p.altitude_difference_m), difference(p.velocity_difference_m_s),
        difference(p.pitch_error_difference_deg), p.pitch_error_rms_deg, p.pitch_error_peak_deg);
  }
  return table;
}

// Replaces what stands between <!-- NAME:begin --> and <!-- NAME:end -->.
void RewriteBlock(const std::string& path, const std::string& name, const std::string& text) {
  std::ifstream file(path, std::ios::binary);
  std::string all{std::istreambuf_iterator<char>(file), {}};
  const std::string begin_mark = "<!-- " + name + ":begin -->\n";
  const std::size_t begin = all.find(begin_mark);
  const std::size_t end = all.find("<!-- " + name + ":end -->");
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error("no markers of " + name + " in " + path);
  WriteFile(path, all.replace(begin + begin_mark.size(), end - begin - begin_mark.size(), text));
}

void Draw(const std::string& page_path) {
  const std::string source = DISPERSA_SOURCE;
  const std::string campaigns = source + "/campaigns", data = source + "/tests/data";
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Physics of "
      "dispersa</title>\n<style>{}{}</style>\n</head>\n<body>\n<h1>Physics of dispersa: atmosphere, "
      "aerodynamics, "
      "work and precision</h1>\n",
      StyleSheet(), FigureStyle());
  const auto add = [&](const char* name, const FigureSheet& sheet) {
    WriteFile(source + "/core/images/" + name + ".svg", StandaloneSvg(sheet));
    page += PageSection(sheet);
  };
  add("atmosphere", AtmosphereSheet(data));
  add("aerodynamics", AerodynamicsSheet(campaigns, data));
  const std::vector<WorkPoint> points = MeasureWorkPrecision(campaigns);
  add("work_precision", WorkPrecisionSheet(points));
  page += "<pre>" + HtmlText(WorkPrecisionCsv(points)) + "</pre>\n</body>\n</html>\n";
  WriteFile(page_path, page);
  const std::string readme = source + "/core/README.md";
  RewriteBlock(readme, "atmosphere", AtmosphereTable(data));
  RewriteBlock(readme, "aerodynamics", AerodynamicsTable(data));
  RewriteBlock(readme, "work-precision", WorkPrecisionTable(points));
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: physics_plots PAGE.html\n");
    return 2;
  }
  try {
    dispersa::Draw(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "physics_plots: %s\n", error.what());
    return 1;
  }
  return 0;
}
