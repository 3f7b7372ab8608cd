// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace isobar {

/// SHA-256 of `text` (FIPS 180-4) as 64 hexadecimal digits.
/// @throws ServiceError when the library has no SHA-256
std::string sha256_hex(std::string_view text);

}  // namespace isobar
