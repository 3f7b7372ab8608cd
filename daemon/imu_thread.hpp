// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/device_thread.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Publishes inertial readings; their pressures only where the configuration names them as the barometer.
class InertialOutput {
 public:
  explicit InertialOutput(bool with_pressure) : imu_(ipc::topics::kImu) {
    if (with_pressure) barometer_.emplace(ipc::topics::kBarometer);
  }
  bool send(const InertialReading& reading) noexcept {
    const bool imu_sent = !reading.has_imu || imu_.send(reading.imu);
    const bool pressure_sent = !reading.has_pressure || !barometer_ || barometer_->send(reading.pressure);
    return imu_sent && pressure_sent;
  }

 private:
  ipc::Publisher<ImuSample> imu_;
  std::optional<ipc::Publisher<PressureSample>> barometer_;
};

/// Reads an IMU attached to this machine; it is then the only writer of the IMU topic, and of the barometer topic
/// if the IMU's barometer is the robot's.
class ImuThread final : public DeviceThread<InertialReading, InertialOutput> {
 public:
  /// @throws ServiceError when the kernel refuses a timer
  ImuThread(std::unique_ptr<Device<InertialReading>> device, bool with_pressure, ThreadSettings settings)
      : DeviceThread(std::move(device), std::move(settings), with_pressure) {}
};

}  // namespace isobar
