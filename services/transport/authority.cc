#include "services/transport/authority.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <stdexcept>
#include <system_error>

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

void WriteNew(const fs::path& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
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
    for (const auto& [name, text] : files) WriteNew(fs::path(draft) / name, text);
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

Signer ReadSigner(const fs::path& directory, const char* certificate, const char* key) {
  return {ReadCertificate(ReadKeyFile(directory / certificate, kMaker)),
          ReadPrivateKey(ReadKeyFile(directory / key, kMaker))};
}

struct Authority {
  Signer identities, permissions;
  std::string governance;
};

Authority ReadAuthority(const fs::path& folder) {
  try {
    return {ReadSigner(folder, kIdentityAuthorityFile, kIdentityAuthorityKeyFile),
            ReadSigner(folder, kPermissionsAuthorityFile, kPermissionsAuthorityKeyFile),
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
    const Certificate signer =
        ReadCertificate(ReadKeyFile(directory / "authority" / kPermissionsAuthorityFile, kMaker));
    return ParseRevocations(VerifiedDocument(ReadKeyFile(file), signer.get()));
  } catch (const std::runtime_error& error) {
    Refuse(file, std::string("the list of revoked keys cannot be read: ") + error.what());
  }
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
  const Signer identity = NewSigner("dispersa identities", true, validity);
  // Signs documents itself and no certificates: nobody else can ever sign permissions.
  const Signer permissions = NewSigner("dispersa permissions", false, validity);
  MakeFolder(folder, {{kIdentityAuthorityFile, ToPem(identity.certificate.get())},
                      {kIdentityAuthorityKeyFile, ToPem(identity.key.get())},
                      {kPermissionsAuthorityFile, ToPem(permissions.certificate.get())},
                      {kPermissionsAuthorityKeyFile, ToPem(permissions.key.get())},
                      {kGovernanceFile, SignDocument(GovernanceDocument(), permissions.certificate.get(),
                                                     permissions.key.get())}});
}

fs::path IssueKeys(const fs::path& directory, Role role, const std::string& name, const Validity& asked,
                   Right right) {
  if (!IsName(name)) {
    throw InputError("'" + name + "' cannot be the name of keys",
                     "1 to 31 letters, digits and '-', the first no '-'");
  }
  const fs::path authority = directory / "authority";
  if (!fs::is_directory(authority)) {
    Refuse(directory, "no authority", "a folder that `dispersa keys init` made");
  }
  const fs::path folder = directory / "issued" / (std::string(Name(role)) + "-" + name);
  const Revoked revoked = ReadRevoked(directory);
  if (const auto names = revoked.find(role); names != revoked.end() && names->second.contains(name)) {
    throw InputError("the keys of the " + std::string(Name(role)) + " '" + name + "' are revoked",
                     "another name");
  }
  if (fs::exists(folder)) {
    Refuse(folder, "these keys exist already and are not overwritten",
           "another name, or to remove the folder first");
  }
  const auto [identities, signer, governance] = ReadAuthority(authority);
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
  const Certificate identity = MakeCertificate({{name, unit}, false, validity.not_before, validity.not_after},
                                               key.get(), identities.certificate.get(), identities.key.get());
  // The certificate's dates are what ends it: those of permissions are read in the local time of whoever
  // checks them.
  const std::string permissions =
      PermissionsDocument(role, name, right, SubjectText(identity.get()), validity.not_before - kDay_s,
                          validity.not_after + kDay_s);
  MakeFolder(folder,
             {{kIdentityAuthorityFile, ToPem(identities.certificate.get())},
              {kPermissionsAuthorityFile, ToPem(signer.certificate.get())},
              {kGovernanceFile, governance},
              {kIdentityFile, ToPem(identity.get())},
              {kIdentityKeyFile, ToPem(key.get())},
              {kPermissionsFile, SignDocument(permissions, signer.certificate.get(), signer.key.get())}});
  return folder;
}

fs::path RevokeKeys(const fs::path& directory, Role role, const std::string& name) {
  if (!IsName(name)) {
    throw InputError("'" + name + "' cannot be the name of keys",
                     "1 to 31 letters, digits and '-', the first no '-'");
  }
  const fs::path authority = directory / "authority";
  if (!fs::is_directory(authority)) {
    Refuse(directory, "no authority", "a folder that `dispersa keys init` made");
  }
  const Authority signs = ReadAuthority(authority);
  Revoked revoked = ReadRevoked(directory);
  revoked[role].insert(name);
  // In the place of the last list, as a whole.
  const fs::path file = directory / kRevokedFile, draft = file.string() + ".new";
  std::error_code error;
  fs::remove(draft, error);
  WriteNew(draft, SignDocument(RevocationText(revoked), signs.permissions.certificate.get(),
                               signs.permissions.key.get()));
  fs::rename(draft, file, error);
  if (error) Refuse(file, "cannot be written: " + error.message());
  return file;
}

}  // namespace dispersa
