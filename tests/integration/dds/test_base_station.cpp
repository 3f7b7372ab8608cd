// SPDX-License-Identifier: BSD-3-Clause
// A base station from its barometer to DDS, and from DDS to a robot's isobard: each side with the test as its
// counterpart, and both together.
#include "tests/integration/dds/base_station_peers.hpp"

#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace isobar::test::test_base_station {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// The programs of a base station "roof", and subscribers of its topics.
struct Roof {
  std::string config = write_config(
      "base",
      "role = \"base-station\"\n[dds]\nbase_station = \"roof\"\n[altimeter]\nstuck_timeout_s = 0.5\n");
  std::shared_ptr<dds::Participant> participant =
      std::make_shared<dds::Participant>(dds::ParticipantSettings{});
  Listener<dds::PressureMessage> pressure{participant, dds::topics::kBasePressure, "roof"};
  Listener<dds::TemperatureMessage> temperature{participant, dds::topics::kBaseTemperature, "roof"};
  Listener<dds::DiagnosticsMessage> diagnostics{participant, dds::topics::kDiagnostics};
  ChildProcess daemon{{ISOBAR_DAEMON, "--config", config}};
  ChildProcess bridge{{ISOBAR_DDS_PROGRAM, "--config", config}};

  Roof() {
    REQUIRE(daemon.read_until("ready: base station \"roof\"", 20s));
    REQUIRE(bridge.read_until("attached", 20s));
  }
  /// Waits until the barometer's error has `word` in its text.
  bool fails_as(const std::string& word) {
    return diagnostics.receive(1, [&word](const dds::DiagnosticsMessage& message) {
      const std::string barometer = text_of(message, "isobar_roof: barometer");
      return says(message, "isobar_roof: barometer", kError) && barometer.find(word) != std::string::npos;
    });
  }
};

TEST_CASE("a base station publishes pressure, its measured variance and temperature with one stamp") {
  Roof roof;
  const Barometer barometer(7373, datagram::Kind::kPressure);
  std::vector<std::int64_t> stamps_ns;
  CHECK(roof.pressure.receive(40, [&](const dds::PressureMessage& message) {
    CHECK(std::string(message.header.frame_id) == "roof");
    CHECK(message.fluid_pressure == doctest::Approx(97'000.0).epsilon(3e-5));
    stamps_ns.push_back(dds::to_stamp_ns(message.header.stamp));
    if (message.variance == 0.0) return false;  // not measured yet
    // From 50 samples or more the estimate is within a third of the truth, at three standard deviations.
    CHECK(std::sqrt(message.variance) == doctest::Approx(0.4).epsilon(0.5).scale(0.0));
    return true;
  }));
  CHECK(roof.temperature.receive(5, [&](const dds::TemperatureMessage& message) {
    CHECK(std::string(message.header.frame_id) == "roof");
    CHECK(message.temperature == 21.25);
    const std::int64_t stamp_ns = dds::to_stamp_ns(message.header.stamp);
    return std::find(stamps_ns.begin(), stamps_ns.end(), stamp_ns) != stamps_ns.end();
  }));
  CHECK(roof.diagnostics.receive(
      1, [](const auto& message) { return says(message, "isobar_roof: barometer", kOk); }));
}

TEST_CASE("another vendor's DDS receives pressure and temperature of a base station") {
  const Roof roof;
  const Barometer barometer(7373, datagram::Kind::kPressure);
  const std::string folder = "/tmp/foreign";
  std::filesystem::create_directories(folder);
  ChildProcess listener({ISOBAR_FOREIGN_LISTENER, folder, "0", "3"});
  CHECK(listener.wait(30s) == 0);
  std::string line;
  int topics = 0;
  while (listener.read_line(line, 1s)) {
    char name[64];  // NOLINT(modernize-avoid-c-arrays)
    int count = 0;
    int bytes = 0;
    REQUIRE(std::sscanf(line.c_str(), "%63s %d %d", name, &count, &bytes) == 3);
    if (!std::string(name).starts_with("rt/roof/")) continue;
    ++topics;
    CHECK(count > 5);
    // Encapsulation header 4, stamp 8, frame 4 + 5, padding 7, two doubles.
    CHECK(bytes == 4 + 8 + 4 + 5 + 7 + 16);
  }
  CHECK(topics == 2);
}

TEST_CASE("a base station reports a silent and a stuck barometer, publishes no pose, and stops on SIGTERM") {
  Roof roof;
  const dds::Reader<dds::OdometryMessage> odometry(roof.participant->get(), dds::topics::kOdom);
  const dds::Reader<dds::TfMessage> mounts(roof.participant->get(), dds::topics::kTfStatic);
  {
    const Barometer barometer(7373, datagram::Kind::kPressure);
    CHECK(roof.diagnostics.receive(
        1, [](const auto& message) { return says(message, "isobar_roof: barometer", kOk); }));
  }
  CHECK(roof.fails_as("silent"));
  {
    const Barometer stuck(7373, datagram::Kind::kPressure, false, 0.0);
    CHECK(roof.fails_as("stuck"));
  }
  for (const dds_entity_t reader : {odometry.get(), mounts.get()}) {
    CHECK(dds_get_matched_publications(reader, nullptr, 0) == 0);
  }
  for (ChildProcess* program : {&roof.bridge, &roof.daemon}) {
    program->signal(SIGTERM);
    CHECK(program->wait(20s) == 0);
  }
}

TEST_CASE(
    "pressure, variance and temperature of two base stations reach isobard with their station's index") {
  Robot robot("[dds]\nsecond_base_station = \"shed\"\n");
  CHECK(robot.says("bridge/second_base_station", kStale));  // nothing received yet
  Base shed;
  shed.name = "shed";
  shed.pressure_pa = 97'900.5;
  shed.clock_ahead_ns = -1'000'000'000'000'000'000;  // its clock is in the 1990s
  const Sender first(robot.participant(), {});
  const Sender second(robot.participant(), shed);
  std::array<int, 2> of_station{};
  std::array<bool, 2> known{};
  for (const Got& got : robot.receive(60)) {
    REQUIRE((got.station == 0 || got.station == 1));
    ++of_station[got.station];
    CHECK(got.pressure_pa == (got.station == 0 ? 98'000.25 : 97'900.5));
    CHECK(got.variance_pa2 == 0.0625);
    // Either of a station's two topics may be discovered first.
    known[got.station] = known[got.station] || got.temperature_c == 17.5;
    if (known[got.station]) CHECK(got.temperature_c == 17.5);
    CHECK(std::abs(got.age_ms) < 2000);  // delay of a loaded machine, without the decades between the clocks
  }
  for (const int station : {0, 1}) {
    CHECK(of_station[station] > 5);
    CHECK(known[station]);
  }
  CHECK(robot.says("bridge/base_station", kOk));
  CHECK(robot.says("bridge/second_base_station", kOk));
}

TEST_CASE("repeated and replayed samples reach isobard once, and the diagnostics report them") {
  Robot robot;
  Base base;
  base.sends_twice = true;
  base.replays = true;
  const Sender sender(robot.participant(), base);
  CHECK(robot.receive(60).size() == 60);
  CHECK(robot.says("bridge/base_station/repeated", kWarning));
  // Three messages are sent for each sample; only the samples pass, at their rate of 40 Hz.
  robot.forget();
  const auto start = std::chrono::steady_clock::now();
  robot.receive(40);
  CHECK(std::chrono::steady_clock::now() - start > 700ms);
}

TEST_CASE("of two base stations with one name the first is used, and the diagnostics report the other") {
  Robot robot;
  const Sender first(robot.participant(), {});
  REQUIRE(robot.receive(10).size() == 10);
  Base other;
  other.pressure_pa = 97'900.5;
  const Sender second(robot.participant(), other);
  CHECK(robot.says("bridge/base_station/other_sender", kWarning));
  CHECK(robot.says("bridge/base_station", kWarning));
  for (const Got& got : robot.receive(40)) CHECK(got.pressure_pa == 98'000.25);
}

TEST_CASE("a base station that ends is reported, and used again after a restart with another clock") {
  Robot robot;
  auto base = std::make_unique<Sender>(robot.participant(), Base{});
  CHECK(robot.receive(20).size() == 20);
  CHECK(robot.says("bridge/base_station", kOk));
  base.reset();  // leaves the DDS domain
  CHECK(robot.says("bridge/base_station", kError));
  robot.forget();
  Base again;
  again.clock_ahead_ns = -86'400'000'000'000;
  base = std::make_unique<Sender>(robot.participant(), again);
  const auto start = std::chrono::steady_clock::now();
  for (const Got& got : robot.receive(5)) CHECK(std::abs(got.age_ms) < 2000);
  CHECK(std::chrono::steady_clock::now() - start < 10s);  // 0.5 s on an idle machine
  CHECK(robot.says("bridge/base_station", kOk));
  CHECK(robot.says("bridge/base_station/restarts", kOk));
}

TEST_CASE("datagrams of a base station follow the same rules: copies are refused and reported") {
  const std::string config = write_config("robot", "[input]\nport = 7381\n");
  ChildProcess robot({ISOBAR_DAEMON, "--config", config});
  REQUIRE(robot.read_until("ready", 20s));
  {
    const Barometer base(7381, datagram::Kind::kBasePressure, true);
    CHECK(robot.read_until("info: base_station: ", 20s));
    CHECK(robot.read_until("warning: base_station/repeated: ", 20s));
  }
  CHECK(robot.read_until("error: base_station: silent", 20s));
  robot.signal(SIGTERM);
  CHECK(robot.wait(20s) == 0);
}

TEST_CASE(
    "a base station on a second machine is reported as silent when killed, and is used again after a "
    "restart") {
  if (std::getenv("ISOBAR_ISOLATED") == nullptr) {
    MESSAGE("skipped: emulating a second machine needs namespaces, hence root");
    return;
  }
  const std::string on_the_roof =
      "printf 'role = \"base-station\"\\n[dds]\\nbase_station = \"roof\"\\n[input]\\nport = 7380\\n' "
      ">/tmp/base.toml\n"
      "$0 --config /tmp/base.toml &\n"
      "$1 --config /tmp/base.toml &\n"
      "wait\n";
  const std::vector<std::string> roof{ISOBAR_ISOLATE, "--machine",       "sh", "-c", on_the_roof,
                                      ISOBAR_DAEMON,  ISOBAR_DDS_PROGRAM};
  const std::string config = write_config("robot", "[dds]\nbase_station = \"roof\"\n");
  ChildProcess robot({ISOBAR_DAEMON, "--config", config});
  REQUIRE(robot.read_until("ready", 20s));
  const ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  const Barometer barometer(7380, datagram::Kind::kPressure);
  {
    ChildProcess base(roof);
    CHECK(robot.read_until("info: base_station: nothing received yet", 30s));
    CHECK(robot.read_until("info: base_station: ", 30s));
    base.signal(SIGKILL);
    CHECK(robot.read_until("error: base_station: silent", 30s));
  }
  const ChildProcess base(roof);
  CHECK(robot.read_until("info: base_station: recovered", 30s));
}

/// A node that writes the wheels' odometry with this forward speed.
class WheelNode {
 public:
  WheelNode(dds_entity_t participant, double speed_m_s)
      : writer_(participant, dds::topics::kWheel), ticker_([this, speed_m_s] {
          dds::OdometryMessage message{};
          message.header = {dds::to_time(wall_ns()), dds::text("odom")};
          message.child_frame_id = dds::text("base_link");
          message.twist.twist.linear.x = speed_m_s;
          writer_.write(message);
        }) {}

 private:
  dds::Writer<dds::OdometryMessage> writer_;
  Ticker ticker_;
};

TEST_CASE("of two nodes that write the wheels' topic the first is used, the other one when that has ended") {
  Robot robot("imu.source = \"dds\"\nwheel.source = \"dds\"\n");
  auto driver = std::make_unique<WheelNode>(robot.participant(), 1.0);
  robot.wheels_for(2s);
  const WheelNode rogue(robot.participant(), 9.0);
  CHECK(robot.says("bridge/received_other_senders", kWarning));
  robot.forget();
  const std::vector<double> speeds = robot.wheels_for(2s);
  CHECK(speeds.size() > 20);
  for (const double speed : speeds) CHECK(speed == 1.0);
  driver.reset();
  robot.wheels_for(500ms);
  const std::vector<double> then = robot.wheels_for(1s);
  CHECK(then.size() > 10);
  for (const double speed : then) CHECK(speed == 9.0);
}

}  // namespace

}  // namespace isobar::test::test_base_station
