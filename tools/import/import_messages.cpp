// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/import_messages.hpp"

#include <cmath>
#include <limits>

#include "core/plausibility.hpp"
#include "run/import/message_stream.hpp"
#include "run/recording/udp_frame.hpp"

namespace isobar::tools {
namespace {

using imports::MessageCursor;

/// Writes the messages of the planned topics, one after the other.
class MessageWriter {
 public:
  MessageWriter(const ImportPlan& plan, recording::RecordingWriter& writer) : plan_(plan), writer_(writer) {}

  void take(const imports::MessageStream& stream, const imports::Message& message) {
    const imports::Channel& channel = stream.channels()[message.channel];
    if (channel.encoding == imports::Encoding::kOther) return;
    const MessageCursor cursor(message.bytes, channel.encoding);
    log_ns_ = message.log_ns;
    const auto is = [&](const std::optional<PlannedTopic>& planned) {
      return planned && planned->index == message.channel;
    };
    if (is(plan_.lidar)) take_lidar(channel, cursor);
    if (is(plan_.lidar_info))
      take_packets(*plan_.lidar_info, channel, cursor, plan_.manifest.lidar->info_port);
    if (is(plan_.imu)) take_imu(cursor);
    if (is(plan_.temperature)) take_temperature(cursor);
    if (is(plan_.pressure)) take_pressure(*plan_.pressure, plan_.pressure_scale, true, cursor);
    if (is(plan_.base_pressure))
      take_pressure(*plan_.base_pressure, plan_.base_pressure_scale, false, cursor);
    if (is(plan_.wheel)) take_wheel(channel, cursor);
    if (is(plan_.reference)) take_reference(channel, cursor);
  }

  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  /// A stamp of the topic's headers on the robot's clock.
  [[nodiscard]] std::int64_t stamp(const PlannedTopic& topic, std::int64_t header_ns) const {
    return (topic.uses_log_time ? log_ns_ : header_ns) + topic.shift_ns;
  }
  /// Counts what cannot be written; true for a sample that can.
  template <typename Sample>
  bool holds(const char* rule, const Sample& sample) {
    const bool good = rule == nullptr && implausible_stamp(sample.stamp_ns) == nullptr;
    left_out_ += good ? 0 : 1;
    return good;
  }

  void take_lidar(const imports::Channel& channel, MessageCursor cursor) {
    if (!plan_.manifest.lidar->holds_clouds()) {
      return take_packets(*plan_.lidar, channel, cursor, plan_.manifest.lidar->port);
    }
    const bool is_livox = channel.type.find("CustomMsg") != std::string::npos;
    const char* rule = is_livox ? imports::read_livox(cursor, cloud_) : imports::read_cloud(cursor, cloud_);
    // Times in points count on the clock of the header, so that the shift stays apart.
    const std::int64_t robot_ns = stamp(*plan_.lidar, cloud_.header.stamp_ns);
    cloud_.cloud.shift_ns = robot_ns - cloud_.cloud.stamp_ns;
    if (implausible_stamp(cloud_.cloud.stamp_ns) != nullptr || plan_.lidar->uses_log_time) {
      cloud_.cloud.stamp_ns = robot_ns;
      cloud_.cloud.shift_ns = 0;
    }
    if (holds(rule, cloud_.cloud) && !writer_.add_cloud(cloud_.cloud)) ++left_out_;
  }

  void take_packets(const PlannedTopic& topic, const imports::Channel& channel, MessageCursor cursor,
                    std::uint16_t port) {
    if (imports::read_packets(channel.type, cursor, packets_) != nullptr) {
      ++left_out_;
      return;
    }
    for (const imports::PacketOfMessage& packet : packets_.packets) {
      // Drivers stamp each packet on its receipt; some leave that empty or count on the sensor's clock.
      constexpr std::int64_t kMostApartNs = 1'000'000'000;
      const std::int64_t header_ns = packets_.header.stamp_ns;
      const bool is_near = std::abs(packet.stamp_ns - header_ns) < kMostApartNs;
      const std::int64_t stamp_ns = stamp(topic, is_near ? packet.stamp_ns : header_ns);
      const bool good = !packet.bytes.empty() && packet.bytes.size() <= recording::kMaxUdpPayloadBytes &&
                        implausible_stamp(stamp_ns) == nullptr;
      left_out_ += good ? 0 : 1;
      if (good) writer_.add_packet(stamp_ns, packet.bytes, port);
    }
  }

  void take_imu(MessageCursor cursor) {
    imports::MessageHeader header;
    ImuSample sample;
    const char* rule = imports::read_imu(cursor, header, sample);
    sample.stamp_ns = stamp(*plan_.imu, header.stamp_ns);
    sample.accel_m_s2 *= plan_.accel_scale;
    sample.gyro_rad_s *= plan_.gyro_scale;
    sample.has_attitude = sample.has_attitude && plan_.keeps_attitude;
    if (holds(rule, sample)) writer_.add_imu(sample);
  }

  void take_temperature(MessageCursor cursor) {
    imports::MessageHeader header;
    double temperature_c = 0.0;
    if (imports::read_temperature(cursor, header, temperature_c) != nullptr) return;
    temperature_c_ = kPlausibleTemperatureC.holds(temperature_c) ? temperature_c
                                                                 : std::numeric_limits<double>::quiet_NaN();
  }

  void take_pressure(const PlannedTopic& topic, double scale, bool is_robot, MessageCursor cursor) {
    imports::MessageHeader header;
    PressureSample sample;
    const char* rule = imports::read_pressure(cursor, header, sample);
    sample.stamp_ns = stamp(topic, header.stamp_ns);
    sample.pressure_pa *= scale;
    sample.variance_pa2 *= scale * scale;
    if (is_robot) sample.temperature_c = temperature_c_;
    if (!holds(rule, sample)) return;
    is_robot ? writer_.add_pressure(sample) : writer_.add_base_pressure(sample);
  }

  void take_wheel(const imports::Channel& channel, MessageCursor cursor) {
    imports::MessageHeader header;
    WheelSample sample;
    const char* rule = nullptr;
    if (kind_of(channel.type) == TopicKind::kTwist) {
      rule = imports::read_twist(cursor, header, sample);
    } else {
      imports::OdometryMessage message;
      rule = imports::read_odometry(cursor, message);
      header = message.pose.header;
      sample = message.twist;
    }
    sample.stamp_ns = stamp(*plan_.wheel, header.stamp_ns);
    if (holds(rule, sample)) writer_.add_wheel(sample);
  }

  void take_reference(const imports::Channel& channel, MessageCursor cursor) {
    imports::OdometryMessage message;
    imports::StampedPose& pose = message.pose;
    const char* rule = nullptr;
    if (kind_of(channel.type) == TopicKind::kOdometry) {
      rule = imports::read_odometry(cursor, message);
    } else if (channel.type == "geometry_msgs/TransformStamped") {
      rule = imports::read_transform(cursor, pose);
    } else {
      rule = imports::read_pose(cursor, pose);
    }
    WheelSample stamped;
    stamped.stamp_ns = stamp(*plan_.reference, pose.header.stamp_ns);
    if (holds(rule, stamped)) writer_.add_reference(stamped.stamp_ns, pose.pose * plan_.T_child_base);
  }

  const ImportPlan& plan_;
  recording::RecordingWriter& writer_;
  std::int64_t log_ns_ = 0;  // of the message
  double temperature_c_ = std::numeric_limits<double>::quiet_NaN();
  imports::CloudMessage cloud_;
  imports::PacketsMessage packets_;
  std::uint64_t left_out_ = 0;
};

}  // namespace

void write_messages(const ImportRequest& request, const ImportPlan& plan, recording::RecordingWriter& writer,
                    std::vector<std::string>& notes, const std::function<void(double)>& progress) {
  const auto stream = imports::open_messages(request.source);
  MessageWriter messages(plan, writer);
  imports::Message message;
  for (std::uint64_t count = 0; stream->next(message); ++count) {
    messages.take(*stream, message);
    if (count % 64 == 0) progress(stream->progress());
  }
  if (messages.left_out() > 0) {
    notes.push_back(std::to_string(messages.left_out()) + " broken messages or packets were left out");
  }
}

}  // namespace isobar::tools
