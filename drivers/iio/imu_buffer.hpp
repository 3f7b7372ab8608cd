// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "core/time/clock_anchor.hpp"
#include "drivers/device/fault_watch.hpp"
#include "drivers/device/inertial_watch.hpp"
#include "drivers/iio/scan_layout.hpp"
#include "drivers/iio/settings.hpp"
#include "drivers/serial/byte_window.hpp"

namespace isobar::iio {

/// IMU with a kernel driver, read through the buffer of its industrial-I/O device: accelerometer and gyro in
/// one device, as BMI160, MPU-6050 and ICM-20948 have them. At the start the buffer is set up (rate, channels,
/// trigger, monotonic time stamps) and switched on; after every fault again. The kernel's mount matrix is not
/// used: imu.rpy_deg is.
class ImuBuffer final : public Device<InertialReading> {
 public:
  explicit ImuBuffer(const ImuBufferSettings& settings);
  ~ImuBuffer() override { close(); }

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return file_; }
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  std::int64_t open(std::int64_t now_ns) noexcept;
  /// Sets the buffer up. The fault with its error, or nullptr.
  const char* set_up(int& error) noexcept;
  const char* set_rate(int& error) noexcept;
  const char* choose_channels(int& error) noexcept;
  const char* read_channel(std::size_t channel, int& error) noexcept;
  const char* read_scales(int& error) noexcept;
  /// Attribute of one axis, or the one that all axes share.
  int read_constant(const char* kind, char axis, const char* suffix, double& value) const noexcept;
  void close() noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  int receive() noexcept;
  bool take_scan(std::int64_t now_ns, Step& step) noexcept;
  std::int64_t fail(DeviceState state, const char* what, std::int64_t now_ns, int error) noexcept;

  ImuBufferSettings settings_;
  std::string place_;
  std::string scan_folder_;
  FaultWatch faults_;
  InertialWatch watch_;
  ClockAnchor anchor_;
  ScanLayout layout_;
  Eigen::Matrix<double, 6, 1> scale_, offset_;  ///< by channel: value = (raw + offset) scale
  serial::ByteWindow window_;
  int file_ = -1;
};

}  // namespace isobar::iio
