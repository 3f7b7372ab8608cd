// SPDX-License-Identifier: BSD-3-Clause
// Inertial-barometric altimeter: a low-pass of pressure heights without lag.
#pragma once

#include <cstdint>

#include "core/altitude/differential_altimeter.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// VerticalFilter alone, without wheels, gates or policy: for a platform with only a barometer and an IMU.
/// The counterpart of PressureFilter, which trades noise for lag: here the acceleration shows start and end
/// of an elevator's ride or of a flight of stairs at once, and the pressure only corrects the slow errors of
/// the acceleration. HeightFilter is the same with wheels, for robots.
///
/// Heights of the barometer's port, relative to the start. Accelerations come in order of stamps; heights may
/// come up to a second late.
class InertialAltimeter {
 public:
  /// `vz_sigma_m_s`: vertical speed at the start, 1 sigma.
  explicit InertialAltimeter(const HeightConfig& config, double vz_sigma_m_s = 0.05);

  enum class Status : std::uint8_t {
    kUsed,
    kBadValue,  ///< not finite, or variance not positive
    kBadTime,   ///< not newer than the last one; height more than a second from the acceleration
  };

  /// Upward acceleration without gravity [m/s^2], mean since the last one. Over a gap (0.1 s) the height is
  /// predicted at constant speed, with the variance of an unobserved ride.
  Status add_acceleration(std::int64_t stamp_ns, double up_m_s2);
  /// Update with `reading` at its own time. Heights before the first acceleration are kBadTime.
  Status add_height(const AltimeterReading& reading);

  /// At the time of the last acceleration.
  [[nodiscard]] double height_m() const { return filter_.value(VerticalFilter::kZ); }
  [[nodiscard]] double variance_m2() const { return filter_.variance(VerticalFilter::kZ); }
  [[nodiscard]] double accel_bias_m_s2() const { return filter_.value(VerticalFilter::kAccelBias); }

 private:
  HeightConfig config_;
  VerticalFilter filter_;
  std::int64_t stamp_ns_ = 0;
  bool started_ = false;
  bool weather_moves_ = false;
};

}  // namespace isobar
