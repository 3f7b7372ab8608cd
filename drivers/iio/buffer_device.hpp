// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "drivers/iio/scan_layout.hpp"
#include "drivers/serial/byte_window.hpp"

namespace isobar::iio {

/// Inertial sensors that a device has, or of which one is read.
enum class Sensors : std::uint8_t { kBoth, kGyro, kAccel };

/// A scan of the buffer in SI units; zero where the device has no such sensor.
struct InertialScan {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  std::int64_t time_ns = 0;  ///< by the device's clock; 0 without time stamps
};

/// The buffer of a device of the kernel's industrial I/O. Nothing throws; after construction nothing is allocated.
class BufferDevice {
 public:
  /// @param device "/dev/iio:device0"; empty: the one in /dev that is named as the folder
  /// @param trigger empty: the driver's own
  BufferDevice(const std::string& folder, const std::string& device, const std::string& trigger, int rate_hz,
               Sensors sensors);
  ~BufferDevice() { close(); }
  BufferDevice(const BufferDevice&) = delete;
  BufferDevice& operator=(const BufferDevice&) = delete;

  /// Sets the buffer up (rate, channels, trigger, monotonic time stamps) and switches it on.
  /// @param error errno; 0: the device is another than asked for
  /// @return the fault; nullptr: none
  const char* open(int& error) noexcept;
  void close() noexcept;
  /// Reads what waits, unless a whole scan is at hand. 0 or errno.
  int receive() noexcept;
  /// Takes the oldest scan; false: none is whole.
  bool next(InertialScan& scan) noexcept;
  [[nodiscard]] bool is_open() const noexcept { return file_ >= 0; }
  [[nodiscard]] bool has_time() const noexcept { return layout_.has(kTimestampChannel); }
  [[nodiscard]] int file_descriptor() const noexcept { return file_; }
  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  const char* set_up(int& error) noexcept;
  const char* set_rate(int& error) noexcept;
  const char* choose_channels(int& error) noexcept;
  const char* read_channel(std::size_t channel, int& error) noexcept;
  const char* read_scales(int& error) noexcept;
  /// Attribute of one axis, or the one that all axes share.
  int read_constant(const char* kind, char axis, const char* suffix, double& value) const noexcept;

  std::string folder_;
  std::string device_;
  std::string trigger_;
  int rate_hz_;
  Sensors sensors_;
  std::string scan_folder_;
  ScanLayout layout_;
  Eigen::Matrix<double, 6, 1> scale_, offset_;  ///< by channel: value = (raw + offset) scale
  serial::ByteWindow window_;
  int file_ = -1;
};

}  // namespace isobar::iio
