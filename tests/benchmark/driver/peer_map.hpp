// SPDX-License-Identifier: BSD-3-Clause
// Local map of the peers: points with normals and a PCL search tree, extended scan by scan.
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

/// At most one point per voxel. A point's normal is fitted to its neighbours in the map, from many scans and
/// rings. It becomes a target only if these span a plane: neighbours on one ring form a line.
class PeerMap {
 public:
  explicit PeerMap(double radius_m) : radius_m_(radius_m) {}

  /// Adds points (p_base) at `T_map_base`, fits new normals, and rebuilds the tree of the targets.
  void add(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& T_map_base);

  /// Points with normals, and their tree; null if there are none.
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
  PeerCloud::Ptr points_{new PeerCloud};                   // all points; without a normal: curvature -1
  std::unordered_map<std::uint64_t, bool> voxels_;         // occupied voxels
  Eigen::Vector3f p_forgot_at_ = Eigen::Vector3f::Zero();  // place of the last dropping of far points
  pcl::search::KdTree<pcl::PointNormal> neighbours_{false};
  PeerCloud::Ptr target_;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree_;
  std::vector<int> found_;
  std::vector<float> squared_;
};

}  // namespace isobar::bench
