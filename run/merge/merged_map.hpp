// SPDX-License-Identifier: BSD-3-Clause
// The folder of a merged map while it is written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/merge/building_merger.hpp"
#include "run/building/building_store.hpp"
#include "run/merge/merge_maps.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar::files {

/// Writes OUT.part, which becomes OUT as a whole.
class MergedMap {
 public:
  /// @throws UsageError where `out` holds something, or OUT.part exists
  /// @throws ServiceError when the disk refuses
  MergedMap(const std::filesystem::path& out, const MapHeader& header);
  /// Removes OUT.part, if it has not become OUT.
  ~MergedMap();
  MergedMap(const MergedMap&) = delete;
  MergedMap& operator=(const MergedMap&) = delete;

  /// Lays all key scans, A's first: what B has seen through is gone afterwards, and what it has seen besides is there.
  void lay(const MergedBuilding& merged, const MergeRequest& request, BuildingStorage& scans,
           const std::function<void(double)>& progress, MergeReport& report);
  /// Takes over the files of A beside its tiles (names of floors, datum) and its settings, and names floors that only B has
  /// named. Then OUT.part becomes OUT.
  void finish(const MergeRequest& request, const MergeFigures& figures);

 private:
  struct Laying;
  void lay_side(Laying& laying, LocalMap& map, std::size_t first, std::size_t end);
  void lay_key(Laying& laying, LocalMap& map, std::size_t submap, KeyScan key);
  void check_disk() const;
  void write_trajectory(const std::vector<Submap>& submaps) const;
  void take_over(const std::filesystem::path& map_of_a);
  void name_floors(const MergeRequest& request, const MergeFigures& figures);

  std::filesystem::path out_;
  std::filesystem::path part_;
  std::unique_ptr<FileTileStore> tiles_;
  std::unique_ptr<BuildingStore> building_;
  bool finished_ = false;
};

}  // namespace isobar::files
