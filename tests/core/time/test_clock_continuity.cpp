// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>

#include "core/time/clock_continuity.hpp"
#include "core/time/stream_beginnings.hpp"

namespace isobar::test::test_clock_continuity {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kHour = 3'600 * kSecond;
constexpr std::int64_t kStep = 5 * kMs;

/// A sensor whose samples arrive 5 ms apart; its clock wraps every hour.
struct Stream {
  ClockContinuity clock{kHour};
  std::int64_t host_ns = 1'700'000'000 * kSecond;
  std::int64_t device_ns = kHour - 3 * kSecond;
  int jumps = 0;

  void sample(std::int64_t late_ns = 0) {
    jumps += clock.add((device_ns % kHour + kHour) % kHour, host_ns + late_ns) ? 1 : 0;
  }
  void pass(std::int64_t host_step_ns, std::int64_t device_step_ns) {
    host_ns += host_step_ns;
    device_ns += device_step_ns;
  }
  void run(std::int64_t duration_ns, std::int64_t late_ns = 0) {
    for (std::int64_t t = 0; t < duration_ns; t += kStep) {
      pass(kStep, kStep);
      sample(late_ns);
    }
  }
};

}  // namespace

TEST_CASE(
    "A clock that loses samples, is late, or stands still with its sender or this machine has not jumped") {
  for (const std::int64_t pause_ns : {kSecond, 3 * kSecond, 8 * kSecond, 25 * kSecond}) {
    Stream stream;
    stream.run(6 * kSecond);
    stream.pass(pause_ns, pause_ns);  // lost
    stream.run(2 * kSecond);
    stream.pass(pause_ns, 0);  // the sender stood still
    stream.run(2 * kSecond);
    stream.pass(0, pause_ns);  // this machine and its clock stood still
    stream.run(2 * kSecond);
    for (std::int64_t t = 0; t < pause_ns; t += kStep) {  // late, in one bunch
      stream.pass(kStep, kStep);
      stream.sample(pause_ns - t);
    }
    stream.run(2 * kSecond);
    stream.pass(pause_ns, pause_ns);
    stream.run(2 * kSecond, pause_ns);  // lost, then all late, then in time again
    stream.run(2 * kSecond);
    CHECK(stream.jumps == 0);
  }
  for (const std::int64_t silence_ns :
       {50 * kSecond, 2 * kHour / 60, kHour / 2, 3 * kHour / 4, kHour, 10 * kHour}) {
    Stream stream;
    stream.run(2 * kSecond);
    stream.pass(silence_ns, silence_ns);
    stream.run(2 * kSecond);
    stream.pass(silence_ns, 0);
    stream.run(2 * kSecond);
    CHECK(stream.jumps == 0);
  }
}

TEST_CASE(
    "A clock that goes back, or further ahead than time, has jumped: once, and after a fraction of a "
    "second") {
  for (const std::int64_t pause_ns : {std::int64_t{0}, 4 * kSecond, 20 * kSecond, 200 * kSecond}) {
    for (const std::int64_t jump_ns : {-kHour / 3, -22 * kSecond, -2 * kSecond, kHour / 4}) {
      if (pause_ns > ClockContinuity::kSilenceNs && jump_ns > -kHour / 3 && jump_ns < 0) continue;
      Stream stream;
      stream.run(30 * kSecond);
      stream.pass(pause_ns, jump_ns);
      stream.run(400 * kMs);
      CHECK(stream.jumps == 1);
      CHECK(stream.clock.jumped_after_pause() == (pause_ns > 0));
      stream.run(30 * kSecond);
      CHECK(stream.jumps == 1);
    }
  }
}

TEST_CASE("Single wrong stamps, and old samples between new ones, are no jump") {
  Stream stream;
  for (int i = 0; i < 2'000; ++i) {
    stream.run(50 * kMs);
    const std::int64_t wrong_ns = i % 3 == 0 ? 20 * kSecond : i % 3 == 1 ? -5 * kSecond : kHour / 2;
    stream.device_ns += wrong_ns;
    stream.sample();
    stream.device_ns -= wrong_ns;
  }
  for (std::int64_t old_ns = 0; old_ns < 3 * kSecond; old_ns += kStep) {  // a bunch that was overtaken
    stream.device_ns += old_ns - 4 * kSecond;
    stream.sample();
    stream.device_ns -= old_ns - 4 * kSecond;
  }
  stream.run(kSecond);
  CHECK(stream.jumps == 0);
}

TEST_CASE(
    "A stream begins anew with its numbers, or with its clock after a pause; not when its clock is set") {
  StreamBeginnings stream;
  std::int64_t host_ns = 1'700'000'000 * kSecond;
  std::int64_t sender_ns = 50 * kSecond;
  std::uint32_t number = 0;
  const auto run = [&] {
    for (int i = 0; i < 200; ++i) {
      stream.add_number(number++, host_ns += kStep);
      stream.add_stamp(sender_ns += kStep, host_ns);
    }
  };
  run();
  sender_ns += 900 * kSecond;  // set
  number += 1'000;             // lost
  run();
  CHECK_FALSE(stream.take());
  number = 0;
  run();
  CHECK(stream.take());
  CHECK_FALSE(stream.take());
  host_ns += 200 * kMs;
  sender_ns -= 900 * kSecond;
  run();
  CHECK(stream.take());
}

}  // namespace isobar::test::test_clock_continuity
