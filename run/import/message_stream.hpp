// SPDX-License-Identifier: BSD-3-Clause
// Recorded messages in the order of the file, whatever the container.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "run/recording/tally.hpp"

namespace isobar::imports {

/// How the bytes of a message are laid out.
enum class Encoding : std::uint8_t {
  kRos1,   ///< ROS 1: little-endian, packed
  kCdr,    ///< ROS 2: plain CDR (XCDR1) behind an encapsulation header
  kOther,  ///< one that is not read: protobuf, JSON …
};

/// A topic of a container.
struct Channel {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu", also where ROS 2 says "sensor_msgs/msg/Imu"
  Encoding encoding = Encoding::kOther;
  std::string encoding_name;  ///< as the container says it
  std::string schema;         ///< definition of the type, where the container has one
};

struct Message {
  std::size_t channel = 0;              ///< index of channels()
  std::int64_t log_ns = 0;              ///< when the recorder received it, its own clock
  std::span<const std::uint8_t> bytes;  ///< valid until the next call of next()
};

/// Reader of a container from its first byte on, without its index: a file without an end, or with a damaged part, is read
/// as far as it goes.
class MessageStream {
 public:
  MessageStream() = default;
  virtual ~MessageStream() = default;
  MessageStream(const MessageStream&) = delete;
  MessageStream& operator=(const MessageStream&) = delete;

  /// The next message; false at the end, and where nothing more can be read.
  virtual bool next(Message& message) = 0;
  /// The topics seen so far; indices stay.
  [[nodiscard]] virtual const std::vector<Channel>& channels() const = 0;
  /// Parts that could not be read: "FILE: byte 8123: rule" of the first one.
  [[nodiscard]] virtual const recording::Tally& damage() const = 0;
  /// Fraction of the bytes read, 0 … 1.
  [[nodiscard]] virtual double progress() const = 0;
  /// "rosbag2 (sqlite3)", "MCAP" …
  [[nodiscard]] virtual std::string container() const = 0;
};

/// Whether `source` is a container that open_messages() reads: by the first bytes of a file, for a folder by its
/// metadata.yaml or its files.
[[nodiscard]] bool holds_messages(const std::filesystem::path& source);

/// Opens a rosbag1, MCAP or rosbag2 file (.db3), compressed as a whole or not, or the folder of the files of one bag.
/// @throws DataError when it is missing or none of them
[[nodiscard]] std::unique_ptr<MessageStream> open_messages(const std::filesystem::path& source);

/// Opens one file of these.
/// @param message_compression of a rosbag2 in SQLite whose messages are compressed one by one: "zstd"; else empty
/// @throws DataError when it is missing or none of them
[[nodiscard]] std::unique_ptr<MessageStream> open_message_file(const std::filesystem::path& file,
                                                               const std::string& message_compression);

/// "sensor_msgs/Imu" of "sensor_msgs/msg/Imu".
[[nodiscard]] std::string plain_type(const std::string& type);

}  // namespace isobar::imports
