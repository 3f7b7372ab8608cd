// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_thread.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "daemon/cpu_time.hpp"
#include "daemon/message_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

MapThread::MapThread(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, double cloud_interval_s,
                     FileTileStore* store, ThreadSettings settings)
    : map_(config, T_base_lidar, store),
      snapshots_(map_.snapshot()),
      scans_(ipc::topics::kRegisteredScan),
      clouds_(ipc::topics::kMapCloud),
      waiter_({&scans_.raw()}),
      store_(store),
      cloud_interval_ns_(static_cast<std::int64_t>(cloud_interval_s * 1e9)),
      deadline_(settings.deadline_ms),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void MapThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
  map_.store_all();
  log_tile_losses();
}

// Freshness wins: only the newest waiting scan enters the map,
// because the registration needs the map around it now.
void MapThread::drain() noexcept {
  changes_.take([this](const Change& change) {
    map_.configure(change.config);
    cloud_interval_ns_ = static_cast<std::int64_t>(change.cloud_interval_s * 1e9);
    deadline_.set_limit(change.deadline_ms);
  });
  auto newest = scans_.take();
  while (auto newer = scans_.take()) {
    newest = std::move(newer);
    ++superseded_;
  }
  if (newest) add(*newest);
  log_tile_losses();
  draft_status_.dropped_scans = scans_.dropped() + superseded_;
  draft_status_.punctuality = deadline_.status();
  draft_status_.cells = map_.cell_count();
  if (store_ != nullptr) {
    draft_status_.on_disk = true;
    draft_status_.tiles_on_disk = store_->tile_count();
    draft_status_.disk_bytes = store_->disk_bytes();
  }
  status_.put(draft_status_);
}

void MapThread::add(const RegisteredScan& scan) noexcept {
  const CpuTimer timer;
  if (map_.update(scan)) {
    snapshots_.publish(map_.snapshot());
    draft_status_.update_ms = timer.elapsed_ms();
  }
  deadline_.note(scan.handed_over_ns, RobotClock::now_ns());
  publish_cloud(scan.pose.stamp_ns);
}

void MapThread::log_tile_losses() noexcept {
  if (store_ == nullptr) return;
  // Only the first loss of each kind is logged; counters.csv has the totals.
  const TileStoreCounters& now = store_->counters();
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

void MapThread::publish_cloud(std::int64_t stamp_ns) noexcept {
  if (cloud_points_sent_ >= points_.size()) {  // no map is on its way
    if (stamp_ns - last_cloud_ns_ < cloud_interval_ns_ || !clouds_.has_subscribers()) return;
    points_.clear();
    map_.append_points(points_);
    last_cloud_ns_ = stamp_ns;
    cloud_points_sent_ = 0;
    ++cloud_sequence_;
  }
  // One piece a scan: a large map fills neither the shared memory nor the time of one update.
  ipc::MapCloud* piece = points_.empty() ? nullptr : clouds_.loan();
  if (piece == nullptr) return;
  piece->stamp_ns = last_cloud_ns_;
  piece->sequence = cloud_sequence_;
  piece->first_point = static_cast<std::uint32_t>(cloud_points_sent_);
  piece->total_points = static_cast<std::uint32_t>(points_.size());
  piece->point_count = std::min(ipc::MapCloud::kMaxPoints, piece->total_points - piece->first_point);
  for (std::uint32_t i = 0; i < piece->point_count; ++i) {
    const MapPoint& point = points_[cloud_points_sent_++];
    const Eigen::Vector3f p_map = point.p_map.cast<float>();
    piece->points[i] = {p_map.x(), p_map.y(), p_map.z(), 0, 0, point.intensity};
  }
  clouds_.publish(piece);
}

}  // namespace isobar
