// SPDX-License-Identifier: BSD-3-Clause
// Payloads about the floors of a building: which ones the map knows, which one the robot is on, and its occupancy grid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/floors/floor_place.hpp"

namespace isobar::ipc {

/// Longest name of a floor, with its terminating null [bytes].
inline constexpr std::size_t kFloorNameBytes = 48;

/// Some rows of the occupancy grid of one floor. All pieces of one sequence number, one after the other, are the grid. A
/// grid is sent again from time to time, with the same number, for readers that came later. About 1 MiB.
struct FloorGrid {
  static constexpr std::uint32_t kMaxCells = 1U << 20U;

  std::int64_t stamp_ns = 0;   ///< of the newest scan in the grid, robot clock
  std::uint32_t sequence = 0;  ///< number of the grid, equal in all its pieces; another grid has another one
  std::uint32_t session = 1;   ///< number of the map frame, as in PoseEstimate
  std::int32_t floor = 0;      ///< number of the floor, as in CurrentFloor
  char floor_name[kFloorNameBytes];  // NOLINT(modernize-avoid-c-arrays): null-terminated; may be empty
  double z_m = 0.0;                  ///< of the floor, map frame
  double resolution_m = 0.0;         ///< edge of a cell
  double origin_x_m = 0.0;           ///< corner of the first cell, smallest x and y, map frame
  double origin_y_m = 0.0;
  std::uint32_t width = 0;      ///< of the whole grid: cells along x
  std::uint32_t height = 0;     ///< of the whole grid: cells along y
  std::uint32_t first_row = 0;  ///< first row of this piece
  std::uint32_t row_count = 0;  ///< cells[0 … row_count * width - 1] are valid
  std::int8_t
      cells[kMaxCells];  // NOLINT(modernize-avoid-c-arrays): percent occupied, -1 unknown; rows along x

  FloorGrid() { floor_name[0] = '\0'; }  // NOLINT: user-provided, so that a loan does not zero 1 MiB
};

/// The floor that the robot is on.
struct CurrentFloor {
  std::int64_t stamp_ns = 0;  ///< of the pose from which it is told, robot clock
  std::uint32_t session = 1;  ///< number of the map frame
  bool known = false;         ///< false: no floor is told; number, name and z_m are then of the last one
  std::int32_t number = 0;    ///< of the floor in its building
  FloorPlace place = FloorPlace::kUnknown;  ///< kOnFloor where known
  double certainty = 0.0;                   ///< 0 … 1, probability that the robot is on this floor
  double z_m = 0.0;                         ///< of the floor, map frame
  char name[kFloorNameBytes] = {};          // NOLINT(modernize-avoid-c-arrays): null-terminated; may be empty
};

/// One floor of the map.
struct KnownFloor {
  std::int32_t number = 0;          ///< as in CurrentFloor
  double z_m = 0.0;                 ///< of the ground, map frame
  char name[kFloorNameBytes] = {};  // NOLINT(modernize-avoid-c-arrays): null-terminated; may be empty

  [[nodiscard]] bool operator==(const KnownFloor& other) const noexcept {
    return number == other.number && z_m == other.z_m && std::strncmp(name, other.name, sizeof name) == 0;
  }
};

/// All floors of the map: driven now, or known from the stored map or from before a restart. Sent when they change.
struct KnownFloors {
  static constexpr std::uint32_t kMost = 200;
  std::uint32_t session = 0;  ///< number of the map frame
  std::uint32_t count = 0;    ///< floors[0 … count - 1] are valid, the lowest first
  KnownFloor floors[kMost];   // NOLINT(modernize-avoid-c-arrays)

  [[nodiscard]] bool operator==(const KnownFloors& other) const noexcept {
    return session == other.session && count == other.count &&
           std::equal(floors, floors + std::min(count, kMost), other.floors);
  }
};

}  // namespace isobar::ipc
