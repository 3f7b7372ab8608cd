// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/setra278/span.hpp"

namespace isobar::iio {

/// Where a barometer of the kernel is.
struct Settings {
  std::string folder = "/sys/bus/iio/devices/iio:device0";
  int rate_hz = 10;  ///< how often it is read
};

/// Where the converter behind a Setra 278 is.
struct SetraSettings {
  Settings device;
  std::string channel = "in_voltage0";
  setra278::Span span;
};

}  // namespace isobar::iio
