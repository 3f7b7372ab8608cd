// SPDX-License-Identifier: BSD-3-Clause
// How the pressures of robot and base station have changed lately: whose drift is it?
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Barometer that has changed alone, faster than weather.
enum class DriftSuspect : std::uint8_t {
  kNone,
  kRobot,    ///< its pressure, its climb subtracted
  kBase,     ///< the base station's in use
  kUnknown,  ///< both have changed, by different amounts
};

/// Changes over up to half a minute, from means of a second. A change of both is the air of the site, and no drift,
/// however fast. One of a single sensor that exceeds four sigmas of the weather (weather_sigma_pa()) is a drift, a
/// step or a zone of ventilation: evidence for a fault of that sensor, to be weighed with the height by other means. At
/// 0.5 Pa/s it is seen after 10 s.
class AirChange {
 public:
  static constexpr std::size_t kKeptS = 32;
  /// Means of a second that must have come before a change is judged.
  static constexpr std::size_t kLeastS = 4;

  struct Change {
    double over_s = 0.0;
    double robot_pa = 0.0;
    double base_pa = 0.0;
  };

  /// Simultaneous pressures in order of time: ln of the robot's [Pa], its climb by inertial sensors and wheels
  /// subtracted, and of the reference.
  void add(std::int64_t stamp_ns, double robot_air_log, double base_log);
  /// Another reference, or another clock.
  void restart() { *this = AirChange(); }

  /// Change over the last `seconds` whole seconds, or over as many as are known: newest mean minus that one.
  [[nodiscard]] Change over(std::size_t seconds) const;
  [[nodiscard]] DriftSuspect suspect() const;

 private:
  struct Mean {
    std::int64_t stamp_ns = 0;
    double robot_log = 0.0;
    double base_log = 0.0;
  };

  void close();
  /// `age`: 0 is the newest.
  [[nodiscard]] const Mean& mean(std::size_t age) const {
    return means_[(next_ + kKeptS - 1 - age) % kKeptS];
  }

  std::array<Mean, kKeptS> means_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  Mean open_;  // sums of the second that has begun
  int open_count_ = 0;
};

}  // namespace isobar
