// Whose ledger of attempts is read and written, and which files are none.
#include "core/results/attempt_ledger.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/results/result_error.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::results_attempt_ledger_test {

namespace fs = std::filesystem;

class AttemptLedgers : public testing::Test {
 protected:
  static std::string WhyNot(const fs::path& file) {
    const AttemptLedger ledger(file);
    AttemptRecord record;
    record.id = "a";
    const std::string unread = ErrorOf<ResultError>([&] { ledger.Read(); });
    EXPECT_EQ(ErrorOf<ResultError>([&] { ledger.Write(record); }), unread);
    return unread;
  }
  static std::size_t Kept(const fs::path& file) {
    AttemptRecord record;
    record.id = "a";
    AttemptLedger(file).Write(record);
    return AttemptLedger(file).Read().size();
  }

  const TemporaryFolder temporary_;
  const fs::path file_ = temporary_ / kLedgerName;
};

TEST_F(AttemptLedgers, AreRegularFilesAndNothingWaits) {
  const std::string rule = " and no regular file, allowed: a file, or none";
  std::ofstream(temporary_ / "elsewhere") << "";
  fs::create_symlink(temporary_ / "elsewhere", file_);
  EXPECT_EQ(WhyNot(file_), file_.string() + ": is a link" + rule);
  EXPECT_EQ(TextOfFile(temporary_ / "elsewhere"), "");
  fs::remove(file_);
  fs::create_symlink(temporary_ / "none", file_);
  EXPECT_EQ(WhyNot(file_), file_.string() + ": is a link" + rule);
  EXPECT_FALSE(fs::exists(temporary_ / "none"));
  fs::remove(file_);
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_EQ(WhyNot(file_), file_.string() + ": is a pipe" + rule);
  EXPECT_EQ(WhyNot("/dev/null"), "/dev/null: is a device" + rule);
  fs::remove(file_);
  EXPECT_EQ(Kept(file_), 1u);
}

TEST_F(AttemptLedgers, OfANeighbourInAFolderOfEverybodyAreNotUsed) {
  const uid_t nobody = 65534;
  EXPECT_EQ(Kept(file_), 1u);
  ASSERT_EQ(chmod(temporary_.path().c_str(), 01777), 0);
  EXPECT_EQ(Kept(file_), 1u) << "one's own";
  // Only root can give a file away. For others the checks above stand alone.
  if (chown(file_.c_str(), nobody, nobody) != 0) return;
  EXPECT_EQ(WhyNot(file_),
            file_.string() +
                ": belongs to another user (number 65534), and everybody may write its folder, allowed: "
                "a result folder in a folder of your own");
  ASSERT_EQ(chmod(temporary_.path().c_str(), 0775), 0);
  EXPECT_EQ(Kept(file_), 1u) << "a folder of a team";
}

}  // namespace dispersa::results_attempt_ledger_test
