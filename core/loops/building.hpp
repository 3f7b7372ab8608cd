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
  Building(const LoopConfig& config, const MapConfig& map, const RegistrationConfig& registration,
           const Eigen::Isometry3d& T_base_lidar);

  /// Takes a registered scan with the height of the air at it.
  /// @return true when loops have changed corrections()
  bool add(const RegisteredScan& scan, const std::optional<AirHeight>& air);

  /// Poses of all key scans, live and corrected; none without a loop, since then nothing corrects the live poses.
  [[nodiscard]] std::vector<CorrectedKey> corrections() const;
  [[nodiscard]] const BuildingCounts& counts() const { return counts_; }
  [[nodiscard]] const std::vector<Submap>& submaps() const { return chain_.submaps(); }
  [[nodiscard]] const std::vector<Loop>& loops() const { return loops_; }
  [[nodiscard]] const PoseGraph& graph() const { return graph_; }

 private:
  struct Candidate {
    std::size_t submap;
    double distance_m;
  };

  void add_node(const std::optional<AirHeight>& air);
  [[nodiscard]] Eigen::Isometry3d T_map_submap(std::size_t number) const;
  [[nodiscard]] std::vector<Candidate> candidates(const KeyScan& key);
  [[nodiscard]] std::optional<LoopGuess> guess(std::size_t submap, const KeyScan& key);
  bool look_for_loops(const RegisteredScan& scan);
  [[nodiscard]] LoopEvidence evidence_of(const Loop& loop, const LoopGuess& guess) const;
  bool accept(const std::vector<Loop>& loops);

  LoopSearchConfig search_;
  std::size_t most_planes_;
  SubmapChain chain_;
  LoopMatcher matcher_;
  LoopPairs pairs_;
  PoseGraph graph_;
  std::vector<Loop> loops_;
  BuildingCounts counts_;
};

}  // namespace isobar
