// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_grid_publisher.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace isobar {
namespace {

bool is_sound(const OccupancyGrid& grid) {
  if (grid.width <= 0 || grid.height <= 0) return false;
  const auto width = static_cast<std::uint64_t>(grid.width);
  const std::uint64_t cells = width * static_cast<std::uint64_t>(grid.height);
  return cells == grid.cells.size() && cells <= FloorGridPublisher::kMaxCells &&
         width <= ipc::FloorGrid::kMaxCells && grid.origin_m.allFinite() && std::isfinite(grid.height_m) &&
         std::isfinite(grid.resolution_m) && grid.resolution_m > 0.0;
}

bool are_equal(const OccupancyGrid& a, const OccupancyGrid& b) {
  return a.resolution_m == b.resolution_m && a.origin_m == b.origin_m && a.width == b.width &&
         a.height == b.height && a.height_m == b.height_m && a.cells == b.cells;
}

}  // namespace

bool FloorGridPublisher::is_other_floor(const GridOrigin& origin) const noexcept {
  return grid_.height == 0 || origin.session != origin_.session || origin.floor != origin_.floor;
}

bool FloorGridPublisher::is_due(const GridOrigin& origin, std::int64_t now_ns) const noexcept {
  if (!grids_.has_subscribers()) return false;
  return is_other_floor(origin) || (!is_sending() && now_ns - taken_ns_ >= kIntervalNs);
}

bool FloorGridPublisher::offer(OccupancyGrid grid, const GridOrigin& origin, std::int64_t now_ns) {
  if (!is_due(origin, now_ns)) return false;
  if (!is_sound(grid)) {
    ++refused_;
    return false;
  }
  std::array<char, ipc::kFloorNameBytes> name{};
  ipc::copy_text(origin.floor_name, name.data(), name.size());
  taken_ns_ = now_ns;
  if (!is_other_floor(origin) && name == name_ && are_equal(grid, grid_)) return false;
  grid_ = std::move(grid);
  origin_ = origin;
  name_ = name;
  ++sequence_;
  next_row_ = 0;
  began_ns_ = now_ns;
  return true;
}

void FloorGridPublisher::step(std::int64_t now_ns) noexcept {
  const bool has_subscribers = grids_.has_subscribers();
  const bool is_first = has_subscribers && !std::exchange(had_subscribers_, has_subscribers);
  if (!has_subscribers || grid_.height == 0) return;
  if (is_first || (!is_sending() && now_ns - began_ns_ >= kRepeatNs)) {
    next_row_ = 0;
    began_ns_ = now_ns;
  }
  if (is_sending()) send_piece();
}

void FloorGridPublisher::send_piece() noexcept {
  ipc::FloorGrid* piece = grids_.loan();
  if (piece == nullptr) return;
  piece->stamp_ns = origin_.stamp_ns;
  piece->sequence = sequence_;
  piece->session = origin_.session;
  piece->floor = origin_.floor;
  std::copy(name_.begin(), name_.end(), piece->floor_name);
  piece->z_m = grid_.height_m;
  piece->resolution_m = grid_.resolution_m;
  piece->origin_x_m = grid_.origin_m.x();
  piece->origin_y_m = grid_.origin_m.y();
  piece->width = static_cast<std::uint32_t>(grid_.width);
  piece->height = static_cast<std::uint32_t>(grid_.height);
  piece->first_row = next_row_;
  piece->row_count = std::min(ipc::FloorGrid::kMaxCells / piece->width, piece->height - next_row_);
  std::copy_n(grid_.cells.begin() + static_cast<std::ptrdiff_t>(std::size_t{next_row_} * piece->width),
              std::size_t{piece->row_count} * piece->width, piece->cells);
  next_row_ += piece->row_count;
  grids_.publish(piece);
}

}  // namespace isobar
