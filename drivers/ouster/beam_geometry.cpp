// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/beam_geometry.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar::ouster {

BeamGeometry::BeamGeometry(const Metadata& metadata) {
  const Eigen::Matrix3d R_sensor_lidar = metadata.T_sensor_lidar.topLeftCorner<3, 3>();
  const Eigen::Vector3d p_lidar_m = metadata.T_sensor_lidar.topRightCorner<3, 1>() * 1e-3;
  const Eigen::Vector3d origin_m(metadata.beam_origin_x_mm * 1e-3, 0.0, metadata.beam_origin_z_mm * 1e-3);
  origin_distance_m_ = static_cast<float>(origin_m.norm());
  columns_.resize(static_cast<std::size_t>(metadata.columns_per_turn));
  for (std::size_t id = 0; id < columns_.size(); ++id) {
    const double theta_rad =
        2.0 * kPi * (1.0 - static_cast<double>(id) / static_cast<double>(columns_.size()));
    const Eigen::Matrix3d R =
        R_sensor_lidar * Eigen::AngleAxisd(theta_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d origin_in_sensor_m = R * origin_m + p_lidar_m;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      columns_[id].origin_m[row] = static_cast<float>(origin_in_sensor_m[r]);
      for (std::size_t col = 0; col < 3; ++col) {
        columns_[id].rotation[3 * row + col] = static_cast<float>(R(r, static_cast<Eigen::Index>(col)));
      }
    }
  }
  const double sensor_ahead_deg = -std::atan2(R_sensor_lidar(1, 0), R_sensor_lidar(0, 0)) / kRadPerDeg;
  const auto pixels = static_cast<std::size_t>(metadata.pixels);
  for (std::size_t row = 0; row < pixels; ++row) {
    const double azimuth_rad = -metadata.azimuth_deg[row] * kRadPerDeg;
    const double altitude_rad = metadata.altitude_deg[row] * kRadPerDeg;
    beams_.push_back({{static_cast<float>(std::cos(azimuth_rad) * std::cos(altitude_rad)),
                       static_cast<float>(std::sin(azimuth_rad) * std::cos(altitude_rad)),
                       static_cast<float>(std::sin(altitude_rad))},
                      turn_count(metadata.azimuth_deg[row] + sensor_ahead_deg),
                      static_cast<std::uint8_t>(pixels - 1 - row)});
  }
}

}  // namespace isobar::ouster
