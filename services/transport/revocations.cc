#include "services/transport/revocations.h"

#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "services/log/log.h"
#include "services/transport/openssl.h"

namespace dispersa {
namespace {

constexpr char kRevokedHead[] = "dispersa revoked keys 2", kHeadWithoutSerials[] = "dispersa revoked keys 1";

/// What a certificate of these keys may have as its unit.
std::vector<std::string> UnitsOf(Role role) {
  std::vector<std::string> units = {Name(role)};
  if (role != Role::kClient) return units;
  for (const Right right : kRights) units.push_back(std::string(Name(role)) + "-" + Name(right));
  return units;
}

}  // namespace

std::string RevocationText(const Revoked& revoked) {
  std::string text = std::string(kRevokedHead) + "\n";
  for (const RevokedKeys& keys : revoked)
    text += std::string(Name(keys.role)) + " " + keys.name + " " + keys.serial + "\n";
  return text;
}

Revoked ParseRevocations(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  const auto next = [&] {
    if (!std::getline(lines, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();  // S/MIME's line ends
    return true;
  };
  const bool has_serials = next() && line == kRevokedHead;
  if (!has_serials && line != kHeadWithoutSerials) throw std::runtime_error("no list of revoked keys");
  Revoked revoked;
  while (next()) {
    std::istringstream words(line + (has_serials ? "" : std::string(" ") + kNoSerial));
    std::string role, name, serial, more;
    words >> role >> name >> serial;
    if (!ParseRole(role) || serial.empty() || words >> more)
      throw std::runtime_error("a line is not 'ROLE NAME SERIAL': '" + line + "'");
    revoked.insert({*ParseRole(role), name, serial});
  }
  return revoked;
}

bool Revocations::Refresh() {
  const std::filesystem::path file = directory_ / kRevokedFile;
  std::error_code error;
  const auto written = std::filesystem::last_write_time(file, error);
  if (error || read_ == written) return false;
  read_ = written;
  try {
    const auto signers = ReadCertificates(ReadKeyFile(directory_ / kPermissionsAuthorityFile));
    std::set<std::string> participants;
    for (const RevokedKeys& keys : ParseRevocations(VerifiedDocument(ReadKeyFile(file), signers)))
      for (const std::string& unit : UnitsOf(keys.role))
        participants.insert(ParticipantsOf({keys.name, unit, keys.serial == kNoSerial ? "" : keys.serial}));
    participants_ = std::move(participants);
    return true;
  } catch (const std::runtime_error& problem) {
    LogError("{}: the list of revoked keys is not taken: {}", file.string(), problem.what());
    return false;
  }
}

void Revocations::RefreshIfDue() {
  constexpr std::chrono::seconds kPeriod(5);
  if (std::chrono::steady_clock::now() < due_) return;
  due_ = std::chrono::steady_clock::now() + kPeriod;
  Refresh();
}

bool Revocations::IsOf(const std::string& participant) const {
  return participants_.contains(participant.substr(0, kParticipantDigits));
}

}  // namespace dispersa
