// SPDX-License-Identifier: BSD-3-Clause
// Interface of the storage for map tiles that are too far from the robot to stay in memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Key-value storage: tile key to serialised tile (MapTile::store()), whose bytes it does not interpret.
/// Called from one thread that is not real-time, so that an implementation may write to disk. Disk errors and
/// damaged files are counted by the implementation, never thrown.
class TileStorage {
 public:
  virtual ~TileStorage() = default;

  /// Stores a tile (1 byte to some megabytes) in place of its older version. Returns false if the disk
  /// refuses: the older version may or may not survive, and the map drops the tile and goes on.
  virtual bool put(const TileKey& key, std::span<const std::byte> bytes) = 0;

  /// Copies the newest version of a tile to `bytes`, whose former content is dropped and whose capacity is
  /// reused. The tile stays in the storage. Returns false and leaves `bytes` empty if the tile is missing or
  /// damaged.
  virtual bool take(const TileKey& key, std::vector<std::byte>& bytes) = 0;

  /// True if the storage has a version of the tile. Its bytes are not checked: take() may find them damaged.
  [[nodiscard]] virtual bool contains(const TileKey& key) const = 0;
};

}  // namespace isobar
