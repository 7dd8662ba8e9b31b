// Table rows on whole cache lines.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace dispersa {

/// Two neighbouring cache lines: a row of 16 doubles.
inline constexpr std::size_t kRowAlignment = 128;

template <class T>
struct RowAllocator {
  using value_type = T;
  RowAllocator() = default;
  template <class U>
  RowAllocator(const RowAllocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(kRowAlignment)));
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(kRowAlignment)); }
  bool operator==(const RowAllocator&) const { return true; }
};

using AlignedRows = std::vector<double, RowAllocator<double>>;

}  // namespace dispersa
