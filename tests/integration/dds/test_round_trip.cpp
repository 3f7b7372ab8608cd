// SPDX-License-Identifier: BSD-3-Clause
// Every message type through Cyclone DDS's serializer and back in one process, and the encapsulation header.
#include <dds/ddsi/ddsi_serdata.h>
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "ipc/dds/discovery.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::test::test_round_trip {

using namespace isobar::dds;

namespace {

/// Writes one message and calls `check` with the message received.
template <class Message, class Check>
void round_trip(const DdsTopic<Message>& topic, const Message& sent, Check&& check) {
  const Participant participant({});
  // Reliable and latched, so that no message is lost.
  const DdsTopic<Message> reliable{topic.name, topic.descriptor, Delivery::kLatched, 1, topic.is_global};
  Reader<Message> reader(participant.get(), reliable);
  Writer<Message> writer(participant.get(), reliable);
  REQUIRE(writer.write(sent));
  CHECK(reader.take(check) == 1);
  CHECK(writer.failures() == 0);
}

TEST_CASE("odometry") {
  OdometryMessage sent{};
  sent.header = {{7, 8}, text("odom")};
  sent.child_frame_id = text("base_link");
  sent.pose.pose.position = {1, 2, 3};
  sent.twist.covariance[35] = 36.0;
  round_trip(topics::kOdom, sent, [](const OdometryMessage& got) {
    CHECK(got.header.stamp.sec == 7);
    CHECK(got.header.stamp.nanosec == 8);
    CHECK(std::string(got.child_frame_id) == "base_link");
    CHECK(got.pose.pose.position.z == 3.0);
    CHECK(got.twist.covariance[35] == 36.0);
  });
}

TEST_CASE("pose") {
  PoseMessage sent{};
  sent.header.frame_id = text("map");
  sent.pose.pose.orientation = {0.1, 0.2, 0.3, 0.9};
  sent.pose.covariance[14] = 0.5;
  round_trip(topics::kPose, sent, [](const PoseMessage& got) {
    CHECK(std::string(got.header.frame_id) == "map");
    CHECK(got.pose.pose.orientation.w == 0.9);
    CHECK(got.pose.covariance[14] == 0.5);
  });
}

TEST_CASE("transforms") {
  std::array<TransformStampedMessage, 2> transforms{};
  for (TransformStampedMessage& transform : transforms) {
    transform.header.frame_id = text("parent");
    transform.child_frame_id = text("child");
  }
  transforms[1].transform.rotation.w = 1.0;
  TfMessage sent{};
  sent.transforms._buffer = transforms.data();
  sent.transforms._length = sent.transforms._maximum = transforms.size();
  round_trip(topics::kTfStatic, sent, [](const TfMessage& got) {
    REQUIRE(got.transforms._length == 2);
    CHECK(std::string(got.transforms._buffer[1].child_frame_id) == "child");
    CHECK(got.transforms._buffer[1].transform.rotation.w == 1.0);
  });
}

TEST_CASE("altitude, pressure and inertial samples") {
  AltitudeMessage altitude{};
  altitude.header.frame_id = text("map");
  altitude.height = 3.5;
  altitude.source = text("held");
  altitude.bias = -0.5;
  altitude.airflow = 0.017;
  altitude.faulty = true;
  altitude.drifting = text("robot");
  round_trip(topics::kAltitude, altitude, [](const AltitudeMessage& got) {
    CHECK(got.height == 3.5);
    CHECK(std::string(got.source) == "held");
    CHECK(got.bias == -0.5);
    CHECK(got.faulty);
    CHECK(std::string(got.drifting) == "robot");
  });
  PressureMessage pressure{};
  pressure.header.frame_id = text("base");
  pressure.fluid_pressure = 101325.0;
  round_trip(topics::kBasePressure, pressure,
             [](const PressureMessage& got) { CHECK(got.fluid_pressure == 101325.0); });
  ImuMessage imu{};
  imu.header.frame_id = text("imu");
  imu.linear_acceleration.z = 9.81;
  imu.linear_acceleration_covariance[8] = 2.0;
  round_trip(topics::kImu, imu, [](const ImuMessage& got) {
    CHECK(got.linear_acceleration.z == 9.81);
    CHECK(got.linear_acceleration_covariance[8] == 2.0);
  });
}

TEST_CASE("a cloud of a megabyte") {
  std::vector<ScanPoint> points(65'536);
  points.back().x_m = 42.0F;
  CloudBuilder builder(CloudBuilder::Fields::kWithRing);
  builder.append(points);
  const std::string frame = "map";
  round_trip(topics::kMapCloud, builder.message(9, frame), [&](const CloudMessage& got) {
    REQUIRE(got.data._length == points.size() * 20);
    float x_m = 0.0F;
    std::memcpy(&x_m, got.data._buffer + (points.size() - 1) * 20, sizeof(x_m));
    CHECK(x_m == 42.0F);
    REQUIRE(got.fields._length == 5);
    CHECK(std::string(got.fields._buffer[4].name) == "ring");
  });
}

TEST_CASE("a grid of a floor, and its number and name") {
  std::vector<std::uint8_t> cells(12, 255);  // -1: unknown
  cells[5] = 100;
  GridMessage grid{};
  grid.header.frame_id = text("map");
  grid.info.resolution = 0.05F;
  grid.info.width = 4;
  grid.info.height = 3;
  grid.info.origin.position.x = -1.5;
  grid.data._buffer = cells.data();
  grid.data._length = grid.data._maximum = 12;
  round_trip(topics::kMap, grid, [](const GridMessage& got) {
    CHECK(got.info.resolution == 0.05F);
    CHECK(got.info.height == 3);
    CHECK(got.info.origin.position.x == -1.5);
    REQUIRE(got.data._length == 12);
    CHECK(got.data._buffer[5] == 100);
    CHECK(static_cast<std::int8_t>(got.data._buffer[11]) == -1);
  });
  round_trip(topics::kFloor, Int32Message{-2}, [](const Int32Message& got) { CHECK(got.data == -2); });
  round_trip(topics::kFloorName, StringMessage{text("cellar")},
             [](const StringMessage& got) { CHECK(std::string(got.data) == "cellar"); });
}

TEST_CASE("diagnostics") {
  const auto builder = std::make_unique<DiagnosticsBuilder>();
  builder->start(1);
  builder->add("lidar", ipc::HealthLevel::kStale, "silent", 5.0);
  round_trip(topics::kDiagnostics, builder->message(), [](const DiagnosticsMessage& got) {
    REQUIRE(got.status._length == 1);
    CHECK(got.status._buffer[0].level == 3);
    CHECK(std::string(got.status._buffer[0].name) == "isobar: lidar");
    CHECK(std::string(got.status._buffer[0].values._buffer[0].value) == "5");
  });
}

TEST_CASE("messages are XCDR1, the only representation that ROS 2 reads") {
  const Participant participant({});
  Reader<AltitudeMessage> reader(participant.get(), topics::kAltitude);
  Writer<AltitudeMessage> writer(participant.get(), topics::kAltitude);
  AltitudeMessage sent{};
  sent.header.frame_id = text("map");
  sent.source = text("none");
  sent.drifting = text("none");
  REQUIRE(writer.write(sent));
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info{};
  REQUIRE(dds_takecdr(reader.get(), &data, 1, &info, DDS_ANY_STATE) == 1);
  std::array<unsigned char, 4> header{};
  ddsi_serdata_to_ser(data, 0, header.size(), header.data());
  ddsi_serdata_unref(data);
  CHECK(header[0] == 0x00);
  CHECK(header[1] == 0x01);
}

TEST_CASE("the node announcement has the size for the configured ROS 2 release") {
  const auto bytes_of = [](int gid_bytes) {
    const Participant participant({});
    NodeAnnouncement announcement(participant.get(), gid_bytes);
    const Writer<AltitudeMessage> writer(participant.get(), topics::kAltitude);
    announcement.announce("robot1", "isobar", {writer.get()}, {});
    dds_topic_descriptor_t descriptor = gid_bytes == 16
                                            ? rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc
                                            : rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo__desc;
    descriptor.m_typename = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
    const auto topic = checked(
        dds_create_topic(participant.get(), &descriptor, "ros_discovery_info", nullptr, nullptr), "topic");
    const QosPointer qos = endpoint_qos(Delivery::kLatched, 1);
    const auto reader =
        checked(dds_create_reader(participant.get(), topic.get(), qos.get(), nullptr), "reader");
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info{};
    REQUIRE(dds_takecdr(reader.get(), &data, 1, &info, DDS_ANY_STATE) == 1);
    const std::uint32_t size = ddsi_serdata_size(data);
    ddsi_serdata_unref(data);
    return size;
  };
  // Header 4, gid, count 4, "/robot1" 4 + 8, "isobar" 4 + 7 padded to 8, no readers 4, one writer 4 + gid.
  CHECK(bytes_of(16) == 4 + 16 + 4 + 12 + 12 + 4 + 4 + 16);
  CHECK(bytes_of(24) == 4 + 24 + 4 + 12 + 12 + 4 + 4 + 24);
}

}  // namespace

}  // namespace isobar::test::test_round_trip
