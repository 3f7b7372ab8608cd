// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/device_attitude.hpp"

#include <cmath>

#include "core/so3.hpp"

namespace isobar {
namespace {

// Interval of updates: the device's errors are correlated over seconds, so that more frequent ones gain
// nothing.
constexpr double kDeviceUpdateS = 0.1;
// Tolerance of the attitude's rate against the gyro: beyond it the device has reset its attitude, and the
// rate is not used.
constexpr double kDeviceRateToleranceRadS = 0.1;
// Tolerance of a quaternion's norm: beyond it the values are not an attitude.
constexpr double kQuaternionNormTolerance = 0.05;

}  // namespace

bool DeviceAttitude::add(const ImuSample& sample, const Eigen::Vector3d& gyro_rad_s,
                         const Eigen::Vector3d& gyro_bias_rad_s, double dt_s) {
  const bool usable =
      used_ && sample.has_attitude && std::abs(sample.q_world_imu.norm() - 1.0) <= kQuaternionNormTolerance;
  if (!usable) {
    has_before_ = false;
    return false;
  }
  const Eigen::Quaterniond q_world_base =
      (sample.q_world_imu.normalized() * q_base_imu_.conjugate()).normalized();
  if (has_before_) {
    const Eigen::Vector3d rate_rad_s = log_so3(q_before_.conjugate() * q_world_base) / dt_s;
    if ((rate_rad_s - gyro_rad_s + gyro_bias_rad_s).cwiseAbs().maxCoeff() < kDeviceRateToleranceRadS) {
      bias_sum_ += (gyro_rad_s - rate_rad_s) * dt_s;
      since_s_ += dt_s;
    }
  }
  q_before_ = q_world_base;
  has_before_ = true;
  return since_s_ >= kDeviceUpdateS;
}

DeviceAttitude::Update DeviceAttitude::take() {
  Update update{q_before_.conjugate() * Eigen::Vector3d::UnitZ(), bias_sum_ / since_s_, since_s_};
  bias_sum_.setZero();
  since_s_ = 0.0;
  return update;
}

}  // namespace isobar
