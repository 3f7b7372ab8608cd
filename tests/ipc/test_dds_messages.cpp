// SPDX-License-Identifier: BSD-3-Clause
// Names and contents of the DDS messages, without a network.
#include "ipc/dds/messages.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include "ipc/dds/outputs.hpp"

namespace isobar::test::test_dds_messages {

using namespace isobar::dds;

namespace {

TEST_CASE("types have their ROS 2 names") {
  // From ROS 2's design document on topic and type names: package::msg::dds_::Name_.
  CHECK(std::string(topics::kOdom.descriptor->m_typename) == "nav_msgs::msg::dds_::Odometry_");
  CHECK(std::string(topics::kPose.descriptor->m_typename) ==
        "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_");
  CHECK(std::string(topics::kTf.descriptor->m_typename) == "tf2_msgs::msg::dds_::TFMessage_");
  CHECK(std::string(topics::kTfStatic.descriptor->m_typename) == "tf2_msgs::msg::dds_::TFMessage_");
  CHECK(std::string(topics::kAltitude.descriptor->m_typename) == "isobar_msgs::msg::dds_::Altitude_");
  CHECK(std::string(topics::kMap.descriptor->m_typename) == "sensor_msgs::msg::dds_::PointCloud2_");
  CHECK(std::string(topics::kDiagnostics.descriptor->m_typename) ==
        "diagnostic_msgs::msg::dds_::DiagnosticArray_");
  CHECK(std::string(topics::kBasePressure.descriptor->m_typename) ==
        "sensor_msgs::msg::dds_::FluidPressure_");
  CHECK(std::string(topics::kBaseTemperature.descriptor->m_typename) ==
        "sensor_msgs::msg::dds_::Temperature_");
  CHECK(std::string(topics::kImu.descriptor->m_typename) == "sensor_msgs::msg::dds_::Imu_");
}

TEST_CASE("topic names get ROS 2's prefix, and the namespace unless they are global") {
  CHECK(dds_name(topics::kOdom, "") == "rt/odom");
  CHECK(dds_name(topics::kOdom, "robot1") == "rt/robot1/odom");
  CHECK(dds_name(topics::kTf, "robot1") == "rt/tf");
  CHECK(dds_name(topics::kTfStatic, "robot1") == "rt/tf_static");
  CHECK(dds_name(topics::kDiagnostics, "robot1") == "rt/diagnostics");
  CHECK(dds_name(topics::kBasePressure, "roof") == "rt/roof/fluid_pressure");
  CHECK(dds_name(topics::kBaseTemperature, "roof") == "rt/roof/temperature");
}

TEST_CASE("stamps survive the conversion to seconds and nanoseconds and back") {
  for (const std::int64_t stamp_ns : {0LL, 1LL, 999'999'999LL, 1'000'000'000LL, 1'795'338'406'661'000'001LL,
                                      -1LL, -1'000'000'000LL, -1'500'000'000LL}) {
    const TimeMessage time = to_time(stamp_ns);
    CHECK(time.nanosec < 1'000'000'000U);
    CHECK(to_stamp_ns(time) == stamp_ns);
  }
  CHECK(to_time(-1).sec == -1);
  CHECK(to_time(-1).nanosec == 999'999'999U);
}

TEST_CASE("a rate limit keeps its average rate and passes every sample of a slower source") {
  const auto passed = [](double limit_hz, double source_hz, double seconds) {
    RateLimit limit(limit_hz);
    int count = 0;
    for (int i = 0; i < static_cast<int>(seconds * source_hz); ++i) {
      // Jitter of 5 % of the source's period, as from a timer.
      const double jitter = 0.05 * ((i * 7919) % 100 - 50) / 50.0;
      count += limit.due(1'000'000'000 + static_cast<std::int64_t>((i + jitter) / source_hz * 1e9)) ? 1 : 0;
    }
    return count;
  };
  CHECK(passed(100.0, 200.0, 10.0) == doctest::Approx(1000).epsilon(0.002));
  CHECK(passed(100.0, 100.0, 10.0) == doctest::Approx(1000).epsilon(0.002));
  CHECK(passed(100.0, 143.0, 10.0) <= 1001);
  CHECK(passed(100.0, 40.0, 10.0) == 400);
  CHECK(passed(10.0, 400.0, 10.0) == doctest::Approx(100).epsilon(0.01));
}

TEST_CASE("a rate limit recovers from a gap and from a clock set back") {
  RateLimit limit(10.0);
  CHECK(limit.due(0));
  CHECK_FALSE(limit.due(50'000'000));
  CHECK(limit.due(60'000'000'000));
  CHECK_FALSE(limit.due(60'050'000'000));  // no burst after the gap
  CHECK(limit.due(1'000'000'000));
  CHECK_FALSE(limit.due(1'050'000'000));
}

TEST_CASE("odometry has pose, twist and both covariances in ROS 2's order") {
  Odometry odometry;
  odometry.stamp_ns = 5'000'000'007;
  odometry.T_odom_base =
      Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0);
  odometry.v_base_m_s = Eigen::Vector3d(4.0, 5.0, 6.0);
  odometry.w_base_rad_s = Eigen::Vector3d(7.0, 8.0, 9.0);
  for (int i = 0; i < 36; ++i) {
    odometry.pose_covariance(i / 6, i % 6) = i;
    odometry.twist_covariance(i / 6, i % 6) = 100 + i;
  }
  const DdsConfig names;
  OdometryMessage message{};
  fill_odometry(odometry, names, message);
  CHECK(message.header.stamp.sec == 5);
  CHECK(message.header.stamp.nanosec == 7);
  CHECK(std::string(message.header.frame_id) == "odom");
  CHECK(std::string(message.child_frame_id) == "base_link");
  CHECK(message.pose.pose.position.z == 3.0);
  // Half the angle about the axis (1, 2, 2) / 3.
  CHECK(message.pose.pose.orientation.w == doctest::Approx(std::cos(0.25)));
  CHECK(message.pose.pose.orientation.x == doctest::Approx(std::sin(0.25) / 3.0));
  CHECK(message.pose.pose.orientation.z == doctest::Approx(std::sin(0.25) * 2.0 / 3.0));
  CHECK(message.twist.twist.linear.y == 5.0);
  CHECK(message.twist.twist.angular.z == 9.0);
  for (int i = 0; i < 36; ++i) {
    CHECK(message.pose.covariance[i] == i);
    CHECK(message.twist.covariance[i] == 100 + i);
  }
}

TEST_CASE("the altitude message names the height source") {
  Prior prior;
  prior.height_m = 7.25;
  prior.height_variance_m2 = 0.01;
  AltitudeMessage message{};
  const DdsConfig names;
  for (const auto& [source, name] :
       {std::pair{HeightSource::kDifferential, "differential"},
        std::pair{HeightSource::kSingleBarometer, "single_barometer"}, std::pair{HeightSource::kHeld, "held"},
        std::pair{HeightSource::kNone, "none"}}) {
    prior.height_source = source;
    fill_altitude(prior, names, message);
    CHECK(std::string(message.source) == name);
  }
  CHECK(message.height == 7.25);
  CHECK(message.variance == 0.01);
}

TEST_CASE("a cloud refers to the points without a copy, and its fields give the offset of each value") {
  std::array<ScanPoint, 3> points{};
  points[2].x_m = 1.5F;
  points[2].intensity = 200;
  points[2].ring = 15;
  CloudBuilder builder;
  const std::string frame = "base_link";
  const CloudMessage& scan = builder.build(1, frame, points.data(), points.size(), true);
  CHECK(scan.data._buffer == reinterpret_cast<const std::uint8_t*>(points.data()));
  CHECK(scan.data._length == 48);
  CHECK(scan.width * scan.point_step == scan.row_step);
  REQUIRE(scan.fields._length == 5);
  const auto value_at = [&](std::uint32_t field) {
    return scan.data._buffer + 2 * scan.point_step + scan.fields._buffer[field].offset;
  };
  float x_m = 0.0F;
  std::memcpy(&x_m, value_at(0), sizeof(x_m));
  CHECK(x_m == 1.5F);
  CHECK(std::string(scan.fields._buffer[3].name) == "intensity");
  CHECK(*value_at(3) == 200);
  CHECK(std::string(scan.fields._buffer[4].name) == "ring");
  CHECK(*value_at(4) == 15);
  CHECK(builder.build(1, frame, points.data(), 0, false).fields._length == 4);
}

TEST_CASE("diagnostics copy texts, truncate long ones and leave out entries beyond the capacity") {
  const auto builder = std::make_unique<DiagnosticsBuilder>();
  builder->start(3'000'000'000);
  {
    const std::string name(300, 'n');
    builder->add(name.c_str(), ipc::HealthLevel::kError, "broken", 0.25);
  }
  const auto& first = builder->message().status._buffer[0];
  CHECK(std::string(first.name).starts_with("isobar: nnn"));
  CHECK(first.level == 2);
  CHECK(std::string(first.message) == "broken");
  CHECK(std::string(first.values._buffer[0].value) == "0.25");
  for (std::size_t i = 0; i < 2 * DiagnosticsBuilder::kMaxStatuses; ++i) {
    builder->add("x", ipc::HealthLevel::kOk, "", 0.0);
  }
  CHECK(builder->message().status._length == DiagnosticsBuilder::kMaxStatuses);
  builder->start(0);
  CHECK(builder->message().status._length == 0);
}

TEST_CASE("the domain configuration enables multicast on loopback and never enables iceoryx") {
  const std::string lo = domain_configuration({0, "lo", 14720});
  CHECK(lo.find("name=\"lo\" multicast=\"true\"") != std::string::npos);
  CHECK(lo.find("<Peer address=\"127.0.0.1\"/>") != std::string::npos);
  const std::string address = domain_configuration({0, "192.0.2.2", 65500});
  CHECK(address.find("address=\"192.0.2.2\"") != std::string::npos);
  CHECK(address.find("<MaxMessageSize>65500B") != std::string::npos);
  CHECK(address.find("Peer") == std::string::npos);
  const std::string automatic = domain_configuration({0, "", 14720});
  CHECK(automatic.find("autodetermine=\"true\"") != std::string::npos);
  for (const std::string& xml : {lo, address, automatic}) {
    CHECK(xml.find("<SharedMemory><Enable>false</Enable></SharedMemory>") != std::string::npos);
  }
}

}  // namespace

}  // namespace isobar::test::test_dds_messages
