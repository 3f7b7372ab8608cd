// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "drivers/vn100/measurement.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"

namespace isobar::test::test_measurement {

using namespace vn100;

namespace {

Eigen::Vector3d down_in_imu(const Eigen::Quaterniond& q_world_imu) {
  return q_world_imu.conjugate() * -Eigen::Vector3d::UnitZ();
}

}  // namespace

TEST_CASE("a packet of the driver's own output gives time, rates, pressure and temperature") {
  const Measurement result = read_packet(own_packet(12'345'678'901'234ULL));
  CHECK(result.has_time);
  CHECK(result.time_startup_ns == 12'345'678'901'234);
  REQUIRE(result.reading.has_imu);
  CHECK(result.reading.imu.accel_m_s2.isApprox(Eigen::Vector3d(0.1, -0.2, -9.8), 1e-6));
  CHECK(result.reading.imu.gyro_rad_s.isApprox(Eigen::Vector3d(0.01, -0.02, 0.25), 1e-6));
  CHECK_FALSE(result.reading.imu.has_attitude);
  REQUIRE(result.reading.has_pressure);
  CHECK(result.reading.pressure.pressure_pa == doctest::Approx(101'325.0).epsilon(1e-6));
  CHECK(result.reading.pressure.temperature_c == doctest::Approx(21.5));
}

TEST_CASE("the quaternion and the angles of the manual's examples are one attitude, scalar last") {
  // UM001 sections 7.2.1 and 7.2.2, registers 8 and 9, read one after the other: equal to 0.1 degree.
  const Eigen::Quaterniond from_angles = from_yaw_pitch_roll({6.271, 0.031, -2.000});
  const Eigen::Quaterniond quaternion(0.998308, -0.017386, -0.000303, 0.055490);
  CHECK(from_angles.angularDistance(quaternion) < 0.1 * std::numbers::pi / 180.0 * 1.1);
  CHECK(from_angles.angularDistance(quaternion.conjugate()) > 0.1);
}

TEST_CASE("the attitude in a world with z up agrees with gravity in the manual's example") {
  // Register 15: quaternion and acceleration (-0.019, 0.320, -9.802) of one instant. 0.03 m/s^2: the lever of
  // 0.2 degrees between filter and acceleration.
  const Eigen::Quaterniond q = to_world_z_up({0.998255, -0.017057, -0.000767, 0.056534});
  const Eigen::Vector3d specific_force = -down_in_imu(q.normalized()) * 9.806;
  CHECK((specific_force - Eigen::Vector3d(-0.019, 0.320, -9.802)).norm() < 0.03);
}

TEST_CASE("compensated values serve where the others are missing, then increments by their time") {
  // IMU group: Accel (bit 9), AngularRate (bit 10).
  const auto compensated = PacketWriter({0xFA, 0x04, 0x00, 0x06}).reals({1, 2, 3, 4, 5, 6}).finish();
  CHECK(read_packet(compensated).reading.imu.accel_m_s2 == Eigen::Vector3d(1, 2, 3));
  CHECK(read_packet(compensated).reading.imu.gyro_rad_s == Eigen::Vector3d(4, 5, 6));
  CHECK_FALSE(read_packet(compensated).has_time);
  // Uncompensated (bits 2, 3) before compensated ones.
  const auto both =
      PacketWriter({0xFA, 0x04, 0x0C, 0x06}).reals({11, 12, 13, 14, 15, 16, 1, 2, 3, 4, 5, 6}).finish();
  CHECK(read_packet(both).reading.imu.accel_m_s2 == Eigen::Vector3d(11, 12, 13));
  CHECK(read_packet(both).reading.imu.gyro_rad_s == Eigen::Vector3d(14, 15, 16));
  // Common group: DeltaTheta (bit 11): 5 ms, degrees, m/s.
  const auto increments =
      PacketWriter({0xFA, 0x01, 0x00, 0x08}).reals({0.005F, 0.9F, 0, 0, 0, 0, -0.049F}).finish();
  REQUIRE(read_packet(increments).reading.has_imu);
  CHECK(read_packet(increments).reading.imu.gyro_rad_s.x() ==
        doctest::Approx(std::numbers::pi).epsilon(1e-6));
  CHECK(read_packet(increments).reading.imu.accel_m_s2.z() == doctest::Approx(-9.8).epsilon(1e-6));
  // The same in the IMU group (bits 6, 7).
  const auto other =
      PacketWriter({0xFA, 0x04, 0xC0, 0x00}).reals({0.005F, 0.9F, 0, 0, 0, 0, -0.049F}).finish();
  CHECK(read_packet(other).reading.imu.gyro_rad_s.isApprox(read_packet(increments).reading.imu.gyro_rad_s));
  // Zero time: no division.
  const auto zero = PacketWriter({0xFA, 0x01, 0x00, 0x08}).reals({0, 1, 1, 1, 1, 1, 1}).finish();
  CHECK_FALSE(read_packet(zero).reading.has_imu);
}

TEST_CASE("what is no attitude or no temperature is left out") {
  // Common group: Quaternion (bit 4), Imu (bit 9); IMU group: Temp, Pres.
  const auto packet = PacketWriter({0xFA, 0x05, 0x10, 0x02, 0x30, 0x00})
                          .reals({0, 0, 0, 0.5F, 1, 2, 3, 4, 5, 6, 2000.0F, 100.0F})
                          .finish();
  const Measurement result = read_packet(packet);
  CHECK(result.reading.has_imu);
  CHECK_FALSE(result.reading.imu.has_attitude);
  CHECK(result.reading.has_pressure);
  CHECK(std::isnan(result.reading.pressure.temperature_c));
}

TEST_CASE("a field is found behind all fields before it, in every group") {
  // All fields of all groups with a known length, each filled with its group and bit.
  std::vector<std::uint8_t> header{0xFA, 0x7F};
  std::vector<std::uint8_t> payload;
  for (int group = 1; group <= 7; ++group) {
    unsigned fields = 0;
    for (int bit = 0; bit < 15; ++bit) {
      const std::size_t length = field_bytes(group, bit);
      if (length > 0) fields |= 1U << bit;
      payload.insert(payload.end(), length, static_cast<std::uint8_t>(group * 16 + bit));
    }
    header.push_back(static_cast<std::uint8_t>(fields & 0xFFU));
    header.push_back(static_cast<std::uint8_t>(fields >> 8U));
  }
  PacketWriter writer(header);
  for (const std::uint8_t byte : payload) writer.number(byte, 1);
  const auto packet = writer.finish();
  REQUIRE(measure_packet(packet).form == PacketForm::kWhole);
  CHECK(measure_packet(packet).bytes == packet.size());
  for (int group = 1; group <= 7; ++group) {
    for (int bit = 0; bit < 15; ++bit) {
      const auto bytes = field(packet, group, bit);
      CHECK(bytes.size() == field_bytes(group, bit));
      for (const std::uint8_t byte : bytes) REQUIRE(byte == group * 16 + bit);
    }
  }
}

}  // namespace isobar::test::test_measurement
