// SPDX-License-Identifier: BSD-3-Clause
// Two buildings that share a part become one:
//
//     B's key scans ─▶ places in A's map ─▶ common frame ─▶ joined graph ─▶ loops between both ─▶ poses of all key scans
//
// The frame is that of A. Loops between both are found and confirmed as those of one run (building.hpp): floors that look the
// same are kept apart by the heights of the air.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/loops/building_storage.hpp"
#include "core/loops/loop_config.hpp"
#include "core/map/map_config.hpp"
#include "core/merge/frame_vote.hpp"
#include "core/merge/joined_buildings.hpp"
#include "core/merge/place_finder.hpp"
#include "core/place/known_map.hpp"
#include "core/registration/registration_config.hpp"

namespace isobar {

/// A building, and what reads its scans.
struct MergeSide {
  StoredBuilding building;
  BuildingStorage& scans;  // NOLINT(cppcoreguidelines-avoid-const-or-ref-data-members)
  Eigen::Isometry3d T_base_lidar = Eigen::Isometry3d::Identity();
};

/// Settings of both runs: those of A.
struct MergeSettings {
  LoopConfig loops;
  MapConfig map;
  RegistrationConfig registration;
};

/// Figures of a merge.
struct MergeFigures {
  std::size_t searched = 0;  ///< places of B
  FrameVerdict frame;
  std::size_t tried = 0;                                    ///< matches of key scans of B to submaps of A
  std::size_t matched = 0;                                  ///< of them, that passed all tests
  std::size_t loops = 0;                                    ///< of them, that agree with all others
  double rms_m = 0.0;                                       ///< of these loops to the poses of the result
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< where the first submap of B came to lie
};

/// Result of a merge.
struct MergedBuilding {
  /// Submaps and loops of both. KeyScan::T_map_base: as the loops have it, in A's frame.
  JoinedBuildings joined;
  MergeFigures figures;
  std::string problem;  ///< why B does not fit; empty: it does, and `joined` is whole
};

/// Merges two buildings. Minutes for kilometres; allocates. One thread.
class BuildingMerger {
 public:
  /// Share of the work that is done, 0 … 1.
  using Progress = std::function<void(double)>;

  /// `map_a`: of the tiles of A. All outlive the merger.
  BuildingMerger(const MergeSettings& settings, const MergeSide& a, const KnownMap& map_a, const MergeSide& b,
                 Progress progress = {});

  /// @param height what the air says of both frames
  [[nodiscard]] MergedBuilding run(const HeightRelation& height);

 private:
  [[nodiscard]] std::unique_ptr<Building> posed(const MergeSide& side) const;
  void find_frame(const Building& b, const HeightRelation& height);
  [[nodiscard]] Loop seed(const Building& a, const Building& b, const ChosenHypothesis& chosen) const;
  [[nodiscard]] std::size_t nearest_submap(const Building& a, const Eigen::Vector3d& p_a) const;
  void find_loops(const Building& a, const Building& b, JoinedBuildings& joined);
  void conclude(const Building& b, JoinedBuildings& joined);
  void report(double share) const {
    if (progress_) progress_(share);
  }

  MergeSettings settings_;
  const MergeSide& a_;
  const KnownMap& map_a_;
  const MergeSide& b_;
  Progress progress_;
  JoinedScans scans_;
  std::vector<PlaceFinder::KeyPlace> places_;
  std::vector<PlaceVote> votes_;
  MergedBuilding merged_;
};

}  // namespace isobar
