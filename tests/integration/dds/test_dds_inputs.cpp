// SPDX-License-Identifier: BSD-3-Clause
// Writers of sensor topics that fit isobar-dds and writers that do not, and the covariance of the wheels.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "ipc/dds/writer_watch.hpp"
#include "tests/integration/dds/base_station_peers.hpp"

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
