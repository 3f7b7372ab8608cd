// SPDX-License-Identifier: BSD-3-Clause
// Key scans: a thin choice of the registered scans, from which submaps are made and loops are measured.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/estimates.hpp"

namespace isobar {

/// Height of base_link from air pressure at a scan, free of the scans.
struct AirHeight {
  double height_m = 0.0;     ///< above the altimeter's zero
  double variance_m2 = 0.0;  ///< of its noise; the altimeter's bias is not in it
};

/// Where a storage keeps the points of a scan.
using ScanHandle = std::uint64_t;
inline constexpr ScanHandle kNoScanHandle = ~ScanHandle{0};

/// A scan that was registered live, with the sample that is matched to submaps.
struct KeyScan {
  std::int64_t stamp_ns = 0;
  double way_m = 0.0;                                               ///< driven since the start
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();     ///< as estimated live
  std::uint32_t map_moves = 0;                                      ///< of T_map_base, see MapMove
  Eigen::Isometry3d T_submap_base = Eigen::Isometry3d::Identity();  ///< in the submap that holds the key scan
  std::optional<AirHeight> air;
  std::vector<Eigen::Vector3f> p_base;  ///< sample of the points [m]; empty where no loop is measured
  ScanHandle scan = kNoScanHandle;      ///< in the building's storage
};

/// Evenly chosen points of a scan, at most `most`, in place of `sample`'s content.
void take_sample(const RegisteredScan& scan, std::size_t most, std::vector<Eigen::Vector3f>& sample);

/// Chooses key scans: half a metre or 15 degrees apart, and at a speed at which that is every scan, 0.2 s.
class KeyScanChoice {
 public:
  static constexpr double kDistanceM = 0.5;
  static constexpr double kAngleDeg = 15.0;
  static constexpr double kLeastS = 0.15;

  /// True if the scan is a key scan: registered, fit for the map, and far enough from the last one.
  [[nodiscard]] bool wants(const PoseEstimate& pose) const;
  /// Goes on after a way that was driven in an earlier run.
  void begin_at(double way_m) { way_m_ = way_m; }
  /// The map has been moved, and the robot with it.
  void follow_map(const Eigen::Isometry3d& T_now_before) { T_map_last_ = T_now_before * T_map_last_; }
  /// The scan becomes the last key scan.
  void take(const PoseEstimate& pose);
  /// Way through all key scans [m].
  [[nodiscard]] double way_m() const { return way_m_; }

 private:
  Eigen::Isometry3d T_map_last_ = Eigen::Isometry3d::Identity();
  std::int64_t last_ns_ = 0;
  bool any_ = false;
  double way_m_ = 0.0;
};

}  // namespace isobar
