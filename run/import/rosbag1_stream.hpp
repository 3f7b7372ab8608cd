// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "run/import/byte_cursor.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/message_stream.hpp"

namespace isobar::imports {

inline constexpr std::string_view kRosbag1Magic = "#ROSBAG V2.0\n";

/// Reader of a ROS 1 bag, version 2.0 (wiki.ros.org/Bags/Format/2.0): chunks none, bz2 and lz4. The index at the end is
/// not needed: `rosbag record` leaves a bag without one (.bag.active) when it is killed.
class Rosbag1Stream : public MessageStream {
 public:
  /// @throws DataError when the file cannot be read or does not begin as a bag of this version
  explicit Rosbag1Stream(const std::filesystem::path& file);

  bool next(Message& message) override;
  [[nodiscard]] const std::vector<Channel>& channels() const override { return channels_; }
  [[nodiscard]] const recording::Tally& damage() const override { return damage_; }
  [[nodiscard]] double progress() const override;
  [[nodiscard]] std::string container() const override { return "rosbag1"; }

 private:
  /// Header and data of a record.
  struct Record {
    std::uint64_t at = 0;  // in the file
    std::span<const std::uint8_t> header;
    std::span<const std::uint8_t> data;
  };

  bool next_in_file(Record& record);
  bool next_in_chunk(Record& record);
  bool take(const Record& record, Message& message);
  void open_chunk(const Record& record);
  void add_connection(const Record& record);
  void note(std::uint64_t at, const char* rule);

  FileBytes file_;
  std::vector<std::uint8_t> header_;
  std::vector<std::uint8_t> data_;
  std::vector<std::uint8_t> chunk_;
  std::size_t chunk_used_ = 0;
  std::uint64_t chunk_at_ = 0;
  std::uint64_t index_at_ = 0;  // as the bag's header says; 0: it was never closed
  bool ended_ = false;
  std::map<std::uint32_t, std::size_t> channel_of_id_;
  std::vector<Channel> channels_;
  recording::Tally damage_;
};

}  // namespace isobar::imports
