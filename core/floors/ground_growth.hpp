// SPDX-License-Identifier: BSD-3-Clause
// Ground that is reached from a path without steps: region growing over the surfaces of columns.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <unordered_set>
#include <vector>

#include "core/floors/floor.hpp"
#include "core/floors/ground_columns.hpp"

namespace isobar {

/// One height a column: surfaces nearest to the floor's height are reached first, so that where a ramp turns above
/// itself the part next to the floor is taken.
class GroundGrowth {
 public:
  struct Reached {
    ColumnIndex column;
    float height_m = 0.0F;
  };

  /// @param within heights that are reached at all
  GroundGrowth(const GroundColumns& columns, const Floor& floor, const Floors::Slab& within);

  /// The ground below the robot at a place of its path: a start of the growth.
  void add_driven(const Eigen::Vector3d& p_ground_map);
  /// Reached columns, each once.
  [[nodiscard]] std::vector<Reached> grow();

 private:
  struct Candidate {
    float penalty_m = 0.0F;  // distance from the floor's heights
    std::uint32_t order = 0;
    Reached at;
    // Reversed, for std::priority_queue: the smallest penalty first, then the oldest.
    bool operator<(const Candidate& other) const {
      return penalty_m != other.penalty_m ? penalty_m > other.penalty_m : order > other.order;
    }
  };

  void propose(const ColumnIndex& column, float height_m);
  void propose_level_ground();
  [[nodiscard]] bool take(const ColumnIndex& column);
  void propose_around(const Reached& from);

  const GroundColumns& columns_;
  Floor floor_;
  Floors::Slab within_;
  std::priority_queue<Candidate> candidates_;
  std::uint32_t order_ = 0;
  std::unordered_set<std::uint64_t> taken_;
  ColumnIndex last_driven_{INT32_MAX, INT32_MAX};
};

}  // namespace isobar
