// SPDX-License-Identifier: BSD-3-Clause
// Texts of a page that holds its own data.
#pragma once

#include <string>
#include <string_view>

namespace isobar::web {

/// What gzip compressed.
/// @throws Error when the bytes are damaged
[[nodiscard]] std::string unpacked(std::string_view gzip);

/// Base64 (RFC 4648), without line ends.
[[nodiscard]] std::string base64(std::string_view bytes);

/// JSON for a <script> element: no text in it can end the element.
[[nodiscard]] std::string script_safe(std::string_view json);

}  // namespace isobar::web
