// SPDX-License-Identifier: BSD-3-Clause
// Base-station pressure that is signed with keys: accepted from members only, and everything else stays as
// it is without keys.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "ipc/dds/secure_participant.hpp"
#include "tests/integration/dds/base_station_peers.hpp"
#include "tests/integration/dds/rtps_tap.hpp"
#include "tests/ipc/keys/key_folders.hpp"
#include "tests/support/message_of.hpp"

namespace isobar::test::test_signed_base_station {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Configuration of a robot that listens to the base station "roof" with the keys in a folder.
std::string robot_with(const fs::path& keys) {
  return "[dds]\nbase_station = \"roof\"\nkeys_directory = \"" + keys.string() + "\"\n";
}

/// A base station that counts its samples: 0.01 Pa more each time. Pauses on demand.
class CountingSender {
 public:
  explicit CountingSender(dds_entity_t participant)
      : pressure_(participant, dds::topics::kBasePressure, "roof"), ticker_([this] { send(); }) {}

  void pause(bool pause) { paused_ = pause; }

 private:
  void send() {
    if (paused_) return;
    dds::PressureMessage message{};
    message.header = {dds::to_time(wall_ns()), dds::text("roof")};
    message.fluid_pressure = 98'000.0 + 0.01 * ++count_;
    pressure_.write(message);
  }

  std::atomic<bool> paused_{false};
  dds::Writer<dds::PressureMessage> pressure_;
  double count_ = 0.0;
  Ticker ticker_;
};

TEST_CASE("a robot with keys takes signed pressure, and everybody without keys still receives its poses") {
  const Site site;
  Robot robot(robot_with(site.robot));
  const dds::SecureParticipant member({}, site.roof);
  Base base;
  base.name = "roof";
  const Sender sender(member.get(), base);
  for (const Got& got : robot.receive(40)) CHECK(got.pressure_pa == 98'000.25);
  CHECK(robot.says("bridge/base_station", kOk));
  CHECK(robot.says("bridge/keys", kOk));  // the diagnostics themselves came without keys
  const dds::Reader<dds::PoseMessage> poses(robot.participant(), dds::topics::kPose);
  int received = 0;
  for (int i = 0; i < 200 && received < 10; ++i) {
    std::this_thread::sleep_for(50ms);
    const_cast<dds::Reader<dds::PoseMessage>&>(poses).take([&](const dds::PoseMessage&) { ++received; });
  }
  CHECK(received >= 10);
}

TEST_CASE("pressure of a sender without keys is refused and reported, also beside the true one") {
  const Site site;
  Robot robot(robot_with(site.robot));
  Base rogue;
  rogue.name = "roof";
  rogue.pressure_pa = 97'000.0;
  const Sender forger(robot.participant(), rogue);
  CHECK(robot.says("bridge/keys/unsigned", kWarning));
  CHECK(robot.receive_for(1s).empty());
  const dds::SecureParticipant member({}, site.roof);
  Base base;
  base.name = "roof";
  const Sender sender(member.get(), base);
  const std::vector<Got> got = robot.receive(40);
  CHECK(got.size() == 40);
  for (const Got& sample : got) CHECK(sample.pressure_pa == 98'000.25);
}

TEST_CASE("pressure signed with keys of other authorities is refused and reported") {
  const Site site;
  const Site stranger;
  Robot robot(robot_with(site.robot));
  const dds::SecureParticipant member({}, stranger.roof);
  Base rogue;
  rogue.name = "roof";
  const Sender sender(member.get(), rogue);
  CHECK(robot.says("bridge/keys/refused", kWarning));
  CHECK(robot.receive_for(2s).empty());
}

TEST_CASE("a robot's keys cannot write pressure, and a base station's write under its own name only") {
  const Site site;
  {
    const dds::SecureParticipant robot({}, site.robot);
    CHECK_THROWS_AS(dds::Writer<dds::PressureMessage>(robot.get(), dds::topics::kBasePressure, "roof"),
                    ServiceError);
  }
  const dds::SecureParticipant roof({}, site.roof);
  const dds::Writer<dds::PressureMessage> own(roof.get(), dds::topics::kBasePressure, "roof");
  CHECK_THROWS_AS(dds::Writer<dds::PressureMessage>(roof.get(), dds::topics::kBasePressure, "shed"),
                  ServiceError);
}

TEST_CASE("replayed, changed and unsigned copies of signed datagrams are not accepted") {
  if (std::getenv("ISOBAR_ISOLATED") == nullptr) {
    MESSAGE("skipped: recording datagrams needs root");
    return;
  }
  const Site site;
  auto robot = std::make_unique<Robot>(robot_with(site.robot));
  const dds::SecureParticipant member({}, site.roof);
  RtpsTap tap(member.get());
  CountingSender sender(member.get());
  const std::vector<Got> before = robot->receive(60);
  REQUIRE(before.size() == 60);
  sender.pause(true);
  const std::vector<Got> last = robot->receive_for(500ms);
  const double newest_pa = last.empty() ? before.back().pressure_pa : last.back().pressure_pa;
  std::vector<Datagram> recorded;
  for (const Datagram& datagram : tap.recorded()) {
    if (has_submessage(datagram.payload, kData)) recorded.push_back(datagram);
  }
  REQUIRE(recorded.size() >= 60);
  REQUIRE(has_submessage(recorded.back().payload, kSecurePrefix));  // they are signed
  const Forger forger;
  SUBCASE("to the robot that has received them") {
    for (const Datagram& datagram : recorded) {
      forger.send(datagram);
      forger.send({datagram.address, datagram.port, with_later_samples(datagram.payload, 10)});
      forger.send({datagram.address, datagram.port, without_signatures(datagram.payload)});
      forger.send(
          {datagram.address, datagram.port, with_later_samples(without_signatures(datagram.payload), 20)});
    }
    CHECK(robot->receive_for(1s).empty());
  }
  SUBCASE("to a robot that has started anew, and does not know them") {
    robot.reset();
    robot = std::make_unique<Robot>(robot_with(site.robot));
    CHECK(robot->says("bridge/keys", kOk));
    std::this_thread::sleep_for(3s);  // the sender is found again, and silent; its handshake takes a second
    for (const Datagram& datagram : recorded) {
      forger.send_to_all(datagram);
      forger.send_to_all({0, 0, without_signatures(datagram.payload)});
    }
    CHECK(robot->receive_for(1s).empty());
  }
  // The true base station is not locked out by what was sent in its name.
  sender.pause(false);
  const std::vector<Got> after = robot->receive(20);
  REQUIRE(after.size() == 20);
  double previous_pa = newest_pa;
  for (const Got& got : after) {
    CHECK(got.pressure_pa > previous_pa);
    previous_pa = got.pressure_pa;
  }
}

TEST_CASE(
    "keys that are missing at the start are named and waited for, and pressure is never taken unsigned") {
  const Site site;
  const fs::path folder = site.folder.path() / "later";
  fs::create_directory(folder);
  Robot robot(robot_with(folder));
  CHECK(robot.says("bridge/keys", kError));
  CHECK(robot.text("bridge/keys") ==
        (folder / "certificate.pem").string() + ": cannot be read: No such file or directory");
  Base base;
  base.name = "roof";
  const Sender forger(robot.participant(), base);
  const dds::SecureParticipant member({}, site.roof);
  base.pressure_pa = 97'500.0;
  const Sender sender(member.get(), base);
  CHECK(robot.receive_for(2s).empty());
  for (const auto& file : fs::directory_iterator(site.robot)) fs::copy(file, folder / file.path().filename());
  const std::vector<Got> got = robot.receive(20);
  CHECK(got.size() == 20);
  for (const Got& sample : got) CHECK(sample.pressure_pa == 97'500.0);
  CHECK(robot.says("bridge/keys", kOk));
}

TEST_CASE(
    "keys that are replaced by new ones are read again, without a restart and without a gap in the poses") {
  const Site site;
  keys::add_member(site.store, {"other", ""}, 10);
  const fs::path folder = site.folder.path() / "robot";
  fs::copy(site.robot, folder);
  Robot robot(robot_with(folder));
  const dds::SecureParticipant member({}, site.roof);
  Base base;
  base.name = "roof";
  const Sender sender(member.get(), base);
  REQUIRE(robot.receive(20).size() == 20);
  // Half of the new keys: the old ones stay in use, and the file is named.
  const auto replace = [&](const char* name) {
    fs::copy_file(site.store / "other" / name, folder / name, fs::copy_options::overwrite_existing);
  };
  replace("certificate.pem");
  CHECK(robot.says("bridge/keys", kWarning));
  CHECK(robot.text("bridge/keys") ==
        (folder / "key.pem").string() + ": must be the private key of certificate.pem beside it");
  robot.forget();
  REQUIRE(robot.receive(20).size() == 20);
  replace("key.pem");
  replace("permissions.p7s");
  CHECK(robot.says("bridge/keys", kOk));
  std::this_thread::sleep_for(3s);
  robot.forget();
  for (const Got& got : robot.receive(20)) CHECK(got.pressure_pa == 98'000.25);
  CHECK(robot.is_same_bridge());
}

TEST_CASE(
    "a base station that is revoked is refused as soon as the robot has the list, and the others are not") {
  const Site site;
  keys::add_member(site.store, {"new_roof", "roof"}, 10);
  const fs::path folder = site.folder.path() / "robot";
  fs::copy(site.robot, folder);
  Robot robot(robot_with(folder));
  std::optional<dds::SecureParticipant> stolen(std::in_place, dds::ParticipantSettings{}, site.roof);
  Base base;
  base.name = "roof";
  auto sender = std::make_unique<Sender>(stolen->get(), base);
  REQUIRE(robot.receive(20).size() == 20);
  fs::copy_file(keys::revoke_member(site.store, "roof").list, folder / "revoked.pem");
  CHECK(robot.says("bridge/keys/refused", kWarning));
  robot.forget();
  CHECK(robot.receive_for(1s).empty());
  CHECK(robot.is_same_bridge());
  sender.reset();
  stolen.reset();
  const dds::SecureParticipant member({}, site.store / "new_roof");
  base.pressure_pa = 97'500.0;
  const Sender replacement(member.get(), base);
  const std::vector<Got> got = robot.receive(20);
  CHECK(got.size() == 20);
  for (const Got& sample : got) CHECK(sample.pressure_pa == 97'500.0);
}

TEST_CASE("a base station signs: members receive it, others do not; with a robot's keys it sends nothing") {
  const Site site;
  const auto config_with = [](const fs::path& keys) {
    return write_config("base",
                        "role = \"base-station\"\n[dds]\nbase_station = \"roof\"\nkeys_directory = \"" +
                            keys.string() + "\"\n");
  };
  const auto plain = std::make_shared<dds::Participant>(dds::ParticipantSettings{});
  Listener<dds::DiagnosticsMessage> diagnostics(plain, dds::topics::kDiagnostics);
  dds::Reader<dds::PressureMessage> unsigned_reader(plain->get(), dds::topics::kBasePressure, "roof");
  dds::SecureParticipant member({}, site.robot);
  dds::Reader<dds::PressureMessage> signed_reader(member.get(), dds::topics::kBasePressure, "roof");
  const Barometer barometer(7373, datagram::Kind::kPressure);
  const std::string config = config_with(site.roof);
  ChildProcess daemon({ISOBAR_DAEMON, "--config", config});
  REQUIRE(daemon.read_until("ready: base station \"roof\"", 20s));
  const auto count = [](auto& reader, int wanted) {
    int received = 0;
    for (int i = 0; i < 100 && received < wanted; ++i) {
      std::this_thread::sleep_for(100ms);
      reader.take([&](const dds::PressureMessage&) { ++received; });
    }
    return received;
  };
  {
    ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
    CHECK(count(signed_reader, 20) >= 20);
    CHECK(count(unsigned_reader, 0) == 0);
    CHECK(dds_get_matched_publications(unsigned_reader.get(), nullptr, 0) == 0);
    bridge.signal(SIGTERM);
    CHECK(bridge.wait(20s) == 0);
  }
  const ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config_with(site.robot)});
  CHECK(diagnostics.receive(1, [](const auto& message) {
    return says(message, "isobar_roof: bridge/keys", kError) &&
           text_of(message, "isobar_roof: bridge/keys").find("must permit to write rt/roof/fluid_pressure") !=
               std::string::npos;
  }));
  CHECK(dds_get_matched_publications(unsigned_reader.get(), nullptr, 0) == 0);
  CHECK(dds_get_matched_publications(signed_reader.get(), nullptr, 0) == 0);
}

}  // namespace

}  // namespace isobar::test::test_signed_base_station
