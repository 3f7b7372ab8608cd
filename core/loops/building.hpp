// SPDX-License-Identifier: BSD-3-Clause
// The building as the run has seen it: submaps, the loops between them, and where all of it stands after the loops.
//
//     registered scan ─▶ submap chain ─▶ key scan ─▶ candidates ─▶ match ─▶ pairs ─▶ pose graph ─▶ corrections
//                                                        ▲                              │
//                                                        └──────────── poses ───────────┘
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/graph/pose_graph.hpp"
#include "core/loops/building_storage.hpp"
#include "core/loops/loop.hpp"
#include "core/loops/loop_config.hpp"
#include "core/loops/loop_evidence.hpp"
#include "core/loops/loop_matcher.hpp"
#include "core/loops/pose_corrections.hpp"
#include "core/loops/submap_chain.hpp"

namespace isobar {

/// Counters of a building.
struct BuildingCounts {
  std::uint64_t submaps = 0;
  std::uint64_t key_scans = 0;
  std::uint64_t tried = 0;     ///< matches of a key scan to a submap of an earlier visit
  std::uint64_t matched = 0;   ///< of them, that passed all tests
  std::uint64_t accepted = 0;  ///< of them, confirmed by a second one
  std::uint64_t taken = 0;     ///< of them, that agree with the graph

  friend BuildingCounts operator+(const BuildingCounts& a, const BuildingCounts& b) {
    return {a.submaps + b.submaps, a.key_scans + b.key_scans, a.tried + b.tried,
            a.matched + b.matched, a.accepted + b.accepted,   a.taken + b.taken};
  }
};

/// Finds the places that the robot sees again, and corrects the poses by them. One thread, not on the way of a scan.
class Building {
 public:
  /// `storage`: keeps the building; may be null. Outlives it.
  Building(const LoopConfig& config, const MapConfig& map, const RegistrationConfig& registration,
           const Eigen::Isometry3d& T_base_lidar, BuildingStorage* storage = nullptr);

  /// Goes on with a building of an earlier run, before the first scan.
  void continue_from(StoredBuilding stored);

  /// Takes a registered scan with the height of the air at it.
  /// @return true when loops have changed corrections()
  bool add(const RegisteredScan& scan, const std::optional<AirHeight>& air);

  /// Looks for loops of a key scan of continue_from() once more, to submaps 0 … `submaps` - 1: those of another run.
  /// `scan`: its points.
  /// @return true when loops have changed corrections()
  bool look_again(std::size_t holder, std::size_t key, const RegisteredScan& scan, std::size_t submaps);

  /// Poses of all key scans, live and corrected; none without a loop, since then nothing corrects the live poses.
  [[nodiscard]] std::vector<CorrectedKey> corrections() const;
  /// Stamps of the first live poses in a map that had been moved, ascending: PoseCorrections needs them.
  [[nodiscard]] const std::vector<std::int64_t>& moved_ns() const { return moved_ns_; }
  /// The map is going to be moved: scans whose pose counts one more PoseEstimate::map_moves are in the moved one.
  /// `T_now_before`: about z.
  [[nodiscard]] bool expects_move() const { return expected_move_.has_value(); }
  void expect_move(const Eigen::Isometry3d& T_now_before) { expected_move_ = T_now_before; }
  /// Pose of a submap, as the loops have it.
  [[nodiscard]] Eigen::Isometry3d T_map_submap(std::size_t number) const;
  [[nodiscard]] const BuildingCounts& counts() const { return counts_; }
  [[nodiscard]] const std::vector<Submap>& submaps() const { return chain_.submaps(); }
  /// The last key scan, and the submap that holds it. Precondition: there is one.
  [[nodiscard]] const KeyScan& last_key() const { return chain_.last_key(); }
  [[nodiscard]] std::size_t holder() const { return chain_.holder(); }
  [[nodiscard]] const std::vector<Loop>& loops() const { return loops_; }
  [[nodiscard]] const PoseGraph& graph() const { return graph_; }

 private:
  struct Candidate {
    std::size_t submap;
    double distance_m;
  };
  /// A key scan that loops are looked for, and where.
  struct Wanted {
    const KeyScan& key;
    std::size_t holder;
    const RegisteredScan& scan;
    std::size_t submaps;  ///< the first ones
  };

  void follow_map(const PoseEstimate& pose);
  void add_node(std::size_t number);
  void store(const RegisteredScan& scan, bool begins);
  [[nodiscard]] ChainLink place_of(const RegisteredScan& scan) const;
  [[nodiscard]] std::vector<Candidate> candidates(const Wanted& wanted) const;
  [[nodiscard]] std::optional<LoopGuess> guess(std::size_t submap, const Wanted& wanted);
  bool look_for_loops(const Wanted& wanted);
  [[nodiscard]] LoopEvidence evidence_of(const Loop& loop, const LoopGuess& guess) const;
  bool add_edge(const Loop& loop);
  bool accept(const std::vector<Loop>& loops);

  LoopSearchConfig search_;
  std::size_t most_planes_;
  BuildingStorage* storage_;
  bool continued_ = false;        // and no scan yet
  std::size_t moves_before_ = 0;  // of the map, in earlier runs
  std::vector<std::int64_t> moved_ns_;
  std::optional<Eigen::Isometry3d> expected_move_;
  SubmapChain chain_;
  LoopMatcher matcher_;
  LoopPairs pairs_;
  PoseGraph graph_;
  std::vector<Loop> loops_;
  BuildingCounts counts_;
};

}  // namespace isobar
