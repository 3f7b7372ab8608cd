// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <fstream>

#include "core/errors.hpp"
#include "run/import/flight_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_flight_logs {
namespace {

template <typename Value>
std::string packed(Value value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string ulog_message(char kind, const std::string& content) {
  return packed(static_cast<std::uint16_t>(content.size())) + kind + content;
}

std::string some_ulog() {
  std::string file("\x55\x4c\x6f\x67\x01\x12\x35\x01", 8);
  file += packed(std::uint64_t{1'000'000});
  file += ulog_message('B', std::string(40, '\0'));
  file += ulog_message(
      'F',
      "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;"
      "int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;uint8_t[4] _padding0;");
  file += ulog_message('F',
                       "vehicle_air_data:uint64_t timestamp;float baro_alt_meter;float baro_temp_celcius;"
                       "float baro_pressure_pa;");
  file += ulog_message('F', "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;");
  const auto add = [&](std::uint16_t id, const std::string& name) {
    file += ulog_message('A', std::string(1, '\0') + packed(id) + name);
  };
  add(0, "sensor_combined");
  add(1, "vehicle_air_data");
  add(2, "vehicle_gps_position");
  for (int i = 0; i < 3; ++i) {
    const auto time_us = static_cast<std::uint64_t>(2'000'000 + i * 5'000);
    file += ulog_message('D', packed(std::uint16_t{0}) + packed(time_us) + packed(0.1F) + packed(0.2F) +
                                  packed(0.3F) + packed(std::uint32_t{5000}) + packed(std::int32_t{0}) +
                                  packed(1.0F) + packed(2.0F) + packed(-9.8F));
    file += ulog_message(
        'D', packed(std::uint16_t{1}) + packed(time_us) + packed(100.0F) + packed(25.0F) + packed(99'000.0F));
  }
  file += ulog_message('D', packed(std::uint16_t{2}) + packed(std::uint64_t{2'000'000}) +
                                packed(std::uint64_t{1'700'000'000'000'000}) + packed(std::int32_t{0}));
  return file;
}

std::string field(const std::string& text, std::size_t size) {
  std::string bytes = text;
  bytes.resize(size, '\0');
  return bytes;
}

std::string dataflash_format(std::uint8_t type, std::uint8_t length, const std::string& name,
                             const std::string& letters, const std::string& columns) {
  return std::string("\xa3\x95\x80", 3) + packed(type) + packed(length) + field(name, 4) +
         field(letters, 16) + field(columns, 64);
}

std::string some_dataflash() {
  std::string file = dataflash_format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  file += dataflash_format(10, 3 + 8 + 1 + 24, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
  file += dataflash_format(11, 3 + 8 + 1 + 4 + 4 + 2, "BARO", "QBffc", "TimeUS,I,Alt,Press,Temp");
  file += dataflash_format(12, 3 + 8 + 1 + 4 + 2, "GPS", "QBIH", "TimeUS,Status,GMS,GWk");
  for (int i = 0; i < 3; ++i) {
    for (const std::uint8_t instance : {std::uint8_t{0}, std::uint8_t{1}}) {
      file += std::string("\xa3\x95\x0a", 3) + packed(static_cast<std::uint64_t>(1'000'000 + i * 2'500)) +
              packed(instance) + packed(0.1F) + packed(0.2F) + packed(0.3F) + packed(1.0F) + packed(2.0F) +
              packed(-9.8F);
    }
    file += std::string("\xa3\x95\x0b", 3) + packed(std::uint64_t{1'000'000}) + packed(std::uint8_t{0}) +
            packed(10.0F) + packed(98'000.0F) + packed(std::int16_t{2'550});
  }
  return file + std::string("\xa3\x95\x0c", 3) + packed(std::uint64_t{1'000'000}) + packed(std::uint8_t{3}) +
         packed(std::uint32_t{1'000}) + packed(std::uint16_t{2'200});
}

imports::FlightLog read(const std::string& bytes) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "log", std::ios::binary) << bytes;
  return imports::read_flight_log(folder.path() / "log");
}

}  // namespace

TEST_CASE("a ULog gives IMU and pressure, z up, on the time of its GNSS receiver") {
  const imports::FlightLog log = read(some_ulog());
  REQUIRE(log.imu.size() == 3);
  CHECK(log.imu[0].stamp_ns == 1'700'000'000'000'000'000);
  CHECK(log.imu[1].stamp_ns - log.imu[0].stamp_ns == 5'000'000);
  CHECK(log.imu[0].accel_m_s2.z() == doctest::Approx(9.8));
  CHECK(log.imu[0].accel_m_s2.y() == doctest::Approx(-2.0));
  CHECK(log.imu[0].gyro_rad_s.x() == doctest::Approx(0.1));
  CHECK(log.imu[0].gyro_rad_s.z() == doctest::Approx(-0.3));
  REQUIRE(log.pressure.size() == 3);
  CHECK(log.pressure[0].pressure_pa == 99'000.0);
  CHECK(log.pressure[0].temperature_c == 25.0);
}

TEST_CASE("a dataflash log gives its first IMU and barometer, by the formats that it states") {
  const imports::FlightLog log = read(some_dataflash());
  REQUIRE(log.imu.size() == 3);
  // Week 2200 began on 6 March 2022 (GPS time); 18 leap seconds.
  CHECK(log.imu[0].stamp_ns == (1'646'524'800LL - 18 + 1) * 1'000'000'000);
  CHECK(log.imu[0].accel_m_s2.z() == doctest::Approx(9.8));
  REQUIRE(log.pressure.size() == 3);
  CHECK(log.pressure[0].pressure_pa == 98'000.0);
  CHECK(log.pressure[0].temperature_c == doctest::Approx(25.5));
}

TEST_CASE("flight logs that are cut or damaged give what is good, and say where they are not") {
  for (const std::string& whole : {some_ulog(), some_dataflash()}) {
    for (std::size_t cut = 30; cut < whole.size(); cut += 29)
      CHECK(read(whole.substr(0, cut)).imu.size() <= 3);
  }
  std::string damaged = some_dataflash();
  damaged.insert(4 * 89 + 10, "garbage");
  const imports::FlightLog log = read(damaged);
  CHECK(log.imu.size() == 2);
  CHECK(log.damage.count > 0);
}

}  // namespace isobar::test::test_flight_logs
