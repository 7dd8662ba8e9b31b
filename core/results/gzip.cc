#include "core/results/gzip.h"

#include <zlib.h>

#include <array>
#include <memory>
#include <new>

namespace dispersa {
namespace {

constexpr int kGzipHeader = 15 + 16, kMemory = 8;
/// For numbers of which most digits are noise: the best level takes twice as long for a fiftieth less.
constexpr int kLevel = 4, kStrategy = Z_FILTERED;

using Step = int (*)(z_stream*, int);
using End = int (*)(z_stream*);

/// All that a stream makes of the bytes; none unless it ends where they do.
std::optional<std::string> Through(z_stream& stream, Step step, End end, std::string_view bytes) {
  const std::unique_ptr<z_stream, End> ends(&stream, end);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string made;
  std::array<char, 64 << 10> out;
  int code = Z_OK;
  while (code == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = out.size();
    code = step(&stream, Z_FINISH);
    const std::size_t count = out.size() - stream.avail_out;
    made.append(out.data(), count);
    if (code == Z_BUF_ERROR && count > 0) code = Z_OK;  // the buffer was full
  }
  if (code != Z_STREAM_END || stream.avail_in > 0) return std::nullopt;
  return made;
}

}  // namespace

std::string Gzip(std::string_view text) {
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipHeader, kMemory, kStrategy) != Z_OK)
    throw std::bad_alloc();
  return Through(stream, deflate, deflateEnd, text).value();
}

std::optional<std::string> Gunzip(std::string_view bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, kGzipHeader) != Z_OK) throw std::bad_alloc();
  return Through(stream, inflate, inflateEnd, bytes);
}

}  // namespace dispersa
