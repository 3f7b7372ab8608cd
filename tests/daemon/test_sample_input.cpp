// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "daemon/sample_input.hpp"

namespace isobar::test::test_sample_input {
namespace {

using datagram::Kind;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 1'735'689'600 * kSecond;
constexpr SenderAddress kLoopback{0x7F000001, 40'000};
constexpr SenderAddress kForger{0x7F000002, 40'001};

/// An input, its machine's clocks and its senders.
struct Inputs {
  SampleInput input;
  std::int64_t monotonic_ns = 100 * kSecond;
  std::int64_t set_by_ns = 0;  ///< how far the system clock was set
  SystemClockWatch system{kStart};
  std::uint64_t taken = 0;
  datagram::Sample newest;

  explicit Inputs(std::vector<std::uint32_t> allowed = {}, SampleInput::Takes takes = {})
      : input(takes, std::move(allowed)) {}

  [[nodiscard]] std::int64_t robot_ns() const { return monotonic_ns + kStart; }
  [[nodiscard]] std::int64_t system_ns() const { return robot_ns() + set_by_ns; }

  /// Delivers one line a millisecond after it was stamped.
  std::uint64_t give(const std::string& line, const SenderAddress& from = kLoopback) {
    monotonic_ns += kMs;
    system.note({monotonic_ns, monotonic_ns + kStart + set_by_ns, 100});
    ReceivedDatagram received;
    received.payload = {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()};
    received.stamp_ns = robot_ns();
    received.sender = from;
    input.begin(received, system);
    std::uint64_t samples = 0;
    for (datagram::Sample sample; input.next(sample); ++samples) newest = sample;
    taken += samples;
    return samples;
  }
};

std::string imu_line(std::uint32_t sequence, std::int64_t stamp_ns, double yaw_rate_rad_s = 0.0) {
  return "imu," + std::to_string(sequence) + "," + std::to_string(stamp_ns) + ",0,0," +
         std::to_string(yaw_rate_rad_s) + ",0,0,9.8";
}
std::string pressure_line(const char* word, std::uint32_t sequence, std::int64_t stamp_ns,
                          double pressure_pa) {
  return std::string(word) + "," + std::to_string(sequence) + "," + std::to_string(stamp_ns) + "," +
         std::to_string(pressure_pa) + ",20";
}

}  // namespace

TEST_CASE(
    "When the system clock is set, no sample of a sender on it is lost, late, or blamed on the sender") {
  Inputs inputs;
  std::uint64_t given = 0;
  double worst_ms = 0.0;
  for (std::uint32_t i = 0; i < 4'000; ++i) {
    inputs.monotonic_ns += 4 * kMs;
    if (i == 1'000) inputs.set_by_ns += 333 * 86'400 * kSecond;
    if (i == 2'500) inputs.set_by_ns -= 2 * 86'400 * kSecond;
    const std::int64_t measured_ns = inputs.robot_ns();
    REQUIRE(inputs.give(imu_line(i, inputs.system_ns())) == 1);
    worst_ms =
        std::max(worst_ms, std::abs(static_cast<double>(inputs.newest.stamp_ns() - measured_ns)) * 1e-6);
    REQUIRE(inputs.give(pressure_line("base", i, inputs.system_ns(), 98'000.0 + i)) == 1);
    CHECK(inputs.newest.pressure.path == SamplePath::kDatagram);
    given += 2;
  }
  const SampleInputStatus status = inputs.input.status();
  CHECK(inputs.taken == given);
  CHECK(worst_ms < 2.5);  // a transport of 1 ms, and the clock anchor's own error
  CHECK(inputs.system.steps() == 2);
  CHECK(status.clock_steps == 0);
  CHECK(status.base.clock_steps == 0);
  CHECK(status.base.count(BaseVerdict::kAhead) == 0);
  CHECK(status.base.count(BaseVerdict::kOutdated) == 0);
}

TEST_CASE("Forged datagrams of another address change nothing, are counted and named") {
  Inputs inputs;
  for (std::uint32_t i = 0; i < 1'000; ++i) {
    inputs.monotonic_ns += 3 * kMs;
    CHECK(inputs.give(imu_line(i, inputs.system_ns())) == 1);
    CHECK(inputs.give(pressure_line("baro", i, inputs.system_ns(), 98'000.0)) == 1);
    // The same sequence numbers, so that they would also pass for the true samples.
    CHECK(inputs.give(imu_line(i + 1, inputs.system_ns(), 3.0), kForger) == 0);
    CHECK(inputs.give(pressure_line("baro", i + 1, inputs.system_ns(), 97'000.0), kForger) == 0);
  }
  const SampleInputStatus status = inputs.input.status();
  for (const Kind kind : {Kind::kImu, Kind::kPressure}) {
    const SenderStatus& senders = status.senders[static_cast<std::size_t>(kind)];
    CHECK(senders.refused == 1'000);
    CHECK(senders.other == kForger);
    CHECK(senders.in_use == kLoopback);
    CHECK(status.counters.lost[static_cast<std::size_t>(kind)] == 0);
    CHECK(status.counters.duplicated[static_cast<std::size_t>(kind)] == 0);
  }
}

TEST_CASE("A second base station with the first one's sequence numbers costs no sample of the first") {
  Inputs inputs;
  for (std::uint32_t i = 0; i < 500; ++i) {
    inputs.monotonic_ns += 30 * kMs;
    CHECK(inputs.give(pressure_line("base", i, inputs.system_ns(), 98'000.0 + i)) == 1);
    CHECK(inputs.give(pressure_line("base", i + 1, inputs.system_ns(), 97'000.0), kForger) == 0);
  }
  CHECK(inputs.input.status().base.count(BaseVerdict::kOtherSender) >= 499);
}

TEST_CASE("A sender that falls silent is followed by another one, whose sequence numbers begin anew") {
  Inputs inputs;
  for (std::uint32_t i = 0; i < 100; ++i) CHECK(inputs.give(imu_line(5'000 + i, 0)) == 1);
  inputs.monotonic_ns += 6 * kSecond;
  for (std::uint32_t i = 0; i < 100; ++i) CHECK(inputs.give(imu_line(4'990 + i, 0), kForger) == 1);
  const SampleInputStatus status = inputs.input.status();
  CHECK(status.senders[0].takeovers == 1);
  CHECK(status.counters.lost[0] == 0);
  CHECK(status.counters.duplicated[0] == 0);
}

TEST_CASE("With keys, base-station pressure in datagrams is refused and counted, and nothing else") {
  Inputs inputs({}, {.unsigned_base = false});
  for (std::uint32_t i = 0; i < 100; ++i) {
    CHECK(inputs.give(pressure_line("base", i, inputs.system_ns(), 98'000.0 + i)) == 0);
    CHECK(inputs.give(pressure_line("baro", i, inputs.system_ns(), 97'000.0 + i)) == 1);
    CHECK(inputs.give(imu_line(i, inputs.system_ns())) == 1);
  }
  CHECK(inputs.input.status().unsigned_base == 100);
  CHECK_FALSE(inputs.input.status().base.heard());
}

TEST_CASE("Only senders that input.senders names are taken") {
  Inputs inputs(addresses_of("127.0.0.1, 192.168.1.50"));
  CHECK(inputs.give(imu_line(0, 0), kForger) == 0);
  CHECK(inputs.give(imu_line(0, 0)) == 1);
  CHECK(inputs.input.status().not_allowed == 1);
  CHECK(inputs.input.status().not_allowed_ipv4 == kForger.ipv4);
  CHECK(addresses_of("").empty());
  CHECK(addresses_of("127.0.0.1, 192.168.1.50") == std::vector<std::uint32_t>{0x7F000001, 0xC0A80132});
}

}  // namespace isobar::test::test_sample_input
