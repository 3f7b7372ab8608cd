// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace isobar::iio {

/// One measured channel of a device of the kernel's industrial I/O interface, read from its folder in sysfs
/// (Linux, Documentation/ABI/testing/sysfs-bus-iio). A driver offers either `NAME_input`, processed, or
/// `NAME_raw` with `_scale` and `_offset`, of which those that all channels of a kind share lack the number:
/// in_voltage0_raw and in_voltage_scale. value = (raw + offset) scale.
class Channel {
 public:
  /// folder: "/sys/bus/iio/devices/iio:device0". name: "in_pressure", "in_voltage0".
  Channel(std::string folder, std::string name);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Finds the files and reads scale and offset. 0 or errno; ENOENT: the device has no such channel. EBADMSG:
  /// a file does not hold a number.
  int open() noexcept;

  struct Value {
    int error = 0;          ///< errno; EBADMSG: no number
    double value = 0.0;     ///< in the unit of the channel: millivolt, kilopascal, milli degree Celsius
    std::int64_t bits = 0;  ///< changes when the reading does
  };
  /// Reads once: the driver may convert meanwhile. Allocates nothing.
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
