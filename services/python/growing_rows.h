// A buffer that grows without being copied: the kernel moves its pages.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

namespace dispersa {

/// Doubles, appended. Only pages that were written take memory. Throws std::bad_alloc.
class GrowingRows {
 public:
  GrowingRows()
      : capacity_(kLeastBytes),
        data_(Mapped(mmap(nullptr, capacity_, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0))) {}
  GrowingRows(GrowingRows&& other) noexcept
      : capacity_(other.capacity_), data_(std::exchange(other.data_, nullptr)), size_(other.size_) {}
  GrowingRows& operator=(GrowingRows&&) = delete;
  ~GrowingRows() {
    if (data_ != nullptr) munmap(data_, capacity_);
  }

  double* data() const { return data_; }
  std::size_t size() const { return size_; }
  /// Adds room for `count` doubles at the end. The caller fills it.
  double* Extend(std::size_t count) {
    const std::size_t needed = (size_ + count) * sizeof(double);
    if (needed > capacity_) {
      const std::size_t capacity = std::max(2 * capacity_, needed);
      data_ = Mapped(mremap(data_, capacity_, capacity, MREMAP_MAYMOVE));
      capacity_ = capacity;
    }
    size_ += count;
    return data_ + size_ - count;
  }

 private:
  static constexpr std::size_t kLeastBytes = 1 << 20;

  static double* Mapped(void* address) {
    if (address == MAP_FAILED) throw std::bad_alloc();
    return static_cast<double*>(address);
  }

  std::size_t capacity_;  ///< bytes
  double* data_;
  std::size_t size_ = 0;
};

}  // namespace dispersa
