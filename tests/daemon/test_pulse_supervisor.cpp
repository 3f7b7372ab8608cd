// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cerrno>
#include <memory>
#include <optional>
#include <string>

#include "daemon/pulse_supervisor.hpp"
#include "tests/drivers/pps/pulse_line.hpp"

namespace isobar::test::test_pulse_supervisor {
namespace {

using ipc::HealthLevel;

constexpr std::int64_t kSecond = 1'000'000'000;

struct Bench {
  Bench() {
    auto made = std::make_unique<PulseLine>();
    line = made.get();
    pps::Settings settings;
    settings.line = 4;
    pulses = std::make_unique<PulseSupervisor>(settings, std::move(made));
  }
  /// Polls every 25 ms until `end_s`, with a pulse at every whole second if `pulsed`.
  void run_until(double end_s, bool pulsed) {
    for (; now_ns < static_cast<std::int64_t>(end_s * 1e9); now_ns += 25'000'000) {
      if (pulsed && now_ns % kSecond == 0) line->waiting.push_back({now_ns, true});
      pulses->poll({now_ns, now_ns + 1'700'000'000 * kSecond + ahead_ns, 50});
    }
  }
  std::optional<ipc::HealthEntry> entry(const std::string& name) {
    ipc::HealthReport report;
    pulses->fill(report);
    for (std::uint32_t i = 0; i < report.entry_count; ++i) {
      if (report.entries[i].name == name) return report.entries[i];
    }
    return std::nullopt;
  }

  PulseLine* line = nullptr;
  std::unique_ptr<PulseSupervisor> pulses;
  std::int64_t now_ns = 100 * kSecond;
  std::int64_t ahead_ns = 0;
};

}  // namespace

TEST_CASE("the pulse's entry tells offset and jitter, and warns of a clock that is off and of silence") {
  Bench bench;
  bench.ahead_ns = 12'000;
  bench.run_until(110.0, true);
  auto entry = bench.entry("pps");
  REQUIRE(entry);
  CHECK(entry->level == HealthLevel::kOk);
  CHECK(std::string(entry->message) ==
        "system clock +0.012 ms against the second, jitter 0.0 us, at /dev/gpiochip0 line 4");
  bench.ahead_ns = -35'200'000;
  bench.run_until(115.0, true);
  entry = bench.entry("pps");
  REQUIRE(entry);
  CHECK(entry->level == HealthLevel::kWarning);
  CHECK(std::string(entry->message) ==
        "system clock -35.200 ms against the second, jitter 0.0 us, at /dev/gpiochip0 line 4: does chrony "
        "follow it?");
  bench.run_until(118.0, false);
  entry = bench.entry("pps");
  REQUIRE(entry);
  CHECK(entry->level == HealthLevel::kWarning);
  CHECK(std::string(entry->message) == "no pulse for 4 s at /dev/gpiochip0 line 4");
  CHECK_FALSE(bench.entry("pps/missing"));
  bench.run_until(120.0, true);
  entry = bench.entry("pps/missing");
  REQUIRE(entry);
  CHECK(entry->level == HealthLevel::kWarning);
}

TEST_CASE("a line that cannot be requested is said, and one that is not configured is not") {
  Bench bench;
  bench.line->open_error = EBUSY;
  bench.run_until(101.0, true);
  const auto entry = bench.entry("pps");
  REQUIRE(entry);
  CHECK(entry->level == HealthLevel::kWarning);
  CHECK(std::string(entry->message) == "/dev/gpiochip0 line 4 cannot be read: Device or resource busy");

  PulseSupervisor none{pps::Settings{}};
  none.poll({kSecond, kSecond, 50});
  ipc::HealthReport report;
  none.fill(report);
  CHECK(report.entry_count == 0);
}

}  // namespace isobar::test::test_pulse_supervisor
