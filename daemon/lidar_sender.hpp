// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/udp/sender_lock.hpp"

namespace isobar {

/// Fastest rotation of the supported lidars is 20 Hz; more scans than this are those of two lidars [Hz].
inline constexpr double kFastestScanHz = 25.0;

/// Admits the packets of one lidar: two on one port give scans of two rooms on top of each other. Live runs and
/// replay use this same object. One thread.
class LidarSender {
 public:
  /// @param sender configured IPv4 address; empty: the first sender of a data packet of this model
  explicit LidarSender(const std::string& sender)
      : lock_(sender.empty() ? std::vector<std::uint32_t>{} : std::vector{ipv4_of(sender)}) {}

  /// @param decoder of the configured model
  /// @param stamp_ns time of arrival, robot clock
  /// @return false for a data packet of another lidar. Anything that is no data packet of this model passes,
  ///         for the decoder to count; it makes no sender known.
  bool admits(const LidarDecoder& decoder, std::span<const std::uint8_t> payload, std::uint32_t ipv4,
              std::int64_t stamp_ns) noexcept {
    if (!decoder.is_data(payload)) return true;
    return lock_.admits({ipv4, 0}, stamp_ns);
  }
  [[nodiscard]] const SenderStatus& status() const noexcept { return lock_.status(); }

 private:
  SenderLock lock_;
};

}  // namespace isobar
