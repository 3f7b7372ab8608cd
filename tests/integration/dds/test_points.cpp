// SPDX-License-Identifier: BSD-3-Clause
// Clouds of a ROS 2 lidar driver, through isobar-dds, to poses of isobard.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "run/recording/recording_reader.hpp"
#include "tests/integration/dds/base_station_peers.hpp"

namespace isobar::test::test_points {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

constexpr std::uint8_t kUint16 = 4;  // sensor_msgs/PointField
constexpr std::uint8_t kUint32 = 6;
constexpr std::uint8_t kFloat32 = 7;

/// A lidar of 16 beams that stands in a room of 16 x 12 x 3 m and turns ten times a second.
class LidarNode {
 public:
  explicit LidarNode(dds_entity_t participant) : writer_(participant, dds::topics::kPoints) {
    fields_ = {{dds::text("x"), 0, kFloat32, 1},
               {dds::text("y"), 4, kFloat32, 1},
               {dds::text("z"), 8, kFloat32, 1},
               {dds::text("ring"), 12, kUint16, 1},
               {dds::text("t"), 16, kUint32, 1}};
    for (int column = 0; column < kColumns; ++column) {
      for (int beam = 0; beam < kBeams; ++beam) add_point(column, beam);
    }
  }

  /// Publishes one turn that ends now.
  void publish(bool is_broken = false) {
    dds::CloudMessage message{};
    message.header = {dds::to_time(wall_ns() - kTurnNs), dds::text("lidar")};
    message.height = 1;
    message.width = kColumns * kBeams;
    message.fields._buffer = fields_.data();
    message.fields._length = message.fields._maximum = static_cast<std::uint32_t>(fields_.size());
    message.point_step = kStep;
    message.row_step = message.width * kStep;
    message.data._buffer = data_.data();
    message.data._length = message.data._maximum =
        static_cast<std::uint32_t>(is_broken ? data_.size() / 2 : data_.size());
    writer_.write(message);
  }

 private:
  static constexpr int kColumns = 450;
  static constexpr int kBeams = 16;

 public:
  static constexpr std::uint32_t kPoints = kColumns * kBeams;

 private:
  static constexpr std::uint32_t kStep = 20;
  static constexpr std::int64_t kTurnNs = 100'000'000;

  void add_point(int column, int beam) {
    const double azimuth = 2.0 * std::numbers::pi * column / kColumns;
    const double elevation = (2.0 * beam - 15.0) * std::numbers::pi / 180.0;
    const double direction[3] = {std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth),
                                 std::sin(elevation)};                  // NOLINT(modernize-avoid-c-arrays)
    const double wall[3] = {8.0, 6.0, direction[2] > 0.0 ? 2.0 : 1.0};  // NOLINT(modernize-avoid-c-arrays)
    double range_m = 100.0;
    for (int axis = 0; axis < 3; ++axis) range_m = std::min(range_m, wall[axis] / std::abs(direction[axis]));
    const std::size_t at = data_.size();
    data_.resize(at + kStep);
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<float>(range_m * direction[axis]);
      std::memcpy(&data_[at + 4 * static_cast<std::size_t>(axis)], &value, 4);
    }
    const auto ring = static_cast<std::uint16_t>(beam);
    const auto time_ns = static_cast<std::uint32_t>(kTurnNs / kColumns * column);
    std::memcpy(&data_[at + 12], &ring, 2);
    std::memcpy(&data_[at + 16], &time_ns, 4);
  }

  dds::Writer<dds::CloudMessage> writer_;
  std::vector<sensor_msgs_msg_dds__PointField_> fields_;
  std::vector<std::uint8_t> data_;
};

/// Clouds of a recording, of which each must hold all points of a turn.
int whole_clouds(const std::filesystem::path& folder) {
  recording::RecordingReader reader(folder);
  int clouds = 0;
  recording::Event event;
  while (reader.next(event)) {
    REQUIRE(event.kind == recording::EventKind::kCloud);
    CHECK(event.cloud->width == LidarNode::kPoints);
    ++clouds;
  }
  return clouds;
}

TEST_CASE("a lidar's clouds over DDS are registered, a broken cloud is refused and said, and silence is") {
  const std::string config =
      write_config("points",
                   "lidar.source = \"dds\"\nimu.source = \"none\"\nbarometer.source = \"none\"\n"
                   "black_box.directory = \"/tmp/box\"\n"
                   "[input]\nexpect_base_station = false\n");
  auto participant = std::make_shared<dds::Participant>(dds::ParticipantSettings{});
  Listener<dds::PoseMessage> poses(participant, dds::topics::kPose);
  Listener<dds::DiagnosticsMessage> diagnostics(participant, dds::topics::kDiagnostics);
  ChildProcess daemon({ISOBAR_DAEMON, "--config", config});
  REQUIRE(daemon.read_until("ready: lidar clouds over DDS", 20s));
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  REQUIRE(bridge.read_until("attached", 20s));

  {
    LidarNode lidar(participant->get());
    int turns = 0;
    const Ticker ticker([&lidar, &turns] {
      // Every fourth step of 25 ms; each twentieth cloud ends early.
      if (++turns % 4 == 0) lidar.publish(turns % 80 == 0);
    });
    int registered = 0;
    CHECK(poses.receive(30, [&registered](const dds::PoseMessage& message) {
      const auto& p = message.pose.pose.position;
      // A lidar that stands still, in noise-free walls.
      CHECK(std::hypot(p.x, p.y, p.z) < 0.05);
      return ++registered > 0;
    }));
    CHECK(diagnostics.receive(1, [](const auto& message) { return says(message, "isobar: lidar", kOk); }));
    CHECK(bridge.read_until(
        "lidar clouds: times from t in ns, relative to the stamp; rings from ring; no intensity", 5s));
    CHECK(bridge.read_until("a cloud is refused: data is shorter than its points", 10s));
    // Recorder and black box keep them.
    ChildProcess recorder({ISOBAR_TOOL, "record", "/tmp/recorded", "--for", "2", "--min-free", "1"});
    CHECK(recorder.wait(30s) == 0);
    CHECK(whole_clouds("/tmp/recorded") >= 10);
    daemon.signal(SIGUSR1);
    CHECK(daemon.read_until("black box saved (signal)", 20s));
    for (const auto& saved : std::filesystem::directory_iterator("/tmp/box")) {
      CHECK(whole_clouds(saved.path()) >= 10);
    }
  }
  CHECK(diagnostics.receive(1, [](const auto& message) {
    return says(message, "isobar: lidar", kError) &&
           text_of(message, "isobar: lidar").find("DDS, topic points") != std::string::npos;
  }));
}

}  // namespace

}  // namespace isobar::test::test_points
