#include "services/transport/wire_shape.h"

#include <cstring>

namespace dispersa {
namespace {

/// Walks over a sample without keeping anything of it.
class Walker {
 public:
  Walker(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  /// Walks over the bytes that the shape describes, up to its end or to the closing bracket. `shape` is left
  /// there.
  bool Walk(const char*& shape) {
    for (; *shape != '\0' && *shape != ']'; ++shape) {
      if (!(*shape == '[' ? Sequence(shape) : Scalar(*shape))) return false;
    }
    return true;
  }
  /// Senders may fill up to a multiple of 4 bytes.
  bool AtEnd() const { return size_ - at_ < 4; }

 private:
  bool Scalar(char kind) {
    if (kind == 's') {
      std::uint32_t length = 0;
      // The length counts the zero that ends the text.
      return Count(&length) && length >= 1 && Skip(length, 1) && data_[at_ - 1] == 0;
    }
    const std::size_t size = SizeOf(kind);
    return Skip(size, size);
  }
  bool Sequence(const char*& shape) {
    std::uint32_t count = 0;
    if (!Count(&count)) return false;
    const char* const element = ++shape;
    while (*shape != '\0') {  // to the bracket that closes this one
      if (*shape == '[') {
        const char* inner = shape;
        int depth = 0;
        do {
          depth += *inner == '[' ? 1 : *inner == ']' ? -1 : 0;
          ++inner;
        } while (depth > 0);
        shape = inner;
      } else if (*shape == ']') {
        break;
      } else {
        ++shape;
      }
    }
    if (shape == element + 1 && *element != 's') {  // scalars lie side by side
      const std::size_t size = SizeOf(*element);
      return count == 0 || Skip(size * count, size);
    }
    if (count > size_ - at_) return false;  // no element is smaller than a byte
    for (std::uint32_t i = 0; i < count; ++i) {
      const char* again = element;
      if (!Walk(again)) return false;
    }
    return true;
  }
  bool Count(std::uint32_t* count) {
    if (!Skip(4, 4)) return false;
    std::memcpy(count, data_ + at_ - 4, 4);
    return true;
  }
  bool Skip(std::size_t bytes, std::size_t alignment) {
    const std::size_t begin = (at_ + alignment - 1) / alignment * alignment;
    if (begin > size_ || bytes > size_ - begin) return false;
    at_ = begin + bytes;
    return true;
  }
  static std::size_t SizeOf(char kind) { return kind == 'Q' ? 8 : kind == 'I' ? 4 : 1; }

  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

}  // namespace

bool HasShape(const char* shape, const std::uint8_t* data, std::size_t size) {
  constexpr std::uint8_t kPlainLittleEndian[] = {0, 1};
  constexpr std::size_t kHeader = 4;  // alignment counts from behind it
  if (size < kHeader || size > kMaxSampleBytes || std::memcmp(data, kPlainLittleEndian, 2) != 0) return false;
  Walker walker(data + kHeader, size - kHeader);
  return walker.Walk(shape) && walker.AtEnd();
}

}  // namespace dispersa
