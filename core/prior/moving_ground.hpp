// SPDX-License-Identifier: BSD-3-Clause
// Detection of moving ground: an elevator, whose ride the accelerometer feels and the wheels do not.
#pragma once

#include <cstdint>

#include "core/prior/filter_forks.hpp"

namespace isobar {

/// Climb of the robot by wheels and attitude.
struct WheelClimb {
  double climb_m_s = 0.0;       ///< vertical speed
  double forward_m_s = 0.0;     ///< along the ground
  double speed_variance = 0.0;  ///< of climb_m_s [m^2/s^2]
  double dt_s = 0.0;            ///< since the last one
};

/// Begins where the vertical speed of a fork, which has had no update by the wheels, departs from theirs, or where the
/// pressure has climbed unfelt (begin()); ends when speed and acceleration agree with the wheels again.
class MovingGround {
 public:
  enum class Event : std::uint8_t {
    kNone,
    kBegins,     ///< the fork is right, and the filter, which believed the wheels, is wrong
    kForkWrong,  ///< the pressure contradicts the fork: it is vibration that it has integrated
    kEnds,
  };

  explicit MovingGround(const HeightConfig& config) : config_(config) {}

  [[nodiscard]] bool moves() const { return moves_; }
  void restart() { moves_ = false; }
  /// Another sensor says so.
  void begin();
  /// The forks have been split off anew.
  void forks_restarted() { disagreeing_s_ = fork_misfit_m_ = 0.0; }
  /// Vertical acceleration without its bias.
  void add_acceleration(double accel_m_s2, double dt_s);
  /// Innovations of one pressure, of the older fork and of the filter [m].
  void add_pressure(double fork_innovation_m, double filter_innovation_m);
  /// @return what has changed with this climb; the caller sets filter and forks
  Event add_climb(const WheelClimb& wheels, const FilterForks& forks, const VerticalFilter& filter);

 private:
  [[nodiscard]] Event watch_start(const WheelClimb& wheels, const FilterForks& forks);
  [[nodiscard]] Event watch_end(const WheelClimb& wheels, const VerticalFilter& filter);

  HeightConfig config_;
  double accel_m_s2_ = 0.0;     // low-passed
  double agreeing_s_ = 0.0;     // in a ride: how long wheels and filter have agreed again
  double disagreeing_s_ = 0.0;  // before one: how long wheels and fork have disagreed
  double fork_misfit_m_ = 0.0;  // |innovation| of the last used pressure: older fork minus filter
  bool moves_ = false;
};

}  // namespace isobar
