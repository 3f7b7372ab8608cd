// SPDX-License-Identifier: BSD-3-Clause
// What of a building outlives memory and process: its submaps, key scans with their points, and loops.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/estimates.hpp"
#include "core/loops/key_scan.hpp"
#include "core/loops/loop.hpp"
#include "core/loops/submap.hpp"

namespace isobar {

/// A building as it was stored: submaps without planes, keys without samples.
struct StoredBuilding {
  std::vector<Submap> submaps;
  std::vector<Loop> loops;
  std::vector<std::int64_t> moved_ns;  ///< see Building::moved_ns()
};

/// Interface of the storage of a building. One thread, not real-time. Errors of the disk are counted by the implementation:
/// what it refuses is missing after a restart, and nothing else is lost.
class BuildingStorage {
 public:
  virtual ~BuildingStorage() = default;

  /// A submap began, with the next number.
  virtual void add_submap(const Submap& submap) = 0;
  /// A submap holds one more key scan. Sets `key.scan`, where the disk takes it.
  virtual void add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) = 0;
  virtual void add_loop(const Loop& loop) = 0;
  virtual void add_move(std::int64_t stamp_ns) = 0;
  /// Reads the scan of a key scan.
  /// @return false, with an `out` of no use, where it is missing or damaged
  virtual bool read_scan(ScanHandle handle, RegisteredScan& out) = 0;
};

}  // namespace isobar
