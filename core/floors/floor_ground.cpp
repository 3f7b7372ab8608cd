// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_ground.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/floors/ground_growth.hpp"

namespace isobar {

namespace {

constexpr int kFillColumns = 12;        // 3 m: walls stand at most this far from ground that is seen
constexpr double kMostColumns = 6.4e7;  // 2 km x 2 km
constexpr float kDropM = 0.25F;         // more than any threshold or kerb that the ground is grown over
constexpr float kDeepestDropM = 2.2F;   // below that it may be the floor below, under this one's slab
constexpr double kMarginM = 0.5;        // beyond the slab, so that its border is seen as a way on
constexpr double kColumnM = GroundColumns::kColumnM;

}  // namespace

FloorGround::FloorGround(const GroundColumns& columns, const Floors& floors, const Floor& floor,
                         std::span<const Eigen::Vector3d> path)
    : slab_(floors.slab_of(floor)) {
  for (const Eigen::Vector3d& p_map : path) {
    if (p_map.allFinite() && slab_.contains(p_map.z() - floors.base_height_m)) path_.push_back(p_map);
  }
  GroundGrowth growth(columns, floor, {slab_.lowest_m - kMarginM, slab_.highest_m + kMarginM});
  for (const Eigen::Vector3d& p_map : path) {
    if (p_map.allFinite()) growth.add_driven(p_map - floors.base_height_m * Eigen::Vector3d::UnitZ());
  }
  place(growth.grow());
  fill();
  mark_drops(columns);
  mark_driven();
}

const FloorGround::Column* FloorGround::find(const ColumnIndex& column) const {
  if (column.x < low_.x || column.y < low_.y || column.x >= high_.x || column.y >= high_.y) return nullptr;
  const auto width = static_cast<std::size_t>(high_.x - low_.x);
  return &columns_[static_cast<std::size_t>(column.y - low_.y) * width +
                   static_cast<std::size_t>(column.x - low_.x)];
}

FloorGround::Column* FloorGround::find(const ColumnIndex& column) {
  return const_cast<Column*>(std::as_const(*this).find(column));  // NOLINT(*-const-cast): *this is mutable
}

FloorGround::Kind FloorGround::kind(const ColumnIndex& column) const {
  const Column* found = find(column);
  return found != nullptr ? found->kind : Kind::kUnknown;
}

bool FloorGround::height_near(const ColumnIndex& column, float& height_m) const {
  const Column* found = find(column);
  if (found == nullptr || found->nearest != Kind::kGround) return false;
  height_m = found->height_m;
  return true;
}

bool FloorGround::is_driven(const ColumnIndex& column) const {
  const Column* found = find(column);
  return found != nullptr && found->driven;
}

void FloorGround::mark_driven() {
  for (const Eigen::Vector3d& p_map : path_) {
    const ColumnIndex centre = GroundColumns::column_of(p_map);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        Column* column = find({centre.x + dx, centre.y + dy});
        if (column != nullptr) column->driven = true;
      }
    }
  }
}

void FloorGround::place(const std::vector<GroundGrowth::Reached>& reached) {
  if (reached.empty()) return;
  low_ = high_ = reached.front().column;
  for (const GroundGrowth::Reached& at : reached) {
    low_ = {std::min(low_.x, at.column.x), std::min(low_.y, at.column.y)};
    high_ = {std::max(high_.x, at.column.x), std::max(high_.y, at.column.y)};
  }
  low_ = {low_.x - kFillColumns, low_.y - kFillColumns};
  high_ = {high_.x + kFillColumns + 1, high_.y + kFillColumns + 1};
  const double width = static_cast<double>(high_.x) - low_.x;
  const double height = static_cast<double>(high_.y) - low_.y;
  if (width * height > kMostColumns) {
    throw DataError("the floor extends over " + std::to_string(std::lround(width * kColumnM)) + " x " +
                    std::to_string(std::lround(height * kColumnM)) + " m, which is too large for one grid");
  }
  columns_.assign(static_cast<std::size_t>(width * height), {});
  for (const GroundGrowth::Reached& at : reached) {
    const Kind kind = slab_.contains(static_cast<double>(at.height_m)) ? Kind::kGround : Kind::kBeyond;
    *find(at.column) = {at.height_m, kind, kind, false};
  }
}

// Breadth first from all columns that have a height.
void FloorGround::fill() {
  std::vector<ColumnIndex> front;
  for (std::int32_t y = low_.y; y < high_.y; ++y) {
    for (std::int32_t x = low_.x; x < high_.x; ++x) {
      if (find({x, y})->kind != Kind::kUnknown) front.push_back({x, y});
    }
  }
  std::vector<ColumnIndex> next;
  for (int step = 0; step < kFillColumns && !front.empty(); ++step, front.swap(next), next.clear()) {
    for (const ColumnIndex& from : front) {
      const Column source = *find(from);
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const ColumnIndex to{from.x + dx, from.y + dy};
        Column* target = find(to);
        if (target == nullptr || target->nearest != Kind::kUnknown) continue;
        target->height_m = source.height_m;
        target->nearest = source.nearest;
        next.push_back(to);
      }
    }
  }
}

void FloorGround::mark_drops(const GroundColumns& columns) {
  for (const GroundColumns::Surface& surface : columns.surfaces()) {
    Column* column = find(surface.column);
    if (column == nullptr || column->kind != Kind::kUnknown || column->nearest != Kind::kGround) continue;
    const float below_m = column->height_m - surface.height_m;
    if (below_m > kDropM && below_m < kDeepestDropM) column->kind = Kind::kDrop;
  }
}

}  // namespace isobar
