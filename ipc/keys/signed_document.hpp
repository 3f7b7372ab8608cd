// SPDX-License-Identifier: BSD-3-Clause
// Documents signed in S/MIME, as DDS security wants governance and permissions.
#pragma once

#include <string>
#include <string_view>

#include "ipc/keys/certificate.hpp"

namespace isobar::keys {

/// A text with the signature of an authority: multipart/signed.
/// @throws ServiceError when OpenSSL fails
[[nodiscard]] std::string sign_document(std::string_view text, const Identity& authority);

/// The text of a signed document.
/// @param path of the document, for the error's text
/// @param authority_path of the authority's certificate, for the error's text
/// @throws DataError "path: rule" when it is no signed document, was changed, or another authority signed it
[[nodiscard]] std::string verified_text(std::string_view document, const X509& authority,
                                        const std::string& path, const std::string& authority_path);

}  // namespace isobar::keys
