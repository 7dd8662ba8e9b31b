// Puts the contents of a file in the place of its name, so that one tree holds everything.
#pragma once

#include <string>
#include <vector>

#include "core/input/field_reader.h"

namespace dispersa {

inline constexpr char kCampaignSchema[] = "dispersa/campaign/1";
inline constexpr char kVehicleSchema[] = "dispersa/vehicle/1";
inline constexpr char kAutopilotSchema[] = "dispersa/autopilot/1";
inline constexpr char kReferenceSchema[] = "dispersa/reference/1";
inline constexpr char kScenarioSchema[] = "dispersa/scenario/1";

/// Whether a text may name files: a canonical text, which lives anywhere, may not.
enum class FileNames { kAllowed, kRefused };

/// Reads the files that a tree names. Names are relative to the file in which they stand. A table is a CSV
/// file, RASP's format if its name ends so, or a sounding. Bytes become {sha256, base64}. A folder becomes a
/// list of {file, time, table}, for each sounding of its files in the order of their names.
class NamedFiles : public FileSource {
 public:
  explicit NamedFiles(FileNames names = FileNames::kAllowed) : names_(names) {}

 protected:
  void Read(InputNode& name, const std::string& path, Holds holds,
            std::vector<InputProblem>& problems) override;

 private:
  const FileNames names_;
};

/// A file's name in messages, and its text.
struct InputText {
  std::string name, text;
};
/// Reads a whole file; "-" is standard input. An unreadable one is a problem at line 1, column 1.
InputText ReadInputFile(const std::string& path, std::vector<InputProblem>& problems);
/// Reads a YAML file. An unreadable one is a problem at line 1, column 1.
InputNode ReadYamlFile(const std::string& path, std::vector<InputProblem>& problems);

}  // namespace dispersa
