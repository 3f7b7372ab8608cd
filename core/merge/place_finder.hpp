// SPDX-License-Identifier: BSD-3-Clause
// Places of a building, searched in the map of another run.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/loops/building.hpp"
#include "core/loops/building_storage.hpp"
#include "core/merge/frame_vote.hpp"
#include "core/place/cold_start.hpp"
#include "core/place/known_map.hpp"
#include "core/registration/registration_config.hpp"

namespace isobar {

/// Height of the origin of map B in map A.
struct HeightRelation {
  double z_a_b_m = 0.0;
  double sigma_m = 30.0;  ///< the default: nothing ties the heights, all levels of A are searched
};

/// Key scans that are searched, and votes about the frame. One thread.
class PlaceFinder {
 public:
  /// Places that are searched at most: some tenths of a second each.
  static constexpr std::size_t kMostPlaces = 24;

  PlaceFinder(const KnownMap& a, const RegistrationConfig& registration,
              const Eigen::Isometry3d& T_base_lidar_b, BuildingStorage& scans_b);

  /// Where a key scan stands in a building.
  struct KeyPlace {
    std::size_t submap = 0;
    std::size_t key = 0;
  };
  /// Places along the whole way, kOnePlaceM or more of way apart, evenly spread.
  [[nodiscard]] static std::vector<KeyPlace> places_of(const Building& b);
  /// Searches one place: what its key scan and some of its submap beside it have seen.
  [[nodiscard]] PlaceVote look(const Building& b, const KeyPlace& at, const HeightRelation& height);

 private:
  void add_scans(const Submap& submap, std::size_t middle, const Eigen::Isometry3d& T_level_submap);
  bool add_scan(const KeyScan& key, const Eigen::Isometry3d& T_level_submap, bool has_rays);

  const KnownMap& a_;
  Eigen::Isometry3d T_base_lidar_;
  BuildingStorage& scans_;
  ColdStart cold_start_;
  PlaceQuery query_;
  std::unique_ptr<RegisteredScan> scan_;
  std::vector<Eigen::Vector3f> p_level_;  // scratch
};

}  // namespace isobar
