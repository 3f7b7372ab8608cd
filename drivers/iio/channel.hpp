// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace isobar::iio {

/// Channel of an industrial-I/O device of the kernel, read through sysfs (Linux,
/// Documentation/ABI/testing/sysfs-bus-iio). A driver has either `NAME_input`, processed, or `NAME_raw` with
/// `NAME_scale` and `NAME_offset`: value = (raw + offset) scale. An attribute shared by all channels of a
/// kind has no channel number: in_voltage0_raw, in_voltage_scale.
class Channel {
 public:
  /// @param folder "/sys/bus/iio/devices/iio:device0"
  /// @param name "in_pressure", "in_voltage0"
  Channel(std::string folder, std::string name);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Opens the channel's file and reads scale and offset.
  /// @return 0 or errno; ENOENT: the device has no such channel; EBADMSG: a file does not hold a number
  int open() noexcept;

  struct Value {
    int error = 0;          ///< 0 or errno; EBADMSG: the file does not hold a number
    double value = 0.0;     ///< in the channel's unit: millivolt, kilopascal, millidegree Celsius
    std::int64_t bits = 0;  ///< bits of the reading, for StuckWatch
  };
  /// Reads once; blocks while the driver converts. Allocates nothing.
  Value read() noexcept;

 private:
  void close() noexcept;
  [[nodiscard]] int open_file(const char* suffix, bool shared) const noexcept;
  int read_constant(const char* suffix, double& value) const noexcept;

  std::string folder_;
  std::string name_;
  std::string shared_name_;
  int file_ = -1;
  bool processed_ = false;
  double scale_ = 1.0;
  double offset_ = 0.0;
};

}  // namespace isobar::iio
