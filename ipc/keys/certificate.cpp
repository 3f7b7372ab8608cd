// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/certificate.hpp"

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <array>
#include <chrono>
#include <ctime>

#include "core/errors.hpp"

namespace isobar::keys {
namespace {

/// 2020-01-01: before the build date of any system that runs this, which is its clock's earliest time.
constexpr std::int64_t kFirstDayS = 1'577'836'800;
constexpr std::int64_t kDayS = 86'400;

KeyPointer make_key() {
  KeyPointer key(EVP_EC_gen("P-256"));
  require_openssl(key != nullptr, "private key");
  return key;
}

void set_serial(X509& certificate) {
  const BigNumberPointer number(BN_new());
  // 127 bits at random: unique without a list of those given out, and positive.
  const bool made = number != nullptr && BN_rand(number.get(), 127, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1;
  require_openssl(made && BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(&certificate)) != nullptr,
                  "serial number");
}

void set_subject(X509& certificate, const std::string& common_name) {
  X509_NAME* name = X509_get_subject_name(&certificate);
  const auto add = [name](const char* field, const std::string& value) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(value.c_str());
    require_openssl(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8, bytes, -1, -1, 0) == 1, field);
  };
  add("O", "isobar");
  add("CN", common_name);
}

void add_extension(X509& certificate, X509& issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, FreeWith<&X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  require_openssl(extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1, value);
}

CertificatePointer make_certificate(const EVP_PKEY& key, const std::string& common_name,
                                    const Validity& validity) {
  CertificatePointer certificate(X509_new());
  require_openssl(certificate != nullptr, "certificate");
  require_openssl(X509_set_version(certificate.get(), X509_VERSION_3) == 1, "version");
  set_serial(*certificate);
  set_subject(*certificate, common_name);
  require_openssl(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), validity.from_s) != nullptr &&
                      ASN1_TIME_set(X509_getm_notAfter(certificate.get()), validity.until_s) != nullptr,
                  "validity");
  require_openssl(X509_set_pubkey(certificate.get(), const_cast<EVP_PKEY*>(&key)) == 1, "public key");
  return certificate;
}

std::string text_with(BioPointer buffer, bool written) {
  require_openssl(written, "PEM");
  return content_of(buffer.get());
}

}  // namespace

Validity valid_for(int years) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
  return {kFirstDayS, now_s + years * kDayS * 36525 / 100};
}

Identity make_authority(const std::string& common_name, const Validity& validity) {
  Identity made{nullptr, make_key()};
  made.certificate = make_certificate(*made.key, common_name, validity);
  X509& certificate = *made.certificate;
  require_openssl(X509_set_issuer_name(&certificate, X509_get_subject_name(&certificate)) == 1, "issuer");
  add_extension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE");
  // digitalSignature: the permissions' authority signs documents, too.
  add_extension(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign,digitalSignature");
  add_extension(certificate, certificate, NID_subject_key_identifier, "hash");
  require_openssl(X509_sign(&certificate, made.key.get(), EVP_sha256()) > 0, "signature");
  return made;
}

Identity issue(const Identity& authority, const std::string& common_name, const Validity& validity) {
  Identity made{nullptr, make_key()};
  made.certificate = make_certificate(*made.key, common_name, validity);
  X509& certificate = *made.certificate;
  X509& issuer = *authority.certificate;
  require_openssl(X509_set_issuer_name(&certificate, X509_get_subject_name(&issuer)) == 1, "issuer");
  add_extension(certificate, issuer, NID_basic_constraints, "critical,CA:FALSE");
  add_extension(certificate, issuer, NID_key_usage, "critical,digitalSignature");
  add_extension(certificate, issuer, NID_subject_key_identifier, "hash");
  add_extension(certificate, issuer, NID_authority_key_identifier, "keyid");
  require_openssl(X509_sign(&certificate, authority.key.get(), EVP_sha256()) > 0, "signature");
  return made;
}

std::string pem_of(const X509& certificate) {
  BioPointer buffer = make_buffer();
  const bool written = PEM_write_bio_X509(buffer.get(), const_cast<X509*>(&certificate)) == 1;
  return text_with(std::move(buffer), written);
}

std::string pem_of(const EVP_PKEY& private_key) {
  BioPointer buffer = make_buffer();
  const bool written = PEM_write_bio_PrivateKey(buffer.get(), const_cast<EVP_PKEY*>(&private_key), nullptr,
                                                nullptr, 0, nullptr, nullptr) == 1;
  return text_with(std::move(buffer), written);
}

CertificatePointer certificate_of(std::string_view pem, const std::string& path) {
  CertificatePointer certificate(PEM_read_bio_X509(reader_of(pem).get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) {
    throw DataError(path + ": must be a certificate in PEM: " + last_openssl_error());
  }
  return certificate;
}

KeyPointer private_key_of(std::string_view pem, const std::string& path) {
  // An empty password instead of a question on the terminal, which a service does not have.
  char none[] = "";  // NOLINT(modernize-avoid-c-arrays)
  KeyPointer key(PEM_read_bio_PrivateKey(reader_of(pem).get(), nullptr, nullptr, none));
  if (key == nullptr) {
    throw DataError(path + ": must be a private key in PEM without a password: " + last_openssl_error());
  }
  return key;
}

std::string subject_of(const X509& certificate) {
  const BioPointer buffer = make_buffer();
  require_openssl(
      X509_NAME_print_ex(buffer.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253) >= 0,
      "subject");
  return content_of(buffer.get());
}

Validity validity_of(const X509& certificate) {
  return {unix_seconds(X509_get0_notBefore(&certificate)), unix_seconds(X509_get0_notAfter(&certificate))};
}

std::string broken_rule(const X509& certificate, const X509& authority, std::int64_t now_s) {
  const StorePointer store(X509_STORE_new());
  const StoreContextPointer context(X509_STORE_CTX_new());
  require_openssl(
      store != nullptr && context != nullptr &&
          X509_STORE_add_cert(store.get(), const_cast<X509*>(&authority)) == 1 &&
          X509_STORE_CTX_init(context.get(), store.get(), const_cast<X509*>(&certificate), nullptr) == 1,
      "verification");
  X509_STORE_CTX_set_time(context.get(), 0, now_s);
  if (X509_verify_cert(context.get()) == 1) return {};
  const Validity validity = validity_of(certificate);
  switch (X509_STORE_CTX_get_error(context.get())) {
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "is not valid before " + date_of(validity.from_s) + ", and this machine's clock says " +
             date_of(now_s);
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return "has expired on " + date_of(std::min(validity.until_s, validity_of(authority).until_s));
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
      return "must be signed by identity_ca.pem beside it, which is another authority";
    default:
      return std::string("cannot be verified: ") +
             X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get()));
  }
}

std::string date_of(std::int64_t unix_s) {
  const std::time_t time = unix_s;
  std::tm parts{};
  std::array<char, 32> text{};
  if (::gmtime_r(&time, &parts) == nullptr) return "an unknown date";
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &parts)};
}

}  // namespace isobar::keys
