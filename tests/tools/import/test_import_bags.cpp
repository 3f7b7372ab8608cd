// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/errors.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/run/import/bag_builder.hpp"
#include "tests/run/import/message_builder.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/import/imported.hpp"
#include "tools/import/import_source.hpp"

namespace isobar::test::test_import_bags {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr std::int64_t kTenthNs = 100'000'000;

/// What differs between the bags of the tests.
struct Robot {
  Form form = Form::kCdrLittle;
  double pressure_unit = 1.0;
  double accel_unit = 1.0;
  std::int64_t imu_behind_ns = 0;  ///< clock of the IMU
  bool has_frames = true;
  bool has_second_lidar = false;
};

std::vector<BagTopic> topics_of(const Robot& robot) {
  const std::string msg = robot.form == Form::kRos1 ? "/" : "/msg/";
  return {{"/points", "sensor_msgs" + msg + "PointCloud2"},
          {"/imu/data", "sensor_msgs" + msg + "Imu"},
          {"/pressure", "sensor_msgs" + msg + "FluidPressure"},
          {"/base_station/pressure", "sensor_msgs" + msg + "FluidPressure"},
          {"/tf_static", "tf2_msgs" + msg + "TFMessage"},
          {"/camera", "sensor_msgs" + msg + "Image"},
          {"/points2", "sensor_msgs" + msg + "PointCloud2"}};
}

/// Two seconds of a robot that stands: clouds of 10 Hz, an IMU of 50 Hz, barometers of 10 Hz.
std::vector<BagMessage> messages_of(const Robot& robot) {
  std::vector<BagMessage> messages;
  const Form form = robot.form;
  if (robot.has_frames) {
    messages.push_back(
        {4, kStartNs, transform_message(form, "base_link", "lidar", {0.1, 0, 0.5, 0, 0, 0, 1})});
    messages.push_back({4, kStartNs, transform_message(form, "base_link", "imu", {0, 0.2, 0, 0, 0, 1, 0})});
  }
  for (std::int64_t i = 0; i < 20; ++i) {
    const std::int64_t ns = kStartNs + i * kTenthNs;
    std::vector<TestPoint> points;
    for (int k = 0; k < 50; ++k) {
      const float angle = 0.1256F * static_cast<float>(k);
      points.push_back(
          {5.0F * std::cos(angle), 5.0F * std::sin(angle), 1.0F, 0.002F * static_cast<float>(k), 3});
    }
    messages.push_back({0, ns + kTenthNs, cloud_message(form, ns, "lidar", points)});
    if (robot.has_second_lidar)
      messages.push_back({6, ns + kTenthNs, cloud_message(form, ns, "lidar", points)});
    messages.push_back({2, ns, pressure_message(form, ns, "baro", 100'000.0 / robot.pressure_unit, 0.0)});
    messages.push_back({3, ns, pressure_message(form, ns, "base", 100'100.0, 0.0)});
    messages.push_back({5, ns, std::string(20, '\0')});
    for (std::int64_t k = 0; k < 5; ++k) {
      const std::int64_t at_ns = ns + k * kTenthNs / 5;
      messages.push_back({1, at_ns,
                          imu_message(form, at_ns - robot.imu_behind_ns, "imu", {0, 0, 0, 1}, {0.01, 0, 0},
                                      {0, 0, 9.80665 / robot.accel_unit})});
    }
  }
  return messages;
}

using namespace tools;

Imported import_of(const std::filesystem::path& source, ImportRequest request = {}) {
  request.source = source;
  return import_and_read(request);
}

Imported import_robot(const Robot& robot, const ImportRequest& request = {}) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bag";
  write_bytes(file, robot.form == Form::kRos1 ? rosbag1_file(topics_of(robot), messages_of(robot), "lz4")
                                              : mcap_file(topics_of(robot), messages_of(robot), "zstd"));
  return import_of(file, request);
}

}  // namespace

TEST_CASE(
    "a bag's lidar, IMU and barometers become a recording with their mounts, from ROS 1 as from ROS 2") {
  for (const Form form : {Form::kRos1, Form::kCdrLittle}) {
    const Imported imported = import_robot({.form = form});
    CHECK(imported.manifest.lidar->holds_clouds());
    CHECK(imported.manifest.lidar->mount.xyz_m == Eigen::Vector3d(0.1, 0.0, 0.5));
    CHECK(imported.manifest.imu->mount.xyz_m.y() == doctest::Approx(0.2));
    CHECK(std::abs(imported.manifest.imu->mount.rpy_deg.z()) == doctest::Approx(180.0));
    CHECK(imported.manifest.description.find("imported from ") == 0);
    CHECK(imported.of(recording::EventKind::kCloud).size() == 20);
    CHECK(imported.of(recording::EventKind::kImu).size() == 100);
    const auto pressure = imported.of(recording::EventKind::kPressure);
    REQUIRE(pressure.size() == 20);
    CHECK(pressure[3].stamp_ns == kStartNs + 3 * kTenthNs);
    CHECK(pressure[3].pressure.pressure_pa == 100'000.0);
    CHECK(imported.of(recording::EventKind::kBasePressure).at(0).pressure.pressure_pa == 100'100.0);
    // An attitude that never turns is none.
    CHECK_FALSE(imported.of(recording::EventKind::kImu).at(0).imu.has_attitude);
    const auto& rows = imported.report.rows;
    REQUIRE(rows.size() == 7);
    CHECK(rows[0].becomes.find("times from time in s") != std::string::npos);
    CHECK(rows[5].becomes == "nothing: a type that is not read");
    CHECK(rows[1].rate_hz == doctest::Approx(50.0).epsilon(0.05));
  }
}

TEST_CASE("units that are not those of the messages are found by the values, converted and said") {
  const Imported imported = import_robot({.pressure_unit = 100.0, .accel_unit = 9.80665});
  CHECK(imported.of(recording::EventKind::kPressure).at(0).pressure.pressure_pa ==
        doctest::Approx(100'000.0));
  CHECK(imported.of(recording::EventKind::kImu).at(0).imu.accel_m_s2.z() == doctest::Approx(9.80665));
  CHECK(imported.report.rows[2].becomes == "barometer.csv: hPa, converted");
  CHECK(imported.report.rows[1].becomes.find("g, converted") != std::string::npos);
}

TEST_CASE(
    "a sensor whose clock is another one is put on the lidar's by the recorder's times, and it is said") {
  const Imported imported = import_robot({.imu_behind_ns = 1'600'000'000'000'000'000});
  const auto imu = imported.of(recording::EventKind::kImu);
  REQUIRE(imu.size() == 100);
  // The lidar's stamps are those of the beginning of a cloud, which comes a tenth of a second later.
  CHECK(imu[0].stamp_ns == kStartNs - kTenthNs);
  CHECK(imported.notes().find("/imu/data: its clock is") != std::string::npos);
}

TEST_CASE("what cannot be known is asked for by the option that answers it, and no folder is left") {
  const TemporaryFolder folder;
  const auto refusal = [&](const Robot& robot, ImportRequest request) {
    write_bytes(folder.path() / "bag", mcap_file(topics_of(robot), messages_of(robot), ""));
    request.source = folder.path() / "bag";
    request.out = folder.path() / "new" / "recording";
    const std::string text = message_of([&] { import_source(request, [](double) {}); });
    CHECK_FALSE(std::filesystem::exists(request.out));
    return text;
  };
  CHECK(refusal({.has_second_lidar = true}, {}).find("--lidar: there are several: /points, /points2") == 0);
  CHECK(refusal({.has_frames = false}, {}).find("--mount: how the IMU (imu) sits relative to the lidar") ==
        0);
  CHECK(refusal({}, {.imu = "/gyro"})
            .find("--imu: /gyro is no topic with messages that it can be; there are /imu/data") == 0);
  CHECK(refusal({.pressure_unit = 1e5}, {}).find("--pressure-unit: /pressure: its median is 1,") == 0);
  CHECK(refusal({}, {.mount_texts = {"lidar=1,2"}}).find("--mount: must be") == 0);
  CHECK(refusal({}, {.accel_unit = "feet"}).find("--accel-unit: must be one of") == 0);
  ImportRequest none{.lidar = "none", .imu = "none", .pressure = "none", .base_pressure = "none"};
  CHECK(refusal({}, none).find(
            "holds no lidar, IMU or barometer that is read; it has /points (sensor_msgs/PointCloud2)") !=
        std::string::npos);
}

TEST_CASE("the answers are taken: a topic of two, a mount, a sensor left out") {
  const Imported imported =
      import_robot({.has_frames = false, .has_second_lidar = true},
                   {.lidar = "/points2", .imu = "none", .mount_texts = {"lidar=1,0,0.2,0,0,90"}});
  CHECK(imported.manifest.lidar->mount.rpy_deg.z() == 90.0);
  CHECK_FALSE(imported.manifest.imu.has_value());
  CHECK(imported.report.rows[6].becomes.find("lidar.clouds") == 0);
  CHECK(imported.report.rows[0].becomes == "nothing: not needed");
}

TEST_CASE("a bag that was cut becomes a shorter recording, and the place of the cut is said") {
  const TemporaryFolder folder;
  const Robot robot;
  const std::string whole = mcap_file(topics_of(robot), messages_of(robot), "lz4");
  write_bytes(folder.path() / "cut.mcap", whole.substr(0, whole.size() / 2));
  const Imported imported = import_of(folder.path() / "cut.mcap");
  const std::size_t clouds = imported.of(recording::EventKind::kCloud).size();
  CHECK(clouds > 5);
  CHECK(clouds < 15);
  CHECK(imported.notes().find("damaged: ") != std::string::npos);
  CHECK(imported.notes().find("cut.mcap: byte ") != std::string::npos);
}

TEST_CASE("a folder that holds something, and a recording, are left alone") {
  const TemporaryFolder folder;
  const Robot robot;
  write_bytes(folder.path() / "bag", mcap_file(topics_of(robot), messages_of(robot), ""));
  ImportRequest request{.source = folder.path() / "bag", .out = folder.path()};
  CHECK(message_of([&] { import_source(request, [](double) {}); }).find("exists already") !=
        std::string::npos);
  CHECK(std::filesystem::exists(folder.path() / "bag"));
  request.out = folder.path() / "r";
  import_source(request, [](double) {});
  const ImportRequest again{.source = folder.path() / "r", .out = folder.path() / "s"};
  CHECK(message_of([&] { import_source(again, [](double) {}); }).find("is a recording already") !=
        std::string::npos);
}

}  // namespace isobar::test::test_import_bags
