// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "config/config.hpp"
#include "daemon/wheel_thread.hpp"

namespace isobar {

/// Thread for the encoders attached to this machine that the configuration names; null when the wheels' samples
/// come from elsewhere. Does not access the hardware: a missing chip is reported and retried once the thread
/// runs.
/// @throws ServiceError when the kernel refuses a timer
[[nodiscard]] std::unique_ptr<WheelThread> make_wheel_thread(const WheelSettings& wheel,
                                                             const ThreadSettings& scheduling);

/// Interval of the samples of the encoders, if wheel.source names them [ns].
[[nodiscard]] std::int64_t wheel_period_ns(const WheelSettings& wheel);

}  // namespace isobar
