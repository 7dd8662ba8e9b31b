#include "core/pages/report_sums.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "core/campaign_yaml/sha256.h"
#include "core/results/gzip.h"
#include "core/results/output_file.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;
constexpr char kBetween[] = "  ";  // as sha256sum has it

/// Empty: it cannot be read.
std::string SumOf(const fs::path& file) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) return Sha256OfFile(file);
  const auto text = Gunzip(ReadWholeFile(file.string() + ".gz", ""));
  return text ? Sha256Hex(*text) : "";
}

}  // namespace

void WriteSums(const fs::path& folder) {
  std::vector<std::string> names = {"cases.csv", "nominal.json", "report.html", "summary.json"};
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "histories", error))
    names.push_back("histories/" + entry.path().filename().string());
  std::sort(names.begin(), names.end());
  std::string lines;
  for (const std::string& name : names) lines += SumOf(folder / name) + kBetween + name + "\n";
  WriteFile(folder / kSumsName, lines);
}

std::vector<std::string> ChangedReports(const fs::path& folder) {
  std::vector<std::string> changed;
  std::error_code error;
  if (!fs::exists(folder / kSumsName, error)) {
    const fs::path summary = folder / "summary.json";
    if (fs::exists(summary, error) && !nlohmann::json::accept(ReadWholeFile(summary, "")))
      changed.push_back("summary.json");
    return changed;
  }
  std::istringstream lines(ReadWholeFile(folder / kSumsName, ""));
  bool is_whole = false;
  for (std::string line; std::getline(lines, line);) {
    const std::string sum = line.substr(0, kDigits);
    is_whole = IsSha256Hex(sum) && line.size() > kDigits + 2 && !lines.eof();
    if (!is_whole) break;
    const std::string name = line.substr(kDigits + 2);
    if (SumOf(folder / name) != sum) changed.push_back(name);
  }
  if (!is_whole) changed.push_back(kSumsName);
  return changed;
}

}  // namespace dispersa
