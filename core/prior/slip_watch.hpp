// SPDX-License-Identifier: BSD-3-Clause
// Slip of the wheels, told from the gyro and from the attitude filter.
#pragma once

namespace isobar {

/// Compares the turn of the wheels with that of the gyro, and counts how often the attitude filter refuses their
/// speed, second by second.
///
///     turn:   |turn by wheels - turn by gyro| > kLeastTurnRad + kTurnShare x the larger way turned
///     speed:  the wheels were outside of the filter's gate for kRefusedShare of the second
///
/// Both sides of a straight drive that slip alike turn nothing. The filter then refuses wheels that block or stand
/// while the robot moves on at more than about 1 m/s; not wheels that spin, whose error it takes for a share of their
/// speed. A wrong track width is no slip: MountEstimate::wheel_turn and the contradictions tell a constant ratio.
class SlipWatch {
 public:
  static constexpr double kWindowS = 1.0;
  /// Turn of a second that noise and bias of the gyro and of encoders do not make: 3.4 deg.
  static constexpr double kLeastTurnRad = 0.06;
  /// Share of the way turned that may differ. A nominal track width, which a skid-steered robot exceeds by up to
  /// 2, makes 0.5 of it.
  static constexpr double kTurnShare = 0.6;
  /// The filter believes wheels that it has refused for a second: that second may begin in the middle of a window.
  static constexpr double kRefusedShare = 0.4;

  struct Slip {
    bool turn = false;
    bool speed = false;
  };

  /// Rates about z of base_link over the last `dt_s`, the gyro's without its bias.
  void add_rates(double gyro_rad_s, double wheels_rad_s, double dt_s) noexcept;
  /// Whether the attitude filter has used a wheel sample, which stands for the last `dt_s`.
  void add_speed(bool used, double dt_s) noexcept { refused_s_ += used ? 0.0 : dt_s; }
  /// The wheels or the gyro were not heard: the second begins anew.
  void restart() noexcept { *this = SlipWatch(); }
  /// Slip in the second that ended with the last add_rates(); none while it lasts.
  [[nodiscard]] Slip take() noexcept;

 private:
  double elapsed_s_ = 0.0;
  double difference_rad_ = 0.0;  // of the turns
  double gyro_way_rad_ = 0.0;    // sums of the turns, whatever their direction
  double wheels_way_rad_ = 0.0;
  double refused_s_ = 0.0;
};

}  // namespace isobar
