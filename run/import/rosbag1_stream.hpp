// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/import/byte_cursor.hpp"
#include "run/import/message_stream.hpp"
#include "run/import/record_stream.hpp"

namespace isobar::imports {

inline constexpr std::string_view kRosbag1Magic = "#ROSBAG V2.0\n";

/// Header and data of a record.
struct Rosbag1Record {
  std::uint64_t at = 0;  ///< in the file
  std::span<const std::uint8_t> header;
  std::span<const std::uint8_t> data;
};

/// Reader of a ROS 1 bag, version 2.0 (wiki.ros.org/Bags/Format/2.0): chunks none, bz2 and lz4. The index at the end is
/// not needed: `rosbag record` leaves a bag without one (.bag.active) when it is killed.
class Rosbag1Stream : public RecordStream<Rosbag1Record> {
 public:
  /// @throws DataError when the file cannot be read or does not begin as a bag of this version
  explicit Rosbag1Stream(const std::filesystem::path& file);

  [[nodiscard]] std::string container() const override { return "rosbag1"; }

 private:
  bool next_in_file(Rosbag1Record& record) override;
  void read_record(ByteCursor& cursor, Rosbag1Record& record) const override;
  bool take(const Rosbag1Record& record, Message& message) override;
  void open_chunk(const Rosbag1Record& record);
  void add_connection(const Rosbag1Record& record);

  std::vector<std::uint8_t> header_;
  std::vector<std::uint8_t> data_;
  std::uint64_t index_at_ = 0;  // as the bag's header says; 0: it was never closed
  bool ended_ = false;
  std::map<std::uint32_t, std::size_t> channel_of_id_;
};

}  // namespace isobar::imports
