// SPDX-License-Identifier: BSD-3-Clause
// Records of `building.log`: what a building knows besides the points of its scans. Append-only, little-endian:
//
//   LogHead (magic, kind, length, checksum), then `length` bytes; the first record is kFormat
//
// A record is written by one call; one that is cut or damaged ends the log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/loops/building_storage.hpp"

namespace isobar::building_log {

/// Version of the log.
inline constexpr std::uint64_t kVersion = 1;

enum class Kind : std::uint32_t {
  kFormat = 1,
  kSubmap = 2,
  kKey = 3,
  kLoop = 4,
  kMove = 5,
};

/// Appends a record to `bytes`.
void append_format(std::vector<std::byte>& bytes);
void append_submap(const Submap& submap, std::vector<std::byte>& bytes);
void append_key(std::size_t submap, const KeyScan& key, std::vector<std::byte>& bytes);
void append_loop(const Loop& loop, std::vector<std::byte>& bytes);
void append_move(std::int64_t stamp_ns, std::vector<std::byte>& bytes);

/// What a log says.
struct LogContent {
  std::uint64_t format = 0;     ///< 0: the log does not say, it is not one
  StoredBuilding building;      ///< of whole records that fit together
  std::size_t whole_bytes = 0;  ///< the rest is cut or damaged
};
/// Reads a log up to the first record that is cut, damaged, or names what is not there.
[[nodiscard]] LogContent read_log(std::span<const std::byte> bytes);

}  // namespace isobar::building_log
