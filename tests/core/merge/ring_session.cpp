// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/merge/ring_session.hpp"

#include <algorithm>

#include "core/loops/building.hpp"

namespace isobar::test {

void MemoryStorage::add_submap(const Submap& submap) {
  stored.submaps.push_back(submap);
  stored.submaps.back().keys.clear();
}

void MemoryStorage::add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) {
  key.scan = scans_.size();
  scans_.push_back({scan.pose, {scan.points, scan.points + scan.point_count}});
  stored.submaps[submap].last_way_m = key.way_m;
  stored.submaps[submap].keys.push_back(key);
  stored.submaps[submap].keys.back().p_base = {};
}

bool MemoryStorage::read_scan(ScanHandle handle, RegisteredScan& out) {
  if (handle >= scans_.size() || (lost_every > 0 && handle % lost_every == 0)) return false;
  out.pose = scans_[handle].pose;
  out.point_count = static_cast<std::uint32_t>(scans_[handle].points.size());
  std::copy(scans_[handle].points.begin(), scans_[handle].points.end(), out.points);
  return true;
}

void drive_ring(const RingSessionWish& wish, BuildingStorage& storage, LocalMap& map) {
  const Eigen::Isometry3d up(Eigen::Translation3d(0.0, 0.0, wish.storey_m));
  RingRun run([&](double) { return wish.T_map_world * up; }, wish.world);
  run.carry(wish.from_m);
  Building building({}, {}, {}, RingRun::lidar_mount(), &storage);
  while (run.way_m() < wish.until_m) {
    const RegisteredScan& scan = run.next();
    building.add(scan, AirHeight{scan.pose.T_map_base.translation().z(), 1e-4});
    map.update(scan);
  }
}

RingSession::RingSession(const RingSessionWish& wish)
    : wish_(wish), map_(std::make_unique<LocalMap>(MapConfig{}, RingRun::lidar_mount())) {
  drive_ring(wish, storage_, *map_);
}

KnownMap RingSession::known_map() const {
  std::vector<MapPoint> points;
  map_->append_points(points);
  return {points, map_->snapshot()};
}

Eigen::Isometry3d RingSession::truth(const KeyScan& key) const {
  Eigen::Isometry3d T = ring_pose(1e-9 * static_cast<double>(key.stamp_ns - 1'700'000'000'000'000'000));
  T.translation().z() += wish_.storey_m;
  return T;
}

}  // namespace isobar::test
