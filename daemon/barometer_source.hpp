// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "config/config.hpp"
#include "drivers/barometer/barometer_device.hpp"

namespace isobar {

/// The barometer of this machine that the configuration names; nullptr when its samples come as datagrams.
/// Touches no hardware: what is missing shows, and is asked for again, once the device runs. Throws
/// ConfigError for a source that has no driver.
[[nodiscard]] std::unique_ptr<BarometerDevice> make_barometer(const BarometerSettings& settings);

}  // namespace isobar
