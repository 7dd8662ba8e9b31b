#include "services/transport/key_folder.h"

#include <fmt/chrono.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "services/transport/network.h"
#include "services/transport/openssl.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kHowTo[] = "give a folder that `dispersa keys issue` made";

[[noreturn]] void RefuseKeys(const fs::path& what, const std::string& problem) {
  throw NetworkError(what.string() + ": " + problem);
}

std::string DateText(std::time_t time) { return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(time)); }

std::string JoinRoles(std::initializer_list<Role> roles) {
  std::string text;
  for (const Role role : roles) text += (text.empty() ? "" : " or ") + std::string(Name(role));
  return text;
}

/// What OpenSSL reads of a file, or a refusal that names the file.
template <typename Read>
auto Parse(const fs::path& file, Read read) {
  const std::string text = ReadKeyFile(file);
  try {
    return read(text);
  } catch (const NetworkError&) {
    throw;
  } catch (const std::runtime_error& error) {
    RefuseKeys(file, error.what());
  }
}

void CheckDates(const fs::path& file, X509* certificate, const char* remedy) {
  const std::time_t now = std::time(nullptr);
  if (now > EndOf(certificate))
    RefuseKeys(file, "expired on " + DateText(EndOf(certificate)) + ": " + remedy);
  if (now < BeginOf(certificate)) {
    RefuseKeys(file, "is valid from " + DateText(BeginOf(certificate)) +
                         " on: the clock of this machine may be wrong");
  }
}

// The group may read: that is how Kubernetes gives a secret to its pod.
void RefuseOpenKey(const fs::path& file) {
  struct stat what {};
  if (stat(file.c_str(), &what) != 0) return;  // said when it is read
  if (what.st_uid != geteuid() && what.st_uid != 0)
    RefuseKeys(file, "belongs to another user, who could use it: `chown` it, or issue new keys");
  if ((what.st_mode & 0027) != 0) {
    RefuseKeys(
        file,
        fmt::format("other users of this machine can use it (mode {:o}): `chmod 600` it, and issue new keys "
                    "if somebody may have read it",
                    what.st_mode & 0777));
  }
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

std::string ReadKeyFile(const fs::path& file, const char* maker) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) {
    RefuseKeys(file,
               errno == ENOENT
                   ? fmt::format("file not found, allowed: a folder with all files that `{}` made", maker)
                   : std::string("cannot be read: ") + std::strerror(errno) + ", allowed: a readable file");
  }
  return text;
}

KeyFolder OpenKeyFolder(const fs::path& directory, std::initializer_list<Role> roles) {
  if (!fs::is_directory(directory)) RefuseKeys(directory, std::string("no folder: ") + kHowTo);
  if (fs::exists(directory / "authority")) {
    RefuseKeys(directory, "the folder of the authority, which signs and does not speak: give one of " +
                              (directory / "issued").string());
  }
  const auto identity_cas = Parse(directory / kIdentityAuthorityFile, ReadCertificates);
  const auto permissions_cas = Parse(directory / kPermissionsAuthorityFile, ReadCertificates);
  const Certificate identity = Parse(directory / kIdentityFile, ReadCertificate);
  RefuseOpenKey(directory / kIdentityKeyFile);
  const PrivateKey key = Parse(directory / kIdentityKeyFile, ReadPrivateKey);
  if (X509_check_private_key(identity.get(), key.get()) != 1) {
    RefuseKeys(directory / kIdentityKeyFile, std::string("not the key of ") + kIdentityFile);
  }
  const auto identity_ca =
      std::find_if(identity_cas.begin(), identity_cas.end(),
                   [&](const Certificate& each) { return IsSignedBy(identity.get(), each.get()); });
  if (identity_ca == identity_cas.end()) {
    RefuseKeys(directory / kIdentityFile, std::string("not signed by ") + kIdentityAuthorityFile);
  }
  X509* permissions_ca = nullptr;
  const auto document_in = [&](const char* name) {
    return Parse(directory / name, [&](const std::string& text) {
      return VerifiedDocument(text, permissions_cas, &permissions_ca);
    });
  };
  document_in(kGovernanceFile);
  const std::string permissions = document_in(kPermissionsFile);
  if (!Contains(permissions, "<subject_name>" + SubjectText(identity.get()) + "</subject_name>")) {
    RefuseKeys(directory / kPermissionsFile,
               std::string("not the permissions of the owner of ") + kIdentityFile);
  }
  const Subject subject = SubjectOf(identity.get());
  const std::string unit = subject.unit.substr(0, subject.unit.find('-'));
  const auto role = ParseRole(unit);
  if (!role || std::find(roles.begin(), roles.end(), *role) == roles.end()) {
    RefuseKeys(directory, "keys of the " + unit + " '" + subject.name + "'; here those of a " +
                              JoinRoles(roles) + " are needed");
  }
  CheckDates(directory / kIdentityAuthorityFile, identity_ca->get(), "make a new authority");
  CheckDates(directory / kPermissionsAuthorityFile, permissions_ca, "make a new authority");
  CheckDates(directory / kIdentityFile, identity.get(), "issue new keys");
  const auto right =
      unit.size() == subject.unit.size() ? std::nullopt : ParseRight(subject.unit.substr(unit.size() + 1));
  return {fs::absolute(directory), *role, subject.name, right};
}

}  // namespace dispersa
