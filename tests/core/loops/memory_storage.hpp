// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/loops/building_storage.hpp"
#include "core/map/tile_storage.hpp"

namespace isobar::test {

/// Building in memory: what a later run would find.
class MemoryStorage final : public BuildingStorage {
 public:
  void add_submap(const Submap& submap) override {
    stored.submaps.push_back(submap);
    stored.submaps.back().keys.clear();
  }
  void add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) override {
    key.scan = scans.size();
    scans.push_back(std::make_unique<RegisteredScan>(scan));
    stored.submaps[submap].keys.push_back(key);
    stored.submaps[submap].keys.back().p_base.clear();
    stored.submaps[submap].last_way_m = key.way_m;
  }
  void add_loop(const Loop& loop) override { stored.loops.push_back(loop); }
  void add_move(std::int64_t stamp_ns) override { stored.moved_ns.push_back(stamp_ns); }
  bool read_scan(ScanHandle handle, RegisteredScan& out) override {
    if (handle >= scans.size() || lost) return false;
    out = *scans[handle];
    out.pose = PoseEstimate{};  // a disk keeps less
    out.pose.stamp_ns = scans[handle]->pose.stamp_ns;
    out.pose.mode = scans[handle]->pose.mode;
    out.pose.overlap = scans[handle]->pose.overlap;
    return true;
  }

  StoredBuilding stored;
  std::vector<std::unique_ptr<RegisteredScan>> scans;
  bool lost = false;  ///< the disk reads nothing any more
};

/// Tiles in memory.
class MemoryTiles final : public TileStorage {
 public:
  bool put(const TileKey& key, std::span<const std::byte> bytes) override {
    tiles[key.hash()] = {bytes.begin(), bytes.end()};
    return true;
  }
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override {
    const auto found = tiles.find(key.hash());
    if (found == tiles.end()) return false;
    bytes = found->second;
    return true;
  }
  [[nodiscard]] bool contains(const TileKey& key) const override { return tiles.contains(key.hash()); }

  std::map<std::uint64_t, std::vector<std::byte>> tiles;
};

}  // namespace isobar::test
