// SPDX-License-Identifier: BSD-3-Clause
// Height from simultaneous pressures of robot and base station.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/altitude/robot_air.hpp"

namespace isobar {

/// Differences of pressure at the base station's sample times, at any rate and delay of the base station.
///
///   h(t_k) = H ln(p_b(t_k) / p_r(t_k))
///
/// h height of the robot's port, H scale height, p_b the base station's sample of time t_k, p_r the robot's
/// pressure, interpolated at t_k. What is common to both sensors at t_k (weather, gusts, a door of the whole
/// building) multiplies both pressures and cancels exactly: neither is filtered alone, so none lags. Smoothing is
/// left to the height filter, which sees height, not air. The robot's motion since t_k,
///
///   h(t) = h(t_k) + c(t) - c(t_k),
///
/// comes from the climb c by accelerometer, wheels and attitude, which is good to centimetres over a second, and not
/// from the robot's pressure, in which it cannot be told from the air's change. So between two samples of the base
/// station there is no height.
///
/// Samples within kBlockS give one mean, which passes both sensors through the same filter: their white noise shrinks
/// before a gate sees it, and one height is no more certain than the robot's samples in it.
class PressurePairs {
 public:
  /// Length of a mean [s]: at 32 Hz four samples, half of the noise; short against a door's pulse.
  static constexpr double kBlockS = 0.12;
  /// Samples of the base station that wait for the robot's next one. A base of 200 Hz for a third of a second.
  static constexpr std::size_t kWaiting = 64;

  struct Mean {
    double difference_log = 0.0;  ///< ln(p_b / p_r)
    double climb_m = 0.0;         ///< c(t_k)
    double robot_share = 1.0;     ///< variance of the robot's part, as a share of one sample's
    double base_variance = 0.0;   ///< relative variance of the base station's part
    double delay_s = 0.0;         ///< t - t_k
  };

  /// A sample of the reference. The oldest waiting one is forgotten when there is no place.
  /// @param reference_log ln of the pressure [Pa], offset of the station included
  /// @param relative_variance of one sample
  void add_base(std::int64_t stamp_ns, double reference_log, double relative_variance);

  /// A sample of the robot.
  /// @return true when `out` was filled from samples of the base station up to this time
  bool add_robot(std::int64_t stamp_ns, double log_pa, double climb_m, Mean& out);

  /// The robot's pressure of the last seconds.
  [[nodiscard]] const RobotAir& robot() const { return robot_; }

  /// After a clock jump, and when the reference changes its datum.
  void restart() {
    robot_.restart();
    waiting_count_ = 0;
    robot_count_ = 0;
  }

 private:
  struct Sample {
    std::int64_t stamp_ns = 0;
    double reference_log = 0.0;
    double relative_variance = 0.0;
  };

  [[nodiscard]] double robot_share(double end_share, int base_count) const;

  RobotAir robot_;
  std::array<Sample, kWaiting> waiting_{};  // oldest first
  std::size_t waiting_count_ = 0;
  std::int64_t mean_ns_ = 0;  // robot sample of the last mean
  int robot_count_ = 0;       // robot samples since
};

}  // namespace isobar
