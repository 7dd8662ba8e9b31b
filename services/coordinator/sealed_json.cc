#include "services/coordinator/sealed_json.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/campaign_yaml/sha256.h"
#include "core/results/result_error.h"
#include "services/coordinator/dump_any_text.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kChecksum[] = "checksum";

}  // namespace

std::string Sealed(Json object) {
  object.erase(kChecksum);
  object[kChecksum] = Sha256Hex(DumpAnyText(object));
  return DumpAnyText(object, 2) + "\n";
}

Json Unseal(const std::string& text, int first_sealed) {
  Json object = Json::parse(text, nullptr, false);
  if (!object.is_object()) throw std::runtime_error("is not a whole JSON object");
  const Json version = object.value("version", Json(1));
  const Json checksum = object.value(kChecksum, Json());
  object.erase(kChecksum);
  const bool is_sealed = version.is_number_integer() && version >= first_sealed;
  if (!is_sealed && checksum.is_null()) return object;
  if (checksum != Sha256Hex(DumpAnyText(object))) throw std::runtime_error("does not fit its checksum");
  return object;
}

std::string ReadWholeFile(const std::filesystem::path& file) {
  std::error_code error;
  std::ifstream stream;
  if (std::filesystem::is_regular_file(file, error)) stream.open(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream.is_open() || !stream)
    throw ResultError(ResultError::Kind::kFile, file.string() + ": cannot be read");
  return std::move(text).str();
}

}  // namespace dispersa
