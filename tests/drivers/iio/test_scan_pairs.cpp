// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "drivers/iio/scan_pairs.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_scan_pairs {

using namespace isobar::iio;

namespace {

constexpr std::int64_t kMs = 1'000'000;

InertialScan gyro_at(std::int64_t time_ns) {
  InertialScan scan;
  scan.time_ns = time_ns;
  scan.gyro_rad_s.x() = 1e-9 * static_cast<double>(time_ns);
  return scan;
}
InertialScan accel_at(std::int64_t time_ns) {
  InertialScan scan;
  scan.time_ns = time_ns;
  scan.accel_m_s2.z() = 2e-9 * static_cast<double>(time_ns);
  return scan;
}
/// Both values were linear in time.
void check(const InertialScan& scan) {
  CHECK(scan.gyro_rad_s.x() == doctest::Approx(1e-9 * static_cast<double>(scan.time_ns)));
  CHECK(scan.accel_m_s2.z() == doctest::Approx(2e-9 * static_cast<double>(scan.time_ns)));
}

}  // namespace

TEST_CASE("accelerations come to the time of the rates, at other rates and phases, in pieces of any order") {
  for (const std::int64_t accel_period_ns : {5 * kMs, 3 * kMs, 10 * kMs}) {
    for (const bool accel_first : {true, false}) {
      auto pairs = std::make_unique<ScanPairs>();
      std::int64_t next_accel_ns = 1'300'000;
      int taken = 0;
      InertialScan scan;
      for (std::int64_t time_ns = 5 * kMs; time_ns <= 500 * kMs; time_ns += 5 * kMs) {
        if (!accel_first) pairs->add_gyro(gyro_at(time_ns));
        for (; next_accel_ns <= time_ns; next_accel_ns += accel_period_ns)
          pairs->add_accel(accel_at(next_accel_ns));
        if (accel_first) pairs->add_gyro(gyro_at(time_ns));
        while (pairs->next(scan)) {
          CHECK(scan.time_ns == 5 * kMs * ++taken);
          check(scan);
        }
      }
      CHECK(taken >= 97);  // the last ones wait for the next acceleration
    }
  }
}

TEST_CASE("scans of one trigger wait for nothing") {
  auto pairs = std::make_unique<ScanPairs>();
  InertialScan scan;
  for (std::int64_t time_ns = 5 * kMs; time_ns <= 50 * kMs; time_ns += 5 * kMs) {
    pairs->add_gyro(gyro_at(time_ns));
    CHECK_FALSE(pairs->next(scan));
    CHECK(pairs->gyro_waits());
    pairs->add_accel(accel_at(time_ns));
    REQUIRE(pairs->next(scan));
    check(scan);
    CHECK_FALSE(pairs->gyro_waits());
  }
}

TEST_CASE("over a gap of the accelerometer nothing is made up, and rates from before it are left out") {
  auto pairs = std::make_unique<ScanPairs>();
  for (std::int64_t time_ns = 0; time_ns <= 300 * kMs; time_ns += 5 * kMs) {
    pairs->add_gyro(gyro_at(time_ns));
    if (time_ns < 20 * kMs || (time_ns > 100 * kMs && time_ns < 200 * kMs)) continue;
    pairs->add_accel(accel_at(time_ns + kMs));
  }
  InertialScan scan;
  int taken = 0;
  while (pairs->next(scan)) {
    ++taken;
    check(scan);
    CHECK(scan.time_ns > 20 * kMs);
    CHECK((scan.time_ns <= 100 * kMs || scan.time_ns > 200 * kMs));
  }
  CHECK(taken == 16 + 20);
}

TEST_CASE("clocks that differ are told, a full queue loses the oldest, and nothing is allocated") {
  auto pairs = std::make_unique<ScanPairs>();
  const std::size_t before = allocation_count();
  InertialScan scan;
  int taken = 0;
  for (int i = 0; i < 1'000; ++i) {
    pairs->add_gyro(gyro_at(i * kMs));
    pairs->add_accel(accel_at(1'700'000'000'000 * kMs + i * kMs));
    taken += pairs->next(scan) ? 1 : 0;
  }
  const bool differ = pairs->clocks_differ();
  pairs->clear();
  const bool differ_afterwards = pairs->clocks_differ();
  for (int i = 0; i < 1'000; ++i) pairs->add_gyro(gyro_at(i * kMs));
  pairs->add_accel(accel_at(900 * kMs));
  const bool found = pairs->next(scan);
  CHECK(allocation_count() == before);
  CHECK(taken == 0);
  CHECK(differ);
  CHECK_FALSE(differ_afterwards);
  REQUIRE(found);
  CHECK(scan.time_ns == 900 * kMs);
}

}  // namespace isobar::test::test_scan_pairs
