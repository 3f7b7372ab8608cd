// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds when isobard or the bridge itself is killed, stopped or restarted. The test is the DDS
// subscriber.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "ipc/shared_memory.hpp"
#include "tests/integration/dds/listener.hpp"
#include "tests/integration/dds/stand_in.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_recovery {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;
using test::Listener;
using test::says;

TEST_CASE(
    "without isobard the bridge waits, logs it once, reports it in the diagnostics, and stops on SIGTERM") {
  Listener<dds::DiagnosticsMessage> listener(dds::topics::kDiagnostics);
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  CHECK(listener.receive(2, [](const auto& message) { return says(message, "isobar: bridge/isobard", 2); }));
  bridge.signal(SIGTERM);
  CHECK(bridge.wait(10s) == 0);
  std::string line;
  int waiting_lines = 0;
  while (bridge.read_line(line, 1s)) {
    waiting_lines += line.find("waiting") != std::string::npos ? 1 : 0;
  }
  CHECK(waiting_lines == 1);
}

TEST_CASE("a killed bridge does not disturb isobard, and a new one takes over") {
  Listener<dds::OdometryMessage> listener(dds::topics::kOdom);
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  {
    ChildProcess bridge({ISOBAR_DDS_PROGRAM});
    CHECK(listener.receive(100));
    bridge.signal(SIGKILL);
    CHECK(bridge.wait(10s) == 128 + SIGKILL);
  }
  CHECK(stand_in.read_until("priors", 5s));
  CHECK(stand_in.read_until("priors", 5s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  listener.forget();
  CHECK(listener.receive(100));
  CHECK(stand_in.running());
  bridge.signal(SIGINT);
  CHECK(bridge.wait(10s) == 0);
  stand_in.signal(SIGTERM);
  CHECK(stand_in.wait(10s) == 0);
}

TEST_CASE("when isobard is killed or stopped and starts again, the bridge reconnects by itself") {
  Listener<dds::OdometryMessage> listener(dds::topics::kOdom);
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  for (const int ending : {SIGKILL, SIGTERM, SIGKILL}) {
    ChildProcess stand_in({ISOBAR_STAND_IN});
    REQUIRE(stand_in.read_until("ready", 10s));
    listener.forget();
    CHECK(listener.receive(20));
    stand_in.signal(ending);
    CHECK(stand_in.wait(10s) == (ending == SIGKILL ? 128 + SIGKILL : 0));
  }
  ChildProcess stand_in({ISOBAR_STAND_IN});
  listener.forget();
  CHECK(listener.receive(20));
  CHECK(bridge.running());  // the same process throughout
  bridge.signal(SIGTERM);
  CHECK(bridge.wait(10s) == 0);
}

TEST_CASE(
    "a reader that comes late gets the whole map, which the bridge receives only while somebody reads it") {
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  const auto participant = std::make_shared<dds::Participant>(dds::ParticipantSettings{});
  Listener<dds::OdometryMessage> odom(participant, dds::topics::kOdom);
  REQUIRE(odom.receive(300));  // longer than the stand-in's map takes
  // Twice: the second reader comes while the bridge still keeps the map for the first one.
  for (int i = 0; i < 2; ++i) {
    Listener<dds::CloudMessage> map(participant, dds::topics::kMapCloud);
    CHECK(map.receive(
        1, [](const dds::CloudMessage& message) { return message.width == stand_in::kMapPoints; }));
  }
  bridge.signal(SIGTERM);
  CHECK(bridge.wait(10s) == 0);
}

TEST_CASE("a bridge that was stopped for 4 s continues") {
  Listener<dds::OdometryMessage> listener(dds::topics::kOdom);
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  CHECK(listener.receive(20));
  bridge.signal(SIGSTOP);
  for (int second = 0; second < 4; ++second) {  // iceoryx's own monitoring would unregister it after 1.5 s
    CHECK(stand_in.read_until("priors", 5s));
  }
  bridge.signal(SIGCONT);
  listener.forget();
  CHECK(listener.receive(200));
  CHECK(stand_in.running());
}

/// What the bridge may be doing when isobard has to stop.
enum class BridgeState { kForwards, kHangs, kKilled, kStarts };

/// Seconds from SIGTERM to the end of isobard's stand-in.
double stop_s(BridgeState state) {
  Listener<dds::OdometryMessage> listener(dds::topics::kOdom);
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  if (state != BridgeState::kStarts) CHECK(listener.receive(20));
  if (state == BridgeState::kHangs) bridge.signal(SIGSTOP);
  if (state == BridgeState::kKilled) bridge.signal(SIGKILL);
  if (state == BridgeState::kStarts) CHECK(bridge.read_until("DDS domain", 10s));  // it attaches right after
  const auto began = std::chrono::steady_clock::now();
  stand_in.signal(SIGTERM);
  CHECK(stand_in.wait(10s) == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (state == BridgeState::kHangs) bridge.signal(SIGCONT);
  if (state != BridgeState::kKilled) {  // the bridge takes no harm: the next isobard has it
    ChildProcess next({ISOBAR_STAND_IN});
    listener.forget();
    CHECK(listener.receive(20));
    CHECK(bridge.running());
  }
  return seconds;
}

TEST_CASE("isobard stops soon whatever the bridge does") {
  // 0.7 s at most on a machine that is not busy: endure stops. Here a build may run beside it, or a sanitizer in it.
  constexpr double kLimitS = ISOBAR_STOP_LIMIT_S;
  CHECK(stop_s(BridgeState::kForwards) < kLimitS);
  CHECK(stop_s(BridgeState::kHangs) < kLimitS);
  CHECK(stop_s(BridgeState::kKilled) < kLimitS);
  CHECK(stop_s(BridgeState::kStarts) < kLimitS);
}

/// Exit code of a forwarding bridge that gets SIGTERM right after isobard got `number`; -1: not within 1.5 s.
int bridge_exit_code_after(int number) {
  Listener<dds::OdometryMessage> listener(dds::topics::kOdom);
  const ChildProcess stand_in({ISOBAR_STAND_IN});
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  CHECK(listener.receive(20));
  stand_in.signal(number);
  bridge.signal(SIGTERM);
  return bridge.wait(1500ms);
}

TEST_CASE("the bridge stops on SIGTERM right after isobard was killed") {
  CHECK(bridge_exit_code_after(SIGKILL) == 0);
}

TEST_CASE("the bridge stops on SIGTERM although isobard hangs and does not answer") {
  CHECK(bridge_exit_code_after(SIGSTOP) == 0);
}

TEST_CASE("a base station's pressure reaches isobard on the robot clock; implausible pressures do not") {
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  Listener<dds::DiagnosticsMessage> listener(dds::topics::kDiagnostics);
  REQUIRE(listener.receive(2));  // the bridge has a health report, and so the robot clock
  const dds::Participant& participant = listener.participant();
  dds::Writer<dds::PressureMessage> writer(participant.get(), dds::topics::kBasePressure, "base");
  dds::PressureMessage message{};
  message.header.frame_id = dds::text("base");
  std::string line;
  int good = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 200 && good < 5; ++i) {
    const auto since_start = std::chrono::steady_clock::now() - start;
    message.header.stamp = dds::to_time(1'000'000'000'000 + since_start / 1ns);  // sender's clock: 1970
    message.fluid_pressure = i % 2 == 0 ? 98765.25 : 1e9;
    writer.write(message);
    while (stand_in.read_line(line, 50ms)) {
      if (line.starts_with("base")) {
        double pressure_pa = 0.0;
        long age_ms = 0;
        REQUIRE(std::sscanf(line.c_str(), "base %lf %ld", &pressure_pa, &age_ms) == 2);
        CHECK(pressure_pa == 98765.25);
        CHECK(std::abs(age_ms) < 1000);  // delay of a loaded machine; the clocks differ by decades
        ++good;
      }
    }
  }
  CHECK(good == 5);
  CHECK(listener.receive(
      1, [](const auto& got) { return says(got, "isobar: bridge/received_implausible", 1); }));
}

TEST_CASE("the configuration file sets the namespace, the frames and the sensor mounts") {
  const std::string file = "/tmp/isobar-bridge-test.toml";
  std::ofstream(file) << "[dds]\nros_namespace = \"robot1\"\nlidar_frame = \"velodyne\"\n"
                         "[lidar]\nxyz_m = [0.1, 0.2, 0.45]\n";
  ChildProcess stand_in({ISOBAR_STAND_IN});
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", file});
  {
    Listener<dds::OdometryMessage> listener(dds::topics::kOdom, "robot1");
    CHECK(listener.receive(20));
  }
  Listener<dds::TfMessage> listener(dds::topics::kTfStatic);
  CHECK(listener.receive(1, [](const dds::TfMessage& message) {
    const auto& lidar = message.transforms._buffer[0];
    const auto& xyz = lidar.transform.translation;
    return std::string("velodyne") == lidar.child_frame_id && xyz.x == 0.1 && xyz.y == 0.2 && xyz.z == 0.45;
  }));
}

TEST_CASE("a wrong domain, file or option is refused with the reason") {
  ChildProcess no_domain({ISOBAR_DDS_PROGRAM, "--domain", "233"});
  CHECK(no_domain.read_until("domain", 10s));
  CHECK(no_domain.wait(10s) == 78);
  ChildProcess no_file({ISOBAR_DDS_PROGRAM, "--config", "/nowhere/isobar.toml"});
  CHECK(no_file.read_until("/nowhere/isobar.toml", 10s));
  CHECK(no_file.wait(10s) == 78);
  ChildProcess no_option({ISOBAR_DDS_PROGRAM, "--nonsense"});
  CHECK(no_option.wait(10s) == 64);
}

}  // namespace

}  // namespace isobar::test::test_recovery
