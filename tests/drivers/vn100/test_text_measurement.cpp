// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/vn100/protocol.hpp"
#include "drivers/vn100/text_line.hpp"
#include "drivers/vn100/text_measurement.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_text_measurement {

using namespace vn100;

namespace {

std::optional<TextMeasurement> read(const std::string& body) { return read_text(command_line(body)); }

Settings taking_what_comes() {
  Settings settings;
  settings.configure = false;
  return settings;
}

/// Readings that a protocol without configuration makes of a stream.
std::vector<serial::ImuEvent> readings_of(Protocol& protocol, const std::string& stream) {
  std::copy(stream.begin(), stream.end(), protocol.room().begin());
  protocol.filled(stream.size());
  std::vector<serial::ImuEvent> readings;
  for (auto event = protocol.next(); event.kind != serial::ImuEvent::Kind::kNone; event = protocol.next()) {
    if (event.kind == serial::ImuEvent::Kind::kReading) readings.push_back(event);
  }
  return readings;
}

std::string as_text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

TEST_CASE("the manual's examples of registers 27, 15, 20 and 80, as the lines that their outputs send") {
  // UM001 v2.22, section 7; the registers' values are those of the asynchronous lines VNYMR, VNQMR, VNMAR, VNDTV.
  const auto ymr = read(
      "VNYMR,+006.380,+000.023,-001.953,+1.0640,-0.2531,+3.0614,+00.005,+00.344,-09.758,-0.001222,-0.000450,"
      "-0.001218");
  REQUIRE(ymr);
  CHECK(ymr->header == "VNYMR");
  REQUIRE(ymr->measurement.reading.has_imu);
  CHECK_FALSE(ymr->measurement.has_time);
  const ImuSample& imu = ymr->measurement.reading.imu;
  CHECK(imu.accel_m_s2 == Eigen::Vector3d(0.005, 0.344, -9.758));
  CHECK(imu.gyro_rad_s == Eigen::Vector3d(-0.001222, -0.000450, -0.001218));
  // At rest: the attitude turns the specific force up, to a quarter of a degree.
  REQUIRE(imu.has_attitude);
  CHECK((imu.q_world_imu * imu.accel_m_s2).normalized().z() > std::cos(0.25 * std::numbers::pi / 180.0));

  const auto qmr = read(
      "VNQMR,-0.017057,-0.000767,+0.056534,+0.998255,+1.0670,-0.2568,+3.0696,-00.019,+00.320,-09.802,-0."
      "002801,"
      "-0.001186,-0.001582");
  REQUIRE(qmr);
  CHECK(qmr->measurement.reading.imu.accel_m_s2 == Eigen::Vector3d(-0.019, 0.320, -9.802));
  CHECK(qmr->measurement.reading.imu.gyro_rad_s == Eigen::Vector3d(-0.002801, -0.001186, -0.001582));
  REQUIRE(qmr->measurement.reading.imu.has_attitude);
  CHECK(qmr->measurement.reading.imu.q_world_imu.angularDistance(imu.q_world_imu) < 0.005);

  const auto mar =
      read("VNMAR,+1.0684,-0.2578,+3.0649,-00.005,+00.341,-09.780,-0.000963,+0.000840,-0.000466");
  REQUIRE(mar);
  CHECK(mar->measurement.reading.imu.accel_m_s2 == Eigen::Vector3d(-0.005, 0.341, -9.780));
  CHECK(mar->measurement.reading.imu.gyro_rad_s == Eigen::Vector3d(-0.000963, 0.000840, -0.000466));
  CHECK_FALSE(mar->measurement.reading.imu.has_attitude);

  const auto dtv = read("VNDTV,+0.665016,-000.119,-000.409,-000.025,+000.011,-000.084,-006.702");
  REQUIRE(dtv);
  CHECK(dtv->measurement.reading.imu.accel_m_s2.z() == doctest::Approx(-6.702 / 0.665016));
  CHECK(dtv->measurement.reading.imu.gyro_rad_s.y() ==
        doctest::Approx(-0.409 * std::numbers::pi / 180.0 / 0.665016));
}

TEST_CASE("VNIMU carries temperature and pressure, in kilopascals") {
  const auto line = read(
      "VNIMU,-02.0841,+00.6045,+02.8911,-00.381,-00.154,-09.657,-00.005683,+00.000262,+00.001475,+21.6,+101."
      "325");
  REQUIRE(line);
  REQUIRE(line->measurement.reading.has_imu);
  CHECK(line->measurement.reading.imu.accel_m_s2 == Eigen::Vector3d(-0.381, -0.154, -9.657));
  CHECK(line->measurement.reading.imu.gyro_rad_s == Eigen::Vector3d(-0.005683, 0.000262, 0.001475));
  REQUIRE(line->measurement.reading.has_pressure);
  CHECK(line->measurement.reading.pressure.pressure_pa == doctest::Approx(101'325.0));
  CHECK(line->measurement.reading.pressure.temperature_c == doctest::Approx(21.6));
}

TEST_CASE("appended counters and status are left out, other values make no measurement") {
  const std::string mar = "VNMAR,1,2,3,4,5,6,7,8,9";
  for (const char* appended : {"", ",S000007", ",T0001234", ",S000007,T0001234", ",V0001", ",S1,T2,I0003"}) {
    INFO(appended);
    const auto line = read(mar + appended);
    REQUIRE(line);
    CHECK(line->measurement.reading.imu.gyro_rad_s == Eigen::Vector3d(7, 8, 9));
  }
  for (const char* bad : {"VNMAR,1,2,3,4,5,6,7,8", "VNMAR,1,2,3,4,5,6,7,8,9,10", "VNMAR,1,2,3,4,5,6,7,8,nan",
                          "VNMAR,1,2,3,4,5,6,7,8,+inf", "VNMAR,1,2,3,4,5,6,7,8,", "VNMAR,1,2,3,4,5,6,7,8,9x",
                          "VNMAR,S1,2,3,4,5,6,7,8,9", "VNMAR,", "VNMAR", "VNXYZ,1,2,3", "VNRRG,27,1,2,3",
                          "VNDTV,+-1,0,0,0,0,0,0", "VNMAR,1e999,2,3,4,5,6,7,8,9"}) {
    INFO(bad);
    CHECK_FALSE(read(bad));
  }
  CHECK_FALSE(read_text("$VNMAR"));
  CHECK_FALSE(read_text(""));
}

TEST_CASE("each output gives what it has, and names what it lacks") {
  struct Case {
    std::string body;
    bool accel, gyro;
  };
  for (const Case& c :
       {Case{"VNYPR,1,2,3", false, false}, Case{"VNQTN,0,0,0,1", false, false},
        Case{"VNACC,1,2,3", true, false}, Case{"VNGYR,1,2,3", false, true},
        Case{"VNYBA,1,2,3,4,5,6,7,8,9", false, true}, Case{"VNYIA,1,2,3,4,5,6,7,8,9", false, true},
        Case{"VNQTA,0,0,0,1,5,6,7", true, false}, Case{"VNQTR,0,0,0,1,5,6,7", false, true},
        Case{"VNQAR,0,0,0,1,5,6,7,8,9,10", true, true}, Case{"VNCMV,1,2,3,4,5,6,7,8,9,20", true, true},
        Case{"VNYCM,1,2,3,4,5,6,7,8,9,10,11,12,20", true, true},
        Case{"VNISE,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15", true, true},
        Case{"VNDTV,0,1,2,3,4,5,6", false, false}}) {
    INFO(c.body);
    const auto line = read(c.body);
    REQUIRE(line);
    CHECK(line->measurement.has_accel == c.accel);
    CHECK(line->measurement.has_gyro == c.gyro);
    CHECK(line->measurement.reading.has_imu == (c.accel && c.gyro));
  }
}

TEST_CASE("without configuration text measures until packets do, with 8-bit and 16-bit checksums") {
  Protocol protocol(taking_what_comes());
  protocol.restart();
  const std::string body = "VNMAR,1,2,3,4,5,6,7,8,9";
  std::array<char, 8> crc{};
  std::snprintf(crc.data(), crc.size(), "*%04X",
                unsigned{crc16(std::span(reinterpret_cast<const std::uint8_t*>(body.data()), body.size()))});
  const std::string line = command_line(body);
  const auto text =
      readings_of(protocol, line + "$" + body + crc.data() + "\r\n$VNMAR,1,2,3,4,5,6,7,8,8*00\r\n");
  REQUIRE(text.size() == 2);
  CHECK_FALSE(text[0].has_device_time);
  CHECK(text[1].reading.imu.accel_m_s2 == Eigen::Vector3d(4, 5, 6));
  const auto mixed =
      readings_of(protocol, as_text(own_packet(5'000'000)) + line + as_text(own_packet(10'000'000)));
  REQUIRE(mixed.size() == 2);
  CHECK(mixed[0].has_device_time);
  CHECK(mixed[1].device_ns == 10'000'000);
}

TEST_CASE("what cannot be used is named with what it lacks") {
  const auto heard = [](const std::string& stream) {
    Protocol protocol(taking_what_comes());
    protocol.restart();
    CHECK(readings_of(protocol, stream).empty());
    const char* words = protocol.heard_instead();
    return std::string(words != nullptr ? words : "");
  };
  CHECK(heard("") == "");
  CHECK(heard(command_line("VNYPR,1,2,3")) ==
        "$VNYPR: no acceleration and angular rate; configure = true, or output Imu");
  CHECK(heard(command_line("VNGYR,1,2,3")) ==
        "$VNGYR: no acceleration with gravity; configure = true, or output Imu");
  CHECK(heard(command_line("VNACC,1,2,3")) == "$VNACC: no angular rate; configure = true, or output Imu");
  CHECK(heard("$GPRMC,000012.800,V,,,,,0.00,0.00,060180,,,N*49\r\n") == "it sends text without measurements");
  // Common group: AngularRate (bit 5) alone.
  const auto rates = PacketWriter({0xFA, 0x01, 0x20, 0x00}).reals({1, 2, 3}).finish();
  CHECK(heard(as_text(rates)) ==
        "packets FA012000: no acceleration with gravity; configure = true, or output Imu");
  // GNSS group of a VN-300 with its list of satellites (bit 14), eight times.
  std::string satellites;
  for (int i = 0; i < 8; ++i)
    satellites += std::string("\xFA\x08\x00\x40", 4) + std::string(30, static_cast<char>(i));
  CHECK(heard(satellites) == "packets FA080040 have fields of unknown length; configure = true");
}

TEST_CASE("reading a line allocates nothing") {
  const std::string line = command_line("VNMAR,1,2,3,4,5,6,7,8,9");
  const std::size_t before = allocation_count();
  const bool found = read_text(line).has_value();
  CHECK(allocation_count() == before);
  CHECK(found);
}

}  // namespace isobar::test::test_text_measurement
