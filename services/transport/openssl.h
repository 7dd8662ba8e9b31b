// OpenSSL's objects with owners, and the few things that keys need of it. Internal to this folder.
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <vector>

namespace dispersa {

template <auto Free>
struct OpenSslFree {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};

using Bio = std::unique_ptr<BIO, OpenSslFree<BIO_free_all>>;
using PrivateKey = std::unique_ptr<EVP_PKEY, OpenSslFree<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, OpenSslFree<X509_free>>;

/// The owner of a certificate.
struct Subject {
  std::string name;  ///< CN
  std::string unit;  ///< OU: a role, of a client ROLE-RIGHT, or empty
  std::string serial =
      {};  ///< 16 digits, that of its certificate; empty: an authority, or of an earlier version
};

struct CertificateContents {
  Subject subject;
  bool is_authority = false;  ///< may sign certificates
  std::time_t not_before = 0;
  std::time_t not_after = 0;
};

/// On the curve P-256, the one that the middleware's key exchange knows. All of these throw
/// std::runtime_error with OpenSSL's words.
PrivateKey MakePrivateKey();
/// 16 random hexadecimal digits.
std::string MakeSerial();
/// Signed by `issuer` with its key, or by itself without an issuer.
Certificate MakeCertificate(const CertificateContents& contents, EVP_PKEY* key, X509* issuer,
                            EVP_PKEY* issuer_key);
/// A document in S/MIME with its signature, as DDS Security wants it.
std::string SignDocument(const std::string& text, X509* signer, EVP_PKEY* key);

std::string ToPem(X509* certificate);
std::string ToPem(EVP_PKEY* key);
Certificate ReadCertificate(const std::string& pem);
/// All of a file: at least one.
std::vector<Certificate> ReadCertificates(const std::string& pem);
PrivateKey ReadPrivateKey(const std::string& pem);

Subject SubjectOf(X509* certificate);
/// "serialNumber=0f3a...,CN=node1,OU=worker,O=dispersa": the form in which permissions name their owner.
std::string SubjectText(X509* certificate);
inline constexpr std::size_t kParticipantDigits = 12;
/// The first kParticipantDigits digits of the names of participants (ParticipantOf) with keys of this owner:
/// the middleware checks that a participant's name and its certificate agree.
std::string ParticipantsOf(const Subject& subject);
std::time_t EndOf(X509* certificate);
std::time_t BeginOf(X509* certificate);
/// Whether `authority` has signed it. Its dates are not checked.
bool IsSignedBy(X509* certificate, X509* authority);
/// The text of a signed document. Throws if it is not one, or if none of `signers`, whose dates are not
/// checked, has signed it. `by` is then the one that has.
std::string VerifiedDocument(const std::string& smime, const std::vector<Certificate>& signers,
                             X509** by = nullptr);

}  // namespace dispersa
