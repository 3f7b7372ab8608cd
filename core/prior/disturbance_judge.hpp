// SPDX-License-Identifier: BSD-3-Clause
// Is it the robot that moves, or the pressure?
#pragma once

#include <cstdint>

#include "core/prior/prior_config.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// Looks at pressures that are too far from what acceleration and wheels predict, and tells from how they
/// came there and what they do then what they are:
///
/// - *A pulse* (door, gust, a fault of some seconds) comes back to the prediction: it is never used.
/// - *A step* (another ventilation zone, a hatch, a fault) went there faster than anything can have climbed
///   unfelt by accelerometer and wheels. Once it is steady it is known for what it is: the pressure's own.
/// - *A motion* crept away no faster than the prediction itself may be wrong: it is the prediction's fault.
///
/// What neither is steady nor comes back (a broken sensor) is waited for without end.
class DisturbanceJudge {
 public:
  enum class Verdict : std::uint8_t {
    kFits,      ///< to be used
    kWait,      ///< not to be used, nothing is decided
    kStep,      ///< the pressure has stepped and is steady now
    kReturned,  ///< the step is over: the pressure is back at its old level
    kMotion,    ///< the height is not where it was predicted
  };

  struct Evidence {
    std::int64_t stamp_ns = 0;
    double height_m = 0.0;                    ///< as the pressure has it
    double noise_variance_m2 = 0.0;           ///< of it
    VerticalFilter::Innovation innovation;    ///< against the prediction
    bool step_open = false;                   ///< the prediction counts on a step …
    VerticalFilter::Innovation without_step;  ///< … and this would be the innovation if that were over
    double climb_sigma_m_s = 0.0;             ///< of the predicted vertical speed
    double wait_s = 0.0;                      ///< how long to wait before anything is believed
  };

  explicit DisturbanceJudge(double gate_sigma) : gate_sigma_(gate_sigma) {}

  Verdict judge(const Evidence& evidence);

  /// A gap: what was predicted before it says nothing.
  void restart() { *this = DisturbanceJudge(gate_sigma_); }

  /// Pressures are being left out.
  [[nodiscard]] bool gated() const { return gated_; }
  /// They went faster than anything can have climbed unfelt.
  [[nodiscard]] bool unfelt() const { return gated_ && unfelt_; }
  [[nodiscard]] std::int64_t gated_since_ns() const { return gated_since_ns_; }
  /// By how much the innovation has moved since the first pressure that was left out [m].
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
  double used_m_ = 0.0;  // innovation of the last pressure that was used, and its height
  double used_height_m_ = 0.0;
  double first_m_ = 0.0;  // innovation of the first one left out
  double level_m_ = 0.0;  // innovation at which the pressure has been steady …
  double moved_m_ = 0.0;
  std::int64_t used_ns_ = 0;
  std::int64_t gated_since_ns_ = 0;
  std::int64_t steady_since_ns_ = 0;  // … since then
  std::int64_t back_since_ns_ = 0;
  bool has_used_ = false;
  bool gated_ = false;
  bool unfelt_ = false;
  bool is_back_ = false;
};

}  // namespace isobar
