// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "config/config.hpp"
#include "config/setting.hpp"

namespace isobar {

/// Sections of the barometers that isobard reads on I2C or SPI.
void add_bus_barometers(BarometerSettings& barometer, std::vector<Setting>& settings);

}  // namespace isobar
