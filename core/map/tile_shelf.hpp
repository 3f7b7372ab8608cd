// SPDX-License-Identifier: BSD-3-Clause
// Where tiles of the map wait that are too far from the robot to stay in memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Keeps the bytes of tiles by their keys. What the bytes mean is the map's business: the shelf gives them
/// back as they were, or not at all. Used by one thread, which is not real-time: an implementation may write
/// to a disk. No function throws for what a disk or a damaged file does.
class TileShelf {
 public:
  virtual ~TileShelf() = default;

  /// Keeps a tile's bytes (1 byte to some megabytes), in place of an older version of the same tile. False
  /// where they could not be kept, because the disk refuses: the shelf has counted it, an older version of
  /// the tile is still there or not, and the map forgets the tile and goes on.
  virtual bool put(const TileKey& key, std::span<const std::byte> bytes) = 0;

  /// Copies the newest version of a tile's bytes to `bytes`, whose former content goes and whose memory is
  /// used again. The tile stays on the shelf. False, and `bytes` empty, if there is none or it is damaged:
  /// the shelf has counted the damage.
  virtual bool take(const TileKey& key, std::vector<std::byte>& bytes) = 0;

  /// True if there is a version of this tile. It has not been looked at: take() may still find it damaged.
  [[nodiscard]] virtual bool contains(const TileKey& key) const = 0;
};

}  // namespace isobar
