// SPDX-License-Identifier: BSD-3-Clause
// The whole device against a simulated Xsens MTi on a pseudo-terminal, in real time.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "drivers/xsens/message.hpp"
#include "drivers/xsens/sensor.hpp"
#include "tests/drivers/serial/imu_bench.hpp"
#include "tests/drivers/serial/pseudo_terminal.hpp"
#include "tests/drivers/xsens/message_writer.hpp"

namespace isobar::test::test_xsens_sensor {

using Bytes = std::vector<std::uint8_t>;

namespace {

/// An MTi-300 that measures from its power-up on and takes an output configuration in its configuration state.
class SimulatedMti {
 public:
  void serve(std::int64_t now_ns) {
    if (!terminal.plugged()) {
      was_plugged_ = false;
      return;
    }
    if (!was_plugged_) {
      was_plugged_ = true;
      measuring_ = true;
      started_ns_ = next_ns_ = now_ns;
      terminal.send(xsens::make_message(xsens::Id::kWakeUp, {}));
    }
    const std::string received = terminal.received();
    input_.insert(input_.end(), received.begin(), received.end());
    while (input_.size() >= 5 && input_.size() >= 5U + input_[3]) {
      const Bytes message(input_.begin(), input_.begin() + 5 + input_[3]);
      input_.erase(input_.begin(), input_.begin() + 5 + input_[3]);
      if (hears) answer(message);
    }
    while (measuring_ && now_ns >= next_ns_) {
      const auto ticks = static_cast<std::uint32_t>((next_ns_ - started_ns_) / 100'000);
      const bool with_pressure = has_barometer && counter_ % 2 == 0;
      if (sends)
        terminal.send(
            own_message(counter_, ticks, 0.25 + 1e-4 * counter_, with_pressure ? 101'000 + counter_ : 0));
      ++counter_;
      next_ns_ += 1'000'000'000 / rate_hz_;
    }
    if (!measuring_) next_ns_ = now_ns;
  }

  PseudoTerminal terminal;
  bool hears = true;
  bool sends = true;
  bool has_barometer = true;
  bool drops_unknown = true;  ///< leaves an output out of the acknowledgement; else an error
  int fastest_hz = 400;
  int writes = 0;  ///< of the output configuration
  int error = 0;   ///< of every GoToMeasurement

 private:
  void answer(const Bytes& message) {
    unsigned sum = 0;
    for (std::size_t i = 1; i < message.size(); ++i) sum += message[i];
    REQUIRE((sum & 0xFFU) == 0);
    switch (static_cast<xsens::Id>(message[2])) {
      case xsens::Id::kGoToConfig:
        measuring_ = false;
        terminal.send(xsens::make_message(xsens::Id::kGoToConfigAck, {}));
        break;
      case xsens::Id::kSetOutput:
        set_output({message.begin() + 4, message.end() - 1});
        break;
      case xsens::Id::kGoToMeasurement:
        if (error != 0) {
          terminal.send(xsens::make_message(xsens::Id::kError, Bytes{static_cast<std::uint8_t>(error)}));
        } else {
          measuring_ = true;
          terminal.send(xsens::make_message(xsens::Id::kGoToMeasurementAck, {}));
        }
        break;
      default:
        FAIL("unknown command");
    }
  }
  void set_output(const Bytes& wanted) {
    if (wanted.empty()) {  // a request
      terminal.send(xsens::make_message(xsens::Id::kSetOutputAck, held_));
      return;
    }
    Bytes held;
    ++writes;
    for (std::size_t at = 0; at + 4 <= wanted.size(); at += 4) {
      const int id = wanted[at] << 8 | wanted[at + 1];
      int rate_hz = wanted[at + 2] << 8 | wanted[at + 3];
      if (id == 0x3010 && !has_barometer) {
        if (drops_unknown) continue;
        terminal.send(xsens::make_message(xsens::Id::kError, Bytes{33}));
        return;
      }
      if (rate_hz != 0xFFFF) rate_hz = std::min(rate_hz, fastest_hz);
      if (id == 0x4020) rate_hz_ = rate_hz;
      held.insert(held.end(), {wanted[at], wanted[at + 1], static_cast<std::uint8_t>(rate_hz >> 8),
                               static_cast<std::uint8_t>(rate_hz & 0xFF)});
    }
    held_ = held;
    terminal.send(xsens::make_message(xsens::Id::kSetOutputAck, held));
  }

  Bytes input_;
  Bytes held_;  ///< output configuration, kept without power
  bool was_plugged_ = false;
  bool measuring_ = false;
  int rate_hz_ = 100;
  std::uint16_t counter_ = 0;
  std::int64_t started_ns_ = 0;
  std::int64_t next_ns_ = 0;
};

struct Robot {
  explicit Robot(xsens::Settings settings = {}) {
    settings.port = sensor->terminal.path();
    bench = std::make_unique<ImuBench>(xsens::make_sensor(settings),
                                       [this](std::int64_t now_ns) { sensor->serve(now_ns); });
  }
  [[nodiscard]] auto pressures() const {
    return std::count_if(bench->samples.begin(), bench->samples.end(),
                         [](const InertialReading& reading) { return reading.has_pressure; });
  }
  std::unique_ptr<SimulatedMti> sensor = std::make_unique<SimulatedMti>();
  std::unique_ptr<ImuBench> bench;
};

}  // namespace

TEST_CASE("an MTi that measures already is set up within half a second and measures at the rate asked for") {
  xsens::Settings settings;
  settings.rate_hz = 200;
  settings.baud = 921'600;
  Robot robot(settings);
  CHECK(robot.bench->device->place() == "Xsens MTi on " + robot.sensor->terminal.path());
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  robot.bench->samples.clear();
  robot.bench->run(0.5);
  CHECK(robot.bench->samples.size() > 92);
  CHECK(robot.bench->samples.size() < 105);
  CHECK(robot.pressures() > 45);
  CHECK(robot.bench->samples[0].imu.accel_m_s2.z() == doctest::Approx(9.8));
  CHECK(robot.bench->samples.back().imu.stamp_ns < monotonic_ns());
  CHECK(robot.bench->samples.back().imu.stamp_ns > monotonic_ns() - 50'000'000);
}

TEST_CASE("a model without a barometer measures without pressure, however it says so") {
  for (const bool drops : {true, false}) {
    Robot robot;
    robot.sensor->has_barometer = false;
    robot.sensor->drops_unknown = drops;
    REQUIRE(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
    robot.bench->run(0.1);
    CHECK_FALSE(robot.bench->samples.empty());
    CHECK(robot.pressures() == 0);
  }
}

TEST_CASE("a rate that the model does not have is told with the one it has") {
  xsens::Settings settings;
  settings.rate_hz = 200;
  settings.baud = 921'600;
  Robot robot(settings);
  robot.sensor->fastest_hz = 100;
  REQUIRE(robot.bench->run_until_state(5.0, DeviceState::kWrongDevice));
  CHECK(robot.bench->fault() == "sends the acceleration with 100 Hz, not 200");
}

TEST_CASE("an error of the sensor is told in words") {
  Robot robot;
  robot.sensor->error = 30;
  REQUIRE(robot.bench->run_until_state(5.0, DeviceState::kWrongDevice));
  CHECK(robot.bench->fault() == "refuses GoToMeasurement: error 30, timer overflow: too much output");
}

TEST_CASE("pulled out, an MTi says so within 0.2 s, and measures within 2 s of its return") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
  robot.bench->run(0.1);
  robot.sensor->terminal.unplug();
  REQUIRE(robot.bench->run_until_state(0.2, DeviceState::kNoAnswer));
  robot.bench->run(0.5);
  robot.sensor->terminal.plug();
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
  CHECK(robot.sensor->writes == 1);  // it has kept the output, which permanent memory need not take again
}

TEST_CASE("an MTi that sends but does not hear is told apart from one that is silent") {
  Robot robot;
  robot.sensor->hears = false;
  REQUIRE(robot.bench->run_until_state(5.0, DeviceState::kNoAnswer));
  CHECK(robot.bench->fault() == "no answer to GoToConfig; it sends, but does not hear: transmit wire?");
}

TEST_CASE("without configuration it takes what the MTi sends") {
  xsens::Settings settings;
  settings.configure = false;
  Robot robot(settings);
  robot.sensor->hears = false;
  CHECK(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
}

TEST_CASE("a rate that the line cannot carry is refused with the remedy") {
  xsens::Settings settings;
  CHECK(xsens::broken_rule(settings) == nullptr);
  settings.rate_hz = 400;
  CHECK(xsens::broken_rule(settings) ==
        std::string("the messages fill more than 0.9 of the line: raise baud or lower rate_hz"));
  settings.baud = 921'600;
  CHECK(xsens::broken_rule(settings) == nullptr);
  settings.rate_hz = 300;
  CHECK(xsens::broken_rule(settings) == std::string("rate_hz must divide 400 Hz"));
}

}  // namespace isobar::test::test_xsens_sensor
