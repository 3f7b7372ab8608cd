// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/map/local_map.hpp"

namespace isobar::test::test_person_gone {

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kLidarHeightM = 1.0;

using RangeOf = std::function<double(const Eigen::Vector3d&)>;

// Open ground under open sky.
double range_to_ground(const Eigen::Vector3d& direction) {
  return direction.z() < 0.0 ? kLidarHeightM / -direction.z() : kNothing;
}

// A person, 0.5 m wide, who stands 4 m ahead in front of `behind`; the head is above the lidar.
RangeOf with_person(const RangeOf& behind) {
  return [behind](const Eigen::Vector3d& d) {
    const double flat = std::hypot(d.x(), d.y());
    const double off = 4.0 * d.y() / flat;
    const double range = (4.0 - std::sqrt(std::max(0.0, 0.0625 - off * off))) / flat;
    const double z = range * d.z();
    const bool hit = d.x() > 0.0 && std::abs(off) < 0.25 && z < 0.8 && z > -kLidarHeightM;
    return hit ? std::min(range, behind(d)) : behind(d);
  };
}

// A wall 8 m ahead, 4 m wide and 3 m high.
double range_to_wall(const Eigen::Vector3d& d) {
  const double range = d.x() > 0.0 ? 8.0 / d.x() : kNothing;
  const bool hit = std::isfinite(range) && std::abs(range * d.y()) < 2.0 && range * d.z() < 2.0;
  return hit ? std::min(range, range_to_ground(d)) : range_to_ground(d);
}

class Standing {
 public:
  // Takes a scan a second, from a lidar 16 rings of which `fires(azimuth_deg, ring)` fire.
  void see(const RangeOf& range_of, int seconds, const std::function<bool(int, int)>& fires = {}) {
    for (int s = 0; s < seconds; ++s) {
      scan_->pose = {};
      scan_->pose.stamp_ns = stamp_ns_ += 1'000'000'000;
      scan_->pose.mode = PoseMode::kRegistered;
      scan_->pose.overlap = 1.0;
      scan_->point_count = 0;
      for (int i = 0; i < 1800; ++i) {
        for (int ring = 0; ring < 16; ++ring) {
          if (!fires || fires(i / 5, ring)) add(range_of, 0.2 * i, ring);
        }
      }
      map_.update(*scan_);
    }
  }

  // Points of the map between the given distances ahead and above a height from the lidar, by default 0.3 m above the
  // ground.
  [[nodiscard]] std::size_t points_ahead(double from_m, double to_m,
                                         double above_m = 0.3 - kLidarHeightM) const {
    std::vector<MapPoint> points;
    map_.append_points(points);
    std::size_t count = 0;
    for (const MapPoint& point : points) {
      const Eigen::Vector3d& p = point.p_map;
      count += p.x() > from_m && p.x() < to_m && std::abs(p.y()) < 2.2 && p.z() > above_m ? 1 : 0;
    }
    return count;
  }

 private:
  void add(const RangeOf& range_of, double azimuth_deg, int ring) {
    const double a = azimuth_deg * std::numbers::pi / 180.0;
    const double e = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
    const Eigen::Vector3d direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    const double range = range_of(direction);
    if (!(range < 60.0)) return;
    const Eigen::Vector3f p = (direction * range).cast<float>();
    scan_->points[scan_->point_count++] =
        ScanPoint{p.x(), p.y(), p.z(), 0, static_cast<std::uint8_t>(ring), 50};
  }

  LocalMap map_{MapConfig{}, Eigen::Isometry3d::Identity()};
  std::unique_ptr<RegisteredScan> scan_ = std::make_unique<RegisteredScan>();
  std::int64_t stamp_ns_ = 0;
};

}  // namespace

TEST_CASE("a person who leaves, leaves the map, before a wall and before the open sky") {
  for (const RangeOf& behind : {RangeOf(range_to_ground), RangeOf(range_to_wall)}) {
    Standing standing;
    standing.see(with_person(behind), 10);
    const std::size_t before = standing.points_ahead(3.5, 4.5);
    REQUIRE(before > 50);
    standing.see(behind, 10);
    CAPTURE(standing.points_ahead(3.5, 4.5));
    CHECK(20 * standing.points_ahead(3.5, 4.5) <= before);
  }
}

TEST_CASE("a wall stays where packets are lost and where it returns a third of the rays") {
  Standing standing;
  standing.see(range_to_wall, 10);
  const std::size_t before = standing.points_ahead(7.5, 8.5);
  REQUIRE(before > 100);
  // Packets of 20 degrees are lost in every scan, at the wall.
  standing.see(range_to_wall, 20, [](int azimuth_deg, int) { return azimuth_deg > 8 && azimuth_deg < 348; });
  CHECK(standing.points_ahead(7.5, 8.5) == before);
  // A surface that returns a third of the rays.
  int shot = 0;
  standing.see(range_to_wall, 20, [&](int, int) { return ++shot % 3 == 0; });
  CHECK(standing.points_ahead(7.5, 8.5) >= before);
}

TEST_CASE("a wall of glass stays when it returns nothing at an angle") {
  // The wall is at the side, seen 60 degrees off its normal; above the horizon nothing is behind it.
  Standing standing;
  const RangeOf glass = [](const Eigen::Vector3d& d) {
    const double range = d.y() > 0.0 ? 2.0 / d.y() : kNothing;
    const bool hit = range * d.x() > 3.5 && range * d.x() < 5.0;
    return hit ? std::min(range, range_to_ground(d)) : range_to_ground(d);
  };
  standing.see(glass, 10);
  const std::size_t before = standing.points_ahead(3.5, 5.0, 0.3);
  REQUIRE(before > 50);
  standing.see(range_to_ground, 20);
  CHECK(10 * standing.points_ahead(3.5, 5.0, 0.3) > 9 * before);
}

}  // namespace isobar::test::test_person_gone
