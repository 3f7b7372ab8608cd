// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/device_thread.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Reads a barometer attached to this machine; it is then the only writer of the barometer topic. On robots and
/// base stations alike.
class BarometerThread final : public DeviceThread<PressureSample, ipc::Publisher<PressureSample>> {
 public:
  /// @throws ServiceError when the kernel refuses a timer
  BarometerThread(std::unique_ptr<Device<PressureSample>> device, ThreadSettings settings)
      : DeviceThread(std::move(device), std::move(settings), ipc::topics::kBarometer) {}
};

}  // namespace isobar
