// SPDX-License-Identifier: BSD-3-Clause
// List of the certificates that an authority has revoked (X.509 CRL), in PEM: machines that were stolen or sold.
#pragma once

#include <string>
#include <string_view>

#include "ipc/keys/certificate.hpp"

namespace isobar::keys {

using RevocationsPointer = std::unique_ptr<X509_CRL, FreeWith<&X509_CRL_free>>;

/// @param path for the error's text
/// @throws DataError "path: rule" when the text is no such list, or the authority has not signed it
[[nodiscard]] RevocationsPointer revocations_of(std::string_view pem, const X509& authority,
                                                const std::string& path);

[[nodiscard]] bool is_revoked(const X509_CRL& revocations, const X509& certificate);

/// A new list, signed by the authority: the former one and one certificate more. It never expires, so that a
/// machine without a network stays usable.
/// @param former may be null
/// @throws ServiceError when OpenSSL fails
[[nodiscard]] std::string with_revoked(const Identity& authority, const X509_CRL* former,
                                       const X509& certificate);

}  // namespace isobar::keys
