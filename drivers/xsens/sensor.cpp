// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/sensor.hpp"

#include "drivers/serial/serial_imu.hpp"
#include "drivers/xsens/protocol.hpp"

namespace isobar::xsens {

std::unique_ptr<Device<InertialReading>> make_sensor(const Settings& settings) {
  return std::make_unique<serial::SerialImu>("Xsens MTi", settings.port, settings.baud, settings.rate_hz,
                                             std::make_unique<Protocol>(settings));
}

}  // namespace isobar::xsens
