// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <limits>

#include "core/altitude/pressure_gate.hpp"

namespace isobar::test::test_pressure_gate {

namespace {
PressureSample sample(double t, double pa) { return {static_cast<std::int64_t>(t * 1e9), pa, 20.0}; }
}  // namespace

TEST_CASE("implausible values and times are distinguished") {
  PressureGate gate{AltimeterConfig{}};
  CHECK(gate.check(sample(0.0, std::numeric_limits<double>::quiet_NaN())) == PressureStatus::kBadValue);
  CHECK(gate.check(sample(0.0, std::numeric_limits<double>::infinity())) == PressureStatus::kBadValue);
  CHECK(gate.check(sample(0.0, 0.0)) == PressureStatus::kBadValue);
  CHECK_FALSE(gate.started());
  CHECK(gate.check(sample(1.0, 1e5)) == PressureStatus::kAccepted);
  CHECK(gate.check(sample(1.0, 1e5 + 1.0)) == PressureStatus::kBadTime);
  CHECK(gate.check(sample(0.5, 1e5 + 1.0)) == PressureStatus::kBadTime);
  CHECK(gate.check({std::numeric_limits<std::int64_t>::min(), 1e5, 0.0}) == PressureStatus::kBadTime);
  CHECK(gate.check({std::numeric_limits<std::int64_t>::max(), 1e5, 0.0}) == PressureStatus::kBadTime);
  CHECK(gate.check(sample(1.1, 1e5 + 1.0)) == PressureStatus::kAccepted);
}

TEST_CASE("spikes are refused, a new level is accepted once confirmed") {
  const AltimeterConfig config;
  PressureGate gate{config};
  double t = 0.0;
  for (int i = 0; i < 10; ++i) CHECK(gate.check(sample(t += 0.03, 1e5 + i)) == PressureStatus::kAccepted);
  CHECK(gate.check(sample(t += 0.03, 1e5 + 4000.0)) == PressureStatus::kBadValue);
  CHECK(gate.check(sample(t += 0.03, 1e5 - 3000.0)) == PressureStatus::kBadValue);
  CHECK(gate.check(sample(t += 0.03, 1e5 + 11.0)) == PressureStatus::kAccepted);
  for (std::uint32_t i = 1; i < config.spike_confirmations; ++i) {
    CHECK(gate.check(sample(t += 0.03, 9e4 + i)) == PressureStatus::kBadValue);
  }
  CHECK(gate.check(sample(t += 0.03, 9e4)) == PressureStatus::kAccepted);
}

TEST_CASE("after a clock jump the next sample is accepted") {
  PressureGate gate{AltimeterConfig{}};
  gate.check(sample(1000.0, 1e5));
  CHECK(gate.check(sample(10.0, 1e5 + 1.0)) == PressureStatus::kBadTime);
  gate.restart_clock();
  CHECK(gate.check(sample(10.0, 1e5 + 1.0)) == PressureStatus::kAccepted);
}

}  // namespace isobar::test::test_pressure_gate
