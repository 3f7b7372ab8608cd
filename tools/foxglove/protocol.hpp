// SPDX-License-Identifier: BSD-3-Clause
// Messages of Foxglove's WebSocket protocol, version 1 (github.com/foxglove/ws-protocol): texts are JSON, data are binary.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::tools::foxglove {

/// A topic that a client can subscribe to.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;       ///< "/odom"
  std::string ros_type;    ///< "nav_msgs/msg/Odometry"
  std::string definition;  ///< in encoding ros2msg
  bool is_latched = false;
};

/// What a client asks for. Other operations of the protocol, such as publishing, are not offered and are refused.
struct ViewerRequest {
  enum class Kind : std::uint8_t { kSubscribe, kUnsubscribe, kRefused };
  struct Subscription {
    std::uint32_t id = 0;  ///< chosen by the client
    std::uint32_t channel = 0;
  };
  Kind kind = Kind::kRefused;
  std::vector<Subscription> subscriptions{};  ///< of kUnsubscribe: ids only
  std::string reason{};                       ///< of kRefused, a sentence
};

/// First message to a client.
std::string server_info(std::string_view name, std::string_view session);

/// The topics, second message to a client.
std::string advertisement(std::span<const Channel> channels);

/// A sentence that the client shows. @param level 0 information, 1 warning, 2 error
std::string status(int level, std::string_view message);

/// A text of a client. Never throws: what is no request is kRefused with its reason.
ViewerRequest parse_request(std::string_view text);

/// Bytes before the payload of a data message: opcode, subscription, time of reception.
inline constexpr std::size_t kDataHeaderBytes = 1 + 4 + 8;
void write_data_header(std::uint32_t subscription, std::int64_t stamp_ns,
                       std::span<std::uint8_t, kDataHeaderBytes> out);

}  // namespace isobar::tools::foxglove
