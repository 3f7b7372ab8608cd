// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/device_thread.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Reads the encoders attached to this machine; it is then the only writer of the wheel topic.
class WheelThread final : public DeviceThread<WheelSample, ipc::Publisher<WheelSample>> {
 public:
  /// @throws ServiceError when the kernel refuses a timer
  WheelThread(std::unique_ptr<Device<WheelSample>> device, ThreadSettings settings)
      : DeviceThread(std::move(device), std::move(settings), ipc::topics::kWheel) {}
};

}  // namespace isobar
