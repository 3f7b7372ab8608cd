// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_thread.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <utility>

#include "daemon/cpu_time.hpp"
#include "daemon/message_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

constexpr std::chrono::seconds kWriteInterval(1);

/// The local map of the run's start, with the tiles around the place of an earlier run, and the scans that may not
/// be in them.
std::unique_ptr<LocalMap> loaded_map(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar,
                                     MapStores& maps, const RunStart& start) {
  auto map = std::make_unique<LocalMap>(config, T_base_lidar, maps.storage(), start.session);
  if (!start.place) return map;
  map->load_around(start.place->T_map_base.translation());
  const std::size_t scans = maps.read_journal([&](const RegisteredScan& scan) { map->update(scan); });
  if (scans > 0)
    spdlog::info("map: {} scans of the journal are inserted: they may not be in the tiles", scans);
  return map;
}

}  // namespace

MapThread::MapThread(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, double cloud_interval_s,
                     MapStores& maps, const RunStart& start, ThreadSettings settings, FloorFeed* floors)
    : config_(config),
      T_base_lidar_(T_base_lidar),
      maps_(maps),
      map_(loaded_map(config, T_base_lidar, maps, start)),
      snapshots_(map_->snapshot()),
      scans_(ipc::topics::kRegisteredScan),
      cloud_(cloud_interval_s),
      floors_(floors),
      waiter_({&scans_.raw()}),
      deadline_(settings.deadline_ms),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void MapThread::loop() noexcept {
  drain_until_stopped(
      waiter_, worker_.heartbeat(), [this] { drain(); }, [] { return kWriteInterval; });
  store_all_tiles();
  log_tile_losses();
}

// Freshness wins: only the newest waiting scan enters the map,
// because the registration needs the map around it now.
void MapThread::drain() noexcept {
  changes_.take([this](const Change& change) {
    map_->configure(change.config);
    config_ = map_->config();
    cloud_.set_interval(change.cloud_interval_s);
    deadline_.set_limit(change.deadline_ms);
  });
  moved_.take([this](MovedMap& moved) { exchange(moved); });
  places_.take([this](const Eigen::Vector3d& p_map) {
    map_->load_around(p_map);
    snapshots_.publish(map_->snapshot());
    looked_.fetch_add(1, std::memory_order_release);
  });
  auto newest = scans_.take();
  while (auto newer = scans_.take()) {
    newest = std::move(newer);
    ++superseded_;
  }
  if (newest) add(*newest);
  if (RobotClock::now_ns() - written_ns_ >= std::chrono::nanoseconds(kWriteInterval).count()) write_tiles();
  log_tile_losses();
  draft_status_.dropped_scans = scans_.dropped() + superseded_;
  draft_status_.punctuality = deadline_.status();
  draft_status_.cells = map_->cell_count();
  if (const FileTileStore* store = maps_.current(); store != nullptr && !maps_.read_only()) {
    draft_status_.on_disk = true;
    draft_status_.tiles_on_disk = store->tile_count();
    draft_status_.disk_bytes = store->disk_bytes();
  }
  status_.put(draft_status_);
}

void MapThread::add(const RegisteredScan& scan) noexcept {
  const CpuTimer timer;
  if (scan.pose.session != map_->session()) begin_session(scan.pose.session);
  if (maps_.read_only() ? map_->follow(scan.pose) : map_->update(scan)) {
    if (ScanJournal* journal = maps_.journal()) journal->add(scan);
    snapshots_.publish(map_->snapshot());
    draft_status_.update_ms = timer.elapsed_ms();
  }
  deadline_.note(scan.handed_over_ns, RobotClock::now_ns());
  cloud_.step(*map_, maps_.current(), scan.pose);
  if (floors_ != nullptr) floors_->step(*map_, maps_.current(), scan.pose.T_map_base.translation());
}

// The old map is kept as it is; the new one begins empty, with a folder of its own.
void MapThread::begin_session(std::uint32_t session) noexcept {
  store_all_tiles();
  FileTileStore* store = nullptr;
  try {
    store = maps_.open(session);
  } catch (const std::exception& error) {
    spdlog::error("{}; the new map is not written", error.what());
  }
  logged_ = {};
  cloud_.start_over();
  map_ = std::make_unique<LocalMap>(config_, T_base_lidar_, store, session);
  snapshots_.publish(map_->snapshot());
}

// The map laid anew takes over. Scans that were registered to the old one are left out by it (LocalMap::update()).
void MapThread::exchange(MovedMap& moved) noexcept {
  if (moved.map->session() != map_->session()) return;
  try {
    moved.map->change_storage(maps_.exchange());
  } catch (const std::exception& error) {
    spdlog::error("map: {}; it goes on as it was", error.what());
    map_->change_storage(maps_.current());
    return;
  }
  moved.map->configure(config_);
  map_.swap(moved.map);
  logged_ = {};
  cloud_.start_over();
  snapshots_.publish(map_->snapshot());
  spdlog::info("map: laid anew after places were seen again; the robot moves by {:.2f} m in it",
               moved.T_now_before.translation().norm());
}

// Once a second, so that a crash loses ten seconds of the map at most.
void MapThread::write_tiles() noexcept {
  written_ns_ = RobotClock::now_ns();
  if (!maps_.configured() || maps_.read_only()) return;
  try {
    // The disk was full at the start.
    if (maps_.current() == nullptr) map_->change_storage(maps_.open(map_->session()));
    if (!maps_.in_place()) follow_folder();
  } catch (const std::exception& error) {
    map_->change_storage(maps_.current());
    if (!draft_status_.disk_failing) spdlog::error("map: {}; poses continue", error.what());
    draft_status_.disk_failing = true;
    return;
  }
  store_changed_tiles();
  maps_.post_for_flush();
}

// The end of a map frame. The journal is kept where a tile was refused.
void MapThread::store_all_tiles() noexcept {
  if (maps_.current() == nullptr || maps_.read_only()) return;
  const std::uint64_t refused = maps_.current()->counters().refused;
  map_->store_all();
  if (maps_.current()->counters().refused == refused) maps_.finish();
}

void MapThread::store_changed_tiles() noexcept {
  const std::uint64_t refused = maps_.current()->counters().refused;
  if (map_->sweep_begins()) {
    if (ScanJournal* journal = maps_.journal()) journal->begin_sweep(sweep_whole_);
    sweep_whole_ = true;
  }
  map_->store_some();
  const bool failing = maps_.current()->counters().refused > refused;
  if (!failing && draft_status_.disk_failing && refused > 0) {
    spdlog::info("map: writing tiles has resumed");
    logged_.refused = false;
  }
  draft_status_.disk_failing = failing;
  sweep_whole_ = sweep_whole_ && !failing;
}

// Somebody deleted the folder of the map: what is still readable and what is in memory goes into a new one.
void MapThread::follow_folder() {
  FileTileStore* store = maps_.open_again();
  map_->change_storage(store);
  spdlog::warn("map: its folder was deleted; it is written anew, with the {} tiles that could be read",
               store->tile_count());
}

void MapThread::log_tile_losses() noexcept {
  if (maps_.current() == nullptr) return;
  // Only the first loss of each kind is logged; counters.csv has the totals.
  const TileStoreCounters& now = maps_.current()->counters();
  if (now.refused > 0 && !logged_.refused) {
    spdlog::error("map: {}; until this ends, tiles that leave memory are lost; poses continue",
                  now.first_refusal);
  }
  if (now.damaged > 0 && !logged_.damaged) spdlog::error("map: {}; that tile is lost", now.first_damage);
  if (now.forgotten > 0 && !logged_.forgotten) {
    spdlog::warn("map: map.max_disk_gb is reached; from now on the oldest stored tiles are deleted");
  }
  logged_ = {now.refused > 0, now.damaged > 0, now.forgotten > 0};
}

}  // namespace isobar
