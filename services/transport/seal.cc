#include "services/transport/seal.h"

#include <openssl/core_names.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/params.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "services/transport/openssl.h"

namespace dispersa {
namespace {

constexpr std::size_t kCode = 16;
constexpr std::size_t kOrigin = Seal::kSize - kCode;

using MacAlgorithm = std::unique_ptr<EVP_MAC, OpenSslFree<EVP_MAC_free>>;
using Mac = std::unique_ptr<EVP_MAC_CTX, OpenSslFree<EVP_MAC_CTX_free>>;

}  // namespace

/// The state that each message's code begins with.
struct Seal::Code {
  explicit Code(const Secret& secret) {
    const MacAlgorithm hmac(EVP_MAC_fetch(nullptr, "HMAC", nullptr));
    char digest[] = "SHA256";
    const OSSL_PARAM parameters[] = {OSSL_PARAM_construct_utf8_string(OSSL_MAC_PARAM_DIGEST, digest, 0),
                                     OSSL_PARAM_construct_end()};
    if (hmac) begin.reset(EVP_MAC_CTX_new(hmac.get()));
    if (!begin || EVP_MAC_init(begin.get(), secret.data(), secret.size(), parameters) != 1) Fail();
  }

  /// The code of a content that ends with its origin.
  std::array<std::uint8_t, kCode> Of(const std::string& topic, const std::uint8_t* data,
                                     std::size_t size) const {
    const Mac mac(EVP_MAC_CTX_dup(begin.get()));
    std::array<std::uint8_t, 32> whole{};
    std::size_t written = 0;
    // With its end: no other topic and content have the same bytes.
    const auto* name = reinterpret_cast<const std::uint8_t*>(topic.c_str());
    if (!mac || EVP_MAC_update(mac.get(), name, topic.size() + 1) != 1 ||
        EVP_MAC_update(mac.get(), data, size) != 1 ||
        EVP_MAC_final(mac.get(), whole.data(), &written, whole.size()) != 1) {
      Fail();
    }
    std::array<std::uint8_t, kCode> code;
    std::copy_n(whole.begin(), kCode, code.begin());
    return code;
  }

  [[noreturn]] static void Fail() { throw std::runtime_error("OpenSSL has no HMAC with SHA-256"); }

  Mac begin;
};

Secret DrawSecret() {
  Secret secret;
  if (getentropy(secret.data(), secret.size()) != 0)
    throw std::system_error(errno, std::generic_category(), "no secret can be drawn");
  return secret;
}

Seal::Seal(const Secret& secret) : code_(std::make_unique<Code>(secret)) {}
Seal::~Seal() = default;

void Seal::Put(const std::string& topic, const Origin& origin, std::uint8_t* data, std::size_t size) const {
  std::memcpy(data + size, origin.writer.data(), origin.writer.size());
  std::memcpy(data + size + origin.writer.size(), &origin.number, sizeof origin.number);
  const auto code = code_->Of(topic, data, size + kOrigin);
  std::memcpy(data + size + kOrigin, code.data(), code.size());
}

bool Seal::Fits(const std::string& topic, const std::uint8_t* data, std::size_t size, Origin* origin) const {
  if (size < kSize) return false;
  const std::uint8_t* const seal = data + (size - kSize);
  const auto code = code_->Of(topic, data, size - kCode);
  if (CRYPTO_memcmp(code.data(), seal + kOrigin, kCode) != 0) return false;
  std::memcpy(origin->writer.data(), seal, origin->writer.size());
  std::memcpy(&origin->number, seal + origin->writer.size(), sizeof origin->number);
  return true;
}

std::uint64_t NextSealNumber(std::uint64_t last) {
  // The clock since the machine's start, which is never set back.
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
  return std::max(last + 1, static_cast<std::uint64_t>(now.count()));
}

}  // namespace dispersa
