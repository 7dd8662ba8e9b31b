// The memory of a flight for a law that may write beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace dispersa {

/// Zeros, aligned to 64 bytes, between two guard pages: touching them ends the process. The space between the
/// block and those pages is checked for writes: less than 64 bytes behind it, a page before it.
class LawMemory {
 public:
  /// Throws std::bad_alloc.
  explicit LawMemory(std::size_t bytes);
  ~LawMemory();
  LawMemory(const LawMemory&) = delete;
  LawMemory& operator=(const LawMemory&) = delete;

  void* get() const { return block_; }
  /// Whether the bytes after the block and the 8 bytes before it are unchanged. Cheap enough for each call.
  bool IsSoundNearby() const {
    std::uint64_t before;
    std::memcpy(&before, block_ - sizeof before, sizeof before);
    return before == kUnwritten && (bytes_ == size_of_block_ || IsSoundBehind());
  }
  /// Whether everything between the pages and the block is unchanged.
  bool IsSound() const;

 private:
  static constexpr std::uint64_t kUnwritten = 0xa5a5a5a5a5a5a5a5;

  bool IsSoundBehind() const;

  unsigned char* pages_ = nullptr;  ///< the first is forbidden, the last too
  std::size_t size_ = 0;            ///< of all
  unsigned char* block_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t size_of_block_ = 0;  ///< up to the page
};

}  // namespace dispersa
