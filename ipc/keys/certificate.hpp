// SPDX-License-Identifier: BSD-3-Clause
// X.509 certificates and their private keys (elliptic curve P-256), in PEM.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "ipc/keys/openssl.hpp"

namespace isobar::keys {

/// A certificate with its private key.
struct Identity {
  CertificatePointer certificate;
  KeyPointer key;
};

/// Time in which a certificate is valid, both seconds since 1970 (UTC).
struct Validity {
  std::int64_t from_s = 0;
  std::int64_t until_s = 0;
};

/// From 2020 on, so that a machine whose clock is not set yet, which is at the date of its system's image,
/// accepts it; until `years` from now.
/// @param years 1 … 50
[[nodiscard]] Validity valid_for(int years);

/// A certificate authority: a certificate that its own key signs.
/// @throws ServiceError when OpenSSL fails
[[nodiscard]] Identity make_authority(const std::string& common_name, const Validity& validity);

/// A certificate for `common_name`, signed by the authority.
/// @throws ServiceError when OpenSSL fails
[[nodiscard]] Identity issue(const Identity& authority, const std::string& common_name,
                             const Validity& validity);

[[nodiscard]] std::string pem_of(const X509& certificate);
[[nodiscard]] std::string pem_of(const EVP_PKEY& private_key);

/// @param path for the error's text
/// @throws DataError "path: rule" when the text is not a certificate or a private key in PEM
[[nodiscard]] CertificatePointer certificate_of(std::string_view pem, const std::string& path);
[[nodiscard]] KeyPointer private_key_of(std::string_view pem, const std::string& path);

/// Name of the owner as RFC 2253 writes it, "CN=roof,O=isobar": the form in which permissions name it.
[[nodiscard]] std::string subject_of(const X509& certificate);
[[nodiscard]] Validity validity_of(const X509& certificate);

/// Rule that a certificate breaks: not signed by the authority, not valid now; empty: none.
/// @param now_s time of the check, seconds since 1970
[[nodiscard]] std::string broken_rule(const X509& certificate, const X509& authority, std::int64_t now_s);

/// Date as people and `date -u` write it: "2036-11-28 20:15:00 UTC".
[[nodiscard]] std::string date_of(std::int64_t unix_s);

}  // namespace isobar::keys
