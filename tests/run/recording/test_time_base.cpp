// SPDX-License-Identifier: BSD-3-Clause
// Steps of the clock that stamped a recording.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run/recording/recording_reader.hpp"
#include "run/recording/time_base.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_time_base {

using namespace isobar::recording;
using isobar::test::Scratch;

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kStartNs = 1'700'000'000 * kSecondNs;

/// A stream of a recording whose clock is set: true times, and what they are stamped.
struct Sensor {
  std::int64_t interval_ns = 0;
  std::int64_t offset_ns = 0;  // of the first sample
  std::int64_t gap_ns = 0;     // pause at the step
  bool steps = true;
};

struct Given {
  std::int64_t true_ns;
  std::int64_t stamp_ns;
};

/// Twelve seconds of the sensors; their clock is set by `step_ns` after five.
class Recording {
 public:
  Recording(std::vector<Sensor> sensors, std::int64_t step_ns)
      : sensors_(std::move(sensors)), step_ns_(step_ns) {
    for (const Sensor& sensor : sensors_) {
      std::vector<std::int64_t> times;
      for (std::int64_t t = sensor.offset_ns; t < 12 * kSecondNs; t += sensor.interval_ns) {
        times.push_back(kStartNs + t + (t >= 5 * kSecondNs ? sensor.gap_ns : 0));
      }
      true_ns_.push_back(std::move(times));
    }
  }

  /// The merged events by sensor, in order.
  /// @param clocks the lidar's own clock is told for sensor 0, with its period; -1: not
  std::vector<std::vector<Given>> merged(std::int64_t period_ns) {
    std::vector<TimeBase::Stream> streams(sensors_.size());
    streams[0].period_ns = std::max<std::int64_t>(0, period_ns);
    TimeBase base(streams);
    std::vector<std::size_t> next(sensors_.size(), 0);
    std::vector<std::vector<Given>> given(sensors_.size());
    const auto take = [&](std::size_t k) {
      if (next[k] == true_ns_[k].size()) {
        base.end(k);
        return;
      }
      base.take(k, stamped(k, next[k]), [&]() -> std::optional<std::int64_t> {
        if (k != 0 || period_ns < 0) return std::nullopt;
        const std::int64_t elapsed_ns = true_ns_[k][next[k]] - true_ns_[k][next[k] - 1] - early_ns;
        return period_ns == 0 ? elapsed_ns : elapsed_ns % period_ns;
      });
    };
    for (std::size_t k = 0; k < sensors_.size(); ++k) take(k);
    for (auto chosen = base.choose(); chosen; chosen = base.choose()) {
      const std::size_t k = *chosen;
      given[k].push_back({true_ns_[k][next[k]], stamped(k, next[k]) + base.shift_ns(k)});
      ++next[k];
      take(k);
    }
    steps = base.steps();
    first_step_ns = base.first_step_ns();
    return given;
  }

  std::uint64_t steps = 0;
  std::int64_t first_step_ns = 0;
  std::int64_t early_ns = 0;  ///< by how much the lidar's own clock is early after the step

 private:
  [[nodiscard]] std::int64_t stamped(std::size_t k, std::size_t row) const {
    const std::int64_t t = true_ns_[k][row];
    return t + (sensors_[k].steps && t >= kStartNs + 5 * kSecondNs ? step_ns_ : 0);
  }

  std::vector<Sensor> sensors_;
  std::int64_t step_ns_;
  std::vector<std::vector<std::int64_t>> true_ns_;
};

/// Largest difference of a stamp from its true time.
std::int64_t largest_error_ns(const std::vector<std::vector<Given>>& sensors) {
  std::int64_t largest_ns = 0;
  for (const auto& events : sensors) {
    for (const Given& event : events) {
      largest_ns = std::max(largest_ns, std::abs(event.stamp_ns - event.true_ns));
    }
  }
  return largest_ns;
}

/// A lidar with packets in one quarter of each turn, an IMU, a barometer and wheels.
std::vector<Sensor> robot() {
  return {{1'327'000, 3'000, 0, true},
          {5'000'000, 0, 0, true},
          {31'250'000, 100'000, 0, true},
          {20'000'000, 7'000'000, 0, true}};
}

constexpr std::int64_t kHourNs = 3'600 * kSecondNs;

}  // namespace

TEST_CASE(
    "a clock that is set back loses nothing and moves nothing, whether the lidar's clock is known or not") {
  for (const double step_s : {-0.5, -1.0, -5.0, -3'600.0}) {
    for (const std::int64_t period_ns : {std::int64_t{-1}, std::int64_t{0}, kHourNs}) {
      CAPTURE(step_s);
      CAPTURE(period_ns);
      Recording recording(robot(), std::llround(step_s * 1e9));
      const auto given = recording.merged(period_ns);
      CHECK(given[1].size() == 2'400);
      // Exact, since the intervals of the streams are.
      CHECK(largest_error_ns(given) <= (period_ns < 0 ? 1'500'000 : 0));
      CHECK(recording.steps == 1);
      CHECK(std::abs(recording.first_step_ns - std::llround(step_s * 1e9)) <= 1'500'000);
    }
  }
}

TEST_CASE("a clock that is set forward is told from a pause by the lidar's clock") {
  for (const std::int64_t step_ns : {20 * kSecondNs, kHourNs, 86'400'000 * kSecondNs}) {
    CAPTURE(step_ns);
    Recording recording(robot(), step_ns);
    CHECK(largest_error_ns(recording.merged(kHourNs)) == 0);
    CHECK(recording.steps == 1);
    CHECK(recording.first_step_ns == step_ns);
    CHECK(largest_error_ns(recording.merged(-1)) == step_ns);  // nothing contradicts a pause
    CHECK(recording.steps == 0);
  }
  std::vector<Sensor> paused = robot();
  for (Sensor& sensor : paused) sensor.gap_ns = 5'000 * kSecondNs;
  Recording recording(paused, 0);
  CHECK(largest_error_ns(recording.merged(kHourNs)) == 0);
  CHECK(recording.steps == 0);
}

TEST_CASE("a lidar that sees a part of the turn tells the step of the clock as well") {
  // The packet after the step began before the part of the turn that is left out: its time is 75 ms early.
  for (const std::int64_t step_ns : {-kSecondNs / 2, -5 * kSecondNs, 20 * kSecondNs, kHourNs}) {
    CAPTURE(step_ns);
    std::vector<Sensor> sensors = robot();
    sensors[0].gap_ns = 75'000'000;
    Recording recording(sensors, step_ns);
    recording.early_ns = 75'000'000;
    CHECK(largest_error_ns(recording.merged(kHourNs)) <= 100'000);
    CHECK(recording.steps == 1);
  }
}

TEST_CASE("a stream on another clock keeps it, and one too slow to show the step is moved with the others") {
  std::vector<Sensor> sensors = robot();
  sensors.push_back({31'250'000, 200'000, 0, false});
  Recording recording(sensors, -5 * kSecondNs);
  CHECK(largest_error_ns(recording.merged(kHourNs)) == 0);
  sensors = robot();
  sensors.push_back({kSecondNs, 300'000'000, 0, true});
  Recording slow(sensors, -kSecondNs / 2);
  auto given = slow.merged(kHourNs);
  // One of its samples may have been given before any other stream showed the step.
  CHECK(std::count_if(given[4].begin(), given[4].end(),
                      [](const Given& event) { return event.stamp_ns != event.true_ns; }) <= 1);
  given.pop_back();
  CHECK(largest_error_ns(given) == 0);
}

TEST_CASE("events are in order of the merged time, but for a turn at the step") {
  const auto given = Recording(robot(), -5 * kSecondNs).merged(kHourNs);
  for (const auto& events : given) {
    CHECK(std::is_sorted(events.begin(), events.end(),
                         [](const Given& a, const Given& b) { return a.stamp_ns < b.stamp_ns; }));
  }
}

TEST_CASE("the reader of a recording goes on over a step of half a second, five seconds or an hour") {
  for (const double step_s : {0.5, 5.0, 3'600.0}) {
    CAPTURE(step_s);
    const Scratch scratch;
    const auto rows = [&](const char* header, std::int64_t interval_ns, const char* values) {
      std::string text = std::string(header) + "\n";
      for (std::int64_t t = 0; t < 12 * kSecondNs; t += interval_ns) {
        const std::int64_t back_ns = t >= 5 * kSecondNs ? std::llround(step_s * 1e9) : 0;
        text += std::to_string(kStartNs + t - back_ns) + values + "\n";
      }
      return text;
    };
    scratch.write("imu.csv", rows("t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2", 5'000'000,
                                  ",0,0,0,0,0,9.81"));
    scratch.write("b.csv", rows("t_ns,pressure_pa,temperature_c", 31'250'000, ",100000,20"));
    scratch.write("w.csv", rows("t_ns,vx_m_s,vy_m_s,wz_rad_s", 20'000'000, ",0,0,0"));
    scratch.write(
        "recording.toml",
        "version = 1\n[imu]\nfile = \"imu.csv\"\n[barometer]\nfile = \"b.csv\"\n[wheel]\nfile = \"w.csv\"\n");
    RecordingReader reader(scratch.path());
    std::array<std::size_t, 5> events{};
    std::int64_t newest_ns = 0;
    std::int64_t largest_step_back_ns = 0;
    for (Event event; reader.next(event);) {
      ++events.at(static_cast<std::size_t>(event.kind));
      largest_step_back_ns = std::max(largest_step_back_ns, newest_ns - event.stamp_ns);
      newest_ns = std::max(newest_ns, event.stamp_ns);
    }
    CHECK(events == std::array<std::size_t, 5>{0, 2'400, 384, 0, 600});
    CHECK(largest_step_back_ns < 50'000'000);
    CHECK(std::abs(newest_ns - kStartNs - 11'995'000'000) < 10'000'000);
    const auto counts = reader.counts();
    const Count* set = test::find_count(counts, "clock of the recording set");
    REQUIRE(set != nullptr);
    CHECK(set->count == 1);
    CHECK(set->first_message.find("set back by") != std::string::npos);
  }
}

}  // namespace isobar::test::test_time_base
