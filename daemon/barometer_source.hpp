// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"

namespace isobar {

/// Thread for the barometer attached to this machine that the configuration
/// names; null when its samples arrive as datagrams. Does not access the
/// hardware: a missing device is reported and retried once the thread runs.
/// @throws ConfigError for a source without a driver
/// @throws ServiceError when the kernel refuses a timer
[[nodiscard]] std::unique_ptr<BarometerThread> make_barometer_thread(const BarometerSettings& settings,
                                                                     const ThreadSettings& scheduling);

}  // namespace isobar
