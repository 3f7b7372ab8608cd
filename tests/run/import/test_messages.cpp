// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "run/import/frame_tree.hpp"
#include "run/import/ros_messages.hpp"
#include "tests/run/import/message_builder.hpp"

namespace isobar::test::test_messages {
namespace {

using imports::MessageCursor;
using imports::MessageHeader;

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'789;

MessageCursor cursor_of(const std::string& bytes, Form form) {
  return {{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
          form == Form::kRos1 ? imports::Encoding::kRos1 : imports::Encoding::kCdr};
}

}  // namespace

TEST_CASE("an Imu is read in every serialisation, with stamp, frame and attitude") {
  for (const Form form : kForms) {
    const std::string bytes =
        imu_message(form, kStampNs, "imu_link", {0.0, 0.0, 0.6, 0.8}, {0.1, 0.2, 0.3}, {1.0, 2.0, 9.0});
    MessageHeader header;
    ImuSample sample;
    REQUIRE(imports::read_imu(cursor_of(bytes, form), header, sample) == nullptr);
    CHECK(header.stamp_ns == kStampNs);
    CHECK(header.frame_id == "imu_link");
    CHECK(sample.gyro_rad_s == Eigen::Vector3d(0.1, 0.2, 0.3));
    CHECK(sample.accel_m_s2 == Eigen::Vector3d(1.0, 2.0, 9.0));
    CHECK(sample.has_attitude);
    CHECK(sample.q_world_imu.w() == doctest::Approx(0.8));
    CHECK(sample.q_world_imu.z() == doctest::Approx(0.6));
  }
}

TEST_CASE("pressure, temperature, odometry, twist, poses and transforms are read in every serialisation") {
  for (const Form form : kForms) {
    MessageHeader header;
    PressureSample pressure;
    const std::string p = pressure_message(form, kStampNs, "baro", 100'000.0, 4.0);
    REQUIRE(imports::read_pressure(cursor_of(p, form), header, pressure) == nullptr);
    CHECK(pressure.pressure_pa == 100'000.0);
    CHECK(pressure.variance_pa2 == 4.0);
    CHECK(std::isnan(pressure.temperature_c));
    const std::string unknown = pressure_message(form, kStampNs, "baro", 100'000.0, 0.0);
    REQUIRE(imports::read_pressure(cursor_of(unknown, form), header, pressure) == nullptr);
    CHECK(std::isnan(pressure.variance_pa2));  // 0 says "unknown" by the message's definition

    std::vector<double> covariance(36, 0.0);
    covariance[0] = 0.01;
    covariance[35] = 0.04;
    const std::string o = MessageBuilder(form)
                              .header(kStampNs, "odom")
                              .text("base_link")
                              .doubles({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0})
                              .doubles(std::vector<double>(36, 0.5))
                              .doubles({0.7, 0.1, 0.0, 0.0, 0.0, 0.2})
                              .doubles(covariance)
                              .bytes();
    imports::OdometryMessage odometry;
    REQUIRE(imports::read_odometry(cursor_of(o, form), odometry) == nullptr);
    CHECK(odometry.pose.child == "base_link");
    CHECK(odometry.pose.pose.translation() == Eigen::Vector3d(1.0, 2.0, 3.0));
    CHECK(odometry.twist.vx_m_s == 0.7);
    CHECK(odometry.twist.wz_rad_s == 0.2);
    CHECK(odometry.twist.vx_variance_m2_s2 == 0.01);
    CHECK(std::isnan(odometry.twist.vy_variance_m2_s2));
    CHECK(odometry.twist.wz_variance_rad2_s2 == 0.04);

    std::vector<imports::StampedPose> transforms;
    const std::string t = transform_message(form, "base_link", "lidar", {0.1, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0});
    REQUIRE(imports::read_transforms(cursor_of(t, form), transforms) == nullptr);
    REQUIRE(transforms.size() == 1);
    CHECK(transforms[0].child == "lidar");
    CHECK(transforms[0].pose.translation().z() == 0.5);
  }
}

TEST_CASE("a cloud keeps its fields and bytes in every serialisation") {
  const std::vector<TestPoint> points{{1.0F, 2.0F, 3.0F, 0.0F, 4}, {5.0F, 6.0F, 7.0F, 0.1F, 9}};
  for (const Form form : kForms) {
    imports::CloudMessage message;
    const std::string bytes = cloud_message(form, kStampNs, "lidar", points);
    REQUIRE(imports::read_cloud(cursor_of(bytes, form), message) == nullptr);
    CHECK(message.header.frame_id == "lidar");
    CHECK(message.cloud.stamp_ns == kStampNs);
    CHECK(message.cloud.width == 2);
    CHECK(message.cloud.point_step == 18);
    REQUIRE(message.cloud.fields.size() == 5);
    CHECK(message.cloud.fields[3].name == "time");
    CHECK(message.cloud.fields[4].offset == 16);
    REQUIRE(message.cloud.data.size() == 36);
    float x = 0.0F;
    std::memcpy(&x, &message.cloud.data[18], sizeof(x));
    CHECK(x == 5.0F);
  }
}

TEST_CASE("a Livox list becomes a cloud with the times of its points, without the doubtful ones") {
  for (const Form form : kForms) {
    MessageBuilder builder(form);
    builder.header(kStampNs, "livox").add(std::uint64_t{5}).add(std::uint32_t{3});
    builder.add(std::uint8_t{1}).raw(std::string(3, '\0')).add(std::uint32_t{3});
    for (std::uint32_t i = 0; i < 3; ++i) {
      builder.add(i * 1000).add(1.0F + static_cast<float>(i)).add(2.0F).add(3.0F);
      builder.add(std::uint8_t{77}).add(static_cast<std::uint8_t>(i == 1 ? 2 : 0)).add(std::uint8_t{4});
    }
    imports::CloudMessage message;
    const std::string bytes = builder.bytes();
    REQUIRE(imports::read_livox(cursor_of(bytes, form), message) == nullptr);
    CHECK(message.cloud.width == 2);
    std::uint32_t offset_ns = 0;
    std::memcpy(&offset_ns, &message.cloud.data[22 + 18], sizeof(offset_ns));
    CHECK(offset_ns == 2000);
  }
}

TEST_CASE("packets come out of each form of list, with their own stamps") {
  const std::string payload(1206, 'v');
  for (const Form form : kForms) {
    imports::PacketsMessage message;
    const std::string velodyne = MessageBuilder(form)
                                     .header(kStampNs, "velodyne")
                                     .add(std::uint32_t{2})
                                     .time(kStampNs + 5)
                                     .raw(payload)
                                     .time(kStampNs + 6)
                                     .raw(payload)
                                     .bytes();
    REQUIRE(imports::read_packets("velodyne_msgs/VelodyneScan", cursor_of(velodyne, form), message) ==
            nullptr);
    REQUIRE(message.packets.size() == 2);
    CHECK(message.packets[1].stamp_ns == kStampNs + 6);
    CHECK(message.packets[1].bytes.size() == 1206);
    const std::string nebula =
        MessageBuilder(form).header(kStampNs, "h").add(std::uint32_t{1}).time(kStampNs).blob("abc").bytes();
    REQUIRE(imports::read_packets("nebula_msgs/NebulaPackets", cursor_of(nebula, form), message) == nullptr);
    CHECK(message.packets.at(0).bytes.size() == 3);
    const std::string ouster = MessageBuilder(form).blob("abcd").bytes();
    REQUIRE(imports::read_packets("ouster_ros/PacketMsg", cursor_of(ouster, form), message) == nullptr);
    CHECK(message.packets.at(0).bytes.size() == 4);
  }
}

TEST_CASE("a message that is cut anywhere is refused, and lengths beyond it take no memory") {
  const std::string whole = cloud_message(Form::kCdrLittle, kStampNs, "lidar", {{1, 2, 3, 0, 1}});
  for (std::size_t cut = 0; cut + 2 < whole.size(); ++cut) {
    imports::CloudMessage message;
    const std::string bytes = whole.substr(0, cut);
    CHECK(imports::read_cloud(cursor_of(bytes, Form::kCdrLittle), message) != nullptr);
  }
  std::vector<imports::StampedPose> transforms;
  const std::string long_list("\xff\xff\xff\xff", 4);
  CHECK(imports::read_transforms(cursor_of(long_list, Form::kRos1), transforms) != nullptr);
  imports::PacketsMessage packets;
  const std::string header = MessageBuilder(Form::kRos1).header(1, "x").bytes() + long_list;
  CHECK(imports::read_packets("nebula_msgs/NebulaPackets", cursor_of(header, Form::kRos1), packets) !=
        nullptr);
  // XCDR2 lays fields out in another way.
  std::string other = whole;
  other[1] = 7;
  imports::CloudMessage message;
  CHECK(imports::read_cloud(cursor_of(other, Form::kCdrLittle), message) != nullptr);
}

TEST_CASE("the frame tree finds a sensor below, above and beside the robot's frame, and ends in a ring") {
  imports::FrameTree tree;
  const auto add = [&](const char* parent, const char* child, double x) {
    imports::StampedPose pose;
    pose.header.frame_id = parent;
    pose.child = child;
    pose.pose.translation().x() = x;
    tree.add({pose});
  };
  add("base_footprint", "base_link", 0.1);
  add("base_footprint", "/mast", 0.3);
  add("mast", "lidar", 0.5);
  CHECK(tree.find("base_link", "lidar")->translation().x() == doctest::Approx(0.7));
  CHECK(tree.find("base_link", "base_footprint")->translation().x() == doctest::Approx(-0.1));
  CHECK(tree.find("base_link", "/base_link")->translation().x() == 0.0);
  CHECK_FALSE(tree.find("base_link", "camera").has_value());
  add("ring_a", "ring_b", 1.0);
  add("ring_b", "ring_a", 1.0);
  CHECK_FALSE(tree.find("ring_a", "lidar").has_value());
}

}  // namespace isobar::test::test_messages
