// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "drivers/pps/pulse_watch.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_pulse_watch {

using namespace isobar::pps;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
/// CLOCK_MONOTONIC at a whole second of true time.
constexpr std::int64_t kFirst = 5'000 * kSecond + 123'456'789;

/// The clocks 20 ms after an edge, the system clock `ahead_ns` ahead of true time.
ClockPair clocks_after(std::int64_t edge_ns, std::int64_t ahead_ns) {
  constexpr std::int64_t kEpoch = 1'700'000'000 * kSecond;
  return {edge_ns + 20'000'000, kEpoch + (edge_ns - kFirst) + 20'000'000 + ahead_ns, 50};
}

}  // namespace

TEST_CASE("pulses are counted, and the system clock's offset is that of the newest, of either sign") {
  PulseWatch watch;
  for (const std::int64_t ahead_ns : {0LL, 1'500LL, -1'500LL, 400'000'000LL, -400'000'000LL}) {
    for (int i = 0; i < 3; ++i) {
      const std::int64_t edge_ns = kFirst + static_cast<std::int64_t>(watch.figures().pulses) * kSecond;
      watch.add(edge_ns, clocks_after(edge_ns, ahead_ns));
    }
    CHECK(watch.figures().offset_ns == ahead_ns);
  }
  CHECK(watch.figures().pulses == 15);
  CHECK(watch.figures().missing == 0);
  CHECK(watch.figures().extra == 0);
  CHECK(watch.figures().jitter_ns == 0.0);
}

TEST_CASE("missing pulses are counted between two, and edges between pulses are none") {
  PulseWatch watch;
  const auto add = [&](double second) {
    const std::int64_t edge_ns = kFirst + static_cast<std::int64_t>(second * 1e9);
    watch.add(edge_ns, clocks_after(edge_ns, 0));
  };
  for (const double second : {0.0, 1.0, 1.0001, 2.0, 2.4, 5.0, 6.0}) add(second);
  CHECK(watch.figures().pulses == 5);
  CHECK(watch.figures().missing == 2);
  CHECK(watch.figures().extra == 2);
  CHECK(watch.figures().offset_ns == 0);
}

TEST_CASE("a first edge that was noise is given up after three that fit no second") {
  PulseWatch watch;
  const auto add = [&](double second) {
    const std::int64_t edge_ns = kFirst + static_cast<std::int64_t>(second * 1e9);
    watch.add(edge_ns, clocks_after(edge_ns, 0));
  };
  for (const double second : {-0.3, 0.0, 1.0, 2.0, 3.0, 4.0}) add(second);
  CHECK(watch.figures().extra == 3);
  CHECK(watch.figures().pulses == 4);
  CHECK(watch.figures().missing == 0);
  CHECK(watch.figures().offset_ns == 0);
}

TEST_CASE("jitter is the scatter of the periods; a clock that runs fast by 300 ppm is none") {
  for (const double sigma_ns : {0.0, 2'000.0, 50'000.0}) {
    PulseWatch watch;
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0.0, 1.0);
    double sum2 = 0.0;
    constexpr int kPulses = 400;
    for (int i = 0; i < kPulses; ++i) {
      const auto edge_ns = kFirst + static_cast<std::int64_t>(i * 1.0003e9 + sigma_ns * noise(random));
      watch.add(edge_ns, clocks_after(edge_ns, 0));
      if (i >= 50) sum2 += watch.figures().jitter_ns * watch.figures().jitter_ns;
    }
    // Two edges make a period: sqrt(2) of their scatter. The mean of 350 values over a memory of 16 is good to 10 %.
    const double rms_ns = std::sqrt(sum2 / (kPulses - 50));
    CHECK(rms_ns == doctest::Approx(std::sqrt(2.0) * sigma_ns).epsilon(0.15));
    CHECK(watch.figures().extra == 0);
  }
}

TEST_CASE("a line that was closed misses no pulses, and adding allocates nothing") {
  PulseWatch watch;
  const std::size_t before = allocation_count();
  watch.add(kFirst, clocks_after(kFirst, 0));
  watch.interrupt();
  watch.add(kFirst + 60 * kSecond, clocks_after(kFirst + 60 * kSecond, 0));
  CHECK(allocation_count() == before);
  CHECK(watch.figures().missing == 0);
  CHECK(watch.figures().pulses == 2);
}

}  // namespace isobar::test::test_pulse_watch
