// SPDX-License-Identifier: BSD-3-Clause
// Every message of the recordings xsens-xbus, with the values that another program decoded.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "drivers/xsens/sample_reader.hpp"
#include "drivers/xsens/stream_parser.hpp"
#include "tests/drivers/xsens/real_xsens.hpp"

namespace isobar::test::test_real_xsens {

using namespace xsens;

namespace {

const std::filesystem::path kFolder = std::filesystem::path(ISOBAR_SHARED_DATA) / "xsens-xbus";
constexpr std::array<const char*, 4> kRecordings{"1", "2", "3", "5"};

bool data_is_missing() {
  if (std::filesystem::exists(kFolder)) return false;
  MESSAGE("skipped: " << kFolder.string() << " is not on this machine");
  return true;
}

struct Message {
  XsensBytes bytes;
  XsensBytes data;
};

std::vector<Message> messages_of(const XsensBytes& stream, std::size_t piece) {
  StreamParser parser;
  std::vector<Message> messages;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    const std::size_t count = std::min(piece, stream.size() - at);
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, parser.room().begin());
    parser.filled(count);
    if (at + count == stream.size()) parser.give_up_incomplete();
    for (Frame frame = parser.next(); frame.found; frame = parser.next()) {
      messages.push_back({{frame.bytes.begin(), frame.bytes.end()}, {frame.data.begin(), frame.data.end()}});
    }
  }
  return messages;
}

struct Kind {
  const char* name;
  std::size_t numbers;  ///< 0: an integer
  bool has_world = false;
  bool has_format = true;
};

/// Names of the other program by identifier without its lowest four bits.
const std::map<int, Kind>& kinds() {
  static const std::map<int, Kind> all{
      {0x0810, {"Temperature", 1}},
      {0x1010, {"UTCTime", 0, false, false}},
      {0x1020, {"PacketCounter", 0, false, false}},
      {0x1060, {"SampleTimeFine", 0, false, false}},
      {0x1070, {"SampleTimeCoarse", 0, false, false}},
      {0x2010, {"Quaternion", 4, true}},
      {0x2020, {"RotationMatrix", 9, true}},
      {0x2030, {"EulerAngles", 3, true}},
      {0x3010, {"BaroPressure", 0, false, false}},
      {0x4010, {"DeltaV", 3}},
      {0x4020, {"Acceleration", 3}},
      {0x4030, {"FreeAcceleration", 3}},
      {0x5020, {"AltitudeEllipsoid", 1}},
      {0x5030, {"PositionECEF", 3}},
      {0x5040, {"LatLon", 2}},
      {0x7010, {"GNSSPVTData", 0, false, false}},
      {0x7020, {"GNSSSatInfo", 0, false, false}},
      {0x8020, {"RateOfTurn", 3}},
      {0x8030, {"DeltaQ", 4}},
      {0xC020, {"MagneticField", 3}},
      {0xD010, {"VelocityXYZ", 3, true}},
      {0xE010, {"StatusByte", 0, false, false}},
      {0xE020, {"StatusWord", 0, false, false}},
  };
  return all;
}

/// An item as the other program prints it.
XsensItem printed(const DataItem& item) {
  const Kind& kind = kinds().at(item.id & 0xFFF0);
  constexpr std::array<const char*, 4> kFormats{"Float32", "FP1220", "FP1632", "Float64"};
  XsensItem result{kind.name, {}};
  if (kind.has_format) {
    const std::string format = kFormats[static_cast<std::size_t>(item.precision())];
    result.first += kind.has_world ? "(EastNorthUp," + format + ")" : "(" + format + ")";
    CHECK((!kind.has_world || item.world() == World::kEastNorthUp));
    REQUIRE(item.has_numbers(kind.numbers));
    for (std::size_t i = 0; i < kind.numbers; ++i) result.second.push_back(item.number(i));
  } else if (item.data.size() <= 4) {
    result.second.push_back(static_cast<double>(item.integer(item.data.size())));
  }
  return result;
}

}  // namespace

TEST_CASE("the recordings hold 100 messages each and no other byte, in every number format") {
  if (data_is_missing()) return;
  for (const char* name : kRecordings) {
    INFO(name);
    const XsensBytes stream = load_bytes(kFolder / name / "output.bin");
    const auto expected = load_hex_lines(kFolder / name / "messages.golden");
    REQUIRE(expected.size() == 100);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{64}, std::size_t{1000}}) {
      const auto messages = messages_of(stream, piece);
      REQUIRE(messages.size() == expected.size());
      for (std::size_t i = 0; i < messages.size(); ++i) REQUIRE(messages[i].bytes == expected[i]);
    }
  }
}

TEST_CASE("every item of the recordings has the values that the other program decoded") {
  if (data_is_missing()) return;
  std::size_t numbers = 0;
  for (const char* name : kRecordings) {
    const auto messages = messages_of(load_bytes(kFolder / name / "output.bin"), 512);
    const auto golden = load_golden(kFolder / name / "output.golden");
    REQUIRE(messages.size() == golden.size());
    for (std::size_t i = 0; i < messages.size(); ++i) {
      INFO(name << " message " << i);
      std::vector<XsensItem> items;
      std::span<const std::uint8_t> data = messages[i].data;
      while (const auto item = take_item(data)) items.push_back(printed(*item));
      REQUIRE(items == golden[i]);
      for (const XsensItem& item : items) numbers += item.second.size();
    }
  }
  CHECK(numbers > 8'000);
}

TEST_CASE("the vendor's own decoding of an MTi-300 agrees") {
  if (data_is_missing()) return;
  const auto examples = load_examples(kFolder / "mti-300_mtmanager_packets.md");
  REQUIRE(examples.size() == 6);
  for (const XsensExample& example : examples) {
    REQUIRE(items_fill(example.data));
    std::vector<double> numbers;
    std::span<const std::uint8_t> data = example.data;
    while (const auto item = take_item(data)) {
      const XsensItem as_text = printed(*item);
      const bool counted = as_text.first.ends_with(")") || as_text.first == "BaroPressure";
      if (counted) numbers.insert(numbers.end(), as_text.second.begin(), as_text.second.end());
    }
    REQUIRE(numbers.size() == example.numbers.size());
    // Eight decimals are printed, of floats with 24 bits.
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      CHECK(std::abs(numbers[i] - example.numbers[i]) < 1e-8 + 1e-7 * std::abs(numbers[i]));
    }
  }
}

TEST_CASE("attitude and acceleration of the recordings agree: z is up in the world") {
  if (data_is_missing()) return;
  int attitudes = 0;
  for (const char* name : {"1", "2", "3"}) {
    SampleReader reader;
    for (const Message& message : messages_of(load_bytes(kFolder / name / "output.bin"), 512)) {
      const InertialReading reading = reader.read(message.data).reading;
      if (!reading.has_imu || !reading.imu.has_attitude) continue;
      ++attitudes;
      // Nearly at rest, in a hand: to 2 degrees (0.35 m/s^2).
      const Eigen::Vector3d force = reading.imu.q_world_imu * reading.imu.accel_m_s2;
      CHECK((force - Eigen::Vector3d(0, 0, 9.81)).norm() < 0.35);
    }
  }
  CHECK(attitudes == 3 * 95);
}

TEST_CASE("matrix and quaternion of one message are one attitude, and its pressure is in pascals") {
  if (data_is_missing()) return;
  int pressures = 0;
  SampleReader reader;
  for (const Message& message : messages_of(load_bytes(kFolder / "5" / "output.bin"), 512)) {
    std::vector<Eigen::Quaterniond> attitudes;
    std::span<const std::uint8_t> data = message.data;
    while (const auto item = take_item(data)) {
      if (const auto q = read_attitude(*item); q) attitudes.push_back(*q);
    }
    if (attitudes.size() == 2) CHECK(attitudes[0].angularDistance(attitudes[1]) < 1e-3);
    const InertialReading reading = reader.read(message.data).reading;
    if (!reading.has_pressure) continue;
    ++pressures;
    CHECK(reading.pressure.pressure_pa == doctest::Approx(101'390.0).epsilon(1e-3));
  }
  CHECK(pressures == 48);
}

TEST_CASE("increments of the recordings, by their time, are the rates of the same messages") {
  if (data_is_missing()) return;
  int compared = 0;
  for (const char* name : {"1", "2", "3"}) {
    SampleReader rates;
    SampleReader increments;
    for (const Message& message : messages_of(load_bytes(kFolder / name / "output.bin"), 512)) {
      XsensBytes without;
      std::span<const std::uint8_t> data = message.data;
      while (const auto item = take_item(data)) {
        if (item->is(Item::kAcceleration) || item->is(Item::kRateOfTurn)) continue;
        without.push_back(static_cast<std::uint8_t>(item->id >> 8U));
        without.push_back(static_cast<std::uint8_t>(item->id & 0xFFU));
        without.push_back(static_cast<std::uint8_t>(item->data.size()));
        without.insert(without.end(), item->data.begin(), item->data.end());
      }
      const InertialReading direct = rates.read(message.data).reading;
      const InertialReading divided = increments.read(without).reading;
      if (!direct.has_imu || !divided.has_imu) continue;
      ++compared;
      // fp12.20 resolves 2^-20 in an increment of 10 ms: 1e-4; two of them in a turn.
      CHECK((direct.imu.accel_m_s2 - divided.imu.accel_m_s2).norm() < 2e-2);
      CHECK((direct.imu.gyro_rad_s - divided.imu.gyro_rad_s).norm() < 1e-3);
    }
  }
  CHECK(compared > 250);
}

}  // namespace isobar::test::test_real_xsens
