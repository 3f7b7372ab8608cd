// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/topic_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/plausibility.hpp"
#include "core/stamp.hpp"

namespace isobar::tools {
namespace {

using imports::MessageCursor;
using imports::MessageHeader;

/// Values that are kept of a topic: a unit shows in fewer.
constexpr std::size_t kMostValues = 20'000;
/// Clouds whose fields are looked at: times in points tell their unit in the first ones.
constexpr std::uint64_t kCloudsDecoded = 3;
/// Longest step over which rates are integrated [s].
constexpr double kLongestStepS = 0.5;

struct KindOfType {
  std::string_view type;
  TopicKind kind;
};
constexpr std::array kKinds{
    KindOfType{"sensor_msgs/PointCloud2", TopicKind::kCloud},
    KindOfType{"livox_ros_driver/CustomMsg", TopicKind::kLivox},
    KindOfType{"livox_ros_driver2/CustomMsg", TopicKind::kLivox},
    KindOfType{"livox_interfaces/CustomMsg", TopicKind::kLivox},
    KindOfType{"sensor_msgs/Imu", TopicKind::kImu},
    KindOfType{"sensor_msgs/FluidPressure", TopicKind::kPressure},
    KindOfType{"sensor_msgs/Temperature", TopicKind::kTemperature},
    KindOfType{"nav_msgs/Odometry", TopicKind::kOdometry},
    KindOfType{"geometry_msgs/TwistStamped", TopicKind::kTwist},
    KindOfType{"geometry_msgs/PoseStamped", TopicKind::kPose},
    KindOfType{"geometry_msgs/PoseWithCovarianceStamped", TopicKind::kPose},
    KindOfType{"geometry_msgs/TransformStamped", TopicKind::kPose},
    KindOfType{"tf2_msgs/TFMessage", TopicKind::kFrames},
    KindOfType{"tf/tfMessage", TopicKind::kFrames},
    KindOfType{"std_msgs/String", TopicKind::kText},
};

void keep(std::vector<double>& values, double value) {
  if (values.size() < kMostValues) values.push_back(value);
}

/// Reads the messages of one container.
class Surveyor {
 public:
  explicit Surveyor(TopicSurvey& survey) : survey_(survey), scan_(std::make_unique<Scan>()) {}

  void take(const imports::MessageStream& stream, const imports::Message& message) {
    while (survey_.topics.size() < stream.channels().size())
      add_topic(stream.channels()[survey_.topics.size()]);
    TopicFindings& topic = survey_.topics[message.channel];
    if (topic.messages++ == 0) topic.first_log_ns = message.log_ns;
    topic.last_log_ns = message.log_ns;
    if (topic.kind == TopicKind::kOther) return;
    MessageHeader header;
    const char* rule = topic.channel.encoding == imports::Encoding::kOther
                           ? "is in an encoding that is not read"
                           : read(topic, MessageCursor(message.bytes, topic.channel.encoding), header);
    if (rule != nullptr) {
      if (topic.broken++ == 0) topic.first_rule = rule;
      return;
    }
    note_header(topic, header, message.log_ns);
  }

 private:
  void add_topic(const imports::Channel& channel) {
    TopicFindings topic;
    topic.channel = channel;
    topic.channel.schema.clear();
    topic.kind = kind_of(channel.type);
    if (topic.kind == TopicKind::kPackets) topic.votes = std::make_shared<ModelVotes>();
    survey_.topics.push_back(std::move(topic));
    last_imu_.emplace_back();
  }

  void note_header(TopicFindings& topic, const MessageHeader& header, std::int64_t log_ns) {
    if (topic.frame_id.empty()) topic.frame_id = header.frame_id;
    if (header.stamp_ns <= 0 || implausible_stamp(header.stamp_ns) != nullptr) {
      ++topic.without_stamp;
      return;
    }
    const std::int64_t lag_ns = log_ns - header.stamp_ns;
    topic.least_lag_ns = std::min(topic.least_lag_ns.value_or(lag_ns), lag_ns);
  }

  const char* read(TopicFindings& topic, MessageCursor cursor, MessageHeader& header) {
    switch (topic.kind) {
      case TopicKind::kImu:
        return read_imu(topic, cursor, header);
      case TopicKind::kPressure: {
        PressureSample sample;
        const char* rule = imports::read_pressure(cursor, header, sample);
        if (rule == nullptr) keep(topic.first_values, sample.pressure_pa);
        return rule;
      }
      case TopicKind::kTemperature: {
        double temperature_c = 0.0;
        return imports::read_temperature(cursor, header, temperature_c);
      }
      case TopicKind::kCloud:
      case TopicKind::kLivox:
        return read_cloud(topic, cursor, header);
      case TopicKind::kPackets:
        return read_packets(topic, cursor, header);
      case TopicKind::kText:
        return imports::read_string(cursor, topic.text);
      default:
        return read_motion(topic, cursor, header);
    }
  }

  const char* read_motion(TopicFindings& topic, MessageCursor cursor, MessageHeader& header) {
    switch (topic.kind) {
      case TopicKind::kOdometry: {
        imports::OdometryMessage message;
        const char* rule = imports::read_odometry(cursor, message);
        header = message.pose.header;
        if (topic.child_frame.empty()) topic.child_frame = message.pose.child;
        topic.has_twist = topic.has_twist || message.twist.vx_m_s != 0.0 || message.twist.wz_rad_s != 0.0;
        return rule;
      }
      case TopicKind::kTwist: {
        WheelSample sample;
        return imports::read_twist(cursor, header, sample);
      }
      case TopicKind::kPose: {
        imports::StampedPose pose;
        const char* rule = topic.channel.type == "geometry_msgs/TransformStamped"
                               ? imports::read_transform(cursor, pose)
                               : imports::read_pose(cursor, pose);
        header = pose.header;
        if (topic.child_frame.empty()) topic.child_frame = pose.child;
        return rule;
      }
      case TopicKind::kFrames: {
        std::vector<imports::StampedPose> transforms;
        const char* rule = imports::read_transforms(cursor, transforms);
        survey_.frames.add(transforms);
        return rule;
      }
      default:
        return nullptr;
    }
  }

  const char* read_imu(TopicFindings& topic, MessageCursor cursor, MessageHeader& header) {
    ImuSample sample;
    if (const char* rule = imports::read_imu(cursor, header, sample); rule != nullptr) return rule;
    keep(topic.first_values, sample.accel_m_s2.norm());
    keep(topic.second_values, sample.gyro_rad_s.norm());
    std::optional<ImuSample>& last = last_imu_[static_cast<std::size_t>(&topic - survey_.topics.data())];
    const double step_s = last ? seconds_between(last->stamp_ns, sample.stamp_ns) : 0.0;
    if (step_s > 0.0 && step_s < kLongestStepS) {
      topic.rate_turn += step_s * sample.gyro_rad_s.norm();
      if (sample.has_attitude && last->has_attitude) {
        topic.attitude_turn_rad += last->q_world_imu.angularDistance(sample.q_world_imu);
      }
    }
    last = sample;
    return nullptr;
  }

  const char* read_cloud(TopicFindings& topic, MessageCursor cursor, MessageHeader& header) {
    const char* rule = topic.kind == TopicKind::kLivox ? imports::read_livox(cursor, cloud_)
                                                       : imports::read_cloud(cursor, cloud_);
    header = cloud_.header;
    if (rule != nullptr || topic.messages > kCloudsDecoded) return rule;
    std::vector<CloudField> fields;
    for (const auto& field : cloud_.cloud.fields) {
      fields.push_back({field.name, field.offset, static_cast<CloudType>(field.datatype)});
    }
    CloudDecoder decoder;
    rule = decoder.decode({.fields = fields,
                           .width = cloud_.cloud.width,
                           .height = cloud_.cloud.height,
                           .point_step = cloud_.cloud.point_step,
                           .row_step = cloud_.cloud.row_step,
                           .is_bigendian = cloud_.cloud.is_bigendian,
                           .data = cloud_.cloud.data,
                           .stamp_ns = cloud_.cloud.stamp_ns},
                          *scan_);
    if (rule == nullptr) topic.cloud_text = decoder.sentence();
    return rule;
  }

  const char* read_packets(TopicFindings& topic, MessageCursor cursor, MessageHeader& header) {
    imports::PacketsMessage message;
    const char* rule = imports::read_packets(topic.channel.type, cursor, message);
    header = message.header;
    if (rule != nullptr) return rule;
    topic.packets += message.packets.size();
    for (const imports::PacketOfMessage& packet : message.packets) topic.votes->add(packet.bytes);
    return nullptr;
  }

  TopicSurvey& survey_;
  std::unique_ptr<Scan> scan_;
  imports::CloudMessage cloud_;
  std::vector<std::optional<ImuSample>> last_imu_;  // by topic
};

}  // namespace

TopicKind kind_of(const std::string& type) {
  if (imports::holds_packets(type)) return TopicKind::kPackets;
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const KindOfType& known) { return known.type == type; });
  return found == kKinds.end() ? TopicKind::kOther : found->kind;
}

double TopicFindings::rate_hz() const {
  const double span_s = seconds_between(first_log_ns, last_log_ns);
  return messages > 1 && span_s > 0.0 ? static_cast<double>(messages - 1) / span_s : 0.0;
}

TopicSurvey survey_topics(const std::filesystem::path& source, const std::function<void(double)>& progress) {
  TopicSurvey survey;
  const auto stream = imports::open_messages(source);
  Surveyor surveyor(survey);
  imports::Message message;
  for (std::uint64_t messages = 0; stream->next(message); ++messages) {
    surveyor.take(*stream, message);
    if (messages % 64 == 0) progress(stream->progress());
  }
  survey.container = stream->container();
  survey.damage = stream->damage();
  return survey;
}

}  // namespace isobar::tools
