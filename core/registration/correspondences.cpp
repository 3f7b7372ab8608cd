// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/correspondences.hpp"

namespace isobar {

std::span<const Pair> Correspondences::find(const MapSnapshot& map, std::span<const Eigen::Vector3f> p_base,
                                            std::size_t stride, const Eigen::Isometry3d& T_map_base,
                                            const Eigen::Vector3d& p_base_lidar, double max_distance_m) {
  pairs_.clear();
  const Eigen::Vector3d viewpoint_map = T_map_base * p_base_lidar;
  const Eigen::Matrix3d R_map_base = T_map_base.linear();
  MapMatch match;
  for (std::size_t i = 0; i < p_base.size() && pairs_.size() < pairs_.capacity(); i += stride) {
    const Eigen::Vector3d p_robot = R_map_base * p_base[i].cast<double>();
    const Eigen::Vector3d p_map = T_map_base.translation() + p_robot;
    if (map.nearest(p_map, viewpoint_map, max_distance_m, match)) {
      const auto residual = static_cast<float>(match.normal_map.cast<double>().dot(p_map - match.q_map));
      pairs_.push_back({p_robot.cast<float>(), match.normal_map, residual});
    }
  }
  return pairs_;
}

}  // namespace isobar
