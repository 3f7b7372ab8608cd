// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "drivers/device/device.hpp"
#include "drivers/xsens/data_items.hpp"

namespace isobar::xsens {

/// Tick of SampleTimeFine [ns], and the period after which it wraps [ns].
inline constexpr std::int64_t kTickNs = 100'000;
inline constexpr std::int64_t kClockPeriodNs = kTickNs << 32U;

/// What a message holds of use here.
struct Measurement {
  std::optional<std::uint16_t> counter;  ///< PacketCounter
  std::optional<std::uint32_t> time;     ///< SampleTimeFine [kTickNs]
  InertialReading reading;               ///< without stamps
  /// What it lacks of acceleration and rate of turn, in words; static, nullptr: nothing.
  const char* lacking = nullptr;
};

/// Attitude in a world with z up; nothing: no attitude, or of a reserved form.
[[nodiscard]] std::optional<Eigen::Quaterniond> read_attitude(const DataItem& item) noexcept;

/// MTData2 to measurements. The values stay in the sensor's own frame: x, y as printed on its housing, z up, so
/// that accel reads (0, 0, +g) at rest and level. Rates and accelerations, else the increments of velocity and
/// turn ("DeltaV", "DeltaQ") divided by the period of the messages that hold them, by SampleTimeFine or UTC.
class SampleReader {
 public:
  /// @param data of a sound MTData2
  Measurement read(std::span<const std::uint8_t> data) noexcept;

 private:
  /// Accelerations and rates of a message in both forms.
  struct Inertial {
    std::optional<Eigen::Vector3d> accel_m_s2, gyro_rad_s, velocity_m_s, turn_rad;
    bool has_free_accel = false;             ///< acceleration without gravity
    std::optional<std::uint32_t> utc_ticks;  ///< time of day [kTickNs]
  };
  static const char* lacking_of(const Inertial& inertial, bool interval_known) noexcept;
  static void take(const DataItem& item, Inertial& inertial) noexcept;
  static void take_time(const DataItem& item, Inertial& inertial) noexcept;
  void take_other(const DataItem& item, Measurement& result) noexcept;
  /// Interval of one increment [s], nothing when unknown.
  std::optional<double> interval_s(std::optional<std::uint32_t> time) noexcept;

  std::optional<std::uint32_t> last_time_;                           ///< of the last message with increments
  std::uint32_t last_ticks_ = 0;                                     ///< its distance from the one before
  std::uint32_t period_ticks_ = 0;                                   ///< 0: unknown so far
  double temperature_c_ = std::numeric_limits<double>::quiet_NaN();  ///< newest: sent more seldom
};

}  // namespace isobar::xsens
