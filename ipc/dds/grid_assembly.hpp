// SPDX-License-Identifier: BSD-3-Clause
// The occupancy grid of a floor, put together from its pieces in shared memory, as nav_msgs/OccupancyGrid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/dds/topics.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

/// Takes the pieces one by one. The newest whole grid stays until the next one is whole.
class GridAssembly {
 public:
  /// Most cells of a grid: 400 x 400 m at 5 cm.
  static constexpr std::uint64_t kMaxCells = 64'000'000;

  /// A first piece begins another grid; a piece without those before it is ignored, and the grid with it. Pieces of the
  /// whole grid that are sent again are ignored.
  /// @return true when another grid has become whole
  bool add(const ipc::FloorGrid& piece);
  /// Whether there is a whole grid.
  [[nodiscard]] bool complete() const noexcept { return whole_.known; }
  /// Pieces refused: more than kMaxCells cells, a number that is not finite, rows beyond the grid.
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  /// Map frame of the whole grid.
  [[nodiscard]] std::uint32_t session() const noexcept { return whole_.session; }

  /// The whole grid. Requires complete(). Valid until the next add(), and during the lifetime of `frame`.
  /// @param shift_ns added to its stamp
  [[nodiscard]] const GridMessage& message(const std::string& frame, std::int64_t shift_ns) noexcept;

 private:
  struct Grid {
    bool known = false;  ///< whole, or being put together
    std::int64_t stamp_ns = 0;
    std::uint32_t sequence = 0;
    std::uint32_t session = 1;
    double z_m = 0.0;
    double resolution_m = 0.0;
    double origin_x_m = 0.0;
    double origin_y_m = 0.0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::int8_t> cells;
  };
  [[nodiscard]] static bool is_sound(const ipc::FloorGrid& piece) noexcept;
  [[nodiscard]] static bool belongs_to(const ipc::FloorGrid& piece, const Grid& grid) noexcept;
  void begin(const ipc::FloorGrid& piece);

  Grid whole_;
  Grid next_;
  std::uint64_t refused_ = 0;
  GridMessage message_{};
};

}  // namespace isobar::dds
