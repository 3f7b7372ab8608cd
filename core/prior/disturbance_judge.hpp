// SPDX-License-Identifier: BSD-3-Clause
// Innovation monitoring of the pressure: tells motion of the robot from disturbances of the pressure.
#pragma once

#include <cstdint>

#include "core/prior/prior_config.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// Classifies pressures whose innovation is outside the gate, by how fast they left the prediction and what
/// they do next:
///
/// - *Pulse* (door, gust, a fault of some seconds): returns to the prediction; never used.
/// - *Step* (another ventilation zone, a hatch, a fault): left faster than a climb that accelerometer and
///   wheels could have missed, and is steady since: a change of the pressure without motion.
/// - *Motion*: left no faster than the prediction may drift: the prediction is wrong.
///
/// A pressure that neither settles nor returns (a broken sensor) stays gated.
class DisturbanceJudge {
 public:
  enum class Verdict : std::uint8_t {
    kFits,      ///< inside the gate: use it
    kWait,      ///< outside the gate, undecided: do not use it
    kStep,      ///< the pressure has stepped and is steady
    kReturned,  ///< the step is over: the pressure is back at its old level
    kMotion,    ///< the predicted height is wrong
  };

  struct Evidence {
    std::int64_t stamp_ns = 0;
    double height_m = 0.0;                    ///< from the pressure
    double noise_variance_m2 = 0.0;           ///< of height_m
    VerticalFilter::Innovation innovation;    ///< against the prediction
    bool step_open = false;                   ///< the prediction contains a step
    VerticalFilter::Innovation without_step;  ///< the innovation without that step
    double climb_sigma_m_s = 0.0;             ///< of the predicted vertical speed
    double wait_s = 0.0;                      ///< time from leaving the gate to kStep or kMotion
  };

  explicit DisturbanceJudge(double gate_sigma) : gate_sigma_(gate_sigma) {}

  Verdict judge(const Evidence& evidence);

  /// After a gap: forgets the prediction's history.
  void restart() { *this = DisturbanceJudge(gate_sigma_); }

  /// Pressures are being rejected.
  [[nodiscard]] bool gated() const { return gated_; }
  /// They left faster than a climb that accelerometer and wheels could have missed.
  [[nodiscard]] bool unfelt() const { return gated_ && unfelt_; }
  [[nodiscard]] std::int64_t gated_since_ns() const { return gated_since_ns_; }
  /// Change of the innovation since the first rejected pressure [m].
  [[nodiscard]] double moved_m() const { return moved_m_; }

 private:
  [[nodiscard]] bool fits(const VerticalFilter::Innovation& innovation) const;
  [[nodiscard]] bool outran_motion(const Evidence& evidence) const;
  [[nodiscard]] double noise_limit_m(const Evidence& evidence) const;
  void begin(const Evidence& evidence);
  void accept(const Evidence& evidence);
  Verdict back(const Evidence& evidence, bool here);
  void watch_steadiness(const Evidence& evidence);

  double gate_sigma_;
  double used_m_ = 0.0;         // innovation of the last used pressure
  double used_height_m_ = 0.0;  // its height
  double first_m_ = 0.0;        // innovation of the first rejected pressure
  double level_m_ = 0.0;        // innovation at which the pressure is steady since steady_since_ns_
  double moved_m_ = 0.0;
  std::int64_t used_ns_ = 0;
  std::int64_t gated_since_ns_ = 0;
  std::int64_t steady_since_ns_ = 0;
  std::int64_t back_since_ns_ = 0;
  bool has_used_ = false;
  bool gated_ = false;
  bool unfelt_ = false;
  bool is_back_ = false;
};

}  // namespace isobar
