// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace isobar::test {

inline constexpr double kRadPerDegree = 3.14159265358979323846 / 180.0;

/// Ouster sensor documentation, "Lidar Range to XYZ", in double precision.
class RangeToXyz {
 public:
  explicit RangeToXyz(nlohmann::json metadata) : root_(std::move(metadata)) {
    const auto field = [this](const char* section, const char* key) {
      return root_.contains(section) ? root_[section][key] : root_[key];
    };
    altitude_ = field("beam_intrinsics", "beam_altitude_angles").get<std::vector<double>>();
    azimuth_ = field("beam_intrinsics", "beam_azimuth_angles").get<std::vector<double>>();
    n_mm_ = field("beam_intrinsics", "lidar_origin_to_beam_origin_mm");
    T_ = field("lidar_intrinsics", "lidar_to_sensor_transform").get<std::vector<double>>();
  }
  [[nodiscard]] Eigen::Vector3d point_m(double range_mm, int id, int row, int columns) const {
    const auto r = static_cast<std::size_t>(row);
    const double encoder = 2.0 * 180.0 * kRadPerDegree * (1.0 - static_cast<double>(id) / columns);
    const double direction = encoder - azimuth_[r] * kRadPerDegree;
    const double phi = altitude_[r] * kRadPerDegree;
    const Eigen::Vector3d p(
        (range_mm - n_mm_) * std::cos(direction) * std::cos(phi) + n_mm_ * std::cos(encoder),
        (range_mm - n_mm_) * std::sin(direction) * std::cos(phi) + n_mm_ * std::sin(encoder),
        (range_mm - n_mm_) * std::sin(phi));
    Eigen::Vector3d out;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(4 * i);
      out[i] = T_[at] * p[0] + T_[at + 1] * p[1] + T_[at + 2] * p[2] + T_[at + 3];
    }
    return out * 1e-3;
  }

 private:
  nlohmann::json root_;
  std::vector<double> altitude_, azimuth_, T_;
  double n_mm_ = 0.0;
};

}  // namespace isobar::test
