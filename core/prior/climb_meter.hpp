// SPDX-License-Identifier: BSD-3-Clause
// Mean climb speed from wheels and attitude, at the update rate of the height filter.
#pragma once

namespace isobar {

/// Integrates climb and forward speed of the IMU's place between two updates of the height filter.
class ClimbMeter {
 public:
  void restart() { elapsed_s_ = climb_m_ = forward_m_ = 0.0; }

  /// Speeds over the last `dt_s`; without wheels only the time.
  void add(double climb_m_s, double forward_m_s, double dt_s) {
    add_time(dt_s);
    climb_m_ += climb_m_s * dt_s;
    forward_m_ += forward_m_s * dt_s;
  }
  void add_time(double dt_s) { elapsed_s_ += dt_s; }

  [[nodiscard]] bool due() const { return elapsed_s_ >= kUpdateS; }
  [[nodiscard]] double elapsed_s() const { return elapsed_s_; }
  [[nodiscard]] double climb_m_s() const { return climb_m_ / elapsed_s_; }
  [[nodiscard]] double forward_m_s() const { return forward_m_ / elapsed_s_; }

 private:
  // Interval of updates: the wheels' error is correlated over seconds, so that more frequent ones gain
  // nothing.
  static constexpr double kUpdateS = 0.04;

  double elapsed_s_ = 0.0;
  double climb_m_ = 0.0;
  double forward_m_ = 0.0;
};

}  // namespace isobar
