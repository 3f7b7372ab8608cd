// SPDX-License-Identifier: BSD-3-Clause
// The recording vn100-serial of another project: 99 binary packets among text, and their values.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "drivers/vn100/measurement.hpp"
#include "drivers/vn100/stream_parser.hpp"

namespace isobar::test::test_real_vn100 {

using namespace vn100;
using Bytes = std::vector<std::uint8_t>;

namespace {

const std::filesystem::path kFolder = std::filesystem::path(ISOBAR_SHARED_DATA) / "vn100-serial";

bool data_is_missing() {
  if (std::filesystem::exists(kFolder)) return false;
  MESSAGE("skipped: " << kFolder.string() << " is not on this machine");
  return true;
}

Bytes load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Rows of F00294_B, without its heading.
std::vector<std::vector<double>> load_values() {
  std::ifstream in(kFolder / "F00294_B");
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    rows.emplace_back();
    const char* at = line.c_str();
    for (char* end = nullptr;; at = end + 1) {
      const double value = std::strtod(at, &end);
      if (end == at) break;
      rows.back().push_back(value);
    }
  }
  return rows;
}

std::vector<Bytes> packets_of(const Bytes& stream, std::size_t piece) {
  StreamParser parser;
  std::vector<Bytes> packets;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    const std::size_t count = std::min(piece, stream.size() - at);
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, parser.room().begin());
    parser.filled(count);
    if (at + count == stream.size()) parser.give_up_incomplete();
    for (Frame frame = parser.next(); frame.kind != Frame::Kind::kNone; frame = parser.next()) {
      if (frame.kind == Frame::Kind::kBinary) packets.emplace_back(frame.bytes.begin(), frame.bytes.end());
    }
  }
  return packets;
}

double real_at(std::span<const std::uint8_t> bytes, std::size_t index) {
  float value = 0.0F;
  std::memcpy(&value, bytes.data() + 4 * index, sizeof value);
  return double{value};
}

/// All fields of the packet in its order, which is that of the columns.
std::vector<double> values_of(const Bytes& packet) {
  std::vector<double> values;
  for (const auto& [group, bits] : {std::pair{3, 0x3EU}, std::pair{5, 0x3AU}}) {
    for (int bit = 0; bit < 15; ++bit) {
      const auto bytes = field(packet, group, bit);
      CHECK(bytes.empty() == ((bits >> bit & 1U) == 0));
      for (std::size_t i = 0; i < bytes.size() / 4; ++i) values.push_back(real_at(bytes, i));
    }
  }
  return values;
}

/// The file prints seven digits of a value.
bool equals_row(const std::vector<double>& values, const std::vector<double>& row) {
  bool equal = values.size() == row.size();
  for (std::size_t i = 0; equal && i < row.size(); ++i) {
    equal = std::abs(values[i] - row[i]) <= 1e-6 * std::abs(row[i]);
  }
  return equal;
}

}  // namespace

TEST_CASE("the recording holds 99 packets and no other, with the values that another program decoded") {
  if (data_is_missing()) return;
  const Bytes stream = load(kFolder / "F00294");
  const auto rows = load_values();
  for (const std::size_t piece : {std::size_t{1}, std::size_t{64}, std::size_t{1000}}) {
    const auto packets = packets_of(stream, piece);
    REQUIRE(packets.size() == 99);
    // The other program left one packet out.
    std::size_t row = 0;
    std::size_t without_row = 0;
    for (const Bytes& packet : packets) {
      if (equals_row(values_of(packet), rows.at(row))) {
        ++row;
      } else {
        ++without_row;
      }
    }
    CHECK(row == rows.size());
    CHECK(without_row == 1);
  }
}

TEST_CASE("the recording's attitude, turned into a world with z up, agrees with its accelerations") {
  if (data_is_missing()) return;
  const auto packets = packets_of(load(kFolder / "F00294"), 512);
  REQUIRE_FALSE(packets.empty());
  for (const Bytes& packet : packets) {
    const Measurement result = read_packet(packet);
    REQUIRE(result.reading.has_imu);
    REQUIRE(result.reading.imu.has_attitude);
    REQUIRE(result.reading.has_pressure);
    CHECK(result.reading.pressure.pressure_pa == doctest::Approx(102'090.0).epsilon(1e-3));
    // At rest: the specific force points up, to a degree (0.17 m/s^2).
    const Eigen::Vector3d force = result.reading.imu.q_world_imu * result.reading.imu.accel_m_s2;
    CHECK((force - Eigen::Vector3d(0, 0, 9.76)).norm() < 0.17);
  }
}

TEST_CASE("the recording cut at any byte loses at most the packet that is cut") {
  if (data_is_missing()) return;
  const Bytes stream = load(kFolder / "F00294");
  const std::size_t all = packets_of(stream, 512).size();
  // Cuts through the first packets; the rest repeats.
  for (std::size_t cut = 1; cut < 700; ++cut) {
    const Bytes tail(stream.begin() + static_cast<std::ptrdiff_t>(cut), stream.end());
    const Bytes head(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(cut));
    const std::size_t both = packets_of(head, 512).size() + packets_of(tail, 512).size();
    REQUIRE(both >= all - 1);
    REQUIRE(both <= all);
  }
}

}  // namespace isobar::test::test_real_vn100
