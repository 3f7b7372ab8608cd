// SPDX-License-Identifier: BSD-3-Clause
// Bags that were compressed as a whole: rosbag2 --compression-mode file, and what people gzip.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "run/import/message_stream.hpp"

namespace isobar::imports {

/// Whether a file is compressed with zstd or gzip, by its first bytes.
[[nodiscard]] bool is_packed(const std::filesystem::path& file);

/// The first bytes of what a file holds, decompressed where it is packed; fewer in a shorter file, none where it cannot be
/// read.
[[nodiscard]] std::string unpacked_head_of(const std::filesystem::path& file, std::size_t bytes);

/// Decompresses a packed file into a temporary folder (TMPDIR) and opens the container that comes out. A damaged or cut file
/// gives what came out before that place.
/// @throws DataError when it cannot be read or written, or holds no container
[[nodiscard]] std::unique_ptr<MessageStream> open_packed(const std::filesystem::path& file);

}  // namespace isobar::imports
