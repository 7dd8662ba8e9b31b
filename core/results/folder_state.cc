#include "core/results/folder_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <system_error>

#include "core/input/input_error.h"
#include "core/results/database.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

/// By the first bytes of the file format; so a wrong file is told from a damaged one.
bool IsDatabase(const fs::path& file) {
  constexpr char kMagic[] = "SQLite format 3";
  char begin[sizeof kMagic] = {};
  std::ifstream(file, std::ios::binary).read(begin, sizeof begin);
  return std::equal(std::begin(kMagic), std::end(kMagic), std::begin(begin));
}

}  // namespace

std::unique_ptr<Database> OpenResultDatabase(const fs::path& directory) {
  std::error_code error;
  if (!fs::is_regular_file(directory / kDatabaseName, error)) {
    throw InputError(fmt::format("{}: not a result folder: it has no {}", directory.string(), kDatabaseName));
  }
  if (!IsDatabase(directory / kDatabaseName)) {
    throw InputError(fmt::format("{}: not a result folder: its {} is no SQLite database", directory.string(),
                                 kDatabaseName));
  }
  return std::make_unique<Database>(directory / kDatabaseName, Database::Mode::kExisting);
}

FolderState ReadFolderState(const fs::path& directory) {
  const std::unique_ptr<Database> database = OpenResultDatabase(directory);
  std::map<std::string, std::string> provenance;
  {
    Statement select = database->Prepare("SELECT key, value FROM provenance");
    while (select.Step()) provenance[select.Text(0)] = select.Text(1);
  }
  FolderState state = {provenance["campaign_id"], provenance["flight_id"],
                       provenance["engine"],      provenance["name"],
                       provenance["seed"],        0,
                       database->Count("cases"),  database->Count("quarantined")};
  const std::string& planned = provenance["cases"];
  std::from_chars(planned.data(), planned.data() + planned.size(), state.planned);
  return state;
}

std::string DamagedPages(const fs::path& directory) {
  const std::unique_ptr<Database> database = OpenResultDatabase(directory);
  Statement check = database->Prepare("PRAGMA integrity_check(1)");
  const std::string found = check.Step() ? check.Text(0) : "";
  return found == "ok" ? "" : found;
}

void CopyResults(const fs::path& directory, const fs::path& file) {
  OpenResultDatabase(directory)->CopyTo(file);
}

}  // namespace dispersa
