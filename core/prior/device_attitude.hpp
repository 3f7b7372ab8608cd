// SPDX-License-Identifier: BSD-3-Clause
// The attitude that some IMUs estimate themselves, as measurements for the attitude filter.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/samples.hpp"

namespace isobar {

/// Averages gyro bias over an update interval: gyro minus the rate of the device's attitude.
class DeviceAttitude {
 public:
  /// `q_base_imu`: attitude of the IMU in base_link. `used`: false switches all of this off.
  DeviceAttitude(const Eigen::Quaterniond& q_base_imu, bool used) : q_base_imu_(q_base_imu), used_(used) {}

  /// One IMU sample, with its gyro in base axes and the filter's bias. True when an update is due.
  bool add(const ImuSample& sample, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
           double dt_s);
  /// After a jump of the clock: no rate is computed across it.
  void restart() { has_before_ = false; }

  /// The due update; taking it starts the next interval.
  struct Update {
    Eigen::Vector3d up_base;          ///< unit vector
    Eigen::Vector3d gyro_bias_rad_s;  ///< mean over interval_s
    double interval_s;
  };
  Update take();

 private:
  Eigen::Quaterniond q_base_imu_;
  bool used_;
  Eigen::Quaterniond q_before_ = Eigen::Quaterniond::Identity();
  bool has_before_ = false;
  double since_s_ = 0.0;
  Eigen::Vector3d bias_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace isobar
