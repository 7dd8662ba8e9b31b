// Authorities, the keys that they issue, and what a process takes for keys: without a network.
#include "services/transport/key_folder.h"

#include <sys/stat.h>

#include "core/containment/contained.h"
#include "core/input/input_error.h"
#include "home_folder.h"
#include "services/transport/admission.h"
#include "services/transport/authority.h"
#include "services/transport/openssl.h"
#include "services/transport/revocations.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::key_folder_test {

namespace fs = std::filesystem;

constexpr std::time_t kDay_s = 86400;

class KeyFolderTest : public testing::Test {
 protected:
  KeyFolderTest() { MakeAuthority(authority(), ValidFor(30)); }

  fs::path authority() const { return folder_ / "ours"; }
  std::string OpenError(const fs::path& folder, Role role = Role::kWorker) {
    return ErrorOf([&] { OpenKeyFolder(folder, {role}); });
  }
  std::string IssueError(const std::string& name, const Validity& validity = ValidFor(1)) {
    return ErrorOf([&] { IssueKeys(authority(), Role::kWorker, name, validity); });
  }
  fs::path Worker(const std::string& name = "one") {
    return IssueKeys(authority(), Role::kWorker, name, ValidFor(1));
  }
  /// The first digits of the names of participants with these keys.
  static std::string ParticipantOfFolder(const fs::path& folder) {
    return ParticipantsOf(SubjectOf(CertificateIn(folder / kIdentityFile).get())) + "0123456789ab";
  }
  static Certificate CertificateIn(const fs::path& file) { return ReadCertificate(TextOfFile(file)); }
  static void Write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  int takes_ = 0;
  TemporaryFolder folder_;
  std::time_t now_ = std::time(nullptr);
};

TEST_F(KeyFolderTest, IssuedKeysAreThoseOfTheirRoleAndName) {
  for (const Role role : kRoles) {
    const fs::path issued = IssueKeys(authority(), role, "node-1", ValidFor(1));
    EXPECT_EQ(issued, authority() / "issued" / (std::string(Name(role)) + "-node-1"));
    const KeyFolder keys = OpenKeyFolder(issued, {Role::kObserver, role});
    EXPECT_EQ(keys.name, "node-1");
    EXPECT_EQ(keys.role, role);
    EXPECT_EQ(ParseRole(Name(role)), role);
    for (const Role other : kRoles) {
      if (other == role) continue;
      EXPECT_EQ(OpenError(issued, other), issued.string() + ": keys of the " + Name(role) +
                                              " 'node-1'; here those of a " + Name(other) + " are needed");
    }
  }
  EXPECT_EQ(ParseRole("king"), std::nullopt);
}

TEST_F(KeyFolderTest, EveryFileIsTheOwnersAlone) {
  const fs::path issued = Worker();
  int files = 0;
  for (const fs::path& folder : {authority() / "authority", issued}) {
    EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all) << folder;
    for (const fs::directory_entry& file : fs::directory_iterator(folder)) {
      ++files;
      EXPECT_EQ(file.status().permissions(), fs::perms::owner_read | fs::perms::owner_write) << file;
    }
  }
  EXPECT_EQ(files, 5 + 6);
}

TEST_F(KeyFolderTest, AKeyThatOthersCanUseIsRefused) {
  const fs::path issued = Worker(), key = issued / kIdentityKeyFile;
  for (const auto& [mode, text] :
       {std::pair(0644, "644"), std::pair(0604, "604"), std::pair(0620, "620"), std::pair(0601, "601")}) {
    chmod(key.c_str(), static_cast<mode_t>(mode));
    EXPECT_EQ(OpenError(issued), key.string() + ": other users of this machine can use it (mode " + text +
                                     "): `chmod 600` it, and issue new keys if somebody may have read it");
  }
  for (const int mode : {0600, 0400, 0440}) {  // the last: a secret of Kubernetes
    chmod(key.c_str(), static_cast<mode_t>(mode));
    EXPECT_EQ(OpenError(issued), "none") << mode;
  }
}

TEST_F(KeyFolderTest, RevokedKeysAreOnAListThatTheAuthoritySigned) {
  const fs::path main = IssueKeys(authority(), Role::kCoordinator, "main", ValidFor(1));
  Revocations revocations(OpenKeyFolder(main, {Role::kCoordinator}));
  EXPECT_FALSE(revocations.Refresh()) << "there is none";
  const auto take = [&] {
    fs::copy_file(authority() / kRevokedFile, main / kRevokedFile, fs::copy_options::overwrite_existing);
    fs::last_write_time(main / kRevokedFile,
                        fs::file_time_type::clock::now() + std::chrono::seconds(++takes_));
    return revocations.Refresh();
  };
  const std::string node1 = ParticipantOfFolder(IssueKeys(authority(), Role::kWorker, "node1", ValidFor(1))),
                    node2 = ParticipantOfFolder(IssueKeys(authority(), Role::kWorker, "node2", ValidFor(1)));
  const std::string ann =
      ParticipantOfFolder(IssueKeys(authority(), Role::kClient, "ann", ValidFor(1), Right::kAdminister));
  EXPECT_EQ(RevokeKeys(authority(), Role::kWorker, "node1"), authority() / kRevokedFile);
  RevokeKeys(authority(), Role::kClient, "ann");
  EXPECT_TRUE(take());
  EXPECT_FALSE(revocations.Refresh()) << "it is the same";
  EXPECT_TRUE(revocations.IsOf(node1));
  EXPECT_TRUE(revocations.IsOf(ann));
  EXPECT_FALSE(revocations.IsOf(node2));
  // The name may be issued again, and its new keys are good.
  const fs::path again = IssueKeys(authority(), Role::kWorker, "node1", ValidFor(1));
  EXPECT_FALSE(revocations.IsOf(ParticipantOfFolder(again)));
  EXPECT_TRUE(revocations.IsOf(node1));
  EXPECT_EQ(IssueError("node1"), again.string() +
                                     ": these keys exist already and are not overwritten, allowed: "
                                     "another name, or to remove the folder first");
  // Without a serial all keys of the name, with one these alone.
  const auto serials = [&](bool is_revoked) {
    std::vector<std::string> of_node1;
    for (const IssuedKeys& keys : ListKeys(authority()))
      if (keys.name == "node1" && keys.is_revoked == is_revoked) of_node1.push_back(keys.serial);
    return of_node1;
  };
  ASSERT_EQ(serials(true).size(), 1u);
  ASSERT_EQ(serials(false).size(), 1u);
  const std::string old = serials(true)[0], fresh = serials(false)[0];
  EXPECT_EQ(ErrorOf([&] { RevokeKeys(authority(), Role::kWorker, "node3"); }),
            "no keys of the worker 'node3' were issued here, allowed: keys that `dispersa keys list` prints; "
            "--serial - for keys of an earlier version");
  EXPECT_THAT(ErrorOf([&] { RevokeKeys(authority(), Role::kClient, "node1", fresh); }),
              StartsWith("no keys of the client 'node1' with the serial " + fresh + " were issued here"));
  RevokeKeys(authority(), Role::kWorker, "node1", old);
  EXPECT_THAT(serials(false), ElementsAre(fresh)) << "it was revoked already";
  // Neither a list of another authority nor one that was edited.
  MakeAuthority(folder_ / "theirs", ValidFor(30));
  IssueKeys(folder_ / "theirs", Role::kWorker, "node2", ValidFor(1));
  const fs::path theirs = RevokeKeys(folder_ / "theirs", Role::kWorker, "node2");
  std::string edited = TextOfFile(authority() / kRevokedFile);
  edited.replace(edited.find("node1"), 5, "node3");
  for (const std::string& text : {TextOfFile(theirs), edited}) {
    Write(authority() / kRevokedFile, text);
    EXPECT_FALSE(take());
    EXPECT_TRUE(revocations.IsOf(node1)) << "the last good one holds";
    EXPECT_FALSE(revocations.IsOf(node2));
  }
}

TEST(RevocationsTest, ATextIsReadAsItIsWritten) {
  const Revoked revoked = {{Role::kWorker, "a", "0f"}, {Role::kWorker, "a", "1f"}, {Role::kClient, "a", "-"}};
  EXPECT_EQ(RevocationText(revoked), "dispersa revoked keys 2\nworker a 0f\nworker a 1f\nclient a -\n");
  EXPECT_EQ(ParseRevocations("dispersa revoked keys 2\r\nworker a 1f\r\nworker a 0f\r\nclient a -\r\n"),
            revoked);
  EXPECT_EQ(ParseRevocations("dispersa revoked keys 1\r\nclient a\r\n"),
            Revoked({{Role::kClient, "a", "-"}}));
  for (const std::string text : {"", "dispersa revoked keys 3\n"})
    EXPECT_EQ(ErrorOf([&] { ParseRevocations(text); }), "no list of revoked keys");
  for (const std::string line : {"king a 0f", "worker", "worker a", "worker a 0f 1f"})
    EXPECT_EQ(ErrorOf([&] { ParseRevocations("dispersa revoked keys 2\n" + line + "\n"); }),
              "a line is not 'ROLE NAME SERIAL': '" + line + "'");
}

// Both signers, before and after; what each program believes.
TEST_F(KeyFolderTest, TwoAuthoritiesAreBelievedUntilTheOldOneRetires) {
  const fs::path old = Worker();
  const auto copy_authorities = [&](const fs::path& to) {
    for (const char* file : {kIdentityAuthorityFile, kPermissionsAuthorityFile})
      fs::copy_file(authority() / "authority" / file, to / file, fs::copy_options::overwrite_existing);
  };
  EXPECT_EQ(
      ErrorOf([&] { RetireAuthority(authority()); }),
      authority().string() +
          ": has one authority, which issues its keys, allowed: an authority after `dispersa keys renew`");
  const fs::path former = RenewAuthority(authority(), ValidFor(30));
  EXPECT_TRUE(fs::exists(former / "identity_ca.key"));
  EXPECT_THAT(ErrorOf([&] { RenewAuthority(authority(), ValidFor(30)); }),
              HasSubstr("was renewed, and the keys of before are still accepted"));
  const fs::path fresh = IssueKeys(authority(), Role::kWorker, "two", ValidFor(1));
  EXPECT_EQ(OpenError(old), "none") << "it needs nothing";
  EXPECT_EQ(OpenError(fresh), "none");
  copy_authorities(old);
  EXPECT_EQ(OpenError(old), "none");
  const auto first_name = [&](const fs::path& folder) {
    return SubjectOf(CertificateIn(folder / kPermissionsAuthorityFile).get()).name;
  };
  EXPECT_EQ(first_name(fresh), "dispersa permissions");
  RevokeKeys(authority(), Role::kWorker, "two");
  RetireAuthority(authority());
  copy_authorities(fresh);
  EXPECT_EQ(OpenError(fresh), "none");
  EXPECT_EQ(first_name(fresh), "dispersa permissions");
  EXPECT_EQ(ListKeys(authority()).back().is_revoked, true) << "the list is signed again";
  copy_authorities(old);
  EXPECT_EQ(OpenError(old), (old / kIdentityFile).string() + ": not signed by identity_ca.pem");
  // And once more.
  RenewAuthority(authority(), ValidFor(30));
  const fs::path third = IssueKeys(authority(), Role::kWorker, "three", ValidFor(1));
  copy_authorities(fresh);
  RetireAuthority(authority());
  EXPECT_EQ(OpenError(fresh), "none");
  copy_authorities(third);
  EXPECT_EQ(OpenError(third), "none");
  EXPECT_EQ(first_name(third), "dispersa permissions");
}

TEST_F(KeyFolderTest, NothingIsOverwritten) {
  const fs::path issued = Worker();
  const std::string key = TextOfFile(issued / kIdentityKeyFile);
  EXPECT_EQ(IssueError("one"), issued.string() +
                                   ": these keys exist already and are not overwritten, allowed: another "
                                   "name, or to remove the folder first");
  EXPECT_EQ(TextOfFile(issued / kIdentityKeyFile), key);
  EXPECT_EQ(ErrorOf([&] { MakeAuthority(authority(), ValidFor(1)); }),
            (authority() / "authority").string() +
                ": there is an authority already, and it is not overwritten, allowed: another folder");
  EXPECT_EQ(OpenError(issued), "none");
}

TEST_F(KeyFolderTest, ANameIsWhatAPartitionAndAFolderCanHave) {
  for (const std::string& name :
       {std::string("a"), std::string("Node-9"), std::string(31, 'x'), std::string("0-")})
    EXPECT_EQ(IssueError(name), "none") << name;
  for (const std::string& name : {std::string(), std::string("-a"), std::string("a_b"), std::string("../a"),
                                  std::string("a*"), std::string("a b"), std::string(32, 'x')}) {
    EXPECT_EQ(IssueError(name),
              "'" + name +
                  "' cannot be the name of keys, allowed: 1 to 31 letters, digits and '-', the first no '-'");
  }
}

TEST_F(KeyFolderTest, KeysEndWithTheirAuthority) {
  const auto end_of = [&](const std::string& name) {
    return EndOf(CertificateIn(authority() / "issued" / ("worker-" + name) / kIdentityFile).get());
  };
  const std::time_t end = EndOf(CertificateIn(authority() / "authority" / kIdentityAuthorityFile).get());
  const auto until = [&](std::time_t when) { return Validity{now_ - kDay_s, when}; };
  EXPECT_EQ(IssueError("earlier", until(end - 5)), "none");
  EXPECT_EQ(end_of("earlier"), end - 5);
  // Made today for as many days as the authority of this morning.
  EXPECT_EQ(IssueError("as-long", until(end + kDay_s)), "none");
  EXPECT_EQ(end_of("as-long"), end);
  EXPECT_EQ(IssueError("longer", until(end + kDay_s + 1)),
            (authority() / "authority").string() +
                ": the authority is valid for fewer days than the keys would be, allowed: fewer days, or a "
                "new authority");
}

TEST_F(KeyFolderTest, TheSignerOfPermissionsSignsNoCertificates) {
  const fs::path folder = authority() / "authority";
  const Certificate signer = CertificateIn(folder / kPermissionsAuthorityFile);
  const PrivateKey key = ReadPrivateKey(TextOfFile(folder / "permissions_ca.key"));
  const PrivateKey own = MakePrivateKey();
  const Certificate forged = MakeCertificate({{"one", "worker"}, false, now_ - kDay_s, now_ + kDay_s},
                                             own.get(), signer.get(), key.get());
  EXPECT_FALSE(IsSignedBy(forged.get(), signer.get()));
  // Nor does whoever has keys.
  const fs::path issued = Worker();
  const Certificate identity = CertificateIn(issued / kIdentityFile);
  const PrivateKey identity_key = ReadPrivateKey(TextOfFile(issued / kIdentityKeyFile));
  const Certificate below = MakeCertificate({{"two", "coordinator"}, false, now_ - kDay_s, now_ + kDay_s},
                                            own.get(), identity.get(), identity_key.get());
  EXPECT_FALSE(IsSignedBy(below.get(), identity.get()));
}

// A folder whose files are made here, one of them wrong.
class MadeUpKeys : public KeyFolderTest {
 protected:
  struct Signer {
    Certificate certificate;
    PrivateKey key;
  };
  Signer MakeSigner(bool is_authority, std::time_t from, std::time_t to) const {
    Signer signer{nullptr, MakePrivateKey()};
    signer.certificate =
        MakeCertificate({{"made up", ""}, is_authority, from, to}, signer.key.get(), nullptr, nullptr);
    return signer;
  }
  /// Good keys, but that each certificate is valid in its own time: days from now.
  struct Days {
    int from, to;
  };
  fs::path MakeKeys(Days identities, Days permissions, Days identity) {
    const auto at = [&](int day) { return now_ + day * kDay_s; };
    const Signer ca = MakeSigner(true, at(identities.from), at(identities.to));
    const Signer signer = MakeSigner(false, at(permissions.from), at(permissions.to));
    const PrivateKey key = MakePrivateKey();
    const Certificate own = MakeCertificate({{"one", "worker"}, false, at(identity.from), at(identity.to)},
                                            key.get(), ca.certificate.get(), ca.key.get());
    const fs::path keys = folder_ / "made_up";
    fs::remove_all(keys);
    fs::create_directories(keys);
    const auto sign = [&](const std::string& text) {
      return SignDocument(text, signer.certificate.get(), signer.key.get());
    };
    Write(keys / kIdentityAuthorityFile, ToPem(ca.certificate.get()));
    Write(keys / kPermissionsAuthorityFile, ToPem(signer.certificate.get()));
    Write(keys / kIdentityFile, ToPem(own.get()));
    Write(keys / kIdentityKeyFile, ToPem(key.get()));
    chmod((keys / kIdentityKeyFile).c_str(), 0600);
    Write(keys / kGovernanceFile, sign(GovernanceDocument()));
    Write(keys / kPermissionsFile, sign(PermissionsDocument(Role::kWorker, "one", Right::kRun,
                                                            SubjectText(own.get()), at(-1), at(1))));
    return keys;
  }
};

TEST_F(MadeUpKeys, AnExpiredFileIsNamedWithItsDateAndARemedy) {
  const Days good{-2, 2}, past{-9, -1}, coming{1, 9};
  EXPECT_EQ(OpenError(MakeKeys(good, good, good)), "none");
  const std::string made_up = (folder_ / "made_up").string();
  const auto expired = [&](const char* file, const char* remedy) {
    return made_up + "/" + file + ": expired on [0-9: -]+ UTC: " + remedy + "$";
  };
  EXPECT_THAT(OpenError(MakeKeys(past, good, good)),
              ContainsRegex(expired(kIdentityAuthorityFile, "make a new authority")));
  EXPECT_THAT(OpenError(MakeKeys(good, past, good)),
              ContainsRegex(expired(kPermissionsAuthorityFile, "make a new authority")));
  EXPECT_THAT(OpenError(MakeKeys(good, good, past)), ContainsRegex(expired(kIdentityFile, "issue new keys")));
  const std::string clock = " on: the clock of this machine may be wrong";
  for (const auto& [file, keys] : {std::pair(kIdentityAuthorityFile, std::array{coming, good, good}),
                                   std::pair(kPermissionsAuthorityFile, std::array{good, coming, good}),
                                   std::pair(kIdentityFile, std::array{good, good, coming})}) {
    const std::string error = OpenError(MakeKeys(keys[0], keys[1], keys[2]));
    EXPECT_THAT(error, HasSubstr(std::string(file) + ": is valid from "));
    EXPECT_THAT(error, EndsWith(clock));
  }
}

TEST_F(KeyFolderTest, ADamagedOrForeignFileIsNamed) {
  MakeAuthority(folder_ / "foreign", ValidFor(30));
  const fs::path foreign = IssueKeys(folder_ / "foreign", Role::kWorker, "one", ValidFor(1));
  const fs::path other = Worker("other"), keys = Worker();
  const auto with = [&](const char* file, const std::string& text) {
    const std::string good = TextOfFile(keys / file);
    Write(keys / file, text);
    const std::string error = OpenError(keys);
    Write(keys / file, good);
    return error;
  };
  const auto from = [&](const char* file, const fs::path& folder) {
    return with(file, TextOfFile(folder / file));
  };
  const auto problem = [&](const char* file, const std::string& what) {
    return (keys / file).string() + ": " + what;
  };
  const std::string unsigned_text = "the signature does not fit: damaged, or of another authority";
  EXPECT_EQ(with(kIdentityFile, "x"), problem(kIdentityFile, "no certificate in PEM"));
  EXPECT_EQ(with(kIdentityKeyFile, "x"), problem(kIdentityKeyFile, "no private key in PEM"));
  EXPECT_EQ(with(kGovernanceFile, "x"), problem(kGovernanceFile, "no signed document"));
  EXPECT_EQ(from(kIdentityKeyFile, other), problem(kIdentityKeyFile, "not the key of identity.pem"));
  EXPECT_EQ(from(kIdentityAuthorityFile, foreign), problem(kIdentityFile, "not signed by identity_ca.pem"));
  EXPECT_EQ(from(kGovernanceFile, foreign), problem(kGovernanceFile, unsigned_text));
  EXPECT_EQ(from(kPermissionsFile, foreign), problem(kPermissionsFile, unsigned_text));
  EXPECT_EQ(from(kPermissionsFile, other),
            problem(kPermissionsFile, "not the permissions of the owner of identity.pem"));
  std::string edited = TextOfFile(keys / kPermissionsFile);
  edited.replace(edited.find("ReportV3"), 8, "OrdersV1");
  EXPECT_EQ(with(kPermissionsFile, edited), problem(kPermissionsFile, unsigned_text));
  EXPECT_EQ(OpenError(keys), "none");
  fs::remove(keys / kGovernanceFile);
  EXPECT_EQ(OpenError(keys),
            problem(kGovernanceFile,
                    "file not found, allowed: a folder with all files that `dispersa keys issue` made"));
  EXPECT_EQ(OpenError(folder_ / "none"),
            (folder_ / "none").string() + ": no folder: give a folder that `dispersa keys issue` made");
  EXPECT_EQ(OpenError(authority()),
            authority().string() +
                ": the folder of the authority, which signs and does not speak: give one of " +
                (authority() / "issued").string());
  const fs::path secret = authority() / "authority" / "identity_ca.key";
  fs::remove(secret);
  EXPECT_EQ(IssueError("three"),
            (authority() / "authority").string() + ": the authority cannot sign: " + secret.string() +
                ": file not found, allowed: a folder with all files that `dispersa keys init` made");
}

/// "publish: topic... in partition", one a line.
std::string RulesIn(const std::string& document) {
  std::string rules;
  for (std::size_t at = 0; (at = document.find("<allow_rule>", at)) != std::string::npos; ++at) {
    const std::string rule = document.substr(at, document.find("</allow_rule>", at) - at);
    rules += rule.find("<publish>") != std::string::npos ? "publish" : "subscribe";
    const auto each = [&rule](const std::string& tag) {
      std::string all;
      const std::string open = "<" + tag + ">";
      for (std::size_t from = 0; (from = rule.find(open, from)) != std::string::npos;) {
        from += open.size();
        all += " " + rule.substr(from, rule.find("</" + tag, from) - from);
      }
      return all;
    };
    rules += each("topic") + " in" + each("partition") + "\n";
  }
  return rules;
}

// The table of services/README.md.
TEST(Permissions, EachRoleMayWhatItNeeds) {
  const auto rules = [](Role role) {
    return RulesIn(PermissionsDocument(role, "node1", Right::kRead, "CN=node1", 0, kDay_s));
  };
  const std::string t = " dispersa/";
  EXPECT_EQ(rules(Role::kWorker), "publish" + t + "WorkerStatusV2" + t + "ReportV3" + t + "TextRequestV1" +
                                      t + "CampaignRefusalV2 in wnode1_*\nsubscribe" + t + "OrdersV1" + t +
                                      "TextV1 in wnode1_*\n");
  EXPECT_EQ(rules(Role::kClient), "publish" + t + "RequestV1 in w_read_node1_*\nsubscribe" + t +
                                      "ReplyV1 in w_read_node1_*\nsubscribe" + t + "ProgressV1" + t +
                                      "ResultV2 in \n");
  EXPECT_EQ(rules(Role::kObserver), "subscribe" + t + "ProgressV1" + t + "ResultV2 in \n");
  EXPECT_EQ(rules(Role::kCoordinator), "publish" + t + "ProgressV1" + t + "ResultV2 in \npublish" + t +
                                           "OrdersV1" + t + "TextV1" + t + "ReplyV1 in w*\nsubscribe" + t +
                                           "WorkerStatusV2" + t + "ReportV3" + t + "TextRequestV1" + t +
                                           "CampaignRefusalV2" + t + "RequestV1 in *\npublish" + t +
                                           "RequestV1 in wnode1_*\nsubscribe" + t + "ReplyV1 in wnode1_*\n");
}

TEST(Permissions, AreOfTheirOwnerInTheirTimeAndNobodyElses) {
  const std::string document =
      PermissionsDocument(Role::kWorker, "a", Right::kRun, "CN=a,OU=worker", 0, 2 * kDay_s);
  for (const char* part :
       {"<subject_name>CN=a,OU=worker</subject_name>", "<not_before>1970-01-01T00:00:00</not_before>",
        "<not_after>1970-01-03T00:00:00</not_after>", "<default>DENY</default>"})
    EXPECT_THAT(document, HasSubstr(part));
  EXPECT_EQ(OwnPrefix("node1"), "node1_") << "else node1 could speak for node10";
}

TEST(Permissions, AClientsNameSaysItsKeysAndWhatTheyMay) {
  for (const Right right : kRights) {
    const std::string who = ClientPrefix("ann-1", right) + "0123";
    EXPECT_EQ(RightOf(who), right);
    EXPECT_EQ(KeyNameOf(who), "ann-1");
    EXPECT_EQ(AccountOf(who), "ann-1");
    EXPECT_EQ(ParseRight(Name(right)), right);
  }
  EXPECT_EQ(ParseRight("all"), std::nullopt);
  // Of keys of an earlier version, of none, and names that claim a right without being such a name.
  EXPECT_EQ(RightOf("ann_0123"), Right::kRun);
  EXPECT_EQ(KeyNameOf("ann_0123"), "ann");
  EXPECT_EQ(KeyNameOf("0123"), "");
  for (const char* who : {"administer_0123", "_administer", "_all_ann_0123", "administer_ann_0123"})
    EXPECT_EQ(RightOf(who), Right::kRun) << who;
}

TEST_F(KeyFolderTest, TheRightOfAClientIsInItsCertificateAndInItsPermissions) {
  const auto issue = [&](const std::string& name, Right right) {
    return OpenKeyFolder(IssueKeys(authority(), Role::kClient, name, ValidFor(1), right), {Role::kClient});
  };
  for (const Right right : kRights) {
    const std::string name = std::string("of-") + Name(right);
    const KeyFolder keys = issue(name, right);
    EXPECT_EQ(keys.right, right);
    EXPECT_EQ(keys.name, name);
    NetworkOptions network;
    network.keys = keys;
    EXPECT_EQ(NameOnNetwork(network, "0123"), std::string("_") + Name(right) + "_" + name + "_0123");
  }
  EXPECT_EQ(OpenKeyFolder(Worker("node1"), {Role::kWorker}).right, std::nullopt);
}

TEST_F(KeyFolderTest, WithoutKeysOnlyThisMachineIsSpokenTo) {
  const HomeFolder home;
  const auto admit = [](const std::string& address, const std::string& peer, bool insecure = false) {
    return Admit({0, address}, {"", insecure}, {Role::kWorker}, peer).address;
  };
  EXPECT_EQ(admit("", "127.0.0.1"), "127.0.0.1") << "the loopback interface alone";
  EXPECT_EQ(admit("", "localhost"), "127.0.0.1");
  EXPECT_EQ(admit("127.0.0.2", "127.9.9.9"), "127.0.0.2");
  EXPECT_EQ(admit("127.0.0.1", ""), "127.0.0.1") << "a coordinator";
  EXPECT_EQ(admit("", "host", true), "");
  const auto refused = [&](const std::string& address, const std::string& peer) {
    return ErrorOf([&] { admit(address, peer); });
  };
  for (const auto& [address, peer] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {"", "host"},
                                                        {"", "127.evil.example"},
                                                        {"", "127.0.0.1.example"},
                                                        {"127.0.0.1", "host"},
                                                        {"10.0.0.1", "127.0.0.1"},
                                                        {"10.0.0.1", ""}}) {
    EXPECT_THAT(refused(address, peer), HasSubstr("a network beyond this machine needs keys"))
        << address << " " << peer;
  }
}

TEST(Admission, PlugInsNeedLeave) {
  const std::string digest(64, 'a'), other(64, 'b');
  const auto refusal = [&](bool allowed) {
    RefusePlugins("");
    AdmitPlugins(allowed);
    return PluginRefusal(digest);
  };
  EXPECT_EQ(refusal(false), "is a shared object; this program runs shared objects only with --allow-plugins");
  EXPECT_EQ(refusal(true), "");
  RefusePlugins("is another one", {digest});
  EXPECT_EQ(PluginRefusal(digest), "");
  EXPECT_EQ(PluginRefusal(other), "is another one");
  RefusePlugins("");
}

TEST_F(KeyFolderTest, KeysAreNamedAndExcludeTheirAbsence) {
  const fs::path keys = Worker("node1");
  const NetworkOptions network = Admit({0, ""}, {keys.string()}, {Role::kWorker}, "host");
  EXPECT_EQ(network.keys->name, "node1");
  EXPECT_EQ(NameOnNetwork(network, "u"), "node1_u");
  EXPECT_EQ(NameOnNetwork({0, ""}, "u"), "u");
  EXPECT_EQ(ErrorOf([&] {
              Admit({0, ""}, {keys.string(), true}, {Role::kWorker}, "host");
            }),
            "--keys and --insecure exclude each other");
  EXPECT_THAT(ErrorOf([&] {
                Admit({0, ""}, {keys.string()}, {Role::kClient}, "host");
              }),
              HasSubstr("keys of the worker 'node1'; here those of a client are needed"));
}

}  // namespace dispersa::key_folder_test
