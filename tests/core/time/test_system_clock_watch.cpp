// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "core/time/clock_anchor.hpp"
#include "core/time/system_clock_watch.hpp"

namespace isobar::test::test_system_clock_watch {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kDay = 86'400 * kSecond;
constexpr std::int64_t kStart = 1'735'689'600 * kSecond;  // system clock at monotonic 0, 2025

/// A machine whose system clock is set now and then.
struct Machine {
  std::int64_t monotonic_ns = 1'000 * kSecond;
  std::int64_t difference_ns = kStart;
  SystemClockWatch watch{kStart};

  std::int64_t read() { return watch.note({monotonic_ns, monotonic_ns + difference_ns, 100}); }
  void pass(std::int64_t duration_ns) { monotonic_ns += duration_ns; }
  [[nodiscard]] std::int64_t robot_ns() const { return monotonic_ns + kStart; }
  [[nodiscard]] std::int64_t system_ns() const { return monotonic_ns + difference_ns; }
  [[nodiscard]] std::int64_t published_ns() const { return robot_ns() + watch.ahead_ns(); }
};

}  // namespace

TEST_CASE("Published stamps follow each step of the system clock, forward and back, at the next reading") {
  Machine machine;
  CHECK(machine.read() == 0);
  CHECK(machine.published_ns() == machine.system_ns());
  for (const std::int64_t step_ns : {3 * kDay, -5 * kDay, 60 * kMs, -60 * kMs}) {
    machine.pass(10 * kSecond);
    CHECK(machine.read() == 0);
    machine.difference_ns += step_ns;
    machine.pass(5 * kMs);
    CHECK(machine.read() == step_ns);
    CHECK(machine.published_ns() == machine.system_ns());
    CHECK(machine.watch.last_step_ns() == step_ns);
    CHECK(machine.watch.stepped_ns() == machine.robot_ns());
  }
  CHECK(machine.watch.steps() == 4);
  CHECK(machine.watch.sums().back() == -2 * kDay);
}

TEST_CASE("A small change is followed smoothly, so that published stamps ascend, and is no step") {
  Machine machine;
  machine.read();
  machine.difference_ns -= 40 * kMs;
  std::int64_t last_ns = machine.published_ns();
  for (int i = 0; i < 20'000; ++i) {
    machine.pass(5 * kMs);
    CHECK(machine.read() == 0);
    CHECK(machine.published_ns() > last_ns);
    last_ns = machine.published_ns();
  }
  CHECK(machine.published_ns() == machine.system_ns());  // 40 ms at 500 ppm take 80 s
  CHECK(machine.watch.steps() == 0);
}

TEST_CASE("A reading that was interrupted between the two clocks is no step") {
  Machine machine;
  machine.read();
  CHECK(machine.watch.note({machine.monotonic_ns, machine.system_ns() + 80 * kMs, 80 * kMs}) == 0);
  CHECK(machine.watch.ahead_ns() == 0);
  CHECK(machine.watch.steps() == 0);
}

TEST_CASE("A sender on the system clock and one with a clock of its own both continue across each step") {
  for (const bool shares_the_clock : {true, false}) {
    Machine machine;
    machine.read();
    SenderClock clock;
    ClockAnchor anchor;
    double worst_ms = 0.0;
    const std::int64_t steps[] = {3 * kDay, -10 * kDay, 2 * kSecond, -700 * kMs};  // NOLINT
    for (int i = 0; i < 5'000; ++i) {
      machine.pass(5 * kMs);
      if (i % 1'000 == 999) machine.difference_ns += steps[i / 1'000 % 4];
      const std::int64_t measured_ns = machine.robot_ns();
      const std::int64_t stamp_ns = shares_the_clock ? machine.system_ns() : machine.monotonic_ns;
      machine.pass(kMs);
      machine.read();
      const std::int64_t expected_ns = machine.robot_ns() - anchor.offset_ns();
      static_cast<void>(anchor.add(clock.without_steps_ns(stamp_ns, expected_ns, i > 0, machine.watch),
                                   machine.robot_ns()));
      const std::int64_t mapped_ns = anchor.to_host_ns(anchor.device_unwrapped_ns());
      worst_ms = std::max(worst_ms, std::abs(static_cast<double>(mapped_ns - measured_ns)) * 1e-6);
    }
    CHECK(anchor.steps() == 0);  // nobody says that the sender's clock was set
    CHECK(worst_ms < 1.5);       // the transport of 1 ms, constant
  }
}

TEST_CASE("A sender that sets its own clock is still seen, also on a machine whose clock was set") {
  Machine machine;
  machine.read();
  machine.difference_ns += kDay;
  SenderClock clock;
  ClockAnchor anchor;
  std::int64_t sender_ns = 77 * kSecond;
  for (int i = 0; i < 400; ++i) {
    machine.pass(5 * kMs);
    machine.read();
    sender_ns += i == 200 ? 100 * kSecond : 5 * kMs;
    const std::int64_t expected_ns = machine.robot_ns() - anchor.offset_ns();
    static_cast<void>(
        anchor.add(clock.without_steps_ns(sender_ns, expected_ns, i > 0, machine.watch), machine.robot_ns()));
  }
  CHECK(anchor.steps() == 1);
}

}  // namespace isobar::test::test_system_clock_watch
