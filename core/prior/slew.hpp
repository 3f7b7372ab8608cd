// SPDX-License-Identifier: BSD-3-Clause
// Rate limiter for corrections of the height: the map tolerates no jump.
#pragma once

#include <algorithm>

namespace isobar {

/// Holds back corrections of a height and releases them at a bounded speed.
class Slew {
 public:
  /// `rate_m_s` > 0. The part of a correction beyond `bound_m` passes at once.
  Slew(double rate_m_s, double bound_m) : rate_m_s_(rate_m_s), bound_m_(bound_m) {}

  /// Starts holding back corrections, for kOpenS.
  void begin() { open_s_ = kOpenS; }
  [[nodiscard]] bool open() const { return open_s_ > 0.0; }

  /// Holds back a correction: subtracts `step_m`, by which the height was just corrected, from rest_m().
  void hold_back(double step_m) { rest_m_ = std::clamp(rest_m_ - step_m, -bound_m_, bound_m_); }

  void advance(double dt_s) {
    open_s_ = std::max(0.0, open_s_ - dt_s);
    const double most_m = rate_m_s_ * dt_s;
    rest_m_ -= std::clamp(rest_m_, -most_m, most_m);
  }

  void restart() { open_s_ = rest_m_ = 0.0; }

  /// Part of the corrections that is still held back, to be added to the height [m].
  [[nodiscard]] double rest_m() const { return rest_m_; }

 private:
  // Duration of holding back: the filter spreads a correction over several pressure samples; a longer one
  // would delay corrections of the motion.
  static constexpr double kOpenS = 3.0;

  double rate_m_s_;
  double bound_m_;
  double rest_m_ = 0.0;
  double open_s_ = 0.0;
};

}  // namespace isobar
