// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/setra278/span.hpp"

namespace isobar::iio {

/// Location of a barometer with a kernel driver.
struct Settings {
  std::string folder = "/sys/bus/iio/devices/iio:device0";
  int rate_hz = 10;  ///< polling rate
};

/// Location of an IMU with a kernel driver, and how its buffer is set up.
struct ImuBufferSettings {
  std::string folder = "/sys/bus/iio/devices/iio:device0";
  std::string device;   ///< "/dev/iio:device0"; empty: in /dev, named as the folder
  std::string trigger;  ///< name of the trigger of the buffer; empty: the driver's own
  int rate_hz = 200;    ///< one that the device offers
  std::string accel_folder =
      {};  ///< of the accelerometer where it is a device of its own; empty: the same device
  std::string accel_device = {};  ///< as `device`, of that one
};

/// Location and span of a Setra 278 behind a converter.
struct SetraSettings {
  Settings device;
  std::string channel = "in_voltage0";
  setra278::Span span;
};

}  // namespace isobar::iio
