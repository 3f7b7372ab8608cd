// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "config/config.hpp"
#include "daemon/imu_thread.hpp"

namespace isobar {

/// Thread for the IMU attached to this machine that the configuration names; null when its samples come from
/// elsewhere. Does not access the hardware: a missing device is reported and retried once the thread runs.
/// @throws ServiceError when the kernel refuses a timer
[[nodiscard]] std::unique_ptr<ImuThread> make_imu_thread(const Config& config,
                                                         const ThreadSettings& scheduling);

/// Interval of the measurements of the IMU that imu.source names, if this machine reads it [ns].
[[nodiscard]] std::int64_t imu_period_ns(const ImuSettings& imu);

}  // namespace isobar
