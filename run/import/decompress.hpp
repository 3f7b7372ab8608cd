// SPDX-License-Identifier: BSD-3-Clause
// Decompression of chunks, in memory that grows with what comes out, up to a limit.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::imports {

/// Decompresses all frames of `from`. What comes out before a damaged place is kept in `to`.
/// @param method "lz4" (frames), "zstd" or "bz2"; "" and "none" copy
/// @param most largest result [bytes]
/// @return nullptr, or the rule that the bytes break, a static text
[[nodiscard]] const char* decompress(std::string_view method, std::span<const std::uint8_t> from,
                                     std::uint64_t most, std::vector<std::uint8_t>& to);

}  // namespace isobar::imports
