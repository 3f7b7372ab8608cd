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
#include <vector>

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
  CHECK(std::string(topics::kMapCloud.descriptor->m_typename) == "sensor_msgs::msg::dds_::PointCloud2_");
  CHECK(std::string(topics::kMap.descriptor->m_typename) == "nav_msgs::msg::dds_::OccupancyGrid_");
  CHECK(std::string(topics::kFloor.descriptor->m_typename) == "std_msgs::msg::dds_::Int32_");
  CHECK(std::string(topics::kFloorName.descriptor->m_typename) == "std_msgs::msg::dds_::String_");
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
  CHECK(dds_name(topics::kOdom, "robot1", "local/odometry") == "rt/robot1/local/odometry");
  CHECK(dds_name(topics::kTf, "robot1") == "rt/tf");
  CHECK(dds_name(topics::kTf, "robot1", "robot1/tf") == "rt/robot1/tf");
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
    fill_altitude(prior, PoseEstimate{}, names, message);
    CHECK(std::string(message.source) == name);
  }
  CHECK(message.height == 7.25);
  CHECK(message.variance == 0.01);
}

TEST_CASE("the altitude message has the altimeter's bias, and nan where the method does not estimate it") {
  PoseEstimate pose;
  pose.altimeter = {.bias_m = -0.5,
                    .bias_sd_m = 0.1,
                    .innovation_m = 0.25,
                    .faulty = true,
                    .drifts = DriftSuspect::kBase,
                    .airflow_s2_m = 0.017,
                    .airflow_sd_s2_m = 0.002};
  AltitudeMessage message{};
  const DdsConfig names;
  pose.effective_method = Method::k3Dof;
  fill_altitude(Prior{}, pose, names, message);
  CHECK(std::isnan(message.bias));
  CHECK(std::isnan(message.bias_variance));
  CHECK(std::isnan(message.innovation));
  CHECK(std::isnan(message.airflow));
  CHECK(std::isnan(message.airflow_variance));
  pose.effective_method = Method::kAdaptive;
  fill_altitude(Prior{}, pose, names, message);
  CHECK(message.bias == -0.5);
  CHECK(message.bias_variance == doctest::Approx(0.01));
  CHECK(message.innovation == 0.25);
  CHECK(message.airflow == 0.017);
  CHECK(std::abs(message.airflow_variance - 4e-6) < 1e-9);
  CHECK(message.faulty);
  CHECK(std::string(message.drifting) == "base_station");
}

TEST_CASE("a cloud has the field types that PCL reads: intensity FLOAT32, ring UINT16") {
  constexpr int kUint16 = 4;  // sensor_msgs/PointField
  constexpr int kFloat32 = 7;
  std::array<ScanPoint, 3> points{};
  points[2].x_m = 1.5F;
  points[2].intensity = 200;
  points[2].ring = 15;
  CloudBuilder builder(CloudBuilder::Fields::kWithRing);
  builder.append(points);
  const std::string frame = "base_link";
  const CloudMessage& scan = builder.message(1, frame);
  REQUIRE(scan.data._length == 3 * scan.point_step);
  CHECK(scan.width * scan.point_step == scan.row_step);
  REQUIRE(scan.fields._length == 5);
  const auto last = [&]<class T>(std::uint32_t field, T value) {
    std::memcpy(&value, scan.data._buffer + 2 * scan.point_step + scan.fields._buffer[field].offset,
                sizeof(value));
    return value;
  };
  CHECK(last(0, 0.0F) == 1.5F);
  CHECK(std::string(scan.fields._buffer[3].name) == "intensity");
  CHECK(scan.fields._buffer[3].datatype == kFloat32);
  CHECK(last(3, 0.0F) == 200.0F);
  CHECK(std::string(scan.fields._buffer[4].name) == "ring");
  CHECK(scan.fields._buffer[4].datatype == kUint16);
  CHECK(last(4, std::uint16_t{}) == 15);
  CloudBuilder map(CloudBuilder::Fields::kWithoutRing);
  map.append(points);
  CHECK(map.message(1, frame).fields._length == 4);
  CHECK(map.message(1, frame).width == 3);
  CHECK(map.message(1, frame).point_step == 16);
}

/// Piece of a map of 7 points, each with its number as x.
std::unique_ptr<ipc::MapCloud> map_piece(std::uint32_t sequence, std::uint32_t first, std::uint32_t count) {
  auto piece = std::make_unique<ipc::MapCloud>();
  piece->stamp_ns = 100 + sequence;
  piece->sequence = sequence;
  piece->first_point = first;
  piece->total_points = 7;
  piece->point_count = count;
  for (std::uint32_t i = 0; i < count; ++i) piece->points[i].x_m = static_cast<float>(first + i);
  return piece;
}

TEST_CASE("a map is published whole, when its last piece has come; one with a lost piece is not") {
  CloudBuilder cloud(CloudBuilder::Fields::kWithoutRing);
  MapAssembly map;
  CHECK_FALSE(map.add(*map_piece(1, 4, 3), cloud));  // a late subscriber begins with the next map
  CHECK_FALSE(map.add(*map_piece(2, 0, 4), cloud));
  CHECK_FALSE(map.complete());
  CHECK(map.add(*map_piece(2, 4, 3), cloud));
  CHECK(map.complete());
  CHECK(map.stamp_ns() == 102);
  REQUIRE(cloud.size() == 7);
  const std::string frame = "map";
  const CloudMessage& message = cloud.message(1, frame);
  for (std::uint32_t i = 0; i < 7; ++i) {
    float x_m = 0.0F;
    std::memcpy(&x_m, message.data._buffer + i * message.point_step, sizeof(x_m));
    CHECK(x_m == static_cast<float>(i));
  }
  CHECK_FALSE(map.add(*map_piece(3, 0, 2), cloud));
  CHECK_FALSE(map.add(*map_piece(3, 4, 3), cloud));  // points 2 and 3 were lost
  CHECK_FALSE(map.add(*map_piece(4, 2, 2), cloud));
  CHECK(map.add(*map_piece(5, 0, 7), cloud));
  auto broken = map_piece(6, 0, 7);
  broken->point_count = 8;
  CHECK_FALSE(map.add(*broken, cloud));
}

TEST_CASE("diagnostics copy texts, truncate long ones and count entries beyond the capacity") {
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
  REQUIRE(builder->message().status._length == DiagnosticsBuilder::kMaxStatuses);
  const auto& last = builder->message().status._buffer[DiagnosticsBuilder::kMaxStatuses - 1];
  CHECK(std::string(last.name) == "isobar: bridge/diagnostics_dropped");
  CHECK(last.level == 1);
  // One entry before, twice the capacity after it, of which one place is the counter's.
  CHECK(std::string(last.values._buffer[0].value) == std::to_string(DiagnosticsBuilder::kMaxStatuses + 2));
  builder->start(0);
  CHECK(builder->message().status._length == 0);
}

TEST_CASE("the domain configuration enables multicast on loopback and never enables iceoryx") {
  const std::vector<Interface> both{{.name = "lo", .address = "127.0.0.1", .is_loopback = true},
                                    {.name = "wlan0", .address = "192.0.2.2"}};
  ParticipantSettings settings;
  settings.max_message_bytes = 65500;
  settings.peers = "192.0.2.9, 192.0.2.10";
  const std::string xml = domain_configuration(settings, both);
  CHECK(xml.find("<NetworkInterface address=\"127.0.0.1\" multicast=\"true\"/>") != std::string::npos);
  CHECK(xml.find("<NetworkInterface address=\"192.0.2.2\"/>") != std::string::npos);
  CHECK(xml.find("<MaxMessageSize>65500B") != std::string::npos);
  for (const char* peer : {"127.0.0.1", "192.0.2.9", "192.0.2.10"}) {
    CHECK(xml.find(std::string("<Peer address=\"") + peer + "\"/>") != std::string::npos);
  }
  CHECK(xml.find("<SharedMemory><Enable>false</Enable></SharedMemory>") != std::string::npos);
}

TEST_CASE("CYCLONEDDS_URI follows the own configuration, so that it wins, and replaces its interfaces") {
  const std::vector<Interface> lo{{.name = "lo", .address = "127.0.0.1", .is_loopback = true}};
  ParticipantSettings settings;
  settings.uri = "file:///etc/cyclone.xml";
  CHECK(domain_configuration(settings, lo).ends_with("</Domain>,file:///etc/cyclone.xml"));
  CHECK(domain_configuration(settings, lo).find("NetworkInterface") != std::string::npos);
  settings.uri_names_interfaces = true;
  CHECK(domain_configuration(settings, lo).find("NetworkInterface") == std::string::npos);
}

}  // namespace

}  // namespace isobar::test::test_dds_messages
