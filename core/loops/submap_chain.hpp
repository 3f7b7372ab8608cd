// SPDX-License-Identifier: BSD-3-Clause
// Chain of submaps along the way: odometry that knows no place again.
//
// The live map pulls a robot that comes back onto what it mapped at the first visit: within some metres its poses take
// up the whole drift of the way between. A graph of those poses would see a motion where there was none. So each key
// scan is registered once more, to the map of the last metres only:
//
//     way ──────────────────────────────────────────────▶
//     submap 1  ▕░░░░░░░░░░░░░░████████████▏
//     submap 2                ▕░░░░░░░░░░░░░████████████▏
//     submap 3                             ▕░░░░░░░░░░░░░░ …
//
// Two submaps grow at a time. A key scan enters both, and is registered to the older one (█), which has seen the way
// before it. The older one holds the pose of the key scan.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/loops/key_scan.hpp"
#include "core/loops/loop_config.hpp"
#include "core/loops/submap.hpp"
#include "core/map/local_map.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"

namespace isobar {

/// Place of a submap in the one before it.
struct ChainLink {
  Eigen::Isometry3d T_before_submap = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< x, y, z [m], roll, pitch, yaw [rad], axes of the submap before
};

/// What a scan has changed.
struct ChainStep {
  bool key = false;     ///< the scan was a key scan
  bool begins = false;  ///< a submap began: the last link() tells its place in the one before
};

/// Makes submaps. One thread, not real-time: it allocates.
class SubmapChain {
 public:
  SubmapChain(const SubmapConfig& config, const MapConfig& map, const RegistrationConfig& registration,
              const Eigen::Isometry3d& T_base_lidar);

  /// Takes a registered scan. Scans that are no key scans are left out.
  ChainStep add(const RegisteredScan& scan, const std::optional<AirHeight>& air);

  /// All submaps; the last two may be growing.
  [[nodiscard]] const std::vector<Submap>& submaps() const { return submaps_; }
  /// Number of complete submaps, the first ones of submaps().
  [[nodiscard]] std::size_t complete() const { return complete_; }
  /// Place of submap `number` (1 …) in the one before it.
  [[nodiscard]] const ChainLink& link(std::size_t number) const { return links_[number]; }
  /// The key scan of the last add() that was one; its submap is `holder()`.
  [[nodiscard]] const KeyScan& last_key() const { return submaps_[holder_].keys.back(); }
  [[nodiscard]] std::size_t holder() const { return holder_; }
  /// Frees the planes of the oldest complete submaps beyond `planes` in all. Loops to them are found no more.
  void forget_beyond(std::size_t planes);

 private:
  /// A submap that grows.
  struct Growing {
    std::size_t number;
    std::unique_ptr<LocalMap> map;
  };

  [[nodiscard]] Eigen::Isometry3d predicted(const RegisteredScan& scan) const;
  /// @return false where the motion is too uncertain for one submap
  bool take_step(const RegisteredScan& scan);
  void begin_submap();
  void complete_oldest();
  void insert(const RegisteredScan& scan);
  void take_sample(const RegisteredScan& scan);

  SubmapConfig config_;
  MapConfig map_config_;
  Eigen::Isometry3d T_base_lidar_;
  MethodTraits traits_;
  ScanMatcher matcher_;
  KeyScanChoice choice_;
  std::vector<Submap> submaps_;
  std::vector<ChainLink> links_;  // by number; identity for the first
  std::vector<Growing> growing_;  // the older one first
  std::size_t complete_ = 0;
  std::size_t holder_ = 0;
  std::size_t forgotten_ = 0;   // submaps without planes, the first ones
  bool lost_ = false;           // since the last key scan
  double sampled_way_m_ = 0.0;  // of the last kept sample
  Vector6d variance_ =
      Vector6d::Zero();  // of the motion since the younger submap began, as ChainLink::covariance
  Eigen::Isometry3d T_map_live_ = Eigen::Isometry3d::Identity();  // of the last key scan
  Eigen::Isometry3d T_older_base_ =
      Eigen::Isometry3d::Identity();  // of the last key scan, in the older submap
  std::vector<Eigen::Vector3f> sample_;
  std::unique_ptr<RegisteredScan> moved_;  // scratch
};

}  // namespace isobar
