// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/arrival_meter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/time/clock_anchor.hpp"
#include "daemon/timing_health.hpp"

namespace isobar::test::test_arrival_meter {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

/// Sensor of 200 Hz with a clock of its own, whose samples are delayed by 3 ms and a random time, through the anchor
/// of a driver.
struct Link {
  std::int64_t clock_ahead_ns = -3'200 * kMs;
  double mean_delay_ms = 0.4;  ///< exponential: the median is ln 2, the 99th percentile ln 100 times the mean
  std::int64_t now_ns = kStart;
  ClockAnchor anchor;
  ArrivalMeter meter;
  std::mt19937_64 random{5};

  void run(double seconds) {
    std::exponential_distribution<double> delay(1.0 / mean_delay_ms);
    for (int i = 0; i < static_cast<int>(seconds * 200.0); ++i) {
      now_ns += 5 * kMs;
      const auto delay_ns = static_cast<std::int64_t>(delay(random) * 1e6);
      const std::int64_t received_ns = now_ns + 3 * kMs + delay_ns;
      (void)anchor.add(now_ns + clock_ahead_ns, received_ns);
      meter.add(anchor.to_host_ns(anchor.device_unwrapped_ns()), {received_ns, anchor.device_ahead_ns()});
    }
  }
  [[nodiscard]] ArrivalFigures figures() const { return meter.figures(now_ns); }
};

}  // namespace

TEST_CASE("offset, latency and jitter of a link are those that it has") {
  Link link;
  CHECK_FALSE(link.figures().known());
  link.run(60.0);
  const ArrivalFigures figures = link.figures();
  // Less the shortest transport, 3 ms; the anchor follows the earliest arrivals within the drift that it allows: some
  // hundredths of a millisecond at 200 Hz.
  CHECK(std::abs(figures.offset_s + 3.203) < 1e-4);
  // Buckets are 19 % wide: half of one, and 4 % for the anchor's error and the sample of 2000.
  CHECK(figures.latency_ms == doctest::Approx(0.4 * std::log(2.0)).epsilon(0.14));
  CHECK(figures.latency_p99_ms == doctest::Approx(0.4 * std::log(100.0)).epsilon(0.16));
  // The interval has two independent delays: sqrt(2) x 0.4 ms, from at least 2000 samples, right to 5 %.
  CHECK(figures.jitter_ms == doctest::Approx(0.4 * std::sqrt(2.0)).epsilon(0.05));
}

TEST_CASE("what has changed is shown after 20 s, and nothing older") {
  Link link;
  link.run(60.0);
  link.mean_delay_ms = 1.0;
  link.run(21.0);
  CHECK(link.figures().latency_ms == doctest::Approx(std::log(2.0)).epsilon(0.14));
  // 1 in 300 arrives before its predecessor, and is no interval: 3 % less.
  CHECK(link.figures().jitter_ms == doctest::Approx(std::sqrt(2.0)).epsilon(0.08));
  link.now_ns += 21 * kSecond;
  CHECK_FALSE(link.figures().known());  // nothing arrives any more
  CHECK(std::isnan(link.figures().offset_s));
}

TEST_CASE("a jump of the sensor's clock leaves neither the old offset nor latencies across the jump") {
  for (const std::int64_t jump_ns : {-3'600 * kSecond, -500 * kMs, 20 * kSecond, 86'400'000 * kSecond}) {
    CAPTURE(jump_ns);
    Link link;
    link.mean_delay_ms = 1.0;
    link.run(15.0);
    link.clock_ahead_ns += jump_ns;
    link.mean_delay_ms = 0.1;
    // ClockAnchor takes 0.5 s at most to believe it.
    link.run(2.0);
    const ArrivalFigures figures = link.figures();
    CHECK(std::abs(figures.offset_s + 3.203 - 1e-9 * static_cast<double>(jump_ns)) < 1e-3);
    // Without the new beginning most of the last 17 s are those before the jump, of ten times the delay.
    CHECK(figures.latency_ms < 0.2);
    CHECK(figures.jitter_ms == doctest::Approx(0.1 * std::sqrt(2.0)).epsilon(0.2));  // of some 300 samples
  }
}

TEST_CASE("samples that arrive together are one arrival, and a pause of a minute is no jitter") {
  ArrivalMeter meter;
  std::int64_t now_ns = kStart;
  for (int i = 0; i < 200; ++i) {
    now_ns += i == 150 ? 60 * kSecond : 50 * kMs;
    for (int sample = 0; sample < 10; ++sample) meter.add(now_ns - 5 * kMs * (10 - sample), {now_ns});
  }
  const ArrivalFigures figures = meter.figures(now_ns);
  CHECK(figures.jitter_ms < 1e-6);
  CHECK(std::isnan(figures.offset_s));
  CHECK(figures.latency_ms == doctest::Approx(27.0).epsilon(0.15));  // 5 to 50 ms
}

TEST_CASE("samples of unknown arrival, as of a recording, are not measured") {
  ArrivalMeter meter;
  for (int i = 0; i < 100; ++i) meter.add(kStart + i * kMs, SampleTiming{});
  CHECK_FALSE(meter.figures(kStart + 100 * kMs).known());
}

TEST_CASE("the line of a sensor has its figures in units that people read") {
  CHECK(timing_text({-3.2, 0.4, 1.9, 0.2}) ==
        "offset -3.200 s, latency 0.40 ms (p99 1.90 ms), jitter 0.20 ms");
  CHECK(timing_text({std::nan(""), 0.4, 1.9, std::nan("")}) ==
        "no clock of its own, latency 0.40 ms (p99 1.90 ms)");
  ipc::HealthReport report;
  add_timing(report, "imu", {});
  CHECK(report.entry_count == 0);
  add_timing(report, "imu", {.measured = true});
  add_timing(report, "imu", {.latency_ms = 0.4, .measured = true});
  REQUIRE(report.entry_count == 2);
  CHECK(std::string(report.entries[0].name) == "imu/timing");
  CHECK(report.entries[0].level == ipc::HealthLevel::kStale);
  CHECK(report.entries[1].level == ipc::HealthLevel::kOk);
}

}  // namespace isobar::test::test_arrival_meter
