// SPDX-License-Identifier: BSD-3-Clause
// A base station from its barometer to DDS, and from DDS to a robot's isobard; each end for itself with the
// test as the other one, and both together.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "drivers/datagram/datagram.hpp"
#include "drivers/datagram/udp.hpp"
#include "tests/integration/dds/listener.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_base_station {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;
using test::Listener;
using test::says;
using test::text_of;

constexpr int kOk = 0;
constexpr int kWarning = 1;
constexpr int kError = 2;

std::int64_t wall_ns() { return std::chrono::system_clock::now().time_since_epoch() / 1ns; }

std::string write_config(const std::string& name, const std::string& text) {
  const std::string file = "/tmp/" + name + ".toml";
  std::ofstream(file) << text;
  return file;
}

/// Calls `step` at some 40 Hz in a thread of its own.
class Ticker {
 public:
  template <class Step>
  explicit Ticker(Step step)
      : thread_([this, step]() mutable {
          while (!stopped_) {
            step();
            std::this_thread::sleep_for(25ms);
          }
        }) {}
  ~Ticker() {
    stopped_ = true;
    thread_.join();
  }
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

 private:
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

/// What a base station sends.
struct Base {
  std::string name = "base";
  double pressure_pa = 98'000.25;
  std::int64_t clock_ahead_ns = 0;
  bool sends_twice = false;
  bool replays = false;  ///< after each sample the one of a second before
};

/// A base station of another make: writes both topics until it is destroyed.
class Sender {
 public:
  Sender(dds_entity_t participant, const Base& base)
      : base_(base),
        pressure_(participant, dds::topics::kBasePressure, base.name),
        temperature_(participant, dds::topics::kBaseTemperature, base.name),
        ticker_([this] { send(); }) {}

 private:
  void write(std::int64_t stamp_ns) {
    dds::PressureMessage message{};
    message.header = {dds::to_time(stamp_ns), dds::text("theirs")};
    message.fluid_pressure = base_.pressure_pa;
    message.variance = 0.0625;
    pressure_.write(message);
  }
  void send() {
    const std::int64_t stamp_ns = wall_ns() + base_.clock_ahead_ns;
    dds::TemperatureMessage message{};
    message.header = {dds::to_time(stamp_ns), dds::text("theirs")};
    message.temperature = 17.5;
    temperature_.write(message);
    write(stamp_ns);
    if (base_.sends_twice) write(stamp_ns);
    sent_.push_back(stamp_ns);
    if (base_.replays && sent_.size() > 40) write(sent_[sent_.size() - 40]);
  }

  Base base_;
  dds::Writer<dds::PressureMessage> pressure_;
  dds::Writer<dds::TemperatureMessage> temperature_;
  std::vector<std::int64_t> sent_;
  Ticker ticker_;
};

/// One line of the stand-in for isobard.
struct Got {
  double pressure_pa = 0.0;
  long age_ms = 0;
  int station = -1;
  double variance_pa2 = 0.0;
  double temperature_c = 0.0;
};

/// A robot whose isobard is the stand-in, and the test that looks at its diagnostics.
class Robot {
 public:
  explicit Robot(const std::string& config = "")
      : participant_(std::make_shared<dds::Participant>(dds::ParticipantSettings{})),
        diagnostics_(participant_, dds::topics::kDiagnostics),
        stand_in_({ISOBAR_STAND_IN}),
        bridge_({ISOBAR_DDS_PROGRAM, "--config", write_config("robot", config)}) {
    REQUIRE(diagnostics_.receive(2));  // isobard has told its clock
  }
  [[nodiscard]] dds_entity_t participant() const { return participant_->get(); }

  /// Waits for the diagnostics to say so.
  bool says(const std::string& entry, int level) {
    diagnostics_.forget();
    return diagnostics_.receive(
        1, [&](const auto& message) { return test::says(message, "isobar: " + entry, level); });
  }
  /// The next samples that isobard gets.
  std::vector<Got> receive(std::size_t wanted) {
    std::vector<Got> samples;
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    std::string line;
    while (samples.size() < wanted && std::chrono::steady_clock::now() < deadline) {
      Got got;
      if (stand_in_.read_line(line, 100ms) &&
          std::sscanf(line.c_str(), "base %lf %ld %d %lf %lf", &got.pressure_pa, &got.age_ms, &got.station,
                      &got.variance_pa2, &got.temperature_c) == 5) {
        samples.push_back(got);
      }
    }
    return samples;
  }
  /// What isobard has got until now, given up.
  void forget() {
    std::string line;
    while (stand_in_.read_line(line, 0ms)) {
    }
  }

 private:
  std::shared_ptr<dds::Participant> participant_;
  Listener<dds::DiagnosticsMessage> diagnostics_;
  ChildProcess stand_in_;
  ChildProcess bridge_;
};

/// A barometer that sends datagrams: 0.4 Pa of white noise.
class Barometer {
 public:
  Barometer(std::uint16_t port, datagram::Kind kind, bool sends_twice = false, double noise_pa = 0.4)
      : kind_(kind),
        sends_twice_(sends_twice),
        sender_("127.0.0.1", port),
        noise_pa_(noise_pa),
        ticker_([this] { send(); }) {}

 private:
  void send() {
    datagram::Sample sample;
    sample.kind = kind_;
    sample.pressure = {wall_ns(), 97'000.0 + noise_pa_ * noise_(random_), 21.25};
    for (int i = 0; i < (sends_twice_ ? 2 : 1); ++i) {
      sample.sequence = sequence_++;  // a copy with a number of its own: the numbers do not show it
      std::array<char, datagram::kMaxLineBytes> line{};
      const std::size_t length = datagram::format_line(sample, line);
      sender_.send({reinterpret_cast<const std::uint8_t*>(line.data()), length});
    }
  }

  datagram::Kind kind_;
  bool sends_twice_;
  UdpSender sender_;
  std::uint32_t sequence_ = 0;
  std::mt19937_64 random_{7};
  double noise_pa_;
  std::normal_distribution<double> noise_;
  Ticker ticker_;
};

TEST_CASE(
    "a base station tells pressure, its measured variance and the temperature under one stamp and its name") {
  const std::string config = write_config(
      "base",
      "role = \"base-station\"\n[dds]\nbase_station = \"roof\"\n[altimeter]\nstuck_timeout_s = 0.5\n");
  auto participant = std::make_shared<dds::Participant>(dds::ParticipantSettings{});
  Listener<dds::PressureMessage> pressure(participant, dds::topics::kBasePressure, "roof");
  Listener<dds::TemperatureMessage> temperature(participant, dds::topics::kBaseTemperature, "roof");
  Listener<dds::DiagnosticsMessage> diagnostics(participant, dds::topics::kDiagnostics);
  dds::Reader<dds::OdometryMessage> odometry(participant->get(), dds::topics::kOdom);
  dds::Reader<dds::TfMessage> mounts(participant->get(), dds::topics::kTfStatic);
  ChildProcess daemon({ISOBAR_DAEMON, "--config", config});
  REQUIRE(daemon.read_until("ready: base station \"roof\"", 20s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  REQUIRE(bridge.read_until("attached", 20s));
  std::vector<std::int64_t> stamps_ns;
  {
    const Barometer barometer(7373, datagram::Kind::kPressure);
    CHECK(pressure.receive(40, [&](const dds::PressureMessage& message) {
      CHECK(std::string(message.header.frame_id) == "roof");
      CHECK(message.fluid_pressure == doctest::Approx(97'000.0).epsilon(3e-5));
      stamps_ns.push_back(dds::to_stamp_ns(message.header.stamp));
      if (message.variance == 0.0) return false;  // not measured yet
      // Of 50 samples and more: the estimate is good to a third, three standard deviations.
      CHECK(std::sqrt(message.variance) == doctest::Approx(0.4).epsilon(0.5));
      return true;
    }));
    CHECK(temperature.receive(5, [&](const dds::TemperatureMessage& message) {
      CHECK(std::string(message.header.frame_id) == "roof");
      CHECK(message.temperature == 21.25);
      const std::int64_t stamp_ns = dds::to_stamp_ns(message.header.stamp);
      return std::find(stamps_ns.begin(), stamps_ns.end(), stamp_ns) != stamps_ns.end();
    }));
    CHECK(diagnostics.receive(
        1, [](const auto& message) { return says(message, "isobar_roof: barometer", kOk); }));
    // Another vendor's DDS reads both: 4 bytes of head, stamp 8, frame 4 + 5 and 7 to fill up, two numbers.
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
      CHECK(bytes == 4 + 8 + 4 + 5 + 7 + 16);
    }
    CHECK(topics == 2);
  }
  const auto fails_as = [&diagnostics](const std::string& word) {
    return diagnostics.receive(1, [&word](const dds::DiagnosticsMessage& message) {
      const std::string barometer = text_of(message, "isobar_roof: barometer");
      return says(message, "isobar_roof: barometer", kError) && barometer.find(word) != std::string::npos;
    });
  };
  CHECK(fails_as("silent"));
  {
    const Barometer stuck(7373, datagram::Kind::kPressure, false, 0.0);
    CHECK(fails_as("stuck"));
  }
  // It is no robot, and says nothing about where it is.
  for (const dds_entity_t reader : {odometry.get(), mounts.get()}) {
    CHECK(dds_get_matched_publications(reader, nullptr, 0) == 0);
  }
  for (ChildProcess* program : {&bridge, &daemon}) {
    program->signal(SIGTERM);
    CHECK(program->wait(20s) == 0);
  }
}

TEST_CASE("pressure, variance and temperature of two base stations reach isobard, each under its number") {
  Robot robot("[dds]\nsecond_base_station = \"shed\"\n");
  CHECK(robot.says("bridge/second_base_station", 3));  // nothing received yet
  Base shed;
  shed.name = "shed";
  shed.pressure_pa = 97'900.5;
  shed.clock_ahead_ns = -1'000'000'000'000'000'000;  // it believes in 1995
  const Sender first(robot.participant(), {});
  const Sender second(robot.participant(), shed);
  std::array<int, 2> of_station{};
  std::array<bool, 2> known{};
  for (const Got& got : robot.receive(60)) {
    REQUIRE((got.station == 0 || got.station == 1));
    ++of_station[got.station];
    CHECK(got.pressure_pa == (got.station == 0 ? 98'000.25 : 97'900.5));
    CHECK(got.variance_pa2 == 0.0625);
    // Of the two topics of a station either may be discovered first.
    known[got.station] = known[got.station] || got.temperature_c == 17.5;
    if (known[got.station]) CHECK(got.temperature_c == 17.5);
    CHECK(std::abs(got.age_ms) < 2000);  // a loaded machine's delay, and not decades
  }
  for (const int station : {0, 1}) {
    CHECK(of_station[station] > 5);
    CHECK(known[station]);
  }
  CHECK(robot.says("bridge/base_station", kOk));
  CHECK(robot.says("bridge/second_base_station", kOk));
}

TEST_CASE("samples that come twice or are replayed reach isobard once, and are named in the diagnostics") {
  Robot robot;
  Base base;
  base.sends_twice = true;
  base.replays = true;
  const Sender sender(robot.participant(), base);
  CHECK(robot.receive(60).size() == 60);
  CHECK(robot.says("bridge/base_station/repeated", kWarning));
  // Three messages go out for each sample: what comes through is what was measured, at its rate of 40 Hz.
  robot.forget();
  const auto start = std::chrono::steady_clock::now();
  robot.receive(40);
  CHECK(std::chrono::steady_clock::now() - start > 700ms);
}

TEST_CASE("of two base stations of one name one is used, and the diagnostics say that there are two") {
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

TEST_CASE(
    "a base station that ends, is started again with another clock, or falls silent is said and taken back") {
  Robot robot;
  auto base = std::make_unique<Sender>(robot.participant(), Base{});
  CHECK(robot.receive(20).size() == 20);
  CHECK(robot.says("bridge/base_station", kOk));
  base.reset();  // says goodbye
  CHECK(robot.says("bridge/base_station", kError));
  robot.forget();
  Base again;
  again.clock_ahead_ns = -86'400'000'000'000;
  base = std::make_unique<Sender>(robot.participant(), again);
  const auto start = std::chrono::steady_clock::now();
  for (const Got& got : robot.receive(5)) CHECK(std::abs(got.age_ms) < 2000);
  CHECK(std::chrono::steady_clock::now() - start <
        10s);  // half a second on a machine with nothing else to do
  CHECK(robot.says("bridge/base_station", kOk));
  CHECK(robot.says("bridge/base_station/restarts", kOk));
}

TEST_CASE("datagrams of a base station are checked by the same rules: copies are refused, and it is named") {
  const std::string config = write_config("robot", "[input]\nport = 7381\n");
  ChildProcess robot({ISOBAR_DAEMON, "--config", config});
  REQUIRE(robot.read_until("ready", 20s));
  {
    const Barometer base(7381, datagram::Kind::kBasePressure, true);
    CHECK(robot.read_until("base_station: ok", 20s));
    CHECK(robot.read_until("base_station/repeated: warning", 20s));
  }
  CHECK(robot.read_until("base_station: error: silent", 20s));
  robot.signal(SIGTERM);
  CHECK(robot.wait(20s) == 0);
}

TEST_CASE(
    "a base station in a machine of its own and a robot: killed, it is missed, and started again it is "
    "back") {
  if (std::getenv("ISOBAR_ISOLATED") == nullptr) {
    MESSAGE("skipped: a second machine on this one needs namespaces of its own, and so root");
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
    CHECK(robot.read_until("base_station: ok", 30s));
    base.signal(SIGKILL);
    CHECK(robot.read_until("base_station: error: silent", 30s));
  }
  const ChildProcess base(roof);
  CHECK(robot.read_until("base_station: ok", 30s));
}

}  // namespace

}  // namespace isobar::test::test_base_station
