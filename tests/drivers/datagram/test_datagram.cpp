// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "drivers/datagram/datagram.hpp"

namespace isobar::test::test_datagram {

using namespace isobar::datagram;

namespace {

std::vector<Sample> parse_all(DatagramParser& parser, std::string_view text) {
  parser.begin({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::vector<Sample> samples;
  Sample sample;
  while (parser.next(sample)) {
    samples.push_back(sample);
  }
  return samples;
}

std::string formatted(const Sample& sample) {
  std::array<char, kMaxLineBytes> text{};
  return {text.data(), format_line(sample, text)};
}

}  // namespace

TEST_CASE("Formatting and parsing give the same bits, for every kind") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 1'000; ++i) {
    Sample sample;
    sample.kind = static_cast<Kind>(i % 4);
    sample.sequence = static_cast<std::uint32_t>(random());
    sample.imu.gyro_rad_s = Eigen::Vector3d(noise(random) * 1e-9, noise(random), -noise(random));
    sample.imu.accel_m_s2 = Eigen::Vector3d(-1.0 / 3.0, noise(random), 9.8);
    sample.imu.has_attitude = i % 8 == 0;
    sample.imu.q_world_imu = sample.imu.has_attitude
                                 ? Eigen::Quaterniond(noise(random), 1, noise(random), 2).normalized()
                                 : Eigen::Quaterniond::Identity();
    sample.pressure = {0, 1e5 + noise(random), 20 + noise(random)};
    sample.wheel = {0, noise(random), noise(random), noise(random)};
    sample.set_stamp_ns(1'700'000'000'123'456'789 + i);
    const std::string line = formatted(sample);
    Sample read;
    REQUIRE(parse_line({line.data(), line.size() - 1}, read) == LineStatus::kOk);
    CHECK(formatted(read) == line);
    CHECK(read.stamp_ns() == sample.stamp_ns());
    if (sample.kind == Kind::kImu) {
      CHECK(read.imu.gyro_rad_s == sample.imu.gyro_rad_s);
      CHECK(read.imu.q_world_imu.coeffs() == sample.imu.q_world_imu.coeffs());
      CHECK(read.imu.has_attitude == sample.imu.has_attitude);
    }
  }
}

TEST_CASE("The longest possible line fits the documented size") {
  Sample sample;
  sample.kind = Kind::kImu;
  sample.sequence = 4'294'967'295;
  sample.imu.stamp_ns = -9'223'372'036'854'775'807;
  const double longest = -2.2250738585072014e-308;
  sample.imu.gyro_rad_s.setConstant(longest);
  sample.imu.accel_m_s2.setConstant(longest);
  sample.imu.q_world_imu.coeffs().setConstant(longest);
  sample.imu.has_attitude = true;
  CHECK(formatted(sample).size() < kMaxLineBytes);
}

TEST_CASE("A datagram holds lines of several kinds; a broken line does not affect the others") {
  DatagramParser parser;
  const auto samples = parse_all(parser,
                                 "imu,0,5,0,0,0,0,0,9.8\r\n"
                                 "baro,0,6,100000,20\n"
                                 "gps,0,6,1,2\n"
                                 "baro,1,7,nan,20\n"
                                 "baro,2,8,1e5\n"
                                 "baro,2,8,1e5,20,\n"
                                 "baro,2,8,1e5,20,3\n"
                                 "baro,-1,8,1e5,20\n"
                                 "baro,,8,1e5,20\n"
                                 "imu,1,5,0,0,0,0,0,9.8,1,0,0\n"
                                 "\n"
                                 "wheel,0,9,50,0,0\n"
                                 "base,0,9,100001,nan\n"
                                 "wheel,1,9,1,0,0.5");
  REQUIRE(samples.size() == 4);
  CHECK(samples[0].kind == Kind::kImu);
  CHECK(samples[1].pressure.pressure_pa == 100'000);
  CHECK(samples[2].kind == Kind::kBasePressure);
  CHECK(std::isnan(samples[2].pressure.temperature_c));
  CHECK(samples[3].wheel.wz_rad_s == 0.5);
  CHECK(parser.counters().unknown_kind == 1);
  CHECK(parser.counters().malformed == 6);
  CHECK(parser.counters().implausible == 2);
}

TEST_CASE(
    "Sequence numbers reveal loss, duplicates, reordering, wrap and restart, separately for each kind") {
  DatagramParser parser;
  const auto feed = [&parser](std::uint32_t sequence) {
    return parse_all(parser, "baro," + std::to_string(sequence) + ",1,1e5,20\n").size();
  };
  constexpr auto kBaro = static_cast<std::size_t>(Kind::kPressure);
  CHECK(feed(4'294'967'294U) == 1);
  CHECK(feed(4'294'967'295U) == 1);
  CHECK(feed(1) == 1);  // 0 is missing
  CHECK(parser.counters().lost[kBaro] == 1);
  CHECK(feed(0) == 1);
  CHECK(feed(4) == 1);
  CHECK(feed(4) == 0);
  CHECK(feed(3) == 1);
  CHECK(feed(3) == 0);
  CHECK(parser.counters().duplicated[kBaro] == 2);
  CHECK(parser.counters().lost[kBaro] == 1);
  CHECK(feed(1'000) == 1);
  CHECK(parser.counters().lost[kBaro] == 996);
  CHECK(feed(10) == 1);  // far back: a restarted sender
  CHECK(feed(11) == 1);
  CHECK(parser.counters().lost[kBaro] == 996);
  CHECK(parser.counters().lost[static_cast<std::size_t>(Kind::kImu)] == 0);
}

}  // namespace isobar::test::test_datagram
