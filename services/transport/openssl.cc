#include "services/transport/openssl.h"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <array>
#include <cstdint>
#include <ctime>
#include <stdexcept>

namespace dispersa {
namespace {

using Extension = std::unique_ptr<X509_EXTENSION, OpenSslFree<X509_EXTENSION_free>>;
using Pkcs7 = std::unique_ptr<PKCS7, OpenSslFree<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, OpenSslFree<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, OpenSslFree<X509_STORE_CTX_free>>;

[[noreturn]] void Fail(const std::string& what) {
  std::array<char, 256> reason{};
  ERR_error_string_n(ERR_get_error(), reason.data(), reason.size());
  ERR_clear_error();
  throw std::runtime_error(what + ": " + reason.data());
}

void Check(bool done, const char* what) {
  if (!done) Fail(what);
}

Bio MemoryOf(const std::string& text) {
  Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  Check(bio != nullptr, "no memory");
  return bio;
}

Bio NewMemory() {
  Bio bio(BIO_new(BIO_s_mem()));
  Check(bio != nullptr, "no memory");
  return bio;
}

std::string TextOf(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

void AddExtension(X509* certificate, int kind, const char* value) {
  const Extension extension(X509V3_EXT_conf_nid(nullptr, nullptr, kind, value));
  Check(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1,
        "an extension of a certificate");
}

void AddToName(X509_NAME* name, const char* field, const std::string& value) {
  if (value.empty()) return;
  Check(X509_NAME_add_entry_by_txt(name, field, MBSTRING_ASC,
                                   reinterpret_cast<const unsigned char*>(value.c_str()), -1, -1, 0) == 1,
        "the name in a certificate");
}

void Fill(X509_NAME* name, const Subject& subject) {
  AddToName(name, "O", "dispersa");
  AddToName(name, "OU", subject.unit);
  AddToName(name, "CN", subject.name);
  AddToName(name, "serialNumber", subject.serial);
}

std::string FieldOf(X509* certificate, int field) {
  std::array<char, 256> text{};
  X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), field, text.data(), text.size());
  return text.data();
}

std::time_t TimeOf(const ASN1_TIME* time) {
  std::tm parts{};
  Check(ASN1_TIME_to_tm(time, &parts) == 1, "a date of a certificate");
  return timegm(&parts);
}

}  // namespace

PrivateKey MakePrivateKey() {
  PrivateKey key(EVP_EC_gen("P-256"));
  Check(key != nullptr, "a private key");
  return key;
}

std::string MakeSerial() {
  std::uint64_t serial = 0;
  Check(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1, "random numbers");
  return fmt::format("{:016x}", serial >> 1);  // positive
}

Certificate MakeCertificate(const CertificateContents& contents, EVP_PKEY* key, X509* issuer,
                            EVP_PKEY* issuer_key) {
  Certificate made(X509_new());
  Check(made != nullptr, "no memory");
  const std::string serial = contents.subject.serial.empty() ? MakeSerial() : contents.subject.serial;
  X509_NAME* name = X509_get_subject_name(made.get());
  Fill(name, contents.subject);
  Check(
      X509_set_version(made.get(), X509_VERSION_3) == 1 &&
          ASN1_INTEGER_set_uint64(X509_get_serialNumber(made.get()), std::stoull(serial, nullptr, 16)) == 1 &&
          ASN1_TIME_set(X509_getm_notBefore(made.get()), contents.not_before) != nullptr &&
          ASN1_TIME_set(X509_getm_notAfter(made.get()), contents.not_after) != nullptr &&
          X509_set_issuer_name(made.get(), issuer ? X509_get_subject_name(issuer) : name) == 1 &&
          X509_set_pubkey(made.get(), key) == 1,
      "a certificate");
  AddExtension(made.get(), NID_basic_constraints,
               contents.is_authority ? "critical,CA:TRUE,pathlen:0" : "critical,CA:FALSE");
  AddExtension(made.get(), NID_key_usage,
               contents.is_authority ? "critical,keyCertSign,cRLSign" : "critical,digitalSignature");
  Check(X509_sign(made.get(), issuer ? issuer_key : key, EVP_sha256()) > 0, "the signature of a certificate");
  return made;
}

std::string SignDocument(const std::string& text, X509* signer, EVP_PKEY* key) {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Bio in = MemoryOf(text), out = NewMemory();
  const Pkcs7 signature(PKCS7_sign(signer, key, nullptr, in.get(), kFlags));
  Check(signature != nullptr && SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags) == 1,
        "the signature of a document");
  return TextOf(out.get());
}

std::string ToPem(X509* certificate) {
  const Bio out = NewMemory();
  Check(PEM_write_bio_X509(out.get(), certificate) == 1, "a certificate as text");
  return TextOf(out.get());
}

std::string ToPem(EVP_PKEY* key) {
  const Bio out = NewMemory();
  Check(PEM_write_bio_PKCS8PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
        "a private key as text");
  return TextOf(out.get());
}

Certificate ReadCertificate(const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(MemoryOf(pem).get(), nullptr, nullptr, nullptr));
  if (!certificate) {
    ERR_clear_error();
    throw std::runtime_error("no certificate in PEM");
  }
  return certificate;
}

std::vector<Certificate> ReadCertificates(const std::string& pem) {
  std::vector<Certificate> certificates;
  const Bio in = MemoryOf(pem);
  while (X509* next = PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr)) certificates.emplace_back(next);
  ERR_clear_error();  // the last reading finds none
  if (certificates.empty()) throw std::runtime_error("no certificate in PEM");
  return certificates;
}

PrivateKey ReadPrivateKey(const std::string& pem) {
  PrivateKey key(PEM_read_bio_PrivateKey(MemoryOf(pem).get(), nullptr, nullptr, nullptr));
  if (!key) {
    ERR_clear_error();
    throw std::runtime_error("no private key in PEM");
  }
  return key;
}

Subject SubjectOf(X509* certificate) {
  return {FieldOf(certificate, NID_commonName), FieldOf(certificate, NID_organizationalUnitName),
          FieldOf(certificate, NID_serialNumber)};
}

std::string SubjectText(X509* certificate) {
  const Bio out = NewMemory();
  Check(X509_NAME_print_ex(out.get(), X509_get_subject_name(certificate), 0, XN_FLAG_RFC2253) >= 0,
        "the name in a certificate");
  return TextOf(out.get());
}

// DDS Security 1.1, 9.3.3: a bit 1, and the first 47 bits of the SHA-256 of the name.
std::string ParticipantsOf(const Subject& subject) {
  const std::unique_ptr<X509_NAME, OpenSslFree<X509_NAME_free>> name(X509_NAME_new());
  Check(name != nullptr, "no memory");
  Fill(name.get(), subject);
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  Check(X509_NAME_digest(name.get(), EVP_sha256(), hash.data(), nullptr) == 1, "the hash of a name");
  std::string text;
  unsigned carried = 1;
  for (int i = 0; i < 6; ++i) {
    const unsigned byte = hash[static_cast<std::size_t>(i)];
    text += fmt::format("{:02x}", (carried << 7 | byte >> 1) & 0xffu);
    carried = byte & 1u;
  }
  return text;
}

std::time_t EndOf(X509* certificate) { return TimeOf(X509_get0_notAfter(certificate)); }
std::time_t BeginOf(X509* certificate) { return TimeOf(X509_get0_notBefore(certificate)); }

bool IsSignedBy(X509* certificate, X509* authority) {
  const Store store(X509_STORE_new());
  const StoreContext context(X509_STORE_CTX_new());
  Check(store && context && X509_STORE_add_cert(store.get(), authority) == 1 &&
            X509_STORE_CTX_init(context.get(), store.get(), certificate, nullptr) == 1,
        "no memory");
  X509_STORE_CTX_set_flags(context.get(), X509_V_FLAG_NO_CHECK_TIME);
  const bool valid = X509_verify_cert(context.get()) == 1;
  ERR_clear_error();
  return valid;
}

std::string VerifiedDocument(const std::string& smime, const std::vector<Certificate>& signers, X509** by) {
  BIO* content = nullptr;
  const Pkcs7 signature(SMIME_read_PKCS7(MemoryOf(smime).get(), &content));
  const Bio in(content), out = NewMemory();
  if (!signature) {
    ERR_clear_error();
    throw std::runtime_error("no signed document");
  }
  const Store store(X509_STORE_new());
  Check(store && X509_STORE_set_flags(store.get(), X509_V_FLAG_NO_CHECK_TIME) == 1, "no memory");
  for (const Certificate& signer : signers)
    Check(X509_STORE_add_cert(store.get(), signer.get()) == 1, "no memory");
  if (PKCS7_verify(signature.get(), nullptr, store.get(), in.get(), out.get(), PKCS7_TEXT) != 1) {
    ERR_clear_error();
    throw std::runtime_error("the signature does not fit: damaged, or of another authority");
  }
  STACK_OF(X509)* const found = PKCS7_get0_signers(signature.get(), nullptr, 0);
  for (const Certificate& signer : signers)
    if (by != nullptr && X509_cmp(signer.get(), sk_X509_value(found, 0)) == 0) *by = signer.get();
  sk_X509_free(found);
  return TextOf(out.get());
}

}  // namespace dispersa
