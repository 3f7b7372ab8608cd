// SPDX-License-Identifier: BSD-3-Clause
// Owners of OpenSSL's objects, and its errors as text. Only for the sources of this folder.
#pragma once

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace isobar::keys {

/// Calls the library's function that frees an object.
template <auto kFree>
struct FreeWith {
  template <class Object>
  void operator()(Object* object) const noexcept {
    kFree(object);
  }
};

using KeyPointer = std::unique_ptr<EVP_PKEY, FreeWith<&EVP_PKEY_free>>;
using CertificatePointer = std::unique_ptr<X509, FreeWith<&X509_free>>;
using BioPointer = std::unique_ptr<BIO, FreeWith<&BIO_free_all>>;
using SignedPointer = std::unique_ptr<PKCS7, FreeWith<&PKCS7_free>>;
using StorePointer = std::unique_ptr<X509_STORE, FreeWith<&X509_STORE_free>>;
using StoreContextPointer = std::unique_ptr<X509_STORE_CTX, FreeWith<&X509_STORE_CTX_free>>;
using BigNumberPointer = std::unique_ptr<BIGNUM, FreeWith<&BN_free>>;

/// Reason of the last failed call, and clears the library's queue of errors.
[[nodiscard]] std::string last_openssl_error();

/// @throws ServiceError "WHAT: reason" when `succeeded` is false: out of memory, no randomness
void require_openssl(bool succeeded, const char* what);

/// A memory BIO that reads `text`, which must outlive it.
[[nodiscard]] BioPointer reader_of(std::string_view text);
/// A memory BIO to write to.
[[nodiscard]] BioPointer make_buffer();
/// What has been written to a memory BIO.
[[nodiscard]] std::string content_of(BIO* buffer);

/// Time as seconds since 1970 (UTC); INT64_MAX when it cannot be represented.
[[nodiscard]] std::int64_t unix_seconds(const ASN1_TIME* time);

}  // namespace isobar::keys
