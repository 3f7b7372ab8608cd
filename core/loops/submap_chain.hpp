// SPDX-License-Identifier: BSD-3-Clause
// Chain of submaps along the way: odometry that knows no place again.
//
// The live map pulls a robot that comes back onto what it mapped at the first visit: within some metres its poses take
// up the whole drift of the way between. A graph of those poses would see a motion where there was none. So on known
// ground each key scan is registered once more, to the map of the last metres only:
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

#include "core/loops/building_storage.hpp"
#include "core/loops/key_scan.hpp"
#include "core/loops/loop_config.hpp"
#include "core/loops/submap.hpp"
#include "core/map/local_map.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"

namespace isobar {

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

  /// Goes on with the submaps of an earlier run, before the first scan, as if the robot had driven `gap_m` between.
  void continue_from(std::vector<Submap> submaps, double gap_m);
  /// Place of the next scan, after continue_from(), in the last submap: upright, with its covariance as that of a link.
  void set_place(const ChainLink& place) { place_ = place; }

  /// Takes a registered scan. Scans that are no key scans are left out.
  ChainStep add(const RegisteredScan& scan, const std::optional<AirHeight>& air);

  /// All submaps; the last two may be growing.
  [[nodiscard]] const std::vector<Submap>& submaps() const { return submaps_; }
  /// Number of complete submaps, the first ones of submaps().
  [[nodiscard]] std::size_t complete() const { return complete_; }
  /// Place of submap `number` (1 …) in the one before it.
  [[nodiscard]] const ChainLink& link(std::size_t number) const { return submaps_[number].link; }
  /// The key scan of the last add() that was one; its submap is `holder()`.
  [[nodiscard]] const KeyScan& last_key() const { return submaps_[holder_].keys.back(); }
  [[nodiscard]] std::size_t holder() const { return holder_; }
  /// The scans from now on are of a map that has been moved; `T_now_before`: about z.
  void follow_map(const Eigen::Isometry3d& T_now_before);
  /// Storage keeps the scan of the last key scan.
  [[nodiscard]] KeyScan& last_key() { return submaps_[holder_].keys.back(); }
  /// Planes of a complete submap, and samples of its key scans: made anew where they were forgotten. Null where the storage
  /// cannot.
  const std::shared_ptr<const MapSnapshot>& planes_of(std::size_t number, BuildingStorage* storage);
  /// Frees the planes that were used longest ago, beyond `planes` in all.
  void forget_beyond(std::size_t planes);

 private:
  /// A submap that grows.
  struct Growing {
    std::size_t number;
    std::unique_ptr<LocalMap> map;
  };

  [[nodiscard]] Eigen::Isometry3d predicted(const RegisteredScan& scan) const;
  [[nodiscard]] bool on_new_ground(const RegisteredScan& scan);
  /// @return false where the motion is too uncertain for one submap
  bool take_step(const RegisteredScan& scan);
  void begin_submap(const RegisteredScan& scan, const std::optional<AirHeight>& air);
  void complete_oldest();
  void hold(const RegisteredScan& scan, const std::optional<AirHeight>& air);
  void insert(const RegisteredScan& scan);

  SubmapConfig config_;
  MapConfig map_config_;
  Eigen::Isometry3d T_base_lidar_;
  MethodTraits traits_;
  ScanMatcher matcher_;
  KeyScanChoice choice_;
  std::vector<Submap> submaps_;
  std::vector<Growing> growing_;  // the older one first
  std::size_t complete_ = 0;
  std::size_t holder_ = 0;
  std::vector<std::uint64_t> used_;  // by number: when planes_of() was last asked
  std::uint64_t uses_ = 0;
  ChainLink place_;             // of the first scan after continue_from()
  bool lost_ = false;           // since the last key scan
  bool known_ground_ = false;   // at the last key scan
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
