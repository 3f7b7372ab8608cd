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

/// Location and span of a Setra 278 behind a converter.
struct SetraSettings {
  Settings device;
  std::string channel = "in_voltage0";
  setra278::Span span;
};

}  // namespace isobar::iio
