// Proof that a message comes from a process with the same secret: `dispersa run` and its children communicate
// where every user of the machine can.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace dispersa {

using Secret = std::array<std::uint8_t, 32>;

/// From the kernel's generator.
Secret DrawSecret();

/// A sample ends with its seal: its writer, its number, and a code over both, its topic and its content (HMAC
/// with SHA-256, the first 128 bits). Nobody can make the code without the secret. So a sample counts once
/// (numbers must grow), on its topic, and from its writer. A seal hides nothing, and it does not prevent
/// disturbance. Thread-safe.
class Seal {
 public:
  /// A writer, by the middleware's name for it.
  using Writer = std::array<std::uint8_t, 16>;
  struct Origin {
    Writer writer{};
    std::uint64_t number = 0;

    bool operator==(const Origin&) const = default;
  };
  static constexpr std::size_t kSize = sizeof(Writer) + sizeof(std::uint64_t) + 16;

  explicit Seal(const Secret& secret);
  ~Seal();
  Seal(const Seal&) = delete;
  Seal& operator=(const Seal&) = delete;

  /// Writes the seal of a content behind it, kSize bytes.
  void Put(const std::string& topic, const Origin& origin, std::uint8_t* data, std::size_t size) const;
  /// Whether `data` ends with the right seal of the bytes before it, and whose seal it is.
  bool Fits(const std::string& topic, const std::uint8_t* data, std::size_t size, Origin* origin) const;

 private:
  struct Code;
  std::unique_ptr<Code> code_;
};

/// A number larger than any before in any process of this machine, for writers whose names may be used again.
std::uint64_t NextSealNumber(std::uint64_t last);

}  // namespace dispersa
