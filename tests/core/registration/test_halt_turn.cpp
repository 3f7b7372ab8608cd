// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/halt_turn.hpp"

namespace isobar::test::test_halt_turn {

namespace {

constexpr std::int64_t kScanNs = 100'000'000;

/// A halt of `scans` scans in which the map turns by `turn_rad` against the gyro.
HaltTurn halted(double turn_rad, int scans) {
  HaltTurn halt;
  for (int i = 0; i <= scans; ++i) halt.stand(i * kScanNs, 3.0 + turn_rad * i / scans);
  return halt;
}

}  // namespace

TEST_CASE("scans that turn a standing robot by a degree make yaw uncertain by a degree") {
  const double sd_rad = std::sqrt(halted(kRadPerDeg, 50).variance_rad2());
  CHECK(sd_rad == doctest::Approx(kRadPerDeg).epsilon(0.1));
  CHECK(halted(-kRadPerDeg, 50).variance_rad2() == doctest::Approx(halted(kRadPerDeg, 50).variance_rad2()));
}

TEST_CASE("noise of scans and the drift of a gyro at rest are no contradiction") {
  CHECK(halted(0.02 * kRadPerDeg, 20).variance_rad2() == 0.0);
  CHECK(halted(0.15 * kRadPerDeg, 600).variance_rad2() == 0.0);  // 0.0025 deg/s for a minute
}

TEST_CASE("a turn that is taken back is none, and the next halt begins anew") {
  HaltTurn halt = halted(kRadPerDeg, 50);
  halt.stand(51 * kScanNs, 3.0);
  CHECK(halt.variance_rad2() == 0.0);
  halt = halted(kRadPerDeg, 50);
  halt.leave();
  CHECK_FALSE(halt.standing());
  halt.stand(60 * kScanNs, 1.0);
  CHECK(halt.variance_rad2() == 0.0);
}

}  // namespace isobar::test::test_halt_turn
