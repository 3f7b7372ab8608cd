// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cerrno>
#include <memory>

#include "drivers/pps/pulse_input.hpp"
#include "tests/drivers/pps/pulse_line.hpp"

namespace isobar::test::test_pulse_input {

using namespace isobar::pps;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

ClockPair at(double second) {
  const auto ns = static_cast<std::int64_t>(second * 1e9);
  return {ns, ns + 1'700'000'000 * kSecond, 50};
}

}  // namespace

TEST_CASE("edges are taken at every poll, rising ones only") {
  auto made = std::make_unique<PulseLine>();
  PulseLine& line = *made;
  PulseInput input(std::move(made));
  for (int second = 10; second < 15; ++second) {
    line.waiting.push_back({second * kSecond, true});
    line.waiting.push_back({second * kSecond + 100'000'000, false});
    input.poll(at(second + 0.12));
  }
  CHECK(line.opens == 1);
  CHECK(input.status().error == 0);
  CHECK(input.status().figures.pulses == 5);
  CHECK(input.status().figures.extra == 0);
  CHECK(input.status().figures.newest_ns == 14 * kSecond);
}

TEST_CASE("a line that another program holds is asked for again every second, and so is one that fails") {
  auto made = std::make_unique<PulseLine>();
  PulseLine& line = *made;
  PulseInput input(std::move(made));
  line.open_error = EBUSY;
  for (int tick = 0; tick < 100; ++tick) input.poll(at(10.0 + 0.025 * tick));
  CHECK(line.opens == 3);
  CHECK(input.status().error == EBUSY);
  line.open_error = 0;
  line.waiting.push_back({13 * kSecond, true});
  input.poll(at(13.1));
  CHECK(input.status().error == 0);
  CHECK(input.status().figures.pulses == 1);
  line.read_error = ENODEV;
  input.poll(at(13.2));
  CHECK(input.status().error == ENODEV);
  line.read_error = 0;
  line.waiting.push_back({20 * kSecond + 500'000'000, true});
  input.poll(at(20.6));
  CHECK(input.status().figures.pulses == 2);
  CHECK(input.status().figures.missing == 0);
}

}  // namespace isobar::test::test_pulse_input
