// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/grid_assembly.hpp"

#include <cmath>
#include <utility>

#include "ipc/dds/messages.hpp"

namespace isobar::dds {
namespace {

/// Beyond this no floor is [m].
constexpr double kFarthestM = 1e7;
/// Sizes of a cell that a planner may use [m].
constexpr double kFinestM = 1e-3;
constexpr double kCoarsestM = 100.0;

bool is_near(double m) { return std::isfinite(m) && std::abs(m) <= kFarthestM; }

}  // namespace

bool GridAssembly::is_sound(const ipc::FloorGrid& piece) noexcept {
  const std::uint64_t cells = std::uint64_t{piece.width} * piece.height;
  return cells > 0 && cells <= kMaxCells && piece.row_count > 0 && piece.first_row < piece.height &&
         piece.row_count <= piece.height - piece.first_row &&
         std::uint64_t{piece.row_count} * piece.width <= ipc::FloorGrid::kMaxCells &&
         is_near(piece.origin_x_m) && is_near(piece.origin_y_m) && is_near(piece.z_m) &&
         piece.resolution_m >= kFinestM && piece.resolution_m <= kCoarsestM;
}

bool GridAssembly::belongs_to(const ipc::FloorGrid& piece, const Grid& grid) noexcept {
  return grid.known && piece.sequence == grid.sequence && piece.session == grid.session &&
         piece.width == grid.width && piece.height == grid.height;
}

void GridAssembly::begin(const ipc::FloorGrid& piece) {
  next_.known = true;
  next_.stamp_ns = piece.stamp_ns;
  next_.sequence = piece.sequence;
  next_.session = piece.session;
  next_.z_m = piece.z_m;
  next_.resolution_m = piece.resolution_m;
  next_.origin_x_m = piece.origin_x_m;
  next_.origin_y_m = piece.origin_y_m;
  next_.width = piece.width;
  next_.height = piece.height;
  next_.cells.clear();
}

bool GridAssembly::add(const ipc::FloorGrid& piece) {
  if (!is_sound(piece)) {
    ++refused_;
    next_.known = false;
    return false;
  }
  if (belongs_to(piece, whole_) && piece.stamp_ns == whole_.stamp_ns) return false;
  if (piece.first_row == 0) begin(piece);
  const bool follows =
      belongs_to(piece, next_) && next_.cells.size() == std::uint64_t{piece.first_row} * piece.width;
  if (!follows) {
    next_.known = false;
    return false;
  }
  next_.cells.insert(next_.cells.end(), piece.cells,
                     piece.cells + std::size_t{piece.row_count} * piece.width);
  if (next_.cells.size() < std::uint64_t{piece.width} * piece.height) return false;
  std::swap(whole_, next_);
  next_.known = false;
  return true;
}

const GridMessage& GridAssembly::message(const std::string& frame, std::int64_t shift_ns) noexcept {
  fill_header(whole_.stamp_ns + shift_ns, frame, message_.header);
  message_.info.map_load_time = message_.header.stamp;
  message_.info.resolution = static_cast<float>(whole_.resolution_m);
  message_.info.width = whole_.width;
  message_.info.height = whole_.height;
  message_.info.origin.position = {whole_.origin_x_m, whole_.origin_y_m, whole_.z_m};
  message_.info.origin.orientation = {0.0, 0.0, 0.0, 1.0};
  message_.data._length = message_.data._maximum = static_cast<std::uint32_t>(whole_.cells.size());
  message_.data._buffer = reinterpret_cast<std::uint8_t*>(whole_.cells.data());  // NOLINT: int8 as octets
  return message_;
}

}  // namespace isobar::dds
