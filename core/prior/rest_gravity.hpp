// SPDX-License-Identifier: BSD-3-Clause
// What a window of rest tells about the direction of gravity.
#pragma once

#include <Eigen/Core>

#include "core/prior/standstill.hpp"

namespace isobar {

/// Variance of gravity's direction from consecutive windows of rest, and of the rate about level axes (a rotation
/// about the vertical cannot be seen in the force: a platform on a rope turns evenly).
///
/// On wheels that stand the mean force is gravity, as well as the means of the windows agree. Without wheels the platform may hang and swing: its force then
/// points along the rope, a swing's angle a off, and nothing but the gyro shows it, as a rate a w that changes over
/// the period. So at first some windows must agree, and the scatter r of their rates bounds the angle: r / w.
class RestGravity {
 public:
  /// Rest without wheels before its gravity is used, in windows: 1.8 s.
  static constexpr int kLeastWindows = 3;
  /// Slowest swing [rad/s]: a rope of 80 m.
  static constexpr double kSlowestSwingRadS = 0.35;

  struct Measurement {
    double variance = 0.0;  ///< of an axis of the mean force [m^2/s^4], its correlation over windows included
    double rate_variance = 0.0;  ///< of the mean rate about a level axis, as a measurement of the gyro's bias
  };

  /// One window. @return false while it is not known to be rest.
  bool add(const StandstillDetector::Rest& rest, bool on_wheels, Measurement& out);
  /// The rest is over.
  void restart() { *this = RestGravity(); }

 private:
  /// Mean and scatter of the windows' means (Welford).
  struct Scatter {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d square_sum = Eigen::Vector3d::Zero();  // of deviations from the mean
    void add(const Eigen::Vector3d& value, int count);
    /// Largest variance of an axis; 0 before the second window.
    [[nodiscard]] double variance(int count) const {
      return count > 1 ? square_sum.maxCoeff() / (count - 1) : 0.0;
    }
  };

  Scatter rate_rad_s_;
  Scatter force_m_s2_;
  int windows_ = 0;
};

}  // namespace isobar
