// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/so3.hpp"
#include "drivers/xsens/protocol.hpp"
#include "drivers/xsens/sample_reader.hpp"
#include "tests/drivers/xsens/message_writer.hpp"

namespace isobar::test::test_sample_reader {

using namespace xsens;

TEST_CASE("rates, accelerations, pressure and the last temperature make a reading") {
  SampleReader reader;
  reader.read(MessageWriter().numbers(0x0810, {36.5}).data());
  const Measurement result = reader.read(MessageWriter()
                                             .integer(0x1020, 65'535, 2)
                                             .integer(0x1060, 0xFFFFFFFFU, 4)
                                             .numbers(0x4023, {1, 2, 3})
                                             .numbers(0x8022, {4, 5, -6})
                                             .integer(0x3010, 101'389, 4)
                                             .data());
  CHECK(result.counter == 65'535);
  CHECK(result.time == 0xFFFFFFFFU);
  REQUIRE(result.reading.has_imu);
  CHECK(result.reading.imu.accel_m_s2 == Eigen::Vector3d(1, 2, 3));
  CHECK(result.reading.imu.gyro_rad_s == Eigen::Vector3d(4, 5, -6));
  REQUIRE(result.reading.has_pressure);
  CHECK(result.reading.pressure.pressure_pa == 101'389.0);
  CHECK(result.reading.pressure.temperature_c == 36.5);
}

TEST_CASE("increments are divided by their period, across lost messages and the clock's wrap") {
  const auto message = [](std::uint32_t ticks) {
    const Eigen::Quaterniond turn = exp_so3({0.0, 0.0, 0.02});
    return MessageWriter()
        .integer(0x1060, ticks, 4)
        .numbers(0x4013, {0.0, 0.0, 0.098})
        .numbers(0x8033, {turn.w(), turn.x(), turn.y(), turn.z()})
        .data();
  };
  SampleReader reader;
  CHECK_FALSE(reader.read(message(0xFFFFFF00U)).reading.has_imu);  // no period so far
  CHECK_FALSE(reader.read(message(0xFFFFFF64U)).reading.has_imu);
  CHECK_FALSE(reader.read(MessageWriter().integer(0x1060, 0xFFFFFF70U, 4).data()).reading.has_imu);
  for (const std::uint32_t ticks : {0xFFFFFFC8U, 44U, 344U, 444U, 100'000U, 100'100U}) {
    const Measurement result = reader.read(message(ticks));
    REQUIRE(result.reading.has_imu);
    CHECK(result.reading.imu.accel_m_s2.z() == doctest::Approx(9.8).epsilon(1e-9));
    CHECK(result.reading.imu.gyro_rad_s.z() == doctest::Approx(2.0).epsilon(1e-9));
  }
}

TEST_CASE(
    "increments without SampleTimeFine are divided by the period of UTC, over midnight and over seconds") {
  const auto message = [](std::uint32_t nanosecond, int hour, int minute, int second) {
    const auto part = [](int value) { return static_cast<std::uint8_t>(value); };
    std::vector<std::uint8_t> utc;
    for (int shift = 24; shift >= 0; shift -= 8)
      utc.push_back(static_cast<std::uint8_t>(nanosecond >> shift));
    for (const std::uint8_t byte :
         {part(0x07), part(0xE8), part(11), part(30), part(hour), part(minute), part(second), part(7)})
      utc.push_back(byte);
    const Eigen::Quaterniond turn = exp_so3({0.0, 0.0, 0.02});
    return MessageWriter()
        .item(0x1010, utc)
        .numbers(0x4012, {0.0, 0.0, 0.098})
        .numbers(0x8030, {turn.w(), turn.x(), turn.y(), turn.z()})
        .data();
  };
  SampleReader reader;
  const Measurement first = reader.read(message(970'000'000, 10, 59, 59));
  CHECK_FALSE(first.reading.has_imu);
  CHECK(std::string(first.lacking) == "a time (SampleTimeFine) for its increments");
  CHECK_FALSE(reader.read(message(980'000'000, 10, 59, 59)).reading.has_imu);
  for (const auto& data :
       {message(990'000'000, 10, 59, 59), message(0, 11, 0, 0), message(10'000'000, 11, 0, 0)}) {
    const Measurement result = reader.read(data);
    REQUIRE(result.reading.has_imu);
    CHECK(result.lacking == nullptr);
    CHECK(result.reading.imu.accel_m_s2.z() == doctest::Approx(9.8).epsilon(1e-6));
    CHECK(result.reading.imu.gyro_rad_s.z() == doctest::Approx(2.0).epsilon(1e-6));
  }
  CHECK(reader.read(message(990'000'000, 23, 59, 59)).reading.has_imu);
  CHECK(reader.read(message(0, 0, 0, 0)).reading.imu.gyro_rad_s.z() == doctest::Approx(2.0).epsilon(1e-6));
}

TEST_CASE("what a message lacks is named, free acceleration and legacy messages besides") {
  const auto lacking = [](const MessageWriter& writer) {
    const Measurement result = SampleReader().read(writer.data());
    CHECK_FALSE(result.reading.has_imu);
    REQUIRE(result.lacking != nullptr);
    return std::string(result.lacking);
  };
  CHECK(lacking(MessageWriter().numbers(0x4020, {1, 2, 3})) == "rate of turn");
  CHECK(lacking(MessageWriter().numbers(0x8043, {1, 2, 3})) == "acceleration");
  CHECK(lacking(MessageWriter().numbers(0x4030, {1, 2, 3}).numbers(0x8020, {1, 2, 3})) ==
        "acceleration with gravity (it has free acceleration)");
  CHECK(lacking(MessageWriter().numbers(0x2010, {1, 0, 0, 0})) == "acceleration and rate of turn");

  Settings settings;
  settings.configure = false;
  Protocol protocol(settings);
  protocol.restart();
  // MTData with a counter of samples alone: preamble, address, id, length, data, checksum.
  const std::vector<std::uint8_t> legacy{0xFA, 0xFF, 0x32, 0x02, 0x00, 0x07, 0xC6};
  std::copy(legacy.begin(), legacy.end(), protocol.room().begin());
  protocol.filled(legacy.size());
  CHECK(protocol.next().kind == serial::ImuEvent::Kind::kOther);
  REQUIRE(protocol.heard_instead() != nullptr);
  CHECK(std::string(protocol.heard_instead()) ==
        "it sends MTData of old firmware: configure = true sets MTData2");
}

TEST_CASE("an attitude is in a world with z up whatever the sensor's world and form") {
  // Rolled by 30 degrees, turned by 90 degrees from east to north.
  const Eigen::Quaterniond q = exp_so3({0, 0, std::numbers::pi / 2}) * exp_so3({std::numbers::pi / 6, 0, 0});
  const auto attitude_of = [](const MessageWriter& writer) {
    return SampleReader().read(writer.data()).reading.imu;
  };
  const auto as_quaternion = [](std::uint16_t id, const Eigen::Quaterniond& value) {
    return MessageWriter().numbers(id, {value.w(), value.x(), value.y(), value.z()});
  };
  const auto up_of = [](const ImuSample& imu) -> Eigen::Vector3d {
    REQUIRE(imu.has_attitude);
    return imu.q_world_imu.conjugate() * Eigen::Vector3d::UnitZ();
  };
  const Eigen::Vector3d up = q.conjugate() * Eigen::Vector3d::UnitZ();
  CHECK(up_of(attitude_of(as_quaternion(0x2013, q))).isApprox(up, 1e-12));
  CHECK(up_of(attitude_of(as_quaternion(0x201B, q))).isApprox(up, 1e-12));
  const Eigen::Quaterniond in_down =
      Eigen::Quaterniond(0, 1, 0, 0) * q;  // the same, told in north, east, down
  CHECK(up_of(attitude_of(as_quaternion(0x2017, in_down))).isApprox(up, 1e-12));
  CHECK_FALSE(attitude_of(as_quaternion(0x201F, q)).has_attitude);
  CHECK_FALSE(attitude_of(MessageWriter().numbers(0x2013, {0, 0, 0, 0})).has_attitude);

  const ImuSample euler = attitude_of(MessageWriter().numbers(0x2033, {30, 0, 90}));
  REQUIRE(euler.has_attitude);
  CHECK(euler.q_world_imu.angularDistance(q) < 1e-9);
  const Eigen::Matrix3d m = q.toRotationMatrix();
  const ImuSample matrix = attitude_of(MessageWriter().numbers(
      0x2023, {m(0, 0), m(1, 0), m(2, 0), m(0, 1), m(1, 1), m(2, 1), m(0, 2), m(1, 2), m(2, 2)}));
  REQUIRE(matrix.has_attitude);
  CHECK(matrix.q_world_imu.angularDistance(q) < 1e-9);
}

TEST_CASE("items of a wrong length are no values") {
  const Measurement result = SampleReader().read(MessageWriter()
                                                     .integer(0x1020, 1, 4)
                                                     .integer(0x1060, 1, 2)
                                                     .integer(0x3010, 1, 2)
                                                     .numbers(0x4020, {1, 2})
                                                     .numbers(0x8020, {1, 2, 3, 4})
                                                     .numbers(0x2010, {1, 2, 3})
                                                     .data());
  CHECK_FALSE(result.counter);
  CHECK_FALSE(result.time);
  CHECK_FALSE(result.reading.has_imu);
  CHECK_FALSE(result.reading.has_pressure);
  CHECK_FALSE(result.reading.imu.has_attitude);
}

}  // namespace isobar::test::test_sample_reader
