// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/sensor.hpp"

#include "drivers/serial/serial_imu.hpp"
#include "drivers/vn100/protocol.hpp"

namespace isobar::vn100 {

std::unique_ptr<Device<InertialReading>> make_sensor(const Settings& settings) {
  return std::make_unique<serial::SerialImu>("VN-100", settings.port, settings.baud, settings.rate_hz,
                                             std::make_unique<Protocol>(settings));
}

}  // namespace isobar::vn100
