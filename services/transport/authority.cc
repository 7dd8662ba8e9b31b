#include "services/transport/authority.h"

#include <fcntl.h>
#include <unistd.h>

#include <fmt/chrono.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/input/input_error.h"
#include "services/transport/key_folder.h"
#include "services/transport/network.h"
#include "services/transport/openssl.h"
#include "services/transport/revocations.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr char kIdentityAuthorityKeyFile[] = "identity_ca.key";
constexpr char kPermissionsAuthorityKeyFile[] = "permissions_ca.key";
constexpr char kMaker[] = "dispersa keys init";
constexpr char kSerialsFile[] = "serials.txt";
/// Fast DDS lets participants meet only if the first certificates of their permissions_ca.pem have the
/// same name. So this is the name of the first one for ever, and later signers have other names.
constexpr char kFirstPermissions[] = "dispersa permissions";
constexpr std::time_t kDay_s = 86400;
constexpr std::size_t kMaxKeyName = 31;  // with '_' and 32 random digits an identifier of 64

[[noreturn]] void Refuse(const fs::path& what, const std::string& problem, const std::string& allowed = "") {
  throw InputError({{what.string(), 0, 0, "", problem, allowed}});
}

bool IsName(const std::string& text) {
  const auto is_letter = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !text.empty() && text.size() <= kMaxKeyName && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return is_letter(c) || c == '-'; });
}

/// `how`: O_EXCL: it is new; O_APPEND: at its end.
void Write(const fs::path& file, const std::string& text, int how) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | how | O_CLOEXEC | O_NOFOLLOW, 0600);
  const bool written = descriptor >= 0 &&
                       write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  if (!written) Refuse(file, std::string("cannot be written: ") + std::strerror(error));
}

/// Appears under its name with all its files, or not at all, and never in the place of another.
void MakeFolder(const fs::path& folder, const std::map<std::string, std::string>& files) {
  std::error_code error;
  fs::create_directories(folder.parent_path(), error);
  std::string draft = (folder.parent_path() / ("." + folder.filename().string() + ".XXXXXX")).string();
  if (error || mkdtemp(draft.data()) == nullptr) {
    Refuse(folder.parent_path(), std::string("no folder can be made: ") + std::strerror(errno));
  }
  try {
    for (const auto& [name, text] : files) Write(fs::path(draft) / name, text, O_EXCL);
    if (std::rename(draft.c_str(), folder.c_str()) != 0) {
      Refuse(folder, "exists already and is not overwritten", "another name, or to remove it first");
    }
  } catch (...) {
    fs::remove_all(draft, error);
    throw;
  }
}

struct Signer {
  Certificate certificate;
  PrivateKey key;
};

Signer NewSigner(const std::string& name, bool is_authority, const Validity& validity) {
  Signer signer{nullptr, MakePrivateKey()};
  signer.certificate = MakeCertificate({{name, ""}, is_authority, validity.not_before, validity.not_after},
                                       signer.key.get(), nullptr, nullptr);
  return signer;
}

/// Of several certificates the one of the key signs.
Signer ReadSigner(const std::string& certificates, const fs::path& key) {
  Signer signer{nullptr, ReadPrivateKey(ReadKeyFile(key, kMaker))};
  for (Certificate& each : ReadCertificates(certificates))
    if (X509_check_private_key(each.get(), signer.key.get()) == 1) signer.certificate = std::move(each);
  if (!signer.certificate)
    throw std::runtime_error(key.string() + ": not the key of a certificate beside it");
  return signer;
}

struct Authority {
  std::string identity_cas, permissions_cas;  ///< the texts of these files
  Signer identities, permissions;
  std::string governance;
};

Authority ReadAuthority(const fs::path& folder) {
  try {
    const std::string identity_cas = ReadKeyFile(folder / kIdentityAuthorityFile, kMaker),
                      permissions_cas = ReadKeyFile(folder / kPermissionsAuthorityFile, kMaker);
    return {identity_cas, permissions_cas, ReadSigner(identity_cas, folder / kIdentityAuthorityKeyFile),
            ReadSigner(permissions_cas, folder / kPermissionsAuthorityKeyFile),
            ReadKeyFile(folder / kGovernanceFile, kMaker)};
  } catch (const std::runtime_error& error) {
    Refuse(folder, std::string("the authority cannot sign: ") + error.what());
  }
}

/// None if nothing was revoked yet.
Revoked ReadRevoked(const fs::path& directory) {
  const fs::path file = directory / kRevokedFile;
  if (!fs::exists(file)) return {};
  try {
    const auto signers =
        ReadCertificates(ReadKeyFile(directory / "authority" / kPermissionsAuthorityFile, kMaker));
    return ParseRevocations(VerifiedDocument(ReadKeyFile(file), signers));
  } catch (const std::runtime_error& error) {
    Refuse(file, std::string("the list of revoked keys cannot be read: ") + error.what());
  }
}

/// In the place of the last list, as a whole.
void WriteRevoked(const fs::path& directory, const Revoked& revoked, const Signer& signer) {
  const fs::path file = directory / kRevokedFile, draft = file.string() + ".new";
  std::error_code error;
  fs::remove(draft, error);
  Write(draft, SignDocument(RevocationText(revoked), signer.certificate.get(), signer.key.get()), O_EXCL);
  fs::rename(draft, file, error);
  if (error) Refuse(file, "cannot be written: " + error.message());
}

std::map<std::string, std::string> FilesOf(const Authority& authority) {
  return {{kIdentityAuthorityFile, authority.identity_cas},
          {kIdentityAuthorityKeyFile, ToPem(authority.identities.key.get())},
          {kPermissionsAuthorityFile, authority.permissions_cas},
          {kPermissionsAuthorityKeyFile, ToPem(authority.permissions.key.get())},
          {kGovernanceFile, SignDocument(GovernanceDocument(), authority.permissions.certificate.get(),
                                         authority.permissions.key.get())}};
}

/// The former folder stays beside it under the name that is returned.
fs::path ReplaceAuthority(const fs::path& directory, const Authority& authority) {
  const Revoked revoked = ReadRevoked(directory);
  const fs::path folder = directory / "authority", former = directory / ("authority-before-" + MakeSerial());
  std::error_code error;
  fs::rename(folder, former, error);
  if (error) Refuse(folder, "cannot be replaced: " + error.message());
  try {
    MakeFolder(folder, FilesOf(authority));
    if (!revoked.empty()) WriteRevoked(directory, revoked, authority.permissions);
  } catch (...) {
    fs::remove_all(folder, error);
    fs::rename(former, folder, error);
    throw;
  }
  return former;
}

void RequireAuthority(const fs::path& directory) {
  if (!fs::is_directory(directory / "authority"))
    Refuse(directory, "no authority", "a folder that `dispersa keys init` made");
}

bool IsRenewed(const Authority& authority) { return ReadCertificates(authority.identity_cas).size() > 1; }

/// Keys that are to be issued under this name again give way to them, if they are revoked.
void MoveRevoked(const fs::path& directory, const fs::path& folder, Role role, const std::string& name) {
  if (!fs::exists(folder / kIdentityFile)) return;
  const std::string serial = SubjectOf(ReadCertificate(ReadKeyFile(folder / kIdentityFile)).get()).serial;
  if (!ReadRevoked(directory).contains({role, name, serial.empty() ? kNoSerial : serial})) return;
  std::error_code error;
  fs::create_directories(directory / "revoked", error);
  fs::rename(folder, directory / "revoked" / (folder.filename().string() + "-" + serial), error);
  if (error) Refuse(folder, "revoked keys, cannot be moved away: " + error.message());
}

}  // namespace

Validity ValidFor(int days) {
  const std::time_t now = std::time(nullptr);
  return {now - kDay_s, now + days * kDay_s};
}

void MakeAuthority(const fs::path& directory, const Validity& validity) {
  const fs::path folder = directory / "authority";
  if (fs::exists(folder)) {
    Refuse(folder, "there is an authority already, and it is not overwritten", "another folder");
  }
  // The second signs documents itself and no certificates: nobody else can ever sign permissions.
  Authority made{"", "", NewSigner("dispersa identities", true, validity),
                 NewSigner(kFirstPermissions, false, validity), ""};
  made.identity_cas = ToPem(made.identities.certificate.get());
  made.permissions_cas = ToPem(made.permissions.certificate.get());
  MakeFolder(folder, FilesOf(made));
}

fs::path RenewAuthority(const fs::path& directory, const Validity& validity) {
  RequireAuthority(directory);
  const Authority old = ReadAuthority(directory / "authority");
  if (IsRenewed(old)) {
    Refuse(directory, "was renewed, and the keys of before are still accepted",
           "`dispersa keys retire` first, when all keys are issued again");
  }
  // Certificates of one name would be taken for each other.
  const std::string mark = " " + MakeSerial();
  Authority renewed{"", "", NewSigner("dispersa identities" + mark, true, validity),
                    NewSigner(kFirstPermissions + mark, false, validity), ""};
  renewed.identity_cas = old.identity_cas + ToPem(renewed.identities.certificate.get());
  renewed.permissions_cas = old.permissions_cas + ToPem(renewed.permissions.certificate.get());
  return ReplaceAuthority(directory, renewed);
}

fs::path RetireAuthority(const fs::path& directory) {
  RequireAuthority(directory);
  Authority authority = ReadAuthority(directory / "authority");
  if (!IsRenewed(authority)) {
    Refuse(directory, "has one authority, which issues its keys", "an authority after `dispersa keys renew`");
  }
  const Certificate& signer = authority.permissions.certificate;
  // Nobody has the key of the first one: it gives its name, and signs nothing.
  const Signer first = NewSigner(kFirstPermissions, false, {BeginOf(signer.get()), EndOf(signer.get())});
  authority.identity_cas = ToPem(authority.identities.certificate.get());
  authority.permissions_cas = ToPem(first.certificate.get()) + ToPem(signer.get());
  return ReplaceAuthority(directory, authority);
}

fs::path IssueKeys(const fs::path& directory, Role role, const std::string& name, const Validity& asked,
                   Right right) {
  if (!IsName(name)) {
    throw InputError("'" + name + "' cannot be the name of keys",
                     "1 to 31 letters, digits and '-', the first no '-'");
  }
  RequireAuthority(directory);
  const fs::path authority = directory / "authority";
  const fs::path folder = directory / "issued" / (std::string(Name(role)) + "-" + name);
  MoveRevoked(directory, folder, role, name);
  if (fs::exists(folder)) {
    Refuse(folder, "these keys exist already and are not overwritten",
           "another name, or to remove the folder first");
  }
  const auto [identity_cas, permissions_cas, identities, signer, governance] = ReadAuthority(authority);
  const std::time_t end = std::min(EndOf(identities.certificate.get()), EndOf(signer.certificate.get()));
  if (asked.not_after > end + kDay_s) {
    Refuse(authority, "the authority is valid for fewer days than the keys would be",
           "fewer days, or a new authority");
  }
  // Made today for as many days as the authority of this morning, they end with it.
  const Validity validity{asked.not_before, std::min(asked.not_after, end)};
  const PrivateKey key = MakePrivateKey();
  const std::string unit =
      role == Role::kClient ? std::string(Name(role)) + "-" + Name(right) : std::string(Name(role));
  const std::string serial = MakeSerial();
  const Certificate identity =
      MakeCertificate({{name, unit, serial}, false, validity.not_before, validity.not_after}, key.get(),
                      identities.certificate.get(), identities.key.get());
  // The certificate's dates are what ends it: those of permissions are read in the local time of whoever
  // checks them.
  const std::string permissions =
      PermissionsDocument(role, name, right, SubjectText(identity.get()), validity.not_before - kDay_s,
                          validity.not_after + kDay_s);
  MakeFolder(folder,
             {{kIdentityAuthorityFile, identity_cas},
              {kPermissionsAuthorityFile, permissions_cas},
              {kGovernanceFile, governance},
              {kIdentityFile, ToPem(identity.get())},
              {kIdentityKeyFile, ToPem(key.get())},
              {kPermissionsFile, SignDocument(permissions, signer.certificate.get(), signer.key.get())}});
  Write(directory / kSerialsFile,
        fmt::format("{} {} {} {:%Y-%m-%d}\n", Name(role), name, serial, fmt::gmtime(validity.not_after)),
        O_APPEND);
  return folder;
}

std::vector<IssuedKeys> ListKeys(const fs::path& directory) {
  RequireAuthority(directory);
  const Revoked revoked = ReadRevoked(directory);
  std::vector<IssuedKeys> listed;
  std::istringstream lines(
      fs::exists(directory / kSerialsFile) ? ReadKeyFile(directory / kSerialsFile, kMaker) : "");
  for (std::string role, name, serial, until; lines >> role >> name >> serial >> until;) {
    const auto known = ParseRole(role);
    if (known) listed.push_back({*known, name, serial, until, revoked.contains({*known, name, serial})});
  }
  // What an earlier version issued has no line.
  for (const RevokedKeys& keys : revoked)
    if (keys.serial == kNoSerial) listed.push_back({keys.role, keys.name, keys.serial, "", true});
  return listed;
}

fs::path RevokeKeys(const fs::path& directory, Role role, const std::string& name,
                    const std::string& serial) {
  if (!IsName(name)) {
    throw InputError("'" + name + "' cannot be the name of keys",
                     "1 to 31 letters, digits and '-', the first no '-'");
  }
  RequireAuthority(directory);
  const Authority signs = ReadAuthority(directory / "authority");
  Revoked revoked = ReadRevoked(directory), now;
  for (const IssuedKeys& keys : ListKeys(directory))
    if (keys.role == role && keys.name == name && (serial.empty() || keys.serial == serial))
      now.insert({role, name, keys.serial});
  const fs::path identity = directory / "issued" / (std::string(Name(role)) + "-" + name) / kIdentityFile;
  const bool is_of_earlier_version =
      fs::exists(identity) && SubjectOf(ReadCertificate(ReadKeyFile(identity)).get()).serial.empty();
  if (serial == kNoSerial || (serial.empty() && is_of_earlier_version)) now.insert({role, name, kNoSerial});
  if (now.empty()) {
    throw InputError("no keys of the " + std::string(Name(role)) + " '" + name + "'" +
                         (serial.empty() ? "" : " with the serial " + serial) + " were issued here",
                     "keys that `dispersa keys list` prints; --serial - for keys of an earlier version");
  }
  revoked.merge(now);
  WriteRevoked(directory, revoked, signs.permissions);
  return directory / kRevokedFile;
}

}  // namespace dispersa
