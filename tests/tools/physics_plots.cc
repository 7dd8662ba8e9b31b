// Draws the figures of the models' pages into core/images/ and services/docs/pages/images/, rewrites the
// tables of atmosphere and aerodynamics in those pages, and writes a page with all of it, work and precision
// too:
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
  const auto add = [&](const char* name, const FigureSheet& sheet, const char* folder = "/core/images/") {
    WriteFile(source + folder + name + ".svg", StandaloneSvg(sheet));
    page += PageSection(sheet);
  };
  add("atmosphere", AtmosphereSheet(data));
  add("aerodynamics", AerodynamicsSheet(campaigns, data));
  add("check_case_17", TwoStageSheet(campaigns, data), "/services/docs/pages/images/");
  const std::vector<WorkPoint> points = MeasureWorkPrecision(campaigns);
  add("work_precision", WorkPrecisionSheet(points));
  page += "<pre>" + HtmlText(WorkPrecisionCsv(points)) + "</pre>\n</body>\n</html>\n";
  WriteFile(page_path, page);
  RewriteBlock(source + "/core/environment/README.md", "atmosphere", AtmosphereTable(data));
  RewriteBlock(source + "/core/vehicle/README.md", "aerodynamics", AerodynamicsTable(data));
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
