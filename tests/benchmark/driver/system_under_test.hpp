// SPDX-License-Identifier: BSD-3-Clause
// Registration and map as the benchmark sees them. This pair of files is the only one of the benchmark that
// calls Registration, LocalMap, MapSnapshot and the stages of a registration: what changes there changes
// here.
#pragma once

#include <cstddef>
#include <memory>

#include "core/map/local_map.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "core/registration/registration.hpp"
#include "daemon/lock_step.hpp"

namespace isobar::bench {

/// Registration and map, joined as in isobard by the exchange of snapshots, but on one thread.
class SystemUnderTest {
 public:
  explicit SystemUnderTest(const StageSettings& settings);

  void add_prior(const Prior& prior) { registration_.add_prior(prior); }
  /// What the registration thread does with a scan: pins the newest snapshot and registers.
  void register_scan(const Scan& scan, RegisteredScan& out);
  /// What the map thread does with it, but for the hand-over. True where the map has a new snapshot.
  bool update_map(const RegisteredScan& scan);
  /// Publishes the newest snapshot, which frees the older ones, and pins and lets go of it once.
  void hand_over();

  /// The newest snapshot.
  [[nodiscard]] const MapSnapshot& snapshot() const { return *map_.snapshot(); }
  [[nodiscard]] std::size_t cell_count() const { return map_.cell_count(); }
  [[nodiscard]] std::size_t tile_count() const { return map_.tile_count(); }
  [[nodiscard]] std::size_t plane_count() const { return snapshot().plane_count(); }
  /// True if the map has a plane within `max_distance_m` of `p_map`: one raw query, as a match makes it.
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

/// Splits the time of a registration by stage, without a clock inside of it: deskewing and sampling are done
/// again on the same scan and timed; what remains of the registration is divided between matching and solving
/// in the proportion of one iteration over all points at the final pose. (Both cost the same share in every
/// iteration, since both run over the same pairs.)
class StageProbe {
 public:
  explicit StageProbe(const StageSettings& settings);

  void add_prior(const Prior& prior) { history_.add(prior); }
  /// All points of `scan`, p_base at its end, and the prior there. Valid until the next call.
  std::span<const ScanPoint> deskew(const Scan& scan, Prior& end);
  /// `registered`: what register_scan() made of `scan` against `map` in `registration_ms`.
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
