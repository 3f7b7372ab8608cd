// SPDX-License-Identifier: BSD-3-Clause
// Bags as public data sets lay them out: several topics of a kind, frames without mounts, stamps that tell nothing.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/run/import/bag_builder.hpp"
#include "tests/run/import/message_builder.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/import/imported.hpp"
#include "tools/import/import_source.hpp"

namespace isobar::test::test_import_choices {
namespace {

using namespace tools;

constexpr std::int64_t kBeginNs = 1'700'000'000'000'000'000;
const std::vector<int> kInOrder{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

/// A topic of a bag and the frame of its messages.
struct Sender {
  std::string topic;
  std::string type;
  std::string frame;
  double pressure_pa = 100'000.0;
  bool has_stamps = true;
};

std::string message_of_type(const Sender& sender, std::int64_t ns) {
  const std::int64_t stamp_ns = sender.has_stamps ? ns : 0;
  if (sender.type == "sensor_msgs/Imu") {
    return imu_message(Form::kRos1, stamp_ns, sender.frame, {0, 0, 0, 1}, {0, 0, 0.1}, {0, 0, 9.81});
  }
  if (sender.type == "sensor_msgs/FluidPressure") {
    return pressure_message(Form::kRos1, stamp_ns, sender.frame, sender.pressure_pa, 0.0);
  }
  std::vector<TestPoint> points;
  for (int k = 0; k < 40; ++k) {
    const float angle = 0.157F * static_cast<float>(k);
    points.push_back(
        {5.0F * std::cos(angle), 5.0F * std::sin(angle), 1.0F, 0.002F * static_cast<float>(k), 3});
  }
  return cloud_message(Form::kRos1, stamp_ns, sender.frame, points);
}

/// One second of all senders at 10 Hz.
/// @param order of the messages in the file
/// @param frames parent and child of each transform
Imported import_of(const std::vector<Sender>& senders, ImportRequest request = {},
                   const std::vector<int>& order = kInOrder, const std::vector<std::string>& frames = {}) {
  const TemporaryFolder folder;
  std::vector<BagTopic> topics{{"/tf_static", "tf2_msgs/TFMessage"}};
  std::vector<BagMessage> messages;
  for (std::size_t i = 0; i + 1 < frames.size(); i += 2) {
    messages.push_back(
        {0, kBeginNs, transform_message(Form::kRos1, frames[i], frames[i + 1], {0.1, 0, 0.2, 0, 0, 0, 1})});
  }
  for (const Sender& sender : senders) topics.push_back({sender.topic, sender.type});
  for (const int i : order) {
    for (std::size_t k = 0; k < senders.size(); ++k) {
      const std::int64_t ns = kBeginNs + i * std::int64_t{100'000'000};
      messages.push_back({k + 1, ns, message_of_type(senders[k], ns)});
    }
  }
  write_bytes(folder.path() / "x.bag", rosbag1_file(topics, messages, "lz4"));
  request.source = folder.path() / "x.bag";
  return import_and_read(request);
}

const Sender kPoints{"/velodyne_points", "sensor_msgs/PointCloud2", "velodyne"};

}  // namespace

TEST_CASE("the lidar's own cloud is told from maps, depth cameras and radars beside it") {
  const Imported imported = import_of({kPoints,
                                       {"/camera/depth/points", "sensor_msgs/PointCloud2", "camera_depth"},
                                       {"/radar_pcl2", "sensor_msgs/PointCloud2", "radar"},
                                       {"/cloud_registered", "sensor_msgs/PointCloud2", "camera_init"},
                                       {"/velodyne_cloud_3", "sensor_msgs/PointCloud2", "map"}});
  CHECK(imported.becomes("/velodyne_points").find("lidar.clouds") == 0);
  CHECK(imported.becomes("/radar_pcl2").find("nothing") == 0);
  // Alone it is taken all the same: a bag of nothing but filtered clouds is a lidar's.
  CHECK(import_of({{"/filtered_points", "sensor_msgs/PointCloud2", "lidar"}})
            .becomes("/filtered_points")
            .find("lidar.clouds") == 0);
}

TEST_CASE("of several IMUs the one whose mount is known is used, not a raw copy nor a camera's") {
  const std::vector<Sender> senders{kPoints,
                                    {"/imu/data", "sensor_msgs/Imu", "imu_link"},
                                    {"/imu/data_raw", "sensor_msgs/Imu", "imu_link"},
                                    {"/camera/imu", "sensor_msgs/Imu", "camera_imu"}};
  // A chain of two frames: base_link -> imu_mount -> imu_link.
  const Imported imported = import_of(
      senders, {}, kInOrder, {"base_link", "velodyne", "base_link", "imu_mount", "imu_mount", "imu_link"});
  CHECK(imported.becomes("/imu/data").find("imu.csv") == 0);
  REQUIRE(imported.manifest.imu);
  CHECK(imported.manifest.imu->mount.xyz_m.isApprox(Eigen::Vector3d(0.2, 0.0, 0.4)));
  // A Livox's IMU is in the frame of its points.
  const Imported livox = import_of({{"/livox/lidar", "sensor_msgs/PointCloud2", "livox_frame"},
                                    {"/livox/imu", "sensor_msgs/Imu", "livox_frame"},
                                    {"/mavros/imu/data", "sensor_msgs/Imu", "base_link"}});
  CHECK(livox.becomes("/livox/imu").find("imu.csv") == 0);
}

TEST_CASE("all that must be asked is asked at once; a replay leaves the IMU out instead") {
  const std::vector<Sender> senders{kPoints,
                                    {"/points2", "sensor_msgs/PointCloud2", "b"},
                                    {"/imu1", "sensor_msgs/Imu", "imu1"},
                                    {"/imu2", "sensor_msgs/Imu", "imu2"}};
  const std::string questions = message_of([&] { import_of(senders); });
  CHECK(questions.find("--lidar: there are several: /velodyne_points, /points2") == 0);
  CHECK(questions.find("\n--imu: there are several: /imu1, /imu2") != std::string::npos);
  ImportRequest replay{.lidar = "/points2", .asks_nothing = true};
  const Imported several = import_of(senders, replay);
  CHECK_FALSE(several.manifest.imu.has_value());
  CHECK(several.notes().find("imu: left out: --imu: there are several") != std::string::npos);
  const std::vector<Sender> one{kPoints, {"/imu1", "sensor_msgs/Imu", "imu1"}};
  CHECK(message_of([&] { import_of(one); }).find("--mount: how the IMU (imu1) sits") == 0);
  replay.lidar.clear();
  const Imported alone = import_of(one, replay);
  CHECK(alone.becomes("/imu1") == "nothing: its mount is not known");
  CHECK(alone.notes().find("imu: left out: --mount: how the IMU (imu1) sits") != std::string::npos);
  // An IMU that a person named is asked about.
  replay.imu = "/imu1";
  CHECK(message_of([&] { import_of(one, replay); }).find("--mount: how the IMU") == 0);
}

TEST_CASE("an airspeed sensor beside a barometer is no second barometer") {
  const Imported imported =
      import_of({kPoints,
                 {"/mavros/imu/static_pressure", "sensor_msgs/FluidPressure", "fcu"},
                 {"/mavros/imu/diff_pressure", "sensor_msgs/FluidPressure", "fcu", 3.0}});
  CHECK(imported.becomes("/mavros/imu/static_pressure") == "barometer.csv: Pa");
}

TEST_CASE("messages without stamps take the recorder's times, and messages out of order are sorted") {
  const Imported imported = import_of({{"/points", "sensor_msgs/PointCloud2", "lidar", 0.0, false},
                                       {"/pressure", "sensor_msgs/FluidPressure", "lidar", 100'000.0, true}},
                                      {}, {0, 2, 1, 3, 4, 6, 5, 7, 8, 9});
  CHECK(imported.notes().find("clock: /points: its messages tell no time; the recorder's times are used") !=
        std::string::npos);
  std::vector<std::int64_t> stamps;
  std::int64_t first_cloud_ns = 0;
  for (const recording::Event& event : imported.events) {
    if (event.kind == recording::EventKind::kPressure) stamps.push_back(event.stamp_ns);
    if (event.kind == recording::EventKind::kCloud && first_cloud_ns == 0) first_cloud_ns = event.stamp_ns;
  }
  CHECK(first_cloud_ns == kBeginNs);
  CHECK(stamps.size() == 10);
  CHECK(std::is_sorted(stamps.begin(), stamps.end()));
}

}  // namespace isobar::test::test_import_choices
