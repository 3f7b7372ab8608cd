// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "run/recording/input_log.hpp"

namespace isobar::test::test_input_log {

using namespace isobar::recording;

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::uint32_t kSender = 0xC0A8'0105;

std::vector<std::uint8_t> payload(std::size_t length) {
  std::vector<std::uint8_t> bytes(length);
  for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::uint8_t>(7 * i + 3);
  return bytes;
}

ImuSample an_imu_sample() {
  ImuSample sample;
  sample.stamp_ns = kStart + 5;
  sample.gyro_rad_s = {0.1, -0.2, 1.0 / 3.0};
  sample.accel_m_s2 = {1e-7, 0.0, 9.81};
  sample.q_world_imu = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  sample.has_attitude = true;
  return sample;
}

PressureSample a_pressure_sample() {
  return {kStart + 6, 101'325.0 + 1.0 / 3.0, std::numeric_limits<double>::quiet_NaN(), 0.25, 1};
}

WheelSample a_wheel_sample() {
  WheelSample sample{kStart + 7, 0.5, -0.25, 0.125};
  sample.vx_variance_m2_s2 = 1.0 / 3.0;
  sample.wz_variance_rad2_s2 = 0.01;
  return sample;
}

/// One record of each kind; `ends` receives the length of the log after each.
InputLog a_log(std::vector<std::size_t>& ends) {
  InputLog log;
  const auto end = [&] { ends.push_back(log.bytes().size()); };
  REQUIRE(log.add_description(17, "version = 1\n", "method = \"3dof\"\n"));
  end();
  REQUIRE(log.add_packet(kStart, kSender, payload(1'206)));
  end();
  log.add(an_imu_sample());
  end();
  log.add_pressure(a_pressure_sample());
  end();
  log.add_base_pressure(a_pressure_sample());
  end();
  log.add(a_wheel_sample());
  end();
  log.add_losses(12);
  end();
  return log;
}

std::size_t records_in(std::span<const std::uint8_t> bytes, bool& damaged) {
  InputLogReader reader(bytes);
  LogEntry entry;
  std::size_t records = 0;
  while (reader.next(entry)) ++records;
  damaged = reader.damaged();
  return records;
}

}  // namespace

TEST_CASE("every record of an input log reads back with the same bits") {
  std::vector<std::size_t> ends;
  const InputLog log = a_log(ends);
  CHECK(log.records() == 7);
  InputLogReader reader(log.bytes());
  LogEntry entry;
  REQUIRE(reader.next(entry));
  CHECK(entry.kind == LogKind::kDescription);
  CHECK(entry.robot_clock_offset_ns == 17);
  CHECK(entry.manifest == "version = 1\n");
  CHECK(entry.settings == "method = \"3dof\"\n");
  REQUIRE(reader.next(entry));
  CHECK(entry.kind == LogKind::kPacket);
  CHECK(entry.stamp_ns == kStart);
  CHECK(entry.sender_ipv4 == kSender);
  CHECK(std::vector<std::uint8_t>(entry.packet.begin(), entry.packet.end()) == payload(1'206));
  REQUIRE(reader.next(entry));
  const ImuSample imu = an_imu_sample();
  CHECK(entry.kind == LogKind::kImu);
  CHECK(entry.imu.stamp_ns == imu.stamp_ns);
  CHECK(entry.imu.gyro_rad_s == imu.gyro_rad_s);
  CHECK(entry.imu.accel_m_s2 == imu.accel_m_s2);
  CHECK(entry.imu.q_world_imu.coeffs() == imu.q_world_imu.coeffs());
  CHECK(entry.imu.has_attitude);
  for (const LogKind kind : {LogKind::kPressure, LogKind::kBasePressure}) {
    REQUIRE(reader.next(entry));
    CHECK(entry.kind == kind);
    CHECK(entry.pressure.stamp_ns == kStart + 6);
    CHECK(entry.pressure.pressure_pa == a_pressure_sample().pressure_pa);
    CHECK(std::isnan(entry.pressure.temperature_c));
    CHECK(entry.pressure.variance_pa2 == 0.25);
    CHECK(entry.pressure.station == 1);
  }
  REQUIRE(reader.next(entry));
  CHECK(entry.kind == LogKind::kWheel);
  CHECK(entry.wheel.stamp_ns == kStart + 7);
  CHECK(entry.wheel.vx_m_s == 0.5);
  CHECK(entry.wheel.vy_m_s == -0.25);
  CHECK(entry.wheel.wz_rad_s == 0.125);
  CHECK(entry.wheel.vx_variance_m2_s2 == 1.0 / 3.0);
  CHECK(std::isnan(entry.wheel.vy_variance_m2_s2));
  CHECK(entry.wheel.wz_variance_rad2_s2 == 0.01);
  REQUIRE(reader.next(entry));
  CHECK(entry.kind == LogKind::kLosses);
  CHECK(entry.losses == 12);
  CHECK_FALSE(reader.next(entry));
  CHECK_FALSE(reader.damaged());
  CHECK(reader.consumed() == log.bytes().size());
}

TEST_CASE("a log that is cut at any byte is readable up to the cut, and counts as cut, not as damaged") {
  std::vector<std::size_t> ends;
  const InputLog log = a_log(ends);
  std::size_t whole = 0;
  for (std::size_t length = 0; length <= log.bytes().size(); ++length) {
    while (whole < ends.size() && ends[whole] <= length) ++whole;
    bool damaged = true;
    const std::size_t records = records_in(log.bytes().first(length), damaged);
    REQUIRE_MESSAGE(records == whole, "cut at byte " << length);
    REQUIRE_MESSAGE(!damaged, "cut at byte " << length);
  }
}

TEST_CASE("no single changed byte is read as data: the log ends before the record that it hits") {
  std::vector<std::size_t> ends;
  const InputLog log = a_log(ends);
  for (std::size_t at = 0; at < log.bytes().size(); ++at) {
    std::vector<std::uint8_t> bytes(log.bytes().begin(), log.bytes().end());
    bytes[at] ^= 0x10;
    std::size_t intact = 0;
    while (ends[intact] <= at) ++intact;
    bool damaged = false;
    REQUIRE_MESSAGE(records_in(bytes, damaged) == intact, "changed byte " << at);
  }
}

TEST_CASE("a record longer than the format allows is refused on writing") {
  InputLog log;
  CHECK_FALSE(log.add_packet(kStart, kSender, payload(kMaxLogRecordBytes)));
  CHECK_FALSE(log.add_description(0, std::string(kMaxLogRecordBytes, 'x'), ""));
  CHECK(log.bytes().empty());
  CHECK(log.records() == 0);
}

}  // namespace isobar::test::test_input_log
