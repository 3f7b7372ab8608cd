// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/velodyne/real_data.hpp"

#include <sqlite3.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace isobar::test {
namespace {

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

template <typename Value>
Value value_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  if (at + sizeof(Value) > bytes.size()) {
    throw std::runtime_error("the file ends early");
  }
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// CDR, little-endian (OMG DDS-RTPS): std_msgs/Header, then a sequence of (time stamp, 1206 bytes), padded to
/// 4 bytes only.
void parse_scan_message(const std::vector<std::uint8_t>& cdr, std::vector<RawPacket>& packets) {
  constexpr std::size_t kEncapsulation = 4;
  constexpr std::size_t kPacket = 1206;
  const auto aligned = [](std::size_t at) { return (at - kEncapsulation + 3) / 4 * 4 + kEncapsulation; };
  std::size_t at = kEncapsulation + 8;  // stamp of the header
  const auto name_length = value_at<std::uint32_t>(cdr, at);
  at = aligned(at + 4 + name_length);
  const auto count = value_at<std::uint32_t>(cdr, at);
  at += 4;
  for (std::uint32_t i = 0; i < count; ++i) {
    at = aligned(at);
    RawPacket packet;
    packet.stamp_ns =
        value_at<std::int32_t>(cdr, at) * std::int64_t{1'000'000'000} + value_at<std::uint32_t>(cdr, at + 4);
    at += 8;
    if (at + kPacket > cdr.size()) {
      throw std::runtime_error("the message ends early");
    }
    packet.bytes.assign(cdr.begin() + static_cast<std::ptrdiff_t>(at),
                        cdr.begin() + static_cast<std::ptrdiff_t>(at + kPacket));
    at += kPacket;
    packets.push_back(std::move(packet));
  }
}

}  // namespace

std::vector<RawPacket> read_bag_packets(const std::filesystem::path& bag) {
  sqlite3* database = nullptr;
  const std::string name = "file:" + std::filesystem::absolute(bag).string() + "?immutable=1";
  if (sqlite3_open_v2(name.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) !=
      SQLITE_OK) {
    throw std::runtime_error("cannot open " + bag.string());
  }
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database, "SELECT data FROM messages ORDER BY timestamp", -1, &statement, nullptr);
  std::vector<RawPacket> packets;
  while (sqlite3_step(statement) == SQLITE_ROW) {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement, 0));
    parse_scan_message({data, data + sqlite3_column_bytes(statement, 0)}, packets);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return packets;
}

std::vector<TruthPoint> read_truth_pcd(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  const std::string marker = "DATA binary\n";
  const std::string head(bytes.begin(), bytes.begin() + 1'000);
  const std::size_t start = head.find(marker) + marker.size();
  constexpr std::size_t kRow = 4 + 4 + 4 + 1 + 1 + 2 + 4 + 4 + 4 + 4;
  std::vector<TruthPoint> points;
  for (std::size_t at = start; at + kRow <= bytes.size(); at += kRow) {
    points.push_back({value_at<float>(bytes, at), value_at<float>(bytes, at + 4),
                      value_at<float>(bytes, at + 8), value_at<std::uint8_t>(bytes, at + 12),
                      value_at<std::uint16_t>(bytes, at + 14), value_at<std::uint32_t>(bytes, at + 28)});
  }
  return points;
}

std::vector<RawPacket> read_simple_pcap(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  constexpr std::size_t kHeaders = 14 + 20 + 8;
  std::vector<RawPacket> packets;
  for (std::size_t at = 24; at + 16 <= bytes.size();) {
    const auto length = value_at<std::uint32_t>(bytes, at + 8);
    RawPacket packet;
    packet.stamp_ns = value_at<std::uint32_t>(bytes, at) * std::int64_t{1'000'000'000} +
                      value_at<std::uint32_t>(bytes, at + 4) * std::int64_t{1'000};
    at += 16;
    packet.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at + kHeaders),
                        bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
    at += length;
    packets.push_back(std::move(packet));
  }
  return packets;
}

}  // namespace isobar::test
