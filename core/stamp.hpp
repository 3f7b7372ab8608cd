// SPDX-License-Identifier: BSD-3-Clause
// Time stamps: differences and plausibility.
#pragma once

#include <cstdint>

namespace isobar {

/// Time from one stamp to another [s].
constexpr double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

/// True for stamps within 126 years of the epoch, whose differences cannot overflow int64. Wider than
/// implausible_stamp() (plausibility.hpp), the range of real measurements.
constexpr bool plausible_stamp(std::int64_t stamp_ns) {
  constexpr std::int64_t kLimitNs = 4'000'000'000'000'000'000;
  return stamp_ns > -kLimitNs && stamp_ns < kLimitNs;
}

}  // namespace isobar
