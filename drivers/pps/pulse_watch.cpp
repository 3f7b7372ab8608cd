// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/pps/pulse_watch.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::pps {

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
/// Periods that the jitter rests on.
constexpr int kMemory = 16;

/// Nearest whole number of seconds.
std::int64_t seconds_of(std::int64_t ns) {
  const std::int64_t half = ns >= 0 ? kSecondNs / 2 : -kSecondNs / 2;
  return (ns + half) / kSecondNs;
}

}  // namespace

void PulseWatch::add(std::int64_t edge_ns, const ClockPair& clocks) noexcept {
  if (figures_.newest_ns == 0) {
    take(edge_ns, clocks);
    return;
  }
  const std::int64_t since_ns = edge_ns - figures_.newest_ns;
  const std::int64_t seconds = seconds_of(since_ns);
  const std::int64_t beyond_ns = since_ns - seconds * kSecondNs;
  if (seconds < 1 || std::abs(beyond_ns) > std::min(kToleranceNs * seconds, kSecondNs / 4)) {
    ++figures_.extra;
    if (++astray_ >= kMostAstray) take(edge_ns, clocks);
    return;
  }
  figures_.missing += static_cast<std::uint64_t>(seconds - 1);
  periods_ = std::min(periods_ + 1, kMemory);
  const double from_mean_ns = static_cast<double>(beyond_ns) / static_cast<double>(seconds) - mean_ns_;
  mean_ns_ += from_mean_ns / periods_;
  // The first period is the mean.
  if (periods_ > 1) variance_ns2_ += (from_mean_ns * from_mean_ns - variance_ns2_) / periods_;
  figures_.jitter_ns = std::sqrt(variance_ns2_);
  take(edge_ns, clocks);
}

void PulseWatch::take(std::int64_t edge_ns, const ClockPair& clocks) noexcept {
  astray_ = 0;
  ++figures_.pulses;
  figures_.newest_ns = edge_ns;
  const std::int64_t system_ns = edge_ns + (clocks.system_ns - clocks.monotonic_ns);
  figures_.offset_ns = system_ns - seconds_of(system_ns) * kSecondNs;
}

}  // namespace isobar::pps
