// SPDX-License-Identifier: BSD-3-Clause
// A floor on which the robot has just arrived, before it is driven enough to count as one.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/floors/floor.hpp"
#include "core/floors/ground_columns.hpp"

namespace isobar {

/// Opens a provisional floor where the robot has been level for 0.5 m or 0.5 s, a usual storey (kLowestStoreyM) or more
/// from all floors, and either a multiple of the building's storeys from them, or the map holds wide, level ground around
/// it: that is so neither on stairs and landings nor in an elevator's cabin, nor on a ramp. find_floors() confirms it later.
/// It is dropped when the robot leaves its height before; no other provisional floor is then given its number.
class FirstArrival {
 public:
  static constexpr double kLeastAreaM2 =
      5.0;  ///< of level ground within kReachM; landings that are seen have 3
  static constexpr double kLeastExtentM = 4.0;  ///< of it, along x or y
  static constexpr double kReachM = 8.0;        ///< around the robot in plan

  /// The robot is here. @param p_map_base base_link in the map frame [m]
  void drive_to(std::int64_t stamp_ns, const Eigen::Vector3d& p_map_base);
  /// Adds a provisional floor at the newest place to `floors`, where all conditions hold. True if it has.
  /// @param ground of the map, finished
  bool open(const GroundColumns& ground, Floors& floors);
  /// Takes the floors that were found anew, and adds the provisional floor unless it is confirmed or dropped.
  void renew(Floors& floors);

 private:
  struct Place {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d p_map_base = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] bool is_level() const;
  bool insert(Floors& floors);

  std::deque<Place> way_;  ///< the last kWayM or kTimeNs
  std::optional<Floor> floor_;
  std::vector<Floor> dropped_;
};

}  // namespace isobar
