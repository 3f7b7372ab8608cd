// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/device/device.hpp"
#include "drivers/vn100/settings.hpp"

namespace isobar::vn100 {

/// @param settings validated: broken_rule() is nullptr
[[nodiscard]] std::unique_ptr<Device<InertialReading>> make_sensor(const Settings& settings);

}  // namespace isobar::vn100
