// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/revocation.hpp"

#include <openssl/pem.h>

#include <ctime>

#include "core/errors.hpp"

namespace isobar::keys {
namespace {

using TimePointer = std::unique_ptr<ASN1_TIME, FreeWith<&ASN1_TIME_free>>;

TimePointer time_of(std::int64_t unix_s) {
  TimePointer time(ASN1_TIME_set(nullptr, unix_s));
  require_openssl(time != nullptr, "time");
  return time;
}

// OpenSSL's getters take pointers to what they do not change.
X509_CRL* writable(const X509_CRL& revocations) { return const_cast<X509_CRL*>(&revocations); }
X509* writable(const X509& certificate) { return const_cast<X509*>(&certificate); }

void add(X509_CRL& to, const ASN1_INTEGER& serial, const ASN1_TIME& time) {
  X509_REVOKED* entry = X509_REVOKED_new();
  require_openssl(entry != nullptr, "revocation");
  const bool added = X509_REVOKED_set_serialNumber(entry, const_cast<ASN1_INTEGER*>(&serial)) == 1 &&
                     X509_REVOKED_set_revocationDate(entry, const_cast<ASN1_TIME*>(&time)) == 1 &&
                     X509_CRL_add0_revoked(&to, entry) == 1;
  if (!added) X509_REVOKED_free(entry);
  require_openssl(added, "revocation");
}

}  // namespace

RevocationsPointer revocations_of(std::string_view pem, const X509& authority, const std::string& path) {
  RevocationsPointer revocations(PEM_read_bio_X509_CRL(reader_of(pem).get(), nullptr, nullptr, nullptr));
  if (revocations == nullptr) {
    throw DataError(path +
                    ": must be a list of revoked certificates (X.509 CRL) in PEM: " + last_openssl_error());
  }
  if (X509_CRL_verify(revocations.get(), X509_get0_pubkey(&authority)) != 1) {
    static_cast<void>(last_openssl_error());
    throw DataError(path +
                    ": must be signed by identity_ca.pem; it was changed or comes from another authority");
  }
  return revocations;
}

bool is_revoked(const X509_CRL& revocations, const X509& certificate) {
  X509_REVOKED* entry = nullptr;
  return X509_CRL_get0_by_cert(writable(revocations), &entry, writable(certificate)) == 1;
}

std::string with_revoked(const Identity& authority, const X509_CRL* former, const X509& certificate) {
  const RevocationsPointer list(X509_CRL_new());
  // From the first day of the certificates on: a machine whose clock is behind takes the list, too.
  const TimePointer since = time_of(validity_of(*authority.certificate).from_s);
  require_openssl(
      list != nullptr && X509_CRL_set_version(list.get(), X509_CRL_VERSION_2) == 1 &&
          X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(authority.certificate.get())) == 1 &&
          X509_CRL_set1_lastUpdate(list.get(), since.get()) == 1,
      "list of revocations");
  STACK_OF(X509_REVOKED)* entries = former != nullptr ? X509_CRL_get_REVOKED(writable(*former)) : nullptr;
  for (int i = 0; i < sk_X509_REVOKED_num(entries); ++i) {
    const X509_REVOKED* entry = sk_X509_REVOKED_value(entries, i);
    add(*list, *X509_REVOKED_get0_serialNumber(entry), *X509_REVOKED_get0_revocationDate(entry));
  }
  add(*list, *X509_get0_serialNumber(&certificate), *time_of(std::time(nullptr)));
  require_openssl(
      X509_CRL_sort(list.get()) == 1 && X509_CRL_sign(list.get(), authority.key.get(), EVP_sha256()) > 0,
      "signature");
  const BioPointer buffer = make_buffer();
  require_openssl(PEM_write_bio_X509_CRL(buffer.get(), list.get()) == 1, "PEM");
  return content_of(buffer.get());
}

}  // namespace isobar::keys
