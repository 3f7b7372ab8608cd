// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/time/clock_anchor.hpp"

namespace isobar::test::test_clock_anchor {

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kHour = 3'600 * kSecond;
constexpr std::int64_t kHost = 1'700'000'000 * kSecond;
constexpr std::int64_t kPacket = 1'327'104;

ClockAnchorConfig hourly() {
  ClockAnchorConfig config;
  config.period_ns = kHour;
  return config;
}

/// A device read every 1.327 ms for `seconds`; its clock starts at `start_ns` and is fast by `drift_ppm`.
struct Device {
  std::int64_t start_ns = 0;
  double drift_ppm = 0.0;
  [[nodiscard]] std::int64_t true_host_ns(int i) const { return kHost + i * kPacket; }
  [[nodiscard]] std::int64_t stamp_ns(int i) const {
    const auto drift_ns = static_cast<std::int64_t>(static_cast<double>(i) * kPacket * drift_ppm * 1e-6);
    return (start_ns + i * kPacket + drift_ns) % kHour;
  }
};

}  // namespace

TEST_CASE("Jitter, drift of either sign, late packets and the hourly wrap cause errors of at most 0.2 ms") {
  for (const double drift_ppm : {-50.0, 0.0, 50.0}) {
    std::mt19937_64 random(5);
    std::exponential_distribution<double> jitter(1.0 / 200e3);  // 0.2 ms on average, never early
    const Device device{kHour - 20 * kSecond, drift_ppm};
    ClockAnchor anchor(hourly());
    double worst_ms = 0.0;
    for (int i = 0; i < 40'000; ++i) {  // 53 s
      const std::int64_t late_ns = i % 997 == 500 ? 2 * kSecond : i % 101 == 50 ? 40 * kMs : 0;
      anchor.add(device.stamp_ns(i),
                 device.true_host_ns(i) + 100'000 + static_cast<std::int64_t>(jitter(random)) + late_ns);
      if (i > 1'000) {
        const auto error_ns =
            anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(i) - 100'000;
        worst_ms = std::max(worst_ms, std::abs(static_cast<double>(error_ns)) * 1e-6);
      }
    }
    CHECK(worst_ms < 0.2);
    CHECK(anchor.steps() == 0);
  }
}

TEST_CASE("A first packet that is late by 40 ms is corrected by the following packets") {
  const Device device;
  ClockAnchor anchor(hourly());
  for (int i = 0; i < 10; ++i) {
    anchor.add(device.stamp_ns(i), device.true_host_ns(i) + (i == 0 ? 40 * kMs : 0));
  }
  CHECK(anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(9) == 0);
}

TEST_CASE("A step of the device clock, forward or backward, re-anchors at the next packet") {
  for (const std::int64_t jump_ns : {1'000 * kSecond, -1'000 * kSecond, 2 * kSecond, -2 * kSecond}) {
    ClockAnchor anchor(hourly());
    const Device before{1'800 * kSecond};
    const Device after{1'800 * kSecond + jump_ns};
    for (int i = 0; i < 1'000; ++i) {
      const auto finding = anchor.add((i < 500 ? before : after).stamp_ns(i), before.true_host_ns(i));
      CHECK((finding == ClockAnchor::Finding::kStep) == (i == 500));
      CHECK(std::abs(anchor.to_host_ns(anchor.device_unwrapped_ns()) - before.true_host_ns(i)) < kMs);
    }
    CHECK(anchor.steps() == 1);
  }
}

TEST_CASE("A single absurd host stamp changes nothing") {
  for (const std::int64_t off_ns : {-kHost, 10 * kMs, -10 * kMs, 100 * kMs, -100 * kMs, kHost}) {
    ClockAnchor anchor(hourly());
    const Device device;
    for (int i = 0; i < 1'000; ++i) {
      anchor.add(device.stamp_ns(i), device.true_host_ns(i) + (i == 500 ? off_ns : 0));
      CHECK(std::abs(anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(i)) < kMs / 2);
    }
    CHECK(anchor.steps() == 0);
  }
}

TEST_CASE("A step of the host clock is followed after half a second if forward, at once if backward") {
  for (const std::int64_t jump_ns : {10 * kSecond, -10 * kSecond}) {
    ClockAnchor anchor(hourly());
    const Device device;
    for (int i = 0; i < 2'000; ++i) {
      anchor.add(device.stamp_ns(i), device.true_host_ns(i) + (i >= 500 ? jump_ns : 0));
    }
    CHECK(anchor.steps() == 1);
    CHECK(std::abs(anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(1'999) - jump_ns) <
          kMs);
  }
}

TEST_CASE("A burst of packets delayed by seconds does not move the anchor") {
  ClockAnchor anchor(hourly());
  const Device device;
  for (int i = 0; i < 4'000; ++i) {
    const bool waited = i >= 1'000 && i < 2'500;  // all arrive with the last one
    anchor.add(device.stamp_ns(i), device.true_host_ns(waited ? 2'500 : i));
    CHECK(std::abs(anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(i)) < kMs);
  }
  CHECK(anchor.steps() == 0);
}

TEST_CASE("Five seconds of silence are not a step") {
  ClockAnchor anchor(hourly());
  const Device device{kHour - 3 * kSecond};
  for (int i = 0; i < 5'000; ++i) {
    if (i < 1'000 || i > 4'768) {
      anchor.add(device.stamp_ns(i), device.true_host_ns(i));
    }
  }
  CHECK(anchor.steps() == 0);
  CHECK(std::abs(anchor.to_host_ns(anchor.device_unwrapped_ns()) - device.true_host_ns(4'999)) < kMs);
}

}  // namespace isobar::test::test_clock_anchor
