// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_thread.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>

#include "daemon/cpu_time.hpp"
#include "daemon/message_loop.hpp"
#include "drivers/datagram/udp.hpp"

namespace isobar {

MapThread::MapThread(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, double cloud_interval_s,
                     RunOutput* output, ThreadSettings settings)
    : settings_(std::move(settings)),
      map_(config, T_base_lidar),
      snapshots_(map_.snapshot()),
      scans_(ipc::topics::kRegisteredScan),
      clouds_(ipc::topics::kMapCloud),
      waiter_({&scans_.raw()}),
      output_(output),
      cloud_interval_ns_(static_cast<std::int64_t>(cloud_interval_s * 1e9)),
      deadline_(settings_.deadline_ms) {}

MapThread::~MapThread() { stop(); }

void MapThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void MapThread::stop() noexcept {
  waiter_.stop();
  if (thread_.joinable()) thread_.join();
}

void MapThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  drain_until_stopped(waiter_, heartbeat_, [this] { drain(); });
  points_.clear();
  map_.append_points(points_);
  write_evicted();
}

// Freshness wins: of several scans that wait only the newest goes into the map, the registration needs it
// now.
void MapThread::drain() noexcept {
  auto newest = scans_.take();
  while (auto newer = scans_.take()) {
    newest = std::move(newer);
    ++overtaken_;
  }
  if (newest) add(*newest);
  own_.dropped_scans = scans_.dropped() + overtaken_;
  own_.punctuality = deadline_.status();
  own_.cells = map_.cell_count();
  status_.put(own_);
}

void MapThread::add(const RegisteredScan& scan) noexcept {
  points_.clear();
  const CpuTimer timer;
  if (map_.update(scan)) {
    snapshots_.publish(map_.snapshot());
    own_.update_ms = timer.elapsed_ms();
  }
  deadline_.note(scan.handed_over_ns, RobotClock::now_ns());
  write_evicted();
  publish_cloud(scan.pose.stamp_ns);
}

void MapThread::write_evicted() noexcept {
  if (output_ == nullptr || points_.empty()) return;
  try {
    output_->add_map_points(points_);
  } catch (const std::exception& error) {
    spdlog::error("map file: {}; the map is no longer written, the pose goes on", error.what());
    output_ = nullptr;
  }
}

void MapThread::publish_cloud(std::int64_t stamp_ns) noexcept {
  if (stamp_ns - last_cloud_ns_ < cloud_interval_ns_ || !clouds_.has_subscribers()) return;
  ipc::MapCloud* cloud = clouds_.loan();
  if (cloud == nullptr) return;
  last_cloud_ns_ = stamp_ns;
  points_.clear();
  map_.append_points(points_);
  const std::size_t stride = points_.size() / ipc::MapCloud::kMaxPoints + 1;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < points_.size(); i += stride) {
    const MapPoint& point = points_[i];
    const Eigen::Vector3f p_map = point.p_map.cast<float>();
    cloud->points[count++] = {p_map.x(), p_map.y(), p_map.z(), 0, 0, point.intensity};
  }
  cloud->stamp_ns = stamp_ns;
  cloud->sequence = cloud_sequence_++;
  cloud->point_count = count;
  clouds_.publish(cloud);
}

}  // namespace isobar
