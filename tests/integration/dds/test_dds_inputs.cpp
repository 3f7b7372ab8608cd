// SPDX-License-Identifier: BSD-3-Clause
// Writers of sensor topics that fit isobar-dds and writers that do not, the covariance of the wheels, hints of where the
// robot is, and the frame on the ground.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/dds/writer_watch.hpp"
#include "tests/integration/dds/base_station_peers.hpp"
#include "tests/integration/dds/stand_in.hpp"

namespace isobar::test::test_dds_inputs {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

constexpr const char* kWheelsOverDds = "wheel.source = \"dds\"\n";
constexpr const char* kReliable = "wheel.source = \"dds\"\n[dds.qos]\nwheel_reliability = \"reliable\"\n";
const dds::DdsTopic<dds::OdometryMessage> kBestEffortWheel = dds::topics::kWheel;

dds::DdsTopic<dds::OdometryMessage> reliable_wheel() {
  dds::DdsTopic<dds::OdometryMessage> topic = dds::topics::kWheel;
  topic.delivery = dds::Delivery::kReliable;
  return topic;
}

/// A node that writes the wheels' odometry until destroyed.
class Wheels {
 public:
  Wheels(dds_entity_t participant, const dds::DdsTopic<dds::OdometryMessage>& topic, double speed_m_s,
         double variance_m2_s2 = 0.0)
      : speed_m_s_(speed_m_s),
        variance_m2_s2_(variance_m2_s2),
        writer_(participant, topic),
        ticker_([this] { send(); }) {}

 private:
  void send() {
    dds::OdometryMessage message{};
    message.header = {dds::to_time(wall_ns()), dds::text("odom")};
    message.child_frame_id = dds::text("base_link");
    message.twist.twist.linear.x = speed_m_s_;
    message.twist.covariance[0] = variance_m2_s2_;
    message.twist.covariance[35] = 4.0 * variance_m2_s2_;
    writer_.write(message);
  }

  double speed_m_s_;
  double variance_m2_s2_;
  dds::Writer<dds::OdometryMessage> writer_;
  Ticker ticker_;
};

TEST_CASE(
    "a best-effort reader takes best-effort and reliable writers alike, with the variances they state") {
  for (const auto& topic : {kBestEffortWheel, reliable_wheel()}) {
    Robot robot(kWheelsOverDds);
    const Wheels wheels(robot.participant(), topic, 0.5, 0.04);
    const std::vector<GotWheel> got = robot.wheels(10);
    REQUIRE(got.size() == 10);
    for (const GotWheel& sample : got) {
      CHECK(sample.vx_m_s == 0.5);
      CHECK(sample.vx_variance_m2_s2 == 0.04);
      CHECK(sample.wz_variance_rad2_s2 == 0.16);
    }
    CHECK(robot.says("bridge/wheel_writer", kOk));
  }
}

TEST_CASE("a reliable reader gets nothing of a best-effort writer, which is said with the remedy, once") {
  Robot robot(kReliable);
  const Wheels wheels(robot.participant(), kBestEffortWheel, 0.5);
  REQUIRE(robot.says("bridge/wheel_writer", kWarning));
  CHECK(robot.text("bridge/wheel_writer") ==
        "the node that writes it offers best effort only: set dds.qos.wheel_reliability = \"best_effort\"");
  CHECK(robot.logs("bridge/wheel_writer: the node that writes it offers best effort only"));
  CHECK_FALSE(robot.logs("wheel_writer", 3s));
  CHECK(robot.wheels_for(500ms).empty());
  // A node that fits: the other one does no harm.
  const Wheels fitting(robot.participant(), reliable_wheel(), 0.25);
  const std::vector<GotWheel> got = robot.wheels(5);
  REQUIRE(got.size() == 5);
  CHECK(got.back().vx_m_s == 0.25);
  CHECK(std::isnan(got.back().vx_variance_m2_s2));
  CHECK(robot.says("bridge/wheel_writer", kOk));
}

TEST_CASE("a topic whose messages are of another type is said with the type") {
  Robot robot(kWheelsOverDds);
  {
    const dds::DdsTopic<dds::TwistMessage> other{"wheel/odom", dds::topics::kWheelTwist.descriptor,
                                                 dds::Delivery::kReliable, 5, false};
    const dds::Writer<dds::TwistMessage> writer(robot.participant(), other);
    REQUIRE(robot.says("bridge/wheel_writer", kWarning));
    CHECK(robot.text("bridge/wheel_writer") ==
          "its messages are geometry_msgs/msg/TwistWithCovarianceStamped; name the right topic in "
          "dds.topics.wheel");
  }
  CHECK(robot.says("bridge/wheel_writer", kOk));  // the node has gone
}

/// A hint as RViz sends it.
dds::PoseMessage rviz_hint(const char* frame) {
  dds::PoseMessage hint{};
  hint.header = {dds::to_time(wall_ns()), dds::text(frame)};
  hint.pose.pose.position = {4.0, -3.0, 0.0};
  hint.pose.pose.orientation = {0.0, 0.0, std::sin(0.35), std::cos(0.35)};
  hint.pose.covariance[0] = hint.pose.covariance[7] = 0.25;
  hint.pose.covariance[35] = 0.0685;
  return hint;
}

bool wait_for_reader(const dds::Writer<dds::PoseMessage>& writer) {
  for (int i = 0; i < 200 && !writer.has_readers(); ++i) std::this_thread::sleep_for(50ms);
  return writer.has_readers();
}

TEST_CASE("a hint of where the robot is reaches isobard; one of another frame is refused, and said") {
  Robot robot;
  dds::Writer<dds::PoseMessage> writer(robot.participant(), dds::topics::kInitialPose);
  REQUIRE(wait_for_reader(writer));
  CHECK(robot.says("bridge/initial_pose_refused", kOk));
  REQUIRE(writer.write(rviz_hint("odom")));
  CHECK(robot.says("bridge/initial_pose_refused", kWarning));
  CHECK(robot.logs("its frame must be the map's, or empty"));
  REQUIRE(writer.write(rviz_hint("map")));
  CHECK(robot.receives("hint 4.000 -3.000 0.000 0 0.7000 1 1 0.2500"));
}

TEST_CASE("hints have the configured topic and reliability: best effort fits every writer") {
  Robot robot("[dds]\ntopics.initial_pose = \"where\"\nqos.initial_pose_reliability = \"best_effort\"\n");
  dds::DdsTopic<dds::PoseMessage> topic = dds::topics::kInitialPose;
  topic.delivery = dds::Delivery::kBestEffort;
  dds::Writer<dds::PoseMessage> writer(robot.participant(), topic, "", "where");
  REQUIRE(wait_for_reader(writer));
  // The reader may match later than the writer: what is sent before is lost.
  const Ticker sender([&] { writer.write(rviz_hint("")); });
  CHECK(robot.receives("hint 4.000 -3.000 0.000 0 0.7000 0 1 0.2500"));
}

TEST_CASE("with a frame on the ground /tf has odom to it and it to base_link, which stays where it is") {
  Robot robot("[dds]\nfootprint_frame = \"base_footprint\"\nfootprint_depth_m = 0.25\n");
  dds::Reader<dds::TfMessage> reader(robot.participant(), dds::topics::kTf);
  bool seen = false;
  for (int i = 0; i < 200 && !seen; ++i) {
    std::this_thread::sleep_for(50ms);
    reader.take([&](const dds::TfMessage& message) {
      if (seen) return;
      seen = true;
      REQUIRE(message.transforms._length == 3);
      const auto* transforms = message.transforms._buffer;
      CHECK(std::string(transforms[1].header.frame_id) == "odom");
      CHECK(std::string(transforms[1].child_frame_id) == "base_footprint");
      CHECK(std::string(transforms[2].header.frame_id) == "base_footprint");
      CHECK(std::string(transforms[2].child_frame_id) == "base_link");
      // The stand-in's robot is level.
      CHECK(std::abs(transforms[1].transform.rotation.z - std::sin(stand_in::kYawRad / 2)) < 1e-9);
      CHECK(std::abs(transforms[2].transform.translation.z - 0.25) < 1e-9);
      CHECK(std::abs(transforms[2].transform.translation.x) < 1e-9);
      CHECK(std::abs(transforms[2].transform.rotation.w - 1.0) < 1e-9);
    });
  }
  CHECK(seen);
}

TEST_CASE("Cyclone DDS reports no inconsistent topic: only the list of writers shows another type") {
  Robot robot;
  const dds::DdsTopic<dds::TwistMessage> wrong{"pose", dds::topics::kWheelTwist.descriptor,
                                               dds::Delivery::kReliable, 5, false};
  const dds::Reader<dds::TwistMessage> reader(robot.participant(), wrong);
  dds::WriterWatch watch(robot.participant());
  std::string trouble;
  for (int i = 0; i < 100 && trouble.empty(); ++i) {
    std::this_thread::sleep_for(50ms);
    watch.look();
    trouble = watch.trouble({"wheel", reader.get()});
  }
  CHECK(trouble.find("geometry_msgs/msg/PoseWithCovarianceStamped") != std::string::npos);
  dds_inconsistent_topic_status_t status{};
  CHECK(dds_get_inconsistent_topic_status(dds_get_topic(reader.get()), &status) == DDS_RETCODE_OK);
  CHECK(status.total_count == 0);
}

}  // namespace

}  // namespace isobar::test::test_dds_inputs
