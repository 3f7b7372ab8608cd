// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/packed_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

constexpr double kSteps = 32'767.0;
constexpr float kNormalSteps = 127.0F;
constexpr double kFarthestPackedM = 1e7;

bool is_sound(const MapPoint& point) {
  return point.p_map.allFinite() && point.p_map.cwiseAbs().maxCoeff() < kFarthestPackedM &&
         point.normal_map.allFinite();
}

std::int8_t packed(float part_of_normal) {
  return static_cast<std::int8_t>(std::lround(std::clamp(part_of_normal, -1.0F, 1.0F) * kNormalSteps));
}

}  // namespace

PackedPoints::PackedPoints(std::span<const MapPoint> points) {
  Eigen::AlignedBox3d box;
  for (const MapPoint& point : points) {
    if (is_sound(point)) box.extend(point.p_map);
  }
  if (box.isEmpty()) return;
  middle_m_ = box.center();
  unit_m_ = std::max(0.5 * box.sizes().maxCoeff(), 1e-6) / kSteps;
  points_.reserve(points.size());
  for (const MapPoint& point : points) {
    if (!is_sound(point)) continue;
    Point next;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const double steps = (point.p_map[axis] - middle_m_[axis]) / unit_m_;
      next.p[i] = static_cast<std::int16_t>(std::lround(std::clamp(steps, -kSteps, kSteps)));
      next.normal[i] = packed(point.normal_map[axis]);
    }
    next.observations = point.observations;
    next.filled = point.filled;
    points_.push_back(next);
  }
}

void PackedPoints::unpack(std::vector<MapPoint>& points) const {
  points.clear();
  points.reserve(points_.size());
  for (const Point& packed_point : points_) {
    MapPoint point;
    point.p_map =
        middle_m_ + unit_m_ * Eigen::Vector3d(packed_point.p[0], packed_point.p[1], packed_point.p[2]);
    point.normal_map =
        Eigen::Vector3f(packed_point.normal[0], packed_point.normal[1], packed_point.normal[2]);
    if (point.normal_map.squaredNorm() > 0.0F) point.normal_map.normalize();
    point.observations = packed_point.observations;
    point.filled = packed_point.filled;
    points.push_back(point);
  }
}

}  // namespace isobar
