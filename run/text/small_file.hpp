// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace isobar::text {

/// Size limits of the TOML files [bytes]. A configuration with all keys and comments takes 60 kB; a manifest
/// may hold a description of any length that a person writes.
inline constexpr std::size_t kMostConfigBytes = std::size_t{64} * 1024;
inline constexpr std::size_t kMostManifestBytes = std::size_t{1024} * 1024;

/// Content of a file, or why it was refused.
struct SmallFile {
  std::string content;
  std::string refusal;  ///< a rule, "is a folder, must be a file"; empty: read
};

/// Reads a whole file of bounded size. Only regular files are read, so that no FIFO, device or socket can
/// block the caller or feed it without end.
[[nodiscard]] SmallFile read_small_file(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace isobar::text
