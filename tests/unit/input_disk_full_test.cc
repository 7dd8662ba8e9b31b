// The words for a disk that is full for this process.
#include "core/input/disk_full.h"
#include "tests/test.h"

namespace dispersa::input_disk_full_test {
namespace {

TEST(DiskFull, HasTheSameWordsForEachLimitAndNamesIt) {
  EXPECT_EQ(DiskFullWords(ENOSPC), "no space left on the disk");
  EXPECT_EQ(DiskFullWords(EDQUOT), "no space left on the disk: the quota is used up");
  EXPECT_EQ(DiskFullWords(EFBIG),
            "no space left on the disk: a file has reached its limit (`ulimit -f`, or the file system's)");
  for (const int full : {EMFILE, ENFILE})
    EXPECT_EQ(DiskFullWords(full), "too many files are open (`ulimit -n`, LimitNOFILE of a unit)");
  for (const int other : {0, EIO, EACCES, EROFS, ENOENT, ENOMEM})
    EXPECT_EQ(DiskFullWords(other), std::nullopt);
}

}  // namespace
}  // namespace dispersa::input_disk_full_test
