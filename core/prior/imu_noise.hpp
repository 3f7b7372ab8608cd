// SPDX-License-Identifier: BSD-3-Clause
// Online estimate of the IMU's noise, vibration included.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/altitude/noise_estimator.hpp"

namespace isobar {

/// White noise of gyro, accelerometer and vertical acceleration, from second differences over about 10 ms.
class ImuNoise {
 public:
  void add_sample(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s) {
    interval_s_ += (dt_s - interval_s_) * kIntervalGain;
    const auto lag = static_cast<std::size_t>(std::max(1.0, std::round(kLagS / interval_s_)));
    for (int axis = 0; axis < 3; ++axis) {
      gyro_[axis].set_lag(lag);
      gyro_[axis].add(gyro_rad_s[axis]);
      accel_[axis].set_lag(lag);
      accel_[axis].add(force_m_s2[axis]);
    }
    up_accel_.set_lag(lag);
  }
  void add_up_accel(double up_accel_m_s2) { up_accel_.add(up_accel_m_s2); }

  /// After a gap: no differences across it.
  void restart() {
    for (auto& axis : gyro_) axis.restart();
    for (auto& axis : accel_) axis.restart();
    up_accel_.restart();
  }

  /// Of one sample, mean over the axes [rad^2/s^2].
  [[nodiscard]] double gyro_variance() const {
    return (gyro_[0].variance() + gyro_[1].variance() + gyro_[2].variance()) / 3.0;
  }
  /// Of one sample, mean over the axes [m^2/s^4].
  [[nodiscard]] double accel_variance() const {
    return (accel_[0].variance() + accel_[1].variance() + accel_[2].variance()) / 3.0;
  }
  /// Spectral density of the vertical acceleration [m^2/s^3]: white down to 5 ms, the bandwidth of an
  /// anti-alias filter.
  [[nodiscard]] double up_accel_density(double dt_s) const {
    return up_accel_.variance() * std::max(dt_s, kBandwidthS);
  }

 private:
  static constexpr double kLagS = 0.01;
  static constexpr double kBandwidthS = 0.005;
  // Low-pass of the sample interval: over 50 samples.
  static constexpr double kIntervalGain = 0.02;
  // Vibration starts with the first step of the robot: a memory of some tenths of a second. Shocks are part
  // of it, so no sample is clipped.
  static constexpr double kMemorySamples = 150.0;
  static constexpr double kNoClip = 1e30;
  static constexpr NoiseEstimator::Options kGyro{0.005, 0.0, 10.0, kMemorySamples, kNoClip};
  static constexpr NoiseEstimator::Options kAccel{0.1, 0.0, 50.0, kMemorySamples, kNoClip};

  std::array<NoiseEstimator, 3> gyro_{NoiseEstimator(kGyro), NoiseEstimator(kGyro), NoiseEstimator(kGyro)};
  std::array<NoiseEstimator, 3> accel_{NoiseEstimator(kAccel), NoiseEstimator(kAccel),
                                       NoiseEstimator(kAccel)};
  NoiseEstimator up_accel_{kAccel};
  double interval_s_ = 0.005;
};

}  // namespace isobar
