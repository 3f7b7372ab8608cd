// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "daemon/seq_lock.hpp"
#include "daemon/stoppable_timer.hpp"
#include "daemon/worker.hpp"
#include "drivers/device/device.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the barometer thread.
struct BarometerThreadStatus {
  bool present = false;          ///< false: no such thread, samples arrive as datagrams
  std::array<char, 80> place{};  ///< "DPS310 on /dev/i2c-1 at 0x77"
  DeviceStatus device;
  std::uint64_t samples_without_memory = 0;
};

/// Reads a barometer attached to this machine; it is then the only writer of the barometer topic. A missing
/// or failed sensor is retried for ever; nothing else waits for it. On robots and base stations alike.
class BarometerThread {
 public:
  /// @throws ServiceError when the kernel refuses a timer
  BarometerThread(std::unique_ptr<Device<PressureSample>> device, ThreadSettings settings);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] BarometerThreadStatus status() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  std::int64_t step() noexcept;

  std::unique_ptr<Device<PressureSample>> device_;
  StoppableTimer timer_;
  ipc::Publisher<PressureSample> publisher_;
  BarometerThreadStatus draft_status_;
  SeqLock<BarometerThreadStatus> status_;
  Worker worker_;
};

}  // namespace isobar
