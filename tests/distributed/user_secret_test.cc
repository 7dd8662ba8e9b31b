// The secret that the programs of one user share on a machine, and the files that are accepted for it.
#include "services/transport/user_secret.h"

#include <sys/stat.h>
#include <unistd.h>

#include "home_folder.h"
#include "services/transport/admission.h"
#include "tests/test.h"

namespace dispersa::user_secret_test {

namespace fs = std::filesystem;

class UserSecretTest : public testing::Test {
 protected:
  std::string Refusal() const {
    return ErrorOf<NetworkError>([this] { OpenUserSecret(file()); });
  }
  std::string Expected(const std::string& problem) const { return Expected(problem, file()); }
  static std::string Expected(const std::string& problem, const fs::path& file) {
    return file.string() + ": " + problem +
           ", allowed: a file of this user alone (permissions 600), --keys, or --insecure";
  }
  fs::path file() const { return UserSecretFile(); }

  HomeFolder home_;
};

TEST_F(UserSecretTest, IsDrawnOnceAndForThisUserAlone) {
  EXPECT_EQ(file(), home_ / ".dispersa" / "secret");
  const Secret first = OpenUserSecret(file());
  EXPECT_EQ(OpenUserSecret(file()), first);
  EXPECT_NE(first, Secret{});
  struct stat what {};
  ASSERT_EQ(stat(file().c_str(), &what), 0);
  EXPECT_EQ(what.st_mode & 0777, 0600u);
  EXPECT_EQ(std::distance(fs::directory_iterator(file().parent_path()), fs::directory_iterator()), 1)
      << "no draft";
  fs::remove(file());
  EXPECT_NE(OpenUserSecret(file()), first);
}

TEST_F(UserSecretTest, OfSeveralThatStartAtOnceAllHaveTheSame) {
  std::vector<Secret> secrets(16);
  {
    std::vector<std::jthread> starts;
    for (Secret& secret : secrets) starts.emplace_back([&] { secret = OpenUserSecret(file()); });
  }
  EXPECT_EQ(std::count(secrets.begin(), secrets.end(), secrets[0]), 16);
}

TEST_F(UserSecretTest, AFileThatOthersMayUseIsRefused) {
  OpenUserSecret(file());
  for (const auto& [mode, text] : {std::pair(0644, "644"), std::pair(0640, "640"), std::pair(0602, "602")}) {
    chmod(file().c_str(), static_cast<mode_t>(mode));
    EXPECT_EQ(Refusal(), Expected(std::string("others may use it (permissions ") + text + ")"));
  }
  chmod(file().c_str(), 0600);
  EXPECT_EQ(Refusal(), "none");
}

TEST_F(UserSecretTest, AnothersFileIsRefused) {
  OpenUserSecret(file());
  // Root gives its own away; to anybody else root's is another user's.
  const fs::path anothers = geteuid() == 0 ? file() : fs::path("/etc/passwd");
  if (geteuid() == 0) {
    ASSERT_EQ(chown(anothers.c_str(), 1, static_cast<gid_t>(-1)), 0);
  }
  EXPECT_EQ(ErrorOf([&] { OpenUserSecret(anothers); }), Expected("it belongs to another user", anothers));
}

TEST_F(UserSecretTest, WhatIsNoSecretIsRefused) {
  OpenUserSecret(file());
  for (const std::size_t size : {0, 31, 33}) {
    std::ofstream(file()) << std::string(size, 'x');
    EXPECT_EQ(Refusal(), Expected("it holds no secret of 32 bytes")) << size;
  }
  fs::remove(file());
  std::ofstream(home_ / "elsewhere") << std::string(32, 'x');
  chmod((home_ / "elsewhere").c_str(), 0600);
  fs::create_symlink(home_ / "elsewhere", file());
  EXPECT_EQ(Refusal(), Expected("cannot be read: Too many levels of symbolic links")) << "a link";
  fs::remove(file());
  fs::create_directory(file());
  EXPECT_EQ(Refusal(), Expected("it holds no secret of 32 bytes")) << "a folder";
}

TEST_F(UserSecretTest, IsWantedOnTheLoopbackInterfaceAloneAndNotWithInsecure) {
  const NetworkOptions loopback = Admit({0, "127.0.0.1"}, {}, {Role::kCoordinator});
  ASSERT_TRUE(loopback.secret);
  EXPECT_EQ(*loopback.secret, OpenUserSecret(file()));
  EXPECT_EQ(Admit({0, ""}, {}, {Role::kWorker}, "127.0.0.1").secret, loopback.secret) << "a worker of it";
  EXPECT_EQ(Admit({0, ""}, {}, {Role::kClient}, "localhost").secret, loopback.secret) << "a client of it";
  EXPECT_FALSE(Admit({0, "127.0.0.1"}, {"", true}, {Role::kCoordinator}).secret);
  chmod(file().c_str(), 0644);
  EXPECT_EQ(ErrorOf([] {
              Admit({0, "127.0.0.1"}, {}, {Role::kCoordinator});
            }),
            Expected("others may use it (permissions 644)"));
}

}  // namespace dispersa::user_secret_test
