#include "services/transport/revocations.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "services/log/log.h"
#include "services/transport/openssl.h"

namespace dispersa {
namespace {

constexpr char kRevokedHead[] = "dispersa revoked keys 1";

}  // namespace

std::string RevocationText(const Revoked& revoked) {
  std::string text = std::string(kRevokedHead) + "\n";
  for (const auto& [role, names] : revoked)
    for (const std::string& name : names) text += std::string(Name(role)) + " " + name + "\n";
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
  if (!next() || line != kRevokedHead) throw std::runtime_error("no list of revoked keys");
  Revoked revoked;
  while (next()) {
    const std::size_t space = line.find(' ');
    const auto role = ParseRole(line.substr(0, space));
    if (!role || space == std::string::npos || space + 1 == line.size())
      throw std::runtime_error("a line is not 'ROLE NAME': '" + line + "'");
    revoked[*role].insert(line.substr(space + 1));
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
    const Certificate signer = ReadCertificate(ReadKeyFile(directory_ / kPermissionsAuthorityFile));
    revoked_ = ParseRevocations(VerifiedDocument(ReadKeyFile(file), signer.get()));
    return true;
  } catch (const std::runtime_error& problem) {
    LogError("{}: the list of revoked keys is not taken: {}", file.string(), problem.what());
    return false;
  }
}

bool Revocations::Contains(Role role, const std::string& name) const {
  const auto found = revoked_.find(role);
  return found != revoked_.end() && found->second.contains(name);
}

bool Revocations::IsOf(Role role, const std::string& participant) const {
  const auto names = revoked_.find(role);
  return names != revoked_.end() &&
         std::any_of(names->second.begin(), names->second.end(), [&](const std::string& name) {
           return participant.starts_with(ParticipantsOf({name, Name(role)}));
         });
}

}  // namespace dispersa
