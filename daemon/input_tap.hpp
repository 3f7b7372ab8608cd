// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemon/path_choice.hpp"
#include "ipc/shared_memory.hpp"
#include "run/recording/input_log.hpp"

namespace isobar {

/// Subscriber of all inputs of isobard, for the black box inside of it and for `isobar record` outside.
/// Belongs to one thread.
class InputTap {
 public:
  /// Longest time between two calls of drain() that loses nothing [ns]: the queue of the lidar's packets holds
  /// 0.12 s of the busiest lidar (PacketTap::kMaxAgeNs), that of the IMU 0.25 s at 1 kHz.
  static constexpr std::int64_t kDrainEveryNs = 50'000'000;

  /// Whether the lidar's scans are inputs, which they are where they come as clouds over DDS; of packets they are made.
  void take_scans(bool wanted);
  /// Appends all waiting inputs to `log`.
  void drain(recording::InputLog& log);

  /// Inputs lost to full queues or for want of shared memory.
  [[nodiscard]] std::uint64_t lost() const noexcept;

 private:
  void drain_packets(recording::InputLog& log);
  void drain_base_stations(recording::InputLog& log);

  ipc::Subscriber<ipc::LidarPackets> packets_{ipc::topics::kLidarPackets};
  ipc::Subscriber<ImuSample> imu_{ipc::topics::kImu};
  ipc::Subscriber<PressureSample> barometer_{ipc::topics::kBarometer};
  ipc::Subscriber<PressureSample> base_barometer_{ipc::topics::kBaseBarometer};
  // What the prior thread refuses is left out.
  std::array<PathChoice, 2> base_paths_{PathChoice(PathChoice::kBaseTakeoverNs),
                                        PathChoice(PathChoice::kBaseTakeoverNs)};  ///< by station
  PathChoice imu_path_{PathChoice::kSensorTakeoverNs};
  PathChoice wheel_path_{PathChoice::kSensorTakeoverNs};
  ipc::Subscriber<WheelSample> wheel_{ipc::topics::kWheel};
  std::optional<ipc::Subscriber<Scan>> scans_;
  std::optional<std::uint64_t> next_packet_;  ///< LidarPackets::first_number of the next group
  std::uint64_t lost_packets_ = 0;
};

}  // namespace isobar
