// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <thread>

#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "drivers/barometer/barometer_device.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the barometer's thread says of itself.
struct BarometerThreadStatus {
  bool present = false;          ///< false: there is no such thread, samples come as datagrams
  std::array<char, 80> place{};  ///< "DPS310 on /dev/i2c-1 at 0x77"
  BarometerStatus device;
  std::uint64_t samples_without_memory = 0;
};

/// Reads a barometer of this machine and is then the only writer of the barometer's topic. A sensor that is
/// missing or fails is asked for again and again; the rest of the program never waits for it. Serves a robot
/// and a base station alike.
class BarometerThread {
 public:
  /// Throws ServiceError when the kernel gives no timer.
  BarometerThread(std::unique_ptr<BarometerDevice> device, ThreadSettings settings);
  ~BarometerThread();
  BarometerThread(const BarometerThread&) = delete;
  BarometerThread& operator=(const BarometerThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] BarometerThreadStatus status() const noexcept { return status_.get(); }
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  std::int64_t step() noexcept;
  void arm(std::int64_t wait_ns) noexcept;
  bool wait() noexcept;

  ThreadSettings settings_;
  std::unique_ptr<BarometerDevice> device_;
  int timer_ = -1;
  int stop_event_ = -1;
  ipc::Publisher<PressureSample> publisher_;
  BarometerThreadStatus own_;
  SeqLock<BarometerThreadStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
