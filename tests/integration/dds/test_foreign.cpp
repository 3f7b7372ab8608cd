// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds with a subscriber of another vendor's DDS, in another process. The received bytes stay in a
// folder for decode.js.
#include <doctest/doctest.h>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/integration/dds/stand_in.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_foreign {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;

const std::string kFolder = ISOBAR_CAPTURE_FOLDER;

/// Decodes one captured message with the other vendor's code, member by member.
class Message {
 public:
  explicit Message(const std::string& topic) {
    std::ifstream file(kFolder + "/" + topic + ".cdr", std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    REQUIRE(bytes_.size() > 4);
    buffer_ = std::make_unique<eprosima::fastcdr::FastBuffer>(bytes_.data(), bytes_.size());
    cdr_ = std::make_unique<eprosima::fastcdr::Cdr>(*buffer_, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                                    eprosima::fastcdr::Cdr::DDS_CDR);
    cdr_->read_encapsulation();
  }
  template <class T>
  T read() {
    T value{};
    *cdr_ >> value;
    return value;
  }
  Eigen::Vector3d read_vector() {
    const double x = read<double>();
    const double y = read<double>();
    return {x, y, read<double>()};
  }
  Eigen::Quaterniond read_quaternion() {
    const Eigen::Vector3d xyz = read_vector();
    return {read<double>(), xyz.x(), xyz.y(), xyz.z()};
  }
  /// Stamp [s] and frame.
  std::pair<double, std::string> read_header() {
    const auto seconds = read<std::int32_t>();
    const auto nanoseconds = read<std::uint32_t>();
    return {seconds + 1e-9 * nanoseconds, read<std::string>()};
  }

 private:
  std::vector<char> bytes_;
  std::unique_ptr<eprosima::fastcdr::FastBuffer> buffer_;
  std::unique_ptr<eprosima::fastcdr::Cdr> cdr_;
};

/// Checks that a position lies on the stand-in's drive, independently of its start time.
void check_position(const Eigen::Vector3d& position, double tolerance_m) {
  CHECK(position.x() > 0.1);
  CHECK(position.y() == doctest::Approx(2.0));
  CHECK(std::abs(position.z() - stand_in::kClimbMS / stand_in::kSpeedMS * position.x()) < tolerance_m);
}

void check_rotation(const Eigen::Quaterniond& q, double yaw_rad) {
  const Eigen::Quaterniond wanted(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  CHECK(q.angularDistance(wanted) < 1e-7);
}

/// The listener's line about a topic.
struct Line {
  long count = 0;
  long bytes = 0;
  long largest_gap_ms = 0;
};

Line find_line(const std::string& output, const std::string& topic) {
  std::istringstream lines(output);
  std::string name;
  for (Line line; lines >> name >> line.count >> line.bytes >> line.largest_gap_ms;) {
    if (name == topic) {
      return line;
    }
  }
  return {};
}

/// Output of the listener, from one run of all programs shared by all cases.
const std::string& capture() {
  static const std::string kOutput = [] {
    std::filesystem::remove_all(kFolder);
    std::filesystem::create_directories(kFolder);
    ChildProcess stand_in({ISOBAR_STAND_IN});
    REQUIRE(stand_in.read_until("ready", 10s));
    ChildProcess bridge({ISOBAR_DDS_PROGRAM});
    REQUIRE(bridge.read_until("attached", 10s));
    // A late reader: tf_static, ros_discovery_info and a map are sent before the listener starts.
    CHECK(stand_in.read_until("priors 200", 10s));
    ChildProcess listener({ISOBAR_FOREIGN_LISTENER, kFolder, "0", "5"});
    REQUIRE(listener.wait(30s) == 0);
    std::string line;
    while (listener.read_line(line, 1s)) {
    }
    return listener.output();
  }();
  return kOutput;
}

TEST_CASE("every topic arrives at its rate") {
  const std::string& output = capture();
  INFO(output);
  // Discovery may take two of the five seconds; the limits leave another two for a loaded machine.
  CHECK(find_line(output, "rt/odom").count >= 100);
  CHECK(find_line(output, "rt/odom").count <= 510);  // 100 Hz at most
  CHECK(find_line(output, "rt/tf").count >= 100);
  CHECK(find_line(output, "rt/pose").count >= 10);
  CHECK(find_line(output, "rt/altitude").count >= 10);
  CHECK(find_line(output, "rt/altitude").count <= 52);  // 10 Hz at most
  CHECK(find_line(output, "rt/registered_scan").count >= 10);
  CHECK(find_line(output, "rt/diagnostics").count >= 1);
}

TEST_CASE("a late reader gets the latched topics") {
  const std::string& output = capture();
  CHECK(find_line(output, "rt/tf_static").count == 1);
  CHECK(find_line(output, "ros_discovery_info").count >=
        1);  // again with the first grid, whose writer is made then
  CHECK(find_line(output, "rt/map_cloud").count >= 1);
  // What is sent again through shared memory is published once.
  CHECK(find_line(output, "rt/map").count == 1);
  CHECK(find_line(output, "rt/floor").count == 1);
  CHECK(find_line(output, "rt/floor_name").count == 1);
}

TEST_CASE("odometry has the frames and values of the drive") {
  capture();
  Message message("rt.odom");
  CHECK(message.read_header().second == "odom");
  CHECK(message.read<std::string>() == "base_link");
  check_position(message.read_vector(), 1e-9);
  check_rotation(message.read_quaternion(), stand_in::kYawRad);
  const auto covariance = message.read<std::array<double, 36>>();
  CHECK(covariance[35] == doctest::Approx(0.06).epsilon(0.01));
  const Eigen::Vector3d v_base = message.read_vector();
  CHECK((v_base - stand_in::prior_at(0, 0).v_base_m_s).norm() < 1e-12);
}

TEST_CASE("the pose has the frame, values and covariance of the registration") {
  capture();
  Message message("rt.pose");
  CHECK(message.read_header().second == "map");
  check_position(message.read_vector(), 1e-9);
  check_rotation(message.read_quaternion(), stand_in::kYawRad);
  const auto covariance = message.read<std::array<double, 36>>();
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(covariance[7 * i] == doctest::Approx(0.01 * static_cast<double>(i + 1)));
  }
  CHECK(covariance[5] == 0.001);
  CHECK(covariance[30] == 0.001);
}

TEST_CASE("tf has map to odom to base_link, with the pose as product; tf_static has the mounts") {
  capture();
  Message tf("rt.tf");
  REQUIRE(tf.read<std::uint32_t>() == 2);
  Eigen::Isometry3d product = Eigen::Isometry3d::Identity();
  for (const auto& [parent, child] : {std::pair{"map", "odom"}, std::pair{"odom", "base_link"}}) {
    CHECK(tf.read_header().second == parent);
    CHECK(tf.read<std::string>() == child);
    const Eigen::Vector3d translation = tf.read_vector();
    product = product * Eigen::Translation3d(translation) * tf.read_quaternion();
  }
  check_position(product.translation(), 1e-9);
  check_rotation(Eigen::Quaterniond(product.linear()), stand_in::kYawRad);

  Message tf_static("rt.tf_static");
  REQUIRE(tf_static.read<std::uint32_t>() == 3);
  for (const char* child : {"lidar", "imu", "barometer"}) {
    CHECK(tf_static.read_header().second == "base_link");
    CHECK(tf_static.read<std::string>() == child);
    tf_static.read_vector();
    tf_static.read_quaternion();
  }
}

TEST_CASE("clouds arrive complete") {
  capture();
  Message map("rt.map_cloud");
  CHECK(map.read_header().second == "map");
  CHECK(map.read<std::uint32_t>() == 1);
  CHECK(map.read<std::uint32_t>() == stand_in::kMapPoints);
  CHECK(find_line(capture(), "rt/map_cloud").bytes > 16L * stand_in::kMapPoints);
}

TEST_CASE(
    "the grid of the floor has the layout of nav_msgs/OccupancyGrid, and the floor its number and name") {
  capture();
  Message grid("rt.map");
  const auto [stamp_s, frame] = grid.read_header();
  CHECK(frame == "map");
  const auto load_s = grid.read<std::int32_t>();
  const auto load_ns = grid.read<std::uint32_t>();
  CHECK(load_s + 1e-9 * load_ns == doctest::Approx(stamp_s));
  CHECK(grid.read<float>() == 0.05F);
  CHECK(grid.read<std::uint32_t>() == stand_in::kGridWidth);
  CHECK(grid.read<std::uint32_t>() == stand_in::kGridHeight);
  const Eigen::Vector3d origin = grid.read_vector();
  CHECK(origin == Eigen::Vector3d(stand_in::kGridOriginXM, stand_in::kGridOriginYM, stand_in::kFloorZM));
  check_rotation(grid.read_quaternion(), 0.0);
  const auto cells = grid.read<std::vector<std::int8_t>>();
  REQUIRE(cells.size() == stand_in::kGridWidth * stand_in::kGridHeight);
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) wrong += cells[i] == stand_in::cell_at(i) ? 0 : 1;
  CHECK(wrong == 0);
  CHECK(Message("rt.floor").read<std::int32_t>() == stand_in::kFloor);
  CHECK(Message("rt.floor_name").read<std::string>() == stand_in::kFloorName);
}

TEST_CASE("diagnostics have the entries of isobard and of the bridge") {
  capture();
  Message message("rt.diagnostics");
  message.read_header();
  REQUIRE(message.read<std::uint32_t>() >= 3);
  // The summary, with the level of isobard's worst entry, lidar/packets_lost.
  CHECK(message.read<std::uint8_t>() == 1);
  CHECK(message.read<std::string>() == "isobar: summary");
  CHECK(message.read<std::string>().find("lidar/packets_lost") != std::string::npos);
  CHECK(message.read<std::string>() == "isobar");
  REQUIRE(message.read<std::uint32_t>() == 1);
  CHECK(message.read<std::string>() == "value");
  message.read<std::string>();
  CHECK(message.read<std::uint8_t>() == 0);
  CHECK(message.read<std::string>() == "isobar: lidar/packets");
}

}  // namespace

}  // namespace isobar::test::test_foreign
