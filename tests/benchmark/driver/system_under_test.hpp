// SPDX-License-Identifier: BSD-3-Clause
// Adapter to registration and map: the only files of the benchmark that call Registration, LocalMap,
// MapSnapshot and the stages of a registration.
#pragma once

#include <cstddef>
#include <memory>

#include "core/map/local_map.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "core/registration/registration.hpp"
#include "daemon/lock_step.hpp"

namespace isobar::bench {

/// Registration and map, connected by snapshots as in isobard, but on one thread.
class SystemUnderTest {
 public:
  explicit SystemUnderTest(const StageSettings& settings);

  void add_prior(const Prior& prior) { registration_.add_prior(prior); }
  /// Work of the registration thread on a scan: pins the newest snapshot and registers.
  void register_scan(const Scan& scan, RegisteredScan& out);
  /// Work of the map thread on it, without the hand-over. True if the map has a new snapshot.
  bool update_map(const RegisteredScan& scan);
  /// Hand-over: publishes the newest snapshot, which frees older ones, then pins and releases it once.
  void hand_over();

  /// Newest snapshot.
  [[nodiscard]] const MapSnapshot& snapshot() const { return *map_.snapshot(); }
  [[nodiscard]] std::size_t cell_count() const { return map_.cell_count(); }
  [[nodiscard]] std::size_t tile_count() const { return map_.tile_count(); }
  [[nodiscard]] std::size_t plane_count() const { return snapshot().plane_count(); }
  /// One query as in matching: true if the map has a plane within `max_distance_m` of `p_map`.
  [[nodiscard]] bool has_plane_near(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map,
                                    double max_distance_m) const;

 private:
  Registration registration_;
  LocalMap map_;
  SnapshotExchange<MapSnapshot> snapshots_;
};

/// CPU time of one registration by stage [ms].
struct StageCosts {
  double deskew_ms = 0.0;
  double sample_ms = 0.0;
  double match_ms = 0.0;
  double solve_ms = 0.0;
};

/// Time of a registration by stage, without reading clocks inside it. Deskewing and sampling are repeated on
/// the same scan and timed; the rest is divided between matching and solving in the ratio of one timed
/// iteration over all points at the final pose (both process the same pairs in every iteration).
class StageProbe {
 public:
  explicit StageProbe(const StageSettings& settings);

  void add_prior(const Prior& prior) { history_.add(prior); }
  /// Deskewed points of `scan` (p_base at its end), and the prior there. Valid until the next call.
  std::span<const ScanPoint> deskew(const Scan& scan, Prior& end);
  /// `registered`: result of register_scan() for `scan` against `map`, which took `registration_ms`.
  StageCosts split(const Scan& scan, const MapSnapshot& map, const RegisteredScan& registered,
                   double registration_ms);

 private:
  [[nodiscard]] double time_match(const MapSnapshot& map, const PoseEstimate& pose);
  [[nodiscard]] double time_solve(const PoseEstimate& pose) const;

  RegistrationConfig config_;
  Eigen::Vector3d p_base_lidar_;
  PriorHistory history_;
  Deskewer deskewer_;
  Sampler sampler_;
  Correspondences correspondences_;
  std::span<const Pair> pairs_;
  std::unique_ptr<RegisteredScan> scratch_;
};

}  // namespace isobar::bench
