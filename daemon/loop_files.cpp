// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/loop_files.hpp"

#include <utility>

#include "core/errors.hpp"
#include "run/building/next_map.hpp"
#include "run/tile_store/disk_flusher.hpp"

namespace isobar {

LoopFiles::LoopFiles(MapFolder map_folder, const MapHeader& header, const TileStoreLimits& limits,
                     double max_disk_gb)
    : map_folder_(std::move(map_folder)),
      header_(header),
      limits_(limits),
      max_bytes_(static_cast<std::uint64_t>(max_disk_gb * 1e9)) {}

BuildingStore* LoopFiles::open(std::uint32_t session) {
  next_map_.reset();
  building_.reset();
  folder_ = map_folder_(session);
  try {
    building_ = BuildingStore::open_to_continue(folder_, max_bytes_);
  } catch (const Error& error) {
    problem_ = error.what();
  }
  return building_.get();
}

TileStorage* LoopFiles::begin_next_map() {
  next_map_.reset();
  try {
    next_map_ = create_next_map(folder_, header_, limits_);
  } catch (const Error& error) {
    problem_ = error.what();
  }
  return next_map_.get();
}

bool LoopFiles::complete_next_map() {
  const bool whole = next_map_ != nullptr && next_map_->counters().refused == 0;
  if (next_map_ && !whole) problem_ = next_map_->counters().first_refusal;
  // A power cut after the exchange must find the tiles.
  const bool on_disk = whole && DiskFlusher::wait_for(next_map_->newest_file());
  if (whole && !on_disk) problem_ = folder_.string() + ": the disk refuses the map that was laid anew";
  next_map_.reset();
  if (!on_disk) return false;
  try {
    isobar::complete_next_map(folder_);
  } catch (const Error& error) {
    problem_ = error.what();
    return false;
  }
  return true;
}

}  // namespace isobar
