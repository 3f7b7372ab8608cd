// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/correlative_search.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

constexpr double kStepRad = 2.0 * std::numbers::pi / kYawSteps;

double cells(double length_m) { return length_m / static_cast<double>(kPlaceCellM); }

// Angle in -pi … pi.
double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

// Bounds of a window as cells of the image, also where they are infinite.
int clamped_cell(double coordinate_m, int first, int size) {
  return static_cast<int>(std::clamp(std::floor(cells(coordinate_m)) - first, 0.0, double(size - 1)));
}

}  // namespace

const std::vector<SlabPose>& CorrelativeSearch::find(const SlabImage& image, const SlabPyramid& pyramid,
                                                     std::span<const Eigen::Vector2f> columns,
                                                     const SearchWindow& window, const SearchLimits& limits) {
  found_.clear();
  heap_.clear();
  nodes_ = 0;
  complete_ = true;
  if (image.empty() || columns.empty()) return found_;
  first_x_ = image.first_x();
  first_y_ = image.first_y();
  start(pyramid, columns, window, limits);
  add_roots();
  while (!heap_.empty() && found_.size() < limits_.most_hypotheses) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Node node = heap_.back();
    heap_.pop_back();
    if (node.bound < least_) break;
    if (hidden(node)) continue;
    if (node.level > 0) {
      expand(node);
      if (nodes_ * columns.size() <= limits_.most_sums) continue;
      complete_ = false;
      break;
    }
    found_.push_back(pose_of(node));
    const auto of_best = static_cast<std::uint32_t>(limits_.least_share_of_best * double(node.bound));
    if (found_.size() == 1) least_ = std::max(least_, of_best);
  }
  return found_;
}

void CorrelativeSearch::start(const SlabPyramid& pyramid, std::span<const Eigen::Vector2f> columns,
                              const SearchWindow& window, const SearchLimits& limits) {
  pyramid_ = &pyramid;
  columns_ = columns;
  window_ = window;
  limits_ = limits;
  const SlabPyramid::Level& image = pyramid.level(0);
  low_column_ = clamped_cell(window.box.low.x(), first_x_, image.width);
  high_column_ = clamped_cell(window.box.high.x(), first_x_, image.width);
  low_row_ = clamped_cell(window.box.low.y(), first_y_, image.height);
  high_row_ = clamped_cell(window.box.high.y(), first_y_, image.height);
  least_ = static_cast<std::uint32_t>(
      std::ceil(std::clamp(limits.least_score, 0.01, 1.0) * double(columns.size() * SlabImage::kFullScore)));
  for (int level = 0; level <= SlabPyramid::kTop; ++level) {
    auto& table = turned_[static_cast<std::size_t>(level)];
    table.resize(static_cast<std::size_t>(kYawSteps >> level));
    for (Turned& one : table) one.known = false;
  }
}

// Entries to which the points move when the robot, in block 0, has the middle heading of the block of headings.
const CorrelativeSearch::Turned& CorrelativeSearch::turned(int level, int yaw) {
  Turned& one = turned_[static_cast<std::size_t>(level)][static_cast<std::size_t>(yaw)];
  if (one.known) return one;
  one.known = true;
  one.offsets.resize(columns_.size());
  const int stride = 1 << level;
  const double angle = (yaw * stride + 0.5 * (stride - 1)) * kStepRad;
  const auto cosine = static_cast<float>(std::cos(angle) / static_cast<double>(kPlaceCellM));
  const auto sine = static_cast<float>(std::sin(angle) / static_cast<double>(kPlaceCellM));
  const auto pitch = static_cast<std::int32_t>(pyramid_->level(level).pitch);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Eigen::Vector2f& p = columns_[i];
    const auto x = static_cast<std::int32_t>(std::floor(cosine * p.x() - sine * p.y() + 0.5F));
    const auto y = static_cast<std::int32_t>(std::floor(sine * p.x() + cosine * p.y() + 0.5F));
    one.offsets[i] = (y >> level) * pitch + (x >> level);
  }
  return one;
}

void CorrelativeSearch::add_roots() {
  for (int yaw = 0; yaw < kYawSteps >> SlabPyramid::kTop; ++yaw) {
    if (yaw_in_window(SlabPyramid::kTop, yaw)) add_roots_of(yaw);
  }
  std::make_heap(heap_.begin(), heap_.end());
}

void CorrelativeSearch::add_roots_of(int yaw) {
  constexpr int kTop = SlabPyramid::kTop;
  constexpr int kLanes = SlabPyramid::kLanes;
  const SlabPyramid::Level& level = pyramid_->level(kTop);
  const int border = SlabImage::kBorder >> kTop;
  const int last_column = std::min(high_column_ >> kTop, level.width - 1 - border);
  const int last_row = std::min(high_row_ >> kTop, level.height - 1 - border);
  for (int row = std::max(low_row_ >> kTop, border); row <= last_row; ++row) {
    int column = std::max(low_column_ >> kTop, border);
    while (column <= last_column) {
      if (pyramid_->standing(kTop, column, row)) {
        add_root_lanes(yaw, column, row, last_column);
        column += kLanes;
      } else {
        ++column;
      }
    }
  }
}

// Bounds of kLanes neighbouring blocks at once: the sums stay in registers.
void CorrelativeSearch::add_root_lanes(int yaw, int column, int row, int last_column) {
  constexpr int kTop = SlabPyramid::kTop;
  constexpr std::size_t kLanes = SlabPyramid::kLanes;
  const SlabPyramid::Level& level = pyramid_->level(kTop);
  const auto at = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * level.pitch) + column;
  const std::uint8_t* scores = level.scores + at;
  std::array<std::uint16_t, kLanes> sums{};
  for (const std::int32_t offset : turned(kTop, yaw).offsets) {
    const std::uint8_t* from = scores + offset;
    for (std::size_t i = 0; i < kLanes; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + from[i]);
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    const int lane = column + static_cast<int>(i);
    if (sums[i] < least_ || lane > last_column || !pyramid_->standing(kTop, lane, row)) continue;
    heap_.push_back({sums[i], static_cast<std::int16_t>(yaw), kTop, lane, row});
  }
}

void CorrelativeSearch::expand(const Node& node) {
  const int h = node.level - 1;
  for (int row = 2 * node.row; row <= 2 * node.row + 1; ++row) {
    if (row > high_row_ >> h || row < low_row_ >> h) continue;
    for (int column = 2 * node.column; column <= 2 * node.column + 1; ++column) {
      if (column > high_column_ >> h || column < low_column_ >> h) continue;
      if (!pyramid_->standing(h, column, row)) continue;
      for (int yaw = 2 * node.yaw; yaw <= 2 * node.yaw + 1; ++yaw) {
        if (!yaw_in_window(h, yaw)) continue;
        push({sum_at(h, yaw, column, row), static_cast<std::int16_t>(yaw), static_cast<std::uint8_t>(h),
              column, row});
      }
    }
  }
}

void CorrelativeSearch::push(const Node& node) {
  ++nodes_;
  if (node.bound < least_ || hidden(node)) return;
  heap_.push_back(node);
  std::push_heap(heap_.begin(), heap_.end());
}

std::uint32_t CorrelativeSearch::sum_at(int level, int yaw, int column, int row) {
  const SlabPyramid::Level& image = pyramid_->level(level);
  const std::uint8_t* scores =
      image.scores + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * image.pitch) + column;
  std::uint32_t sum = 0;
  for (const std::int32_t offset : turned(level, yaw).offsets) sum += scores[offset];
  return sum;
}

bool CorrelativeSearch::yaw_in_window(int level, int yaw) const {
  const int stride = 1 << level;
  const double middle = (yaw * stride + 0.5 * (stride - 1)) * kStepRad;
  const double half = 0.5 * (stride - 1) * kStepRad;
  return std::abs(wrapped(middle - window_.yaw_rad)) <= window_.half_yaw_rad + half + 1e-9;
}

// All of the node is near a hypothesis that is better.
bool CorrelativeSearch::hidden(const Node& node) const {
  const int stride = 1 << node.level;
  const double half = 0.5 * (stride - 1);
  const double x_m = (first_x_ + node.column * stride + half + 0.5) * static_cast<double>(kPlaceCellM);
  const double y_m = (first_y_ + node.row * stride + half + 0.5) * static_cast<double>(kPlaceCellM);
  const double yaw_rad = (node.yaw * stride + half) * kStepRad;
  const double near_m = limits_.apart_m - half * static_cast<double>(kPlaceCellM);
  const double near_rad = limits_.apart_rad - half * kStepRad;
  return std::any_of(found_.begin(), found_.end(), [&](const SlabPose& pose) {
    return std::abs(pose.x_m - x_m) < near_m && std::abs(pose.y_m - y_m) < near_m &&
           std::abs(wrapped(pose.yaw_rad - yaw_rad)) < near_rad;
  });
}

SlabPose CorrelativeSearch::pose_of(const Node& leaf) const {
  SlabPose pose;
  pose.x_m = (first_x_ + leaf.column + 0.5) * static_cast<double>(kPlaceCellM);
  pose.y_m = (first_y_ + leaf.row + 0.5) * static_cast<double>(kPlaceCellM);
  pose.yaw_rad = wrapped(leaf.yaw * kStepRad);
  pose.score = double(leaf.bound) / double(columns_.size() * SlabImage::kFullScore);
  return pose;
}

}  // namespace isobar
