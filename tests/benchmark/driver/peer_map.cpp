// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/peer_map.hpp"

#include <pcl/common/centroid.h>
#include <pcl/search/impl/search.hpp>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace isobar::bench {

namespace {

// Edge of a voxel: small enough for the neighbour search below on a wall, large enough for a small tree.
constexpr float kVoxelM = 0.2F;
// Fit of a normal: search radius of its neighbours, and their smallest number.
constexpr double kNeighbourM = 0.6;
constexpr std::size_t kFewestNeighbours = 6;
// Ratio of variances across and along a line below which neighbours lie on one ring.
constexpr float kLineShare = 0.05F;
constexpr float kNoNormal = -1.0F;
// Motion of the robot after which far points are dropped.
constexpr float kForgetStepM = 10.0F;

}  // namespace

std::uint64_t PeerMap::voxel_of(const Eigen::Vector3f& p_map) {
  constexpr std::int64_t kHalfRange = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::int64_t>(std::floor(p_map[axis] / kVoxelM)) + kHalfRange;
    key = key << 21U | (static_cast<std::uint64_t>(index) & 0x1FFFFFU);
  }
  return key;
}

void PeerMap::add(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& T_map_base) {
  const Eigen::Isometry3f T = T_map_base.cast<float>();
  forget_far(T.translation());
  insert(cloud, T);
  fit_normals(T.translation());
  build_target();
}

void PeerMap::forget_far(const Eigen::Vector3f& p_map_base) {
  if ((p_map_base - p_forgot_at_).norm() < kForgetStepM) return;
  p_forgot_at_ = p_map_base;
  const auto radius = static_cast<float>(radius_m_);
  std::erase_if(points_->points, [&](const pcl::PointNormal& point) {
    const Eigen::Vector3f p_map = point.getVector3fMap();
    const bool far = (p_map - p_map_base).norm() > radius;
    if (far) voxels_.erase(voxel_of(p_map));
    return far;
  });
}

void PeerMap::insert(std::span<const ScanPoint> cloud, const Eigen::Isometry3f& T_map_base) {
  for (const ScanPoint& p_base : cloud) {
    const Eigen::Vector3f p_map = T_map_base * Eigen::Vector3f(p_base.x_m, p_base.y_m, p_base.z_m);
    if (!voxels_.try_emplace(voxel_of(p_map), true).second) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = p_map;
    point.curvature = kNoNormal;
    points_->push_back(point);
  }
  points_->width = static_cast<std::uint32_t>(points_->size());
  points_->height = 1;
}

void PeerMap::fit_normals(const Eigen::Vector3f& p_map_sensor) {
  neighbours_.setInputCloud(points_);
  for (pcl::PointNormal& point : points_->points) {
    if (point.curvature == kNoNormal) fit_normal(point, p_map_sensor);
  }
}

bool PeerMap::fit_normal(pcl::PointNormal& point, const Eigen::Vector3f& p_map_sensor) {
  neighbours_.radiusSearch(point, kNeighbourM, found_, squared_);
  if (found_.size() < kFewestNeighbours) return false;
  Eigen::Matrix3f covariance;
  Eigen::Vector4f centroid;
  pcl::computeMeanAndCovarianceMatrix(*points_, found_, covariance, centroid);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(covariance);
  const Eigen::Vector3f& variances = axes.eigenvalues();  // ascending
  if (variances[1] < kLineShare * variances[2]) return false;
  Eigen::Vector3f normal = axes.eigenvectors().col(0);
  if (normal.dot(p_map_sensor - point.getVector3fMap()) < 0.0F) normal = -normal;
  point.getNormalVector3fMap() = normal;
  point.curvature = std::max(0.0F, variances[0]) / variances.sum();
  return true;
}

void PeerMap::build_target() {
  PeerCloud::Ptr target(new PeerCloud);
  for (const pcl::PointNormal& point : points_->points) {
    if (point.curvature != kNoNormal) target->push_back(point);
  }
  if (target->empty()) return;
  target_ = target;
  tree_.reset(new pcl::search::KdTree<pcl::PointNormal>(false));
  tree_->setInputCloud(target_);
}

}  // namespace isobar::bench
