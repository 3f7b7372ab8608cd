// SPDX-License-Identifier: BSD-3-Clause
// The whole device against a simulated VN-100 on a pseudo-terminal, in real time.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "drivers/vn100/sensor.hpp"
#include "drivers/vn100/text_line.hpp"
#include "tests/drivers/serial/imu_bench.hpp"
#include "tests/drivers/serial/pseudo_terminal.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"
#include "tests/drivers/vn100/simulated_vn100.hpp"

namespace isobar::test::test_vn100_sensor {

namespace {

struct Robot {
  explicit Robot(vn100::Settings settings = {}) {
    settings.port = sensor->terminal.path();
    bench = std::make_unique<ImuBench>(vn100::make_sensor(settings),
                                       [this](std::int64_t now_ns) { sensor->serve(now_ns); });
  }
  std::unique_ptr<SimulatedVn100> sensor = std::make_unique<SimulatedVn100>();
  std::unique_ptr<ImuBench> bench;
};

}  // namespace

TEST_CASE("a VN-100 as it comes is set up within half a second and measures at its rate") {
  Robot robot;
  CHECK(robot.bench->device->place() == "VN-100 on " + robot.sensor->terminal.path());
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  robot.bench->samples.clear();
  const std::int64_t begin_ns = monotonic_ns();
  robot.bench->run(0.5);
  const auto& samples = robot.bench->samples;
  CHECK(samples.size() > 92);
  CHECK(samples.size() < 105);
  CHECK(samples[0].imu.accel_m_s2.z() == doctest::Approx(-9.8));
  CHECK(std::string(robot.bench->device->status().note.data()).find("low-latency") != std::string::npos);
  // Stamps follow the sensor's clock, whatever the scheduler does to the reading; a few may follow a first
  // one that was late.
  const auto irregular =
      std::count_if(samples.begin() + 1, samples.end(), [&](const InertialReading& reading) {
        const InertialReading& before = *(&reading - 1);
        return std::abs(reading.imu.stamp_ns - before.imu.stamp_ns - 5'000'000) > 500'000;
      });
  CHECK(irregular < 10);
  CHECK(samples[0].imu.stamp_ns > begin_ns - 100'000'000);
  CHECK(samples.back().imu.stamp_ns < monotonic_ns());
}

TEST_CASE("a pressure is delivered when it changes, and at most every 0.1 s while it does not") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
  robot.bench->samples.clear();
  robot.bench->run(0.5);
  const auto pressures = [&] {
    return std::count_if(robot.bench->samples.begin(), robot.bench->samples.end(),
                         [](const InertialReading& reading) { return reading.has_pressure; });
  };
  CHECK(pressures() >= 4);
  CHECK(pressures() <= 6);
  robot.bench->samples.clear();
  robot.sensor->pressure_kpa = 101.016F;
  CHECK(robot.bench->run_until(0.05, [&] { return pressures() > 0; }));
  CHECK(robot.bench->samples.back().pressure.pressure_pa == doctest::Approx(101'016.0));
}

TEST_CASE("pulled out, it says so within 0.2 s, and measures within 2 s of its return") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
  robot.bench->run(0.1);
  robot.sensor->terminal.unplug();
  REQUIRE(robot.bench->run_until_state(0.2, DeviceState::kNoAnswer));
  CHECK(robot.bench->fault().starts_with("unplugged"));
  robot.bench->run(0.5);
  CHECK(robot.bench->fault() == "no such port (No such file or directory)");
  robot.sensor->terminal.plug();
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
}

TEST_CASE("silence is said within 0.2 s, with the port still there") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
  robot.bench->run(0.1);
  robot.sensor->sends = false;
  REQUIRE(robot.bench->run_until_state(0.2, DeviceState::kSilent));
  CHECK(robot.bench->fault() == "no new result");
  robot.sensor->sends = true;
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
}

TEST_CASE("a refusal is told in the sensor's words, and so is another value read back") {
  Robot robot;
  robot.sensor->refusal = "VNERR,0C";
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kWrongDevice));
  CHECK(robot.bench->fault() == "refuses $VNWRG,75: error 12, baud rate too low for this output");

  Robot forgetful;
  forgetful.sensor->read_back = "1,16,05,0201,0030";
  REQUIRE(forgetful.bench->run_until_state(0.5, DeviceState::kWrongDevice));
  CHECK(forgetful.bench->fault() == "holds 1,16,05,0201,0030 in register 75, not 1,4,05,0201,0030");
}

TEST_CASE("an answer with a wrong checksum is asked for again") {
  Robot robot;
  robot.sensor->damaged_answers = 2;
  REQUIRE(robot.bench->run_until_state(1.0, DeviceState::kMeasuring));
  CHECK(robot.bench->device->status().counters.starts == 1);
}

TEST_CASE("a sensor that does not answer is told apart from one that is not there") {
  Robot deaf;
  deaf.sensor->hears = false;
  REQUIRE(deaf.bench->run_until_state(5.0, DeviceState::kNoAnswer));
  CHECK(deaf.bench->fault() == "no answer to $VNWRG,06; nothing comes: power, wiring?");

  Robot other_rate;
  other_rate.sensor->hears = false;
  int turn = 0;
  other_rate.bench->run_until(1.5, [&] {
    if (++turn % 8 == 0) other_rate.sensor->terminal.send("\x01\x83\xfe");
    return other_rate.bench->state() == DeviceState::kNoAnswer;
  });
  CHECK(other_rate.bench->fault() == "no answer to $VNWRG,06; bytes without sense: baud rate?");
}

TEST_CASE("values that do not change are stuck") {
  Robot robot;
  robot.sensor->frozen = true;
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kStuck));
}

TEST_CASE("without configuration it takes what the sensor sends, and says what else comes") {
  vn100::Settings settings;
  settings.configure = false;
  Robot robot(settings);
  robot.sensor->hears = false;
  robot.bench->run_until(0.5, [&] {
    robot.sensor->terminal.send(vn100::command_line("VNYPR,1,2,3"));
    return robot.bench->state() == DeviceState::kSilent;
  });
  CHECK(robot.bench->fault() == "$VNYPR: no acceleration and angular rate; configure = true, or output Imu");
  std::uint64_t time_ns = 0;
  float rate = 0.0F;
  robot.bench->run_until(1.0, [&] {
    robot.sensor->terminal.send(own_packet(time_ns += 1'000'000, rate += 0.001F));
    return robot.bench->state() == DeviceState::kMeasuring;
  });
  CHECK(robot.bench->state() == DeviceState::kMeasuring);
}

TEST_CASE("without configuration a sensor as it comes measures by its text, stamped by the time of receipt") {
  vn100::Settings settings;
  settings.configure = false;
  settings.rate_hz = 40;
  Robot robot(settings);
  robot.sensor->hears = false;
  int sent = 0;
  const std::int64_t begin_ns = monotonic_ns();
  robot.bench->run_until(1.0, [&] {
    const std::string turn = std::to_string(++sent);
    robot.sensor->terminal.send(vn100::command_line(
        "VNYMR,+006.380,+000.023,-001.953,+1.0640,-0.2531,+3.0614,+00.005,+00.344,-09.758,"
        "-0.001222,-0.000450,-0.000" +
        turn));
    return robot.bench->samples.size() >= 20;
  });
  REQUIRE(robot.bench->samples.size() >= 20);
  CHECK(robot.bench->state() == DeviceState::kMeasuring);
  CHECK(robot.bench->samples[0].imu.accel_m_s2 == Eigen::Vector3d(0.005, 0.344, -9.758));
  for (const InertialReading& reading : robot.bench->samples) {
    // A line of 120 characters takes 10 ms.
    CHECK(reading.imu.stamp_ns > begin_ns - 20'000'000);
    CHECK(reading.imu.stamp_ns < monotonic_ns());
  }
}

TEST_CASE("a rate that the line cannot carry is refused with the remedy") {
  vn100::Settings settings;
  CHECK(vn100::broken_rule(settings) == nullptr);
  settings.attitude = true;
  CHECK(vn100::broken_rule(settings) ==
        std::string("the packets fill more than 0.9 of the line: raise baud or lower rate_hz"));
  settings.baud = 921'600;
  CHECK(vn100::broken_rule(settings) == nullptr);
  settings.rate_hz = 300;
  CHECK(vn100::broken_rule(settings) == std::string("rate_hz must divide the sensor's 800 Hz"));
}

}  // namespace isobar::test::test_vn100_sensor
