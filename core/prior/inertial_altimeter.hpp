// SPDX-License-Identifier: BSD-3-Clause
// The low-pass that does not lag: heights from pressure, carried between samples by vertical acceleration.
#pragma once

#include <cstdint>

#include "core/altitude/differential_altimeter.hpp"
#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// VerticalFilter alone: no wheels, no gates, no policy. For a platform of which only a barometer and an IMU
/// are known, and the counterpart of PressureFilter: that one trades noise for lag; here the acceleration
/// tells the start and the end of an elevator's ride or of a flight of stairs at once, and the pressure only
/// has to hold the slow errors of the acceleration. HeightFilter is the same with wheels, for robots.
///
/// Heights are those of the barometer's port, relative to the start. Use it in the order of stamps of the
/// acceleration; heights may come up to a second late.
class InertialAltimeter {
 public:
  /// `vz_sigma_m_s`: how fast it may be rising at the start.
  explicit InertialAltimeter(const HeightConfig& config, double vz_sigma_m_s = 0.05);

  enum class Status : std::uint8_t {
    kUsed,
    kBadValue,  ///< not finite, or a variance that is not positive
    kBadTime,   ///< not newer than the one before; a height more than a second from the acceleration
  };

  /// Acceleration upwards without gravity [m/s^2], mean since the one before. After a gap (0.1 s) the height
  /// is carried on at constant speed and becomes as uncertain as a ride unseen.
  Status add_acceleration(std::int64_t stamp_ns, double up_m_s2);
  /// Uses `reading` in the state of its own time. Heights before the first acceleration are kBadTime.
  Status add_height(const AltimeterReading& reading);

  /// At the last acceleration.
  [[nodiscard]] double height_m() const { return filter_.value(VerticalFilter::kZ); }
  [[nodiscard]] double speed_m_s() const { return filter_.value(VerticalFilter::kVz); }
  [[nodiscard]] double variance_m2() const { return filter_.variance(VerticalFilter::kZ); }
  [[nodiscard]] double accel_bias_m_s2() const { return filter_.value(VerticalFilter::kAccelBias); }
  [[nodiscard]] std::int64_t stamp_ns() const { return stamp_ns_; }

 private:
  HeightConfig config_;
  VerticalFilter filter_;
  std::int64_t stamp_ns_ = 0;
  bool started_ = false;
  bool weather_moves_ = false;
};

}  // namespace isobar
