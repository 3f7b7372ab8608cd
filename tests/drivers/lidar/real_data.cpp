// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/lidar/real_data.hpp"

#include <sqlite3.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
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

/// CDR, little-endian (OMG DDS-RTPS): std_msgs/Header, then a sequence of (time stamp, flags, bytes), padded to 4 bytes
/// only. Hesai's and RoboSense's bytes are followed by the number of those that are used.
void parse_scan_message(const std::vector<std::uint8_t>& cdr, const BagFormat& format,
                        std::vector<RawPacket>& packets) {
  constexpr std::size_t kEncapsulation = 4;
  const auto aligned = [](std::size_t at) { return (at - kEncapsulation + 3) / 4 * 4 + kEncapsulation; };
  std::size_t at = kEncapsulation + 8;  // stamp of the header
  const auto name_length = value_at<std::uint32_t>(cdr, at);
  at += 4 + name_length;
  at = aligned(at);
  const auto count = value_at<std::uint32_t>(cdr, at);
  at += 4;
  for (std::uint32_t i = 0; i < count; ++i) {
    at = aligned(at);
    RawPacket packet;
    packet.stamp_ns =
        value_at<std::int32_t>(cdr, at) * std::int64_t{1'000'000'000} + value_at<std::uint32_t>(cdr, at + 4);
    at += 8 + format.flags;
    if (at + format.packet_bytes > cdr.size()) throw std::runtime_error("the message ends early");
    const auto begin = cdr.begin() + static_cast<std::ptrdiff_t>(at);
    at += format.packet_bytes;
    std::size_t used = format.packet_bytes;
    if (format.has_size) {
      at = aligned(at);
      used = value_at<std::uint32_t>(cdr, at);
      at += 4;
    }
    packet.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(used));
    packets.push_back(std::move(packet));
  }
}

}  // namespace

std::vector<RawPacket> read_bag_packets(const std::filesystem::path& bag, const BagFormat& format) {
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
    parse_scan_message({data, data + sqlite3_column_bytes(statement, 0)}, format, packets);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return packets;
}

std::vector<TruthPoint> read_truth_pcd(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::string> fields;
  std::vector<std::size_t> sizes;
  std::string line;
  bool is_binary = false;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "FIELDS")
      while (words >> word) fields.push_back(word);
    if (word == "SIZE")
      for (std::size_t size = 0; words >> size;) sizes.push_back(size);
    if (word != "DATA") continue;
    words >> word;
    is_binary = word == "binary";
    break;
  }
  std::vector<TruthPoint> points;
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::istringstream text(std::string(bytes.begin(), bytes.end()));
  for (std::size_t at = 0; is_binary ? at < bytes.size() : bool(text >> std::ws) && !text.eof();) {
    TruthPoint point{};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      double value = 0.0;
      if (!is_binary) {
        text >> value;
      } else if (fields[i] == "x" || fields[i] == "y" || fields[i] == "z") {
        value = value_at<float>(bytes, at);
      } else {
        value = sizes[i] == 1   ? value_at<std::uint8_t>(bytes, at)
                : sizes[i] == 2 ? value_at<std::uint16_t>(bytes, at)
                                : value_at<std::uint32_t>(bytes, at);
      }
      at += sizes[i];
      if (fields[i] == "x") point.x_m = static_cast<float>(value);
      if (fields[i] == "y") point.y_m = static_cast<float>(value);
      if (fields[i] == "z") point.z_m = static_cast<float>(value);
      if (fields[i] == "intensity") point.intensity = static_cast<std::uint8_t>(value);
      if (fields[i] == "channel") point.channel = static_cast<std::uint16_t>(value);
    }
    points.push_back(point);
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

void PointGrid::add(const Scan& scan) {
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    const ScanPoint& p = scan.points[i];
    cells_[key(p.x_m, p.y_m, p.z_m, 0, 0, 0)].push_back(p);
  }
}

NearestPoint PointGrid::nearest(const TruthPoint& t) const {
  NearestPoint best;
  for (int i = 0; i < 27; ++i) {
    const auto cell = cells_.find(key(t.x_m, t.y_m, t.z_m, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    if (cell == cells_.end()) continue;
    for (const ScanPoint& p : cell->second) {
      const double apart_m = std::hypot(double{p.x_m} - t.x_m, double{p.y_m} - t.y_m, double{p.z_m} - t.z_m);
      if (apart_m < best.apart_m) best = {apart_m, p};
    }
  }
  return best;
}

std::int64_t PointGrid::key(float x, float y, float z, int dx, int dy, int dz) {
  const auto cell = [](float v, int d) {
    return static_cast<std::int64_t>(std::floor(v / 0.05F)) + d + 4'000;
  };
  return (cell(x, dx) * 100'000 + cell(y, dy)) * 100'000 + cell(z, dz);
}

std::vector<std::unique_ptr<Scan>> scans_of(ScanAssembler& assembler, const std::vector<RawPacket>& packets) {
  std::vector<std::unique_ptr<Scan>> scans;
  auto scan = std::make_unique<Scan>();
  for (const auto& packet : packets) {
    if (assembler.add_packet(packet.bytes, packet.stamp_ns, *scan).scan_complete) {
      scans.push_back(std::move(scan));
      scan = std::make_unique<Scan>();
    }
  }
  if (assembler.flush(*scan)) scans.push_back(std::move(scan));
  return scans;
}

}  // namespace isobar::test
