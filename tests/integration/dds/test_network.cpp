// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds while network interfaces come, go and change. The test runs in a network namespace of its own
// with a pair of virtual interfaces: wlan0, the robot's, and ap, a peer's.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/dds/listener.hpp"
#include "tests/integration/dds/stand_in.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_network {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest gap that one stalled scheduling of a loaded test machine adds.
constexpr auto kStall = 400ms;

bool has_namespaces() { return std::getenv("ISOBAR_ISOLATED") != nullptr; }

void ip(const std::string& arguments) {
  REQUIRE(std::system(("ip " + arguments).c_str()) == 0);  // NOLINT(concurrency-mt-unsafe): one thread
}

/// The robot's Wi-Fi, without an address at first.
class Wifi {
 public:
  Wifi() {
    ip("link add wlan0 type veth peer name ap");
    ip("link set ap up");
    ip("link set wlan0 up");
  }
  ~Wifi() { static_cast<void>(std::system("ip link delete wlan0")); }  // NOLINT(concurrency-mt-unsafe)
  Wifi(const Wifi&) = delete;
  Wifi& operator=(const Wifi&) = delete;

  void set_address(const std::string& address) const { ip("addr add " + address + "/24 dev wlan0"); }
  void lose_address() const { ip("addr flush dev wlan0"); }
};

std::string write_network_config(const std::string& text) {
  std::string file = "/tmp/isobar-network-test.toml";
  std::ofstream(file) << "[dds]\n" << text;
  return file;
}

/// Subscriber on loopback alone: a process of this machine.
template <class Message>
class LocalListener {
 public:
  explicit LocalListener(const dds::DdsTopic<Message>& topic, const std::string& name = "")
      : participant_(std::make_shared<dds::Participant>(settings())),
        reader_(participant_->get(), topic, "", name) {}

  /// Takes messages for `time`.
  template <class Use>
  void listen(std::chrono::milliseconds time, Use&& use) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
      reader_.take(use);
      std::this_thread::sleep_for(2ms);
    }
  }

 private:
  static dds::ParticipantSettings settings() {
    dds::ParticipantSettings lo;
    lo.network_interface = "lo";
    return lo;
  }
  std::shared_ptr<dds::Participant> participant_;
  dds::Reader<Message> reader_;
};

/// Counts the poses received and those that are missing between the first and the last, by their stamps.
class PoseCount {
 public:
  void operator()(const dds::PoseMessage& message) {
    stamps_ns_.push_back(dds::to_stamp_ns(message.header.stamp));
    const auto now = std::chrono::steady_clock::now();
    if (stamps_ns_.size() > 1) largest_gap_ = std::max(largest_gap_, now - last_);
    last_ = now;
  }
  [[nodiscard]] std::size_t count() const { return stamps_ns_.size(); }
  [[nodiscard]] long missing() const {
    constexpr std::int64_t kPeriodNs = stand_in::kPriorPeriodNs * stand_in::kPriorsPerScan;
    // Rounded: published stamps follow the system clock, so that a period may be microseconds shorter.
    const std::int64_t span_ns = stamps_ns_.back() - stamps_ns_.front();
    return (span_ns + kPeriodNs / 2) / kPeriodNs + 1 - static_cast<long>(stamps_ns_.size());
  }
  [[nodiscard]] std::chrono::milliseconds largest_gap() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(largest_gap_);
  }

 private:
  std::vector<std::int64_t> stamps_ns_;
  std::chrono::steady_clock::time_point last_;
  std::chrono::steady_clock::duration largest_gap_{};
};

TEST_CASE("an interface that is not there is waited for, and loopback serves this machine meanwhile") {
  if (!has_namespaces()) return;
  const std::string config = write_network_config("network_interface = \"wlan0\"\n");
  LocalListener<dds::PoseMessage> listener(dds::topics::kPose);
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  CHECK(bridge.read_until("network_interface: wlan0 is not up or has no IPv4 address", 10s));
  CHECK(bridge.read_until("attached", 10s));
  PoseCount poses;
  listener.listen(3s, poses);
  CHECK(poses.count() >= 10);
  const Wifi wifi;
  wifi.set_address("10.0.0.5");
  CHECK(bridge.read_until("wlan0 (10.0.0.5)", 10s));
  bridge.signal(SIGTERM);
  CHECK(bridge.wait(10s) == 0);
  CHECK(bridge.output().find("waiting for it") == bridge.output().rfind("waiting for it"));  // said once
}

TEST_CASE("while Wi-Fi loses its address and gets another, a subscriber of this machine loses no pose") {
  if (!has_namespaces()) return;
  const Wifi wifi;
  wifi.set_address("10.0.0.5");
  const std::string config = write_network_config("network_interface = \"wlan0\"\n");
  LocalListener<dds::PoseMessage> listener(dds::topics::kPose);
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  REQUIRE(bridge.read_until("wlan0 (10.0.0.5)", 10s));
  REQUIRE(bridge.read_until("attached", 10s));
  PoseCount poses;
  listener.listen(2s, poses);
  REQUIRE(poses.count() >= 10);
  wifi.lose_address();
  listener.listen(4s, poses);
  wifi.set_address("10.0.0.6");
  listener.listen(4s, poses);
  CHECK(poses.missing() == 0);
  // The participant is made anew within 0.2 s; a pose comes every 0.1 s.
  CHECK(poses.largest_gap() < 300ms + kStall);
  bridge.signal(SIGTERM);
  CHECK(bridge.wait(10s) == 0);
  std::string line;
  int lines = 0;
  while (bridge.read_line(line, 1s)) ++lines;
  CHECK(bridge.output().find("wlan0 (10.0.0.6)") != std::string::npos);
  CHECK(lines < 15);  // not one for each message that could not be sent
}

TEST_CASE("without a configured interface all are used: an Ethernet lidar does not hide Wi-Fi") {
  if (!has_namespaces()) return;
  const Wifi wifi;
  ip("addr add 192.168.1.77/24 dev ap");  // stands for the lidar's network
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  CHECK(bridge.read_until("on lo (127.0.0.1), ap (192.168.1.77)", 10s));
  wifi.set_address("10.0.0.5");
  CHECK(bridge.read_until("wlan0 (10.0.0.5)", 10s));
}

TEST_CASE("ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY and CYCLONEDDS_URI are followed and named in the log") {
  const std::string uri =
      "<CycloneDDS><Domain><General><MaxMessageSize>4000B</MaxMessageSize></General></Domain>"
      "</CycloneDDS>";
  ChildProcess bridge({"/usr/bin/env", "ROS_DOMAIN_ID=7", "ROS_LOCALHOST_ONLY=1", "CYCLONEDDS_URI=" + uri,
                       ISOBAR_DDS_PROGRAM});
  CHECK(bridge.read_until("configured by CYCLONEDDS_URI", 10s));
  CHECK(bridge.read_until("DDS domain 7 on lo (127.0.0.1)", 10s));
  CHECK(bridge.output().find("ROS_LOCALHOST_ONLY") != std::string::npos);
  ChildProcess no_domain({"/usr/bin/env", "ROS_DOMAIN_ID=300", ISOBAR_DDS_PROGRAM});
  CHECK(no_domain.read_until("ROS_DOMAIN_ID", 10s));
  CHECK(no_domain.wait(10s) == 78);
}

TEST_CASE("topics are renamed, frames get a prefix, and a transform that another node owns is left out") {
  const std::string config = write_network_config(
      "network_interface = \"lo\"\nframe_prefix = \"robot1/\"\npublish_tf_map_odom = false\n"
      "[dds.topics]\npose = \"localisation/pose\"\ntf = \"robot1/tf\"\n");
  ChildProcess stand_in({ISOBAR_STAND_IN});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  {
    LocalListener<dds::PoseMessage> poses(dds::topics::kPose, "localisation/pose");
    std::string frame;
    poses.listen(3s, [&](const dds::PoseMessage& message) { frame = message.header.frame_id; });
    CHECK(frame == "robot1/map");
  }
  LocalListener<dds::TfMessage> transforms(dds::topics::kTf, "robot1/tf");
  std::string child;
  std::uint32_t count = 0;
  transforms.listen(3s, [&](const dds::TfMessage& message) {
    count = message.transforms._length;
    child = message.transforms._buffer[0].child_frame_id;
  });
  CHECK(count == 1);
  CHECK(child == "robot1/base_link");
}

TEST_CASE("before the first registration there is neither a pose nor odometry nor a transform") {
  ChildProcess stand_in({ISOBAR_STAND_IN, "--initializing"});
  REQUIRE(stand_in.read_until("ready", 10s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM});
  REQUIRE(bridge.read_until("attached", 10s));
  {
    LocalListener<dds::PoseMessage> poses(dds::topics::kPose);
    int count = 0;
    poses.listen(2s, [&](const dds::PoseMessage&) { ++count; });
    CHECK(count == 0);
  }
  {
    LocalListener<dds::OdometryMessage> odometry(dds::topics::kOdom);
    int count = 0;
    odometry.listen(2s, [&](const dds::OdometryMessage&) { ++count; });
    CHECK(count == 0);
  }
  LocalListener<dds::DiagnosticsMessage> diagnostics(dds::topics::kDiagnostics);
  int count = 0;
  diagnostics.listen(4s, [&](const dds::DiagnosticsMessage&) { ++count; });
  CHECK(count > 0);  // the bridge does publish
}

}  // namespace

}  // namespace isobar::test::test_network
