// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/cloud/cloud_decoder.hpp"
#include "run/import/frame_tree.hpp"
#include "run/import/message_stream.hpp"
#include "run/import/ros_messages.hpp"
#include "tools/import/model_votes.hpp"

namespace isobar::tools {

/// What a type of messages can become.
enum class TopicKind : std::uint8_t {
  kOther,
  kPackets,  ///< datagrams of a lidar
  kCloud,    ///< sensor_msgs/PointCloud2
  kLivox,    ///< a list of points of a Livox
  kImu,
  kPressure,
  kTemperature,
  kOdometry,
  kTwist,
  kPose,    ///< of the robot, from elsewhere
  kFrames,  ///< mounts
  kText,    ///< an Ouster's metadata
};

[[nodiscard]] TopicKind kind_of(const std::string& type);

/// What one topic was found to hold.
struct TopicFindings {
  imports::Channel channel;
  TopicKind kind = TopicKind::kOther;
  std::uint64_t messages = 0;
  std::uint64_t broken = 0;
  std::string first_rule;  ///< that a broken message breaks
  std::int64_t first_log_ns = 0;
  std::int64_t last_log_ns = 0;
  std::uint64_t without_stamp = 0;           ///< messages whose header's stamp is 0 or impossible
  std::optional<std::int64_t> least_lag_ns;  ///< of the log behind the header's stamps
  std::string frame_id;                      ///< of the first message
  std::string child_frame;                   ///< of an odometry
  std::vector<double> first_values;          ///< pressure, or norms of specific force; a bounded number
  std::vector<double> second_values;         ///< norms of angular rates
  double attitude_turn_rad = 0.0;            ///< sum of the turns of an IMU's attitude
  double rate_turn = 0.0;                    ///< integral of its rates, in their unit times s
  bool has_twist = false;                    ///< an odometry whose twist is not always zero
  std::string cloud_text;                    ///< what the points of a cloud hold
  std::string text;                          ///< of the last std_msgs/String
  std::shared_ptr<ModelVotes> votes;         ///< of packets
  std::uint64_t packets = 0;

  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] bool is_usable() const { return messages > broken; }
};

/// A container, read once from its beginning to its end.
struct TopicSurvey {
  std::string container;
  std::vector<TopicFindings> topics;
  imports::FrameTree frames;
  recording::Tally damage;
};

/// @param progress called with 0 … 1
[[nodiscard]] TopicSurvey survey_topics(const std::filesystem::path& source,
                                        const std::function<void(double)>& progress);

}  // namespace isobar::tools
