// A law that writes outside its memory is detected, or its process ends.
#include "core/control/law_memory.h"
#include "tests/test.h"

namespace dispersa::control_law_memory_test {
namespace {

constexpr std::size_t kSizes[] = {0, 1, 8, 63, 64, 100, 4032, 4096, 5000, 1 << 20};

unsigned char* BytesOf(const LawMemory& memory) { return static_cast<unsigned char*>(memory.get()); }

TEST(LawMemory, IsAlignedAndZeroAndSound) {
  for (const std::size_t size : kSizes) {
    const LawMemory memory(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory.get()) % 64, 0u);
    EXPECT_TRUE(
        std::all_of(BytesOf(memory), BytesOf(memory) + size, [](unsigned char byte) { return byte == 0; }));
    std::fill(BytesOf(memory), BytesOf(memory) + size, static_cast<unsigned char>(1));
    EXPECT_TRUE(memory.IsSound() && memory.IsSoundNearby()) << size;
  }
}

TEST(LawMemory, SeesWhatIsWrittenBesideIt) {
  for (const std::size_t size : kSizes) {
    for (const std::ptrdiff_t before : {1, 8}) {
      const LawMemory memory(size);
      BytesOf(memory)[-before] = 1;
      EXPECT_FALSE(memory.IsSoundNearby()) << size;
      EXPECT_FALSE(memory.IsSound()) << size;
    }
    const LawMemory memory(size);
    BytesOf(memory)[-64] = 1;
    EXPECT_FALSE(memory.IsSound()) << size;
    if (size % 64 == 0) continue;
    const LawMemory behind(size);
    BytesOf(behind)[size] = 1;
    EXPECT_FALSE(behind.IsSoundNearby()) << size;
    EXPECT_FALSE(behind.IsSound()) << size;
  }
}

TEST(LawMemory, EndsWhoWritesFarBesideIt) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{64}, std::size_t{100}}) {
    const LawMemory memory(size);
    EXPECT_EXIT(BytesOf(memory)[(size + 63) / 64 * 64] = 1, testing::KilledBySignal(SIGSEGV), "");
    EXPECT_EXIT(BytesOf(memory)[-4097] = 1, testing::KilledBySignal(SIGSEGV), "");
  }
}

}  // namespace
}  // namespace dispersa::control_law_memory_test
