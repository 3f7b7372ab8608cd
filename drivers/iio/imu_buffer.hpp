// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/time/clock_anchor.hpp"
#include "drivers/device/fault_watch.hpp"
#include "drivers/device/inertial_watch.hpp"
#include "drivers/iio/buffer_device.hpp"
#include "drivers/iio/scan_pairs.hpp"
#include "drivers/iio/settings.hpp"

namespace isobar::iio {

/// IMU with a kernel driver, read through the buffer of its industrial-I/O device: accelerometer and gyro in
/// one device, as BMI160, MPU-6050 and ICM-20948 have them, or in two, as LSM6DSx and ICM-42600 do, paired by their time
/// stamps. After every fault the buffers are set up again. The kernel's mount matrix is not used: imu.rpy_deg is.
class ImuBuffer final : public Device<InertialReading> {
 public:
  explicit ImuBuffer(const ImuBufferSettings& settings);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return main_.file_descriptor(); }
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  std::int64_t open(std::int64_t now_ns) noexcept;
  void close() noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  /// Reads both devices. 0 or errno.
  int receive() noexcept;
  bool next(InertialScan& scan) noexcept;
  bool take(const InertialScan& scan, std::int64_t now_ns, Step& step) noexcept;
  std::int64_t fail(DeviceState state, const char* what, std::int64_t now_ns, int error) noexcept;

  std::string place_;
  BufferDevice main_;                    ///< both sensors, or the gyro
  std::unique_ptr<BufferDevice> accel_;  ///< null: the accelerometer is in main_
  ScanPairs pairs_;
  FaultWatch faults_;
  InertialWatch watch_;
  ClockAnchor anchor_;
};

}  // namespace isobar::iio
