#include "core/control/law_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <new>

namespace dispersa {
namespace {

constexpr std::size_t kAlignment = 64;

std::size_t PageSize() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

std::size_t RoundedUp(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

}  // namespace

// The block ends where the last page begins, up to its alignment: most who write beside it write behind it.
LawMemory::LawMemory(std::size_t bytes) : bytes_(bytes), size_of_block_(RoundedUp(bytes, kAlignment)) {
  const std::size_t page = PageSize();
  size_ = RoundedUp(size_of_block_ + kAlignment, page) + 2 * page;
  void* const pages = mmap(nullptr, size_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  pages_ = static_cast<unsigned char*>(pages);
  if (mprotect(pages_ + page, size_ - 2 * page, PROT_READ | PROT_WRITE) != 0) {
    munmap(pages_, size_);
    throw std::bad_alloc();
  }
  block_ = pages_ + size_ - page - size_of_block_;
  std::fill(pages_ + page, block_, static_cast<unsigned char>(kUnwritten));
  std::fill(block_ + bytes, block_ + size_of_block_, static_cast<unsigned char>(kUnwritten));
}

LawMemory::~LawMemory() { munmap(pages_, size_); }

bool LawMemory::IsSoundBehind() const {
  return std::all_of(block_ + bytes_, block_ + size_of_block_,
                     [](unsigned char byte) { return byte == static_cast<unsigned char>(kUnwritten); });
}

bool LawMemory::IsSound() const {
  for (const unsigned char* at = pages_ + PageSize(); at < block_; at += sizeof kUnwritten)
    if (std::memcmp(at, &kUnwritten, sizeof kUnwritten) != 0) return false;
  return IsSoundBehind();
}

}  // namespace dispersa
