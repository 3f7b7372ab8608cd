// SPDX-License-Identifier: BSD-3-Clause
// The occupancy grid of the robot's floor, in shared memory.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/floors/occupancy_grid.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Floor and time of a grid.
struct GridOrigin {
  std::int64_t stamp_ns = 0;      ///< of the newest scan in it, robot clock
  std::uint32_t session = 1;      ///< number of the map frame
  std::int32_t floor = 0;         ///< number of the floor
  std::string_view floor_name{};  ///< cut to ipc::kFloorNameBytes
};

/// Publishes grids in pieces of a megabyte, one a step, so that a large one fills neither the shared memory nor the time of
/// a step. Of one floor at most one grid in kIntervalNs, and none that equals the one before; another floor's at once. The
/// newest is sent again every kRepeatNs, and when the first subscriber comes. Nothing without subscribers. One thread.
class FloorGridPublisher {
 public:
  static constexpr std::int64_t kIntervalNs = 1'000'000'000;
  static constexpr std::int64_t kRepeatNs = 5'000'000'000;
  /// Most cells of a grid, as of its readers (dds::GridAssembly).
  static constexpr std::uint64_t kMaxCells = 64'000'000;

  /// Whether offer() would take a grid of this floor: to be asked before one is made.
  [[nodiscard]] bool is_due(const GridOrigin& origin, std::int64_t now_ns) const noexcept;
  /// Takes a grid. Refuses one that is not due, equals the last one, or is malformed (size, finiteness; counted).
  /// @param now_ns robot clock
  bool offer(OccupancyGrid grid, const GridOrigin& origin, std::int64_t now_ns);
  /// Sends the next piece, if there is one.
  void step(std::int64_t now_ns) noexcept;
  /// Grids refused as malformed.
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

 private:
  [[nodiscard]] bool is_sending() const noexcept { return static_cast<int>(next_row_) < grid_.height; }
  [[nodiscard]] bool is_other_floor(const GridOrigin& origin) const noexcept;
  void send_piece() noexcept;

  ipc::Publisher<ipc::FloorGrid> grids_{ipc::topics::kFloorGrid};
  OccupancyGrid grid_;  ///< the newest; height 0: none
  GridOrigin origin_;
  std::array<char, ipc::kFloorNameBytes> name_{};
  std::uint32_t sequence_ = 0;
  std::uint32_t next_row_ = 0;  ///< first row that is not sent
  std::int64_t began_ns_ = 0;   ///< when the newest grid, or its repetition, began
  std::int64_t taken_ns_ = 0;   ///< when the newest grid was taken
  bool had_subscribers_ = false;
  std::uint64_t refused_ = 0;
};

}  // namespace isobar
