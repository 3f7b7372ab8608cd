// SPDX-License-Identifier: BSD-3-Clause
// Which clock stamps the points of a lidar.
#pragma once

#include <cstdint>
#include <optional>

#include "core/name_table.hpp"
#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar {

enum class LidarTime : std::uint8_t {
  kReceive,  ///< the kernel's receive times, smoothed by ClockAnchor: late by the least time of transport
  kSensor,   ///< the sensor's clock, where it and this machine follow GPS, PPS or PTP
};

inline constexpr NameTable<LidarTime, 2> kLidarTimeNames{{{
    {LidarTime::kReceive, "receive"},
    {LidarTime::kSensor, "sensor"},
}}};

/// Offset of the host's clock to the sensor's if both count the same seconds: the whole number of seconds next to the
/// measured offset. It need not be 0, since a sensor may count from the hour, or in TAI.
/// @param measured_ns host minus sensor, with the latency of transport in it
/// @return nothing when the sensor cannot be locked to the host's seconds: `measured_ns` differs by more than a
///         packet's latency
[[nodiscard]] constexpr std::optional<std::int64_t> whole_seconds_ns(std::int64_t measured_ns) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  constexpr std::int64_t kMostLatencyNs = 50'000'000;  // an Ouster's packet of 64 columns: 17 ms
  constexpr std::int64_t kMostErrorNs = 5'000'000;     // of the two clocks
  const std::int64_t shifted_ns = measured_ns + kMostErrorNs;
  const std::int64_t rest_ns = (shifted_ns % kSecondNs + kSecondNs) % kSecondNs;
  if (rest_ns > kMostErrorNs + kMostLatencyNs) return std::nullopt;
  return shifted_ns - rest_ns;
}

/// Whether a sensor's word on its clock allows its stamps: it is locked, or its packets do not tell.
[[nodiscard]] constexpr bool may_stamp(LidarSync sync) {
  return sync == LidarSync::kLocked || sync == LidarSync::kUnknown;
}

}  // namespace isobar
