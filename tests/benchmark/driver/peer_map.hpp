// SPDX-License-Identifier: BSD-3-Clause
// The local map of the peers: PCL's search tree over points with normals, grown scan by scan.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/samples.hpp"

namespace isobar::bench {

using PeerCloud = pcl::PointCloud<pcl::PointNormal>;

/// At most one point a voxel. A point's normal is that of its neighbours in the map, of many scans and rings;
/// it becomes a target only when these span a plane, since neighbours on one ring make a line.
class PeerMap {
 public:
  explicit PeerMap(double radius_m) : radius_m_(radius_m) {}

  /// Adds p_base placed at `T_map_base`, fits the normals that are new, and builds the tree of the targets.
  void add(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& T_map_base);

  /// Points with normals, and a tree over them. Null before there are any.
  [[nodiscard]] const PeerCloud::Ptr& target() const { return target_; }
  [[nodiscard]] const pcl::search::KdTree<pcl::PointNormal>::Ptr& tree() const { return tree_; }

 private:
  [[nodiscard]] static std::uint64_t voxel_of(const Eigen::Vector3f& p_map);
  void forget_far(const Eigen::Vector3f& p_map_base);
  void insert(std::span<const ScanPoint> cloud, const Eigen::Isometry3f& T_map_base);
  void fit_normals(const Eigen::Vector3f& p_map_sensor);
  bool fit_normal(pcl::PointNormal& point, const Eigen::Vector3f& p_map_sensor);
  void build_target();

  double radius_m_;
  PeerCloud::Ptr points_{new PeerCloud};                   // all; those without a normal have curvature -1
  std::unordered_map<std::uint64_t, bool> voxels_;         // those that hold a point
  Eigen::Vector3f p_forgot_at_ = Eigen::Vector3f::Zero();  // where far points were dropped last
  pcl::search::KdTree<pcl::PointNormal> neighbours_{false};
  PeerCloud::Ptr target_;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree_;
  std::vector<int> found_;
  std::vector<float> squared_;
};

}  // namespace isobar::bench
