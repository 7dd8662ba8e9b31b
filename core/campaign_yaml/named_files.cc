#include "core/campaign_yaml/named_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/campaign_yaml/base64.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/parse_csv.h"
#include "core/campaign_yaml/parse_rasp.h"
#include "core/campaign_yaml/parse_sounding.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/campaign_yaml/sha256.h"
#include "core/campaign_yaml/standard_input.h"
#include "core/campaign_yaml/text_problems.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

// A campaign's text carries it to every worker.
constexpr std::size_t kLargestFileOfBytes = std::size_t{32} << 20;

// A thrust curve may be what hobby motors have, by the end of its name; a wind profile what weather services
// give.
// `time`: of the sounding that is wanted of several, "" if there is one; it receives its time.
InputNode ParseTable(const std::string& text, const std::string& file, std::string& time,
                     std::vector<InputProblem>& problems) {
  const std::size_t before = problems.size();
  if (IsSoundingText(text)) {
    if (!CheckUtf8(text, file, problems)) return {};
    const Sounding sounding = ReadSounding(text, file, time, problems);
    time = sounding.time;
    return problems.size() > before ? InputNode() : TableOf(sounding, file, problems);
  }
  if (WithoutByteOrderMark(text).starts_with('<')) {
    problems.push_back({file, 1, 1, "", "the file is XML, such as RockSim's motors (.rse), and no table",
                        "a CSV file; of a motor also an .eng file"});
    return {};
  }
  std::string end = std::filesystem::path(file).extension().string();
  for (char& c : end) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (end == ".eng") return ParseRasp(text, file, problems);
  InputNode table = ParseCsv(text, file, problems);
  if (problems.size() > before || !IsSoundingTable(table)) return table;
  const Sounding sounding = ReadSounding(table, problems);
  time = sounding.time;
  return problems.size() > before ? InputNode() : TableOf(sounding, file, problems);
}

// Each file of a folder, but those whose names begin with '.'.
InputNode Folder(const std::string& folder, const InputNode& place, const std::string& path,
                 std::vector<InputProblem>& problems) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
      names.push_back(entry.path().filename().string());
  if (error || names.empty())
    return AddProblem(problems, place, path,
                      error ? "cannot read the folder '" + folder + "': " + error.message()
                            : "the folder '" + folder + "' has no files",
                      "a folder of soundings, named relative to this file"),
           InputNode();
  std::sort(names.begin(), names.end());
  InputNode list = ListAt(place);
  for (const std::string& name : names) {
    const std::string file = (std::filesystem::path(folder) / name).string();
    InputNode top = MapAt(place);
    top.file = std::make_shared<const std::string>(file);
    top.line = top.column = 1;
    std::string text, reason;
    if (!ReadFile(file, &text, &reason)) {
      AddProblem(problems, top, "", "cannot be read: " + reason, "a readable file");
      continue;
    }
    std::vector<std::string> times = TimesOf(text);
    if (times.empty()) times.emplace_back();
    for (std::string& time : times) {
      InputNode sounding = top, table = ParseTable(text, file, time, problems);
      if (time.empty()) time = TimeInName(name);
      SetMember(sounding, "file", TextAt(top, name));
      if (!time.empty()) SetMember(sounding, "time", TextAt(top, time));
      SetMember(sounding, "table", std::move(table));
      list.items.push_back(std::move(sounding));
    }
  }
  return list;
}

/// Whether a file could not be read because there is none.
bool IsMissing(const std::string& reason) { return reason == std::strerror(ENOENT); }

InputNode Bytes(const std::string& bytes, const std::string& file, const InputNode& place,
                const std::string& path, std::vector<InputProblem>& problems) {
  if (bytes.empty() || bytes.size() > kLargestFileOfBytes) {
    AddProblem(problems, place, path,
               "'" + file + "' " + (bytes.empty() ? "is empty" : "is larger than 32 MiB"),
               "a shared object of at most 32 MiB");
    return {};
  }
  InputNode inlined = MapAt(place);
  SetMember(inlined, "sha256", TextAt(place, Sha256Hex(bytes)));
  SetMember(inlined, "base64", TextAt(place, Base64(bytes)));
  return inlined;
}

}  // namespace

void NamedFiles::Read(InputNode& name, const std::string& path, Holds holds,
                      std::vector<InputProblem>& problems) {
  const InputNode place = std::move(name);
  name = InputNode();
  if (names_ == FileNames::kRefused)
    return AddProblem(problems, place, path, "the file '" + place.text + "' is named in a text without files",
                      "its contents in its place");
  if (place.text.empty())
    return AddProblem(problems, place, path, "the file name is empty", "a file name, relative to this file");
  const std::string file =
      (std::filesystem::path(*place.file).parent_path() / place.text).lexically_normal().string();
  std::string text, reason, time;
  if (holds == Holds::kFolder)
    name = Folder(file, place, path, problems);
  else if (!ReadFile(file, &text, &reason))
    AddProblem(problems, place, path,
               IsMissing(reason) ? "file '" + file + "' not found" : "cannot read '" + file + "': " + reason,
               IsMissing(reason) ? "a file, named relative to this one"
                                 : "a readable file, named relative to this one");
  else if (holds == Holds::kDocument)
    name = ParseYaml(text, file, problems);
  else if (holds == Holds::kTable)
    name = ParseTable(text, file, time, problems);
  else
    name = Bytes(text, file, place, path, problems);
}

InputText ReadInputFile(const std::string& path, std::vector<InputProblem>& problems) {
  // Without a folder, so that the names in it are relative to the current one.
  InputText file{path == kStandardInput ? kStandardInputName : path, {}};
  std::string reason;
  if (!(path == kStandardInput ? ReadStandardInput(&file.text, &reason)
                               : ReadFile(path, &file.text, &reason)))
    problems.push_back({file.name, 1, 1, "",
                        IsMissing(reason) ? "file not found" : "cannot be read: " + reason,
                        IsMissing(reason) ? "a file that exists" : "a readable file"});
  return file;
}

InputNode ReadYamlFile(const std::string& path, std::vector<InputProblem>& problems) {
  const std::size_t before = problems.size();
  const InputText file = ReadInputFile(path, problems);
  return problems.size() > before ? InputNode() : ParseYaml(file.text, file.name, problems);
}

}  // namespace dispersa
