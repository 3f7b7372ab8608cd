// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lidar_clock.hpp"

#include <memory>
#include <optional>
#include <span>

namespace isobar {

recording::LidarClock lidar_clock(const LidarConfig& lidar) {
  const std::shared_ptr<LidarDecoder> decoder = make_lidar_decoder(lidar);
  const std::int64_t period_ns = decoder->period_ns();
  const auto elapsed = [decoder, period_ns](
                           std::span<const std::uint8_t> before,
                           std::span<const std::uint8_t> after) -> std::optional<std::int64_t> {
    PacketColumns first;
    PacketColumns second;
    if (!decoder->is_data(before) || !decoder->is_data(after) ||
        decoder->read(before, first) != DecodeStatus::kOk ||
        decoder->read(after, second) != DecodeStatus::kOk) {
      return std::nullopt;
    }
    std::int64_t elapsed_ns = second.device_ns - first.device_ns;
    if (period_ns > 0) elapsed_ns = (elapsed_ns % period_ns + period_ns) % period_ns;
    if (elapsed_ns < 0) return std::nullopt;  // it began anew
    return elapsed_ns;
  };
  return {period_ns, elapsed};
}

}  // namespace isobar
