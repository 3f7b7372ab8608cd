// SPDX-License-Identifier: BSD-3-Clause
// Turn and way of the robot from one scan to the next, from the scans alone: no IMU, no wheels, no map, none of which may
// be believed while they are checked.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/contradictions/motion_series.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Horizontal slice of a scan: one point and the line through its neighbours for every half degree of azimuth.
struct ScanProfile {
  static constexpr std::size_t kBins = 720;
  struct Bin {
    Eigen::Vector2f p_m = Eigen::Vector2f::Zero();       ///< in axes of base_link, from the lidar
    Eigen::Vector2f centre_m = Eigen::Vector2f::Zero();  ///< of the line
    Eigen::Vector2f normal = Eigen::Vector2f::Zero();
    float range_m = 0.0F;
    float slope2 = 0.0F;  ///< squared tangent of the elevation
    bool valid = false;
    bool has_line = false;
  };
  std::array<Bin, kBins> bins{};
  int points = 0;
};

/// Motion between two scans.
struct ScanStep {
  std::int64_t from_ns = 0;  ///< middle of the scan before
  std::int64_t to_ns = 0;
  PlanarStep step;
  bool turn_known = false;  ///< the shapes fit, and fix the turn
  bool way_known = false;   ///< they fix both directions of the way too: no bare corridor
};

/// Registers each scan's slice to that of the scan before: search of the turn, then point-to-line ICP with three
/// unknowns. 0.8 ms a scan. Allocates nothing. Not thread-safe.
class ScanMotion {
 public:
  explicit ScanMotion(const Eigen::Isometry3d& T_base_lidar);
  /// The next scan. Nothing for the first one and after a gap.
  std::optional<ScanStep> add(const Scan& scan);

 private:
  void fill(const Scan& scan, ScanProfile& profile) const;

  Eigen::Matrix3f R_base_lidar_;
  Eigen::Vector2d lever_m_;
  ScanProfile before_;
  ScanProfile after_;
  std::int64_t before_ns_ = 0;
  bool started_ = false;
};

/// Motion that takes the points of `after` onto the lines of `before`, of the lidar in its own axes.
ScanStep match_profiles(const ScanProfile& before, const ScanProfile& after);
/// Lines through the neighbours of each point.
void fit_lines(ScanProfile& profile);

}  // namespace isobar
