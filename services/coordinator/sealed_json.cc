#include "services/coordinator/sealed_json.h"

#include <stdexcept>

#include "core/campaign_yaml/sha256.h"
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

}  // namespace dispersa
