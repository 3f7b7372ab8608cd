// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/drivers/velodyne/velodyne_stream.hpp"

namespace isobar::test::test_decoder {

namespace {

using test::build_packet;
using test::PacketPlan;
using test::VelodyneConfig;
using test::VelodyneStream;

constexpr std::int64_t kHostStart = 1'700'000'000'000'000'000;
constexpr double kRad = 3.14159265358979323846 / 180.0;
// Manual 63-9243: 24 firings of 55.296 us a packet.
constexpr double kVlpPacketUs = 24 * 55.296;

/// The n-th packet of a VLP-16 that turns at 600 rpm from azimuth `start_deg`, its clock at `clock_us` at the
/// start.
PacketPlan turning(int n, double start_deg = 0.0, double clock_us = 1e6) {
  PacketPlan plan;
  plan.timestamp_us = static_cast<std::uint32_t>(std::fmod(clock_us + n * kVlpPacketUs, 3.6e9));
  plan.step_deg = 0.00011059200 * 3'600.0;  // two firings at 3600 deg/s
  plan.first_azimuth_deg = std::fmod(start_deg + 12 * n * plan.step_deg, 360.0);
  return plan;
}

std::int64_t host_of(int n) { return kHostStart + static_cast<std::int64_t>(n * kVlpPacketUs * 1e3); }

struct Run {
  explicit Run(const VelodyneConfig& config = {}) : decoder(config), scan(std::make_unique<Scan>()) {}
  DecodeStatus feed(const std::vector<std::uint8_t>& bytes, std::int64_t host_ns) {
    const auto result = decoder.add_packet(bytes, host_ns, *scan);
    if (result.scan_complete) {
      done.push_back(std::move(scan));
      scan = std::make_unique<Scan>();
    }
    return result.status;
  }
  void finish() {
    if (decoder.flush(*scan)) {
      done.push_back(std::move(scan));
      scan = std::make_unique<Scan>();
    }
  }
  [[nodiscard]] std::size_t points() const {
    std::size_t sum = 0;
    for (const auto& s : done) {
      sum += s->point_count;
    }
    return sum;
  }
  VelodyneStream decoder;
  std::unique_ptr<Scan> scan;
  std::vector<std::unique_ptr<Scan>> done;
};

}  // namespace

TEST_CASE(
    "Each laser's point has the position of the manual's geometry, with the azimuth at its own firing") {
  PacketPlan plan;
  plan.first_azimuth_deg = 90.0;
  plan.step_deg = 0.4;
  plan.distance = [](int block, int channel) {
    return static_cast<std::uint16_t>(1'000 + 40 * block + channel);
  };
  Run run;
  run.feed(build_packet(plan), kHostStart);
  run.finish();
  REQUIRE(run.points() == 12 * 32);
  // Elevations in firing order, manual 63-9243 table 9-1.
  const double elevation_deg[16] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  for (int block = 0; block < 12; ++block) {
    for (int channel = 0; channel < 32; ++channel) {
      const ScanPoint& p = run.done[0]->points[block * 32 + channel];
      const double t_us = (channel / 16) * 55.296 + (channel % 16) * 2.304;
      const double azimuth = (90.0 + 0.4 * block + 0.4 * t_us / 110.592) * kRad;
      const double elevation = elevation_deg[channel % 16] * kRad;
      const double range_m = 0.002 * (1'000 + 40 * block + channel);
      const double error_m = std::hypot(p.x_m - range_m * std::cos(elevation) * std::cos(azimuth),
                                        p.y_m + range_m * std::cos(elevation) * std::sin(azimuth),
                                        p.z_m - range_m * std::sin(elevation));
      CHECK(error_m < range_m * 0.0051 * kRad);  // the azimuth is rounded to 0.01 deg
      CHECK(std::abs(p.time_4us * 4.0 - (block * 110.592 + t_us)) <= 2.01);
      CHECK(p.intensity == channel);
      CHECK(p.ring == static_cast<int>(elevation_deg[channel % 16] + 15) / 2);
    }
  }
}

TEST_CASE("At every rotation up to 10 degrees a block, azimuths round to the nearest hundredth, halves up") {
  struct Timing {
    velodyne::Model model;
    std::uint8_t product_id;
    // Both manuals: firing times are whole multiples of a step between lasers.
    int steps_a_block;
    int (*steps_until)(int channel);
  };
  for (const Timing& timing :
       {Timing{velodyne::Model::kVlp16, 0x22, 48,
               [](int channel) { return channel / 16 * 24 + channel % 16; }},
        Timing{velodyne::Model::kHdl32e, 0x21, 40, [](int channel) { return channel; }}}) {
    VelodyneConfig config;
    config.model = timing.model;
    for (int step = 0; step <= 1'000; ++step) {
      Run run(config);
      PacketPlan plan;
      plan.product_id = timing.product_id;
      plan.first_azimuth_deg = 300.0;
      plan.step_deg = 0.01 * step;
      run.feed(build_packet(plan), kHostStart);
      for (int channel = 0; channel < 32; ++channel) {  // of block 0
        const ScanPoint& p = run.scan->points[channel];
        const int beyond =
            (2 * step * timing.steps_until(channel) + timing.steps_a_block) / (2 * timing.steps_a_block);
        const double azimuth = -std::atan2(p.y_m, p.x_m) / kRad + 360.0;
        // Positions in single precision: 1e-5 deg.
        REQUIRE(std::abs(std::fmod(azimuth, 360.0) - (300.0 + 0.01 * beyond)) < 1e-4);
      }
    }
  }
}

TEST_CASE("A packet that closes a scan needs the caller's memory only during its own call") {
  Run kept;
  Run reused;
  std::vector<std::uint8_t> buffer;
  std::vector<std::vector<std::uint8_t>> all;
  for (int n = 0; n < 200; ++n) {
    all.push_back(build_packet(turning(n, 350.0)));
    buffer = all.back();
    kept.feed(all.back(), host_of(n));
    reused.feed(buffer, host_of(n));
    std::fill(buffer.begin(), buffer.end(), std::uint8_t{0xAA});
  }
  kept.finish();
  reused.finish();
  REQUIRE(kept.done.size() == reused.done.size());
  for (std::size_t i = 0; i < kept.done.size(); ++i) {
    const Scan& a = *kept.done[i];
    const Scan& b = *reused.done[i];
    REQUIRE(a.point_count == b.point_count);
    CHECK(std::memcmp(a.points, b.points, a.point_count * sizeof(ScanPoint)) == 0);
  }
}

TEST_CASE("Azimuths interpolate through 360 degrees") {
  PacketPlan plan;
  plan.first_azimuth_deg = 359.8;  // block 1 starts at 0.2
  plan.step_deg = 0.4;
  Run run;
  run.feed(build_packet(plan), kHostStart);
  run.finish();
  const ScanPoint& p = run.done.at(0)->points[31];  // laser 15 of the second firing in block 0
  const double azimuth_deg = std::atan2(-p.y_m, p.x_m) / kRad;
  CHECK(azimuth_deg == doctest::Approx(-0.2 + 0.4 * (55.296 + 15 * 2.304) / 110.592).epsilon(0.05));
}

TEST_CASE("A revolution that ends within a packet loses no point") {
  Run run;
  const int packets = 200;  // 265 ms: 955 degrees, passes 0 twice
  for (int n = 0; n < packets; ++n) {
    CHECK(run.feed(build_packet(turning(n, 123.4)), host_of(n)) == DecodeStatus::kOk);
  }
  run.finish();
  CHECK(run.points() == static_cast<std::size_t>(packets) * 12 * 32);
  CHECK(run.done.size() == 3);
  for (std::size_t i = 0; i + 1 < run.done.size(); ++i) {
    const Scan& scan = *run.done[i];
    CHECK(scan.sequence == i);
    // The next one starts one firing block after the last block's start.
    const std::int64_t step_ns = run.done[i + 1]->stamp_ns - scan.end_stamp_ns;
    CHECK(step_ns > 0);
    CHECK(step_ns < 110'592);
    if (i > 0) {
      CHECK(std::abs(static_cast<double>(run.done[i + 1]->stamp_ns - scan.stamp_ns) - 100e6) < 120e3);
    }
  }
}

TEST_CASE("Scan times follow the host's clock across the sensor's hourly wrap") {
  Run run;
  for (int n = 0; n < 400; ++n) {
    run.feed(build_packet(turning(n, 0.0, 3.6e9 - 0.25e6)), host_of(n));
  }
  run.finish();
  CHECK(run.decoder.counters().lost == 0);
  CHECK(run.decoder.counters().clock_steps == 0);
  CHECK(run.points() == 400U * 12 * 32);
  for (const auto& scan : run.done) {
    const auto in_packets = static_cast<double>(scan->stamp_ns - kHostStart) / (kVlpPacketUs * 1e3);
    CHECK(in_packets > -0.01);
    CHECK(in_packets < 400);
  }
}

TEST_CASE("Dual return keeps both returns, or one when they are equal") {
  PacketPlan plan;
  plan.return_mode = 0x39;
  plan.distance = [](int block, int channel) {
    return static_cast<std::uint16_t>(block % 2 == 1 && channel % 4 == 0 ? 3'000 : 2'000);
  };
  Run run;
  run.feed(build_packet(plan), kHostStart);
  run.finish();
  CHECK(run.points() == 6 * 32 + 6 * 8);
  // Six firing blocks, so the last laser fires half as late as with single return.
  CHECK(run.done[0]->end_stamp_ns - run.done[0]->stamp_ns == 5 * 110'592 + 55'296 + 15 * 2'304);
}

TEST_CASE("HDL-32E: 32 lasers 1.152 us apart in a cycle of 46.08 us, lowest at -30.67 degrees") {
  VelodyneConfig config;
  config.model = velodyne::Model::kHdl32e;
  PacketPlan plan;
  plan.product_id = 0x21;
  Run run(config);
  run.feed(build_packet(plan), kHostStart);
  run.finish();
  REQUIRE(run.points() == 384);
  const ScanPoint& lowest = run.done[0]->points[0];
  CHECK(lowest.ring == 0);
  CHECK(lowest.z_m == doctest::Approx(5.0 * std::sin(-30.67 * kRad)));
  const ScanPoint& highest = run.done[0]->points[31];
  CHECK(highest.ring == 31);
  CHECK(highest.z_m == doctest::Approx(5.0 * std::sin(10.67 * kRad)));
  CHECK(run.done[0]->end_stamp_ns - run.done[0]->stamp_ns == 11 * 46'080 + 31 * 1'152);
}

TEST_CASE("Range limits and the masked sector drop exactly the returns inside them") {
  VelodyneConfig config;
  config.min_range_m = 1.0;
  config.max_range_m = 5.0;
  config.mask_start_deg = 350.0;
  config.mask_end_deg = 10.0;
  PacketPlan plan;
  plan.first_azimuth_deg = 100.0;
  plan.distance = [](int, int channel) {
    const std::uint16_t distances[4] = {0, 499, 500, 2'501};  // none, 0.998 m, 1.000 m, 5.002 m
    return distances[channel % 4];
  };
  Run run(config);
  run.feed(build_packet(plan), kHostStart);
  CHECK(run.decoder.counters().returns == 12 * 8);
  plan.first_azimuth_deg = 355.0;
  plan.timestamp_us = 1'327;
  run.feed(build_packet(plan), kHostStart + 1'327'000);
  CHECK(run.decoder.counters().returns == 12 * 8);
}

TEST_CASE("Broken packets are refused and counted by kind, and do not affect other packets") {
  Run run;
  std::mt19937 random(7);
  for (int n = 0; n < 100; ++n) {
    const auto good = build_packet(turning(n));
    auto garbage = good;
    garbage[300] ^= 0x55U;  // the flag of block 3
    auto wrong_azimuth = good;
    wrong_azimuth[103] = 0xFF;
    auto wrong_mode = good;
    wrong_mode[1204] = 0x12;
    auto wrong_model = good;
    wrong_model[1205] = 0x28;
    CHECK(run.feed({good.begin(), good.begin() + static_cast<long>(random() % 1'206)}, host_of(n)) !=
          DecodeStatus::kOk);
    auto oversized = good;
    oversized.push_back(0);
    CHECK(run.feed(oversized, host_of(n)) == DecodeStatus::kOversized);
    CHECK(run.feed(garbage, host_of(n)) == DecodeStatus::kGarbage);
    CHECK(run.feed(wrong_azimuth, host_of(n)) == DecodeStatus::kGarbage);
    CHECK(run.feed(wrong_mode, host_of(n)) == DecodeStatus::kGarbage);
    CHECK(run.feed(wrong_model, host_of(n)) == DecodeStatus::kWrongModel);
    CHECK(run.feed(good, host_of(n)) == DecodeStatus::kOk);
    CHECK(run.feed(good, host_of(n)) == DecodeStatus::kDuplicate);
  }
  run.finish();
  CHECK(run.points() == 100U * 12 * 32);
  const auto& counters = run.decoder.counters();
  CHECK(counters.truncated + counters.no_points == 100);
  CHECK(counters.oversized == 100);
  CHECK(counters.garbage == 300);
  CHECK(counters.wrong_model == 100);
  CHECK(counters.duplicated == 100);
  CHECK(counters.lost == 0);
  CHECK(run.decoder.decoder().mismatch() == "packets of VLP-32C (product id 0x28), but VLP-16 is configured");
}

TEST_CASE("Swapped packets are decoded, also across two revolutions, and do not count as lost") {
  Run run;
  std::vector<int> order(300);
  for (int n = 0; n < 300; ++n) {
    order[static_cast<std::size_t>(n)] = n;
  }
  for (std::size_t i = 5; i + 1 < order.size(); i += 7) {
    std::swap(order[i], order[i + 1]);
  }
  int k = 0;
  for (const int n : order) {
    CHECK(run.feed(build_packet(turning(n)), host_of(k++) + 200'000) == DecodeStatus::kOk);
  }
  run.finish();
  CHECK(run.points() == 300U * 12 * 32);
  CHECK(run.decoder.counters().reordered == 42);
  CHECK(run.decoder.counters().lost == 0);
  for (const auto& scan : run.done) {
    for (std::uint32_t i = 0; i < scan->point_count; ++i) {
      REQUIRE(scan->points[i].time_4us * 4'000 <= scan->end_stamp_ns - scan->stamp_ns + 4'000);
    }
  }
}

TEST_CASE("Lost packets are counted in the scan that misses them") {
  Run run;
  for (int n = 0; n < 150; ++n) {
    if (n != 20 && n != 21 && n != 90) {
      run.feed(build_packet(turning(n)), host_of(n));
    }
  }
  run.finish();
  CHECK(run.decoder.counters().lost == 3);
  CHECK(run.done.at(0)->packets_lost == 2);
  CHECK(run.done.at(1)->packets_lost == 1);
}

TEST_CASE("Five seconds without packets end the scan, and the next one has the right time") {
  Run run;
  for (int n = 0; n < 4'000; ++n) {
    if (n < 30 || n >= 3'800) {
      run.feed(build_packet(turning(n)), host_of(n));
    }
  }
  run.finish();
  CHECK(run.points() == 230U * 12 * 32);
  CHECK(run.decoder.counters().lost == 3'770);
  REQUIRE(run.done.size() >= 2);
  CHECK(run.done[0]->point_count == 30U * 12 * 32);
  CHECK(std::abs(static_cast<double>(run.done[1]->stamp_ns - host_of(3'800))) < 1e6);
}

TEST_CASE("A step of the sensor's clock ends the scan, and loses no point and no time") {
  Run run;
  for (int n = 0; n < 300; ++n) {
    run.feed(build_packet(turning(n, 0.0, n < 120 ? 1e6 : 1.8e9)), host_of(n));
  }
  run.finish();
  CHECK(run.decoder.counters().clock_steps == 1);
  CHECK(run.points() == 300U * 12 * 32);
  for (const auto& scan : run.done) {
    CHECK(scan->stamp_ns >= kHostStart - 1'000'000);
    CHECK(scan->end_stamp_ns <= host_of(301));
    CHECK(scan->end_stamp_ns - scan->stamp_ns < 101'000'000);
  }
}

TEST_CASE("A sensor that does not rotate fills scan after scan to capacity, without loss") {
  Run run;
  for (int n = 0; n < 400; ++n) {
    auto plan = turning(n);
    plan.first_azimuth_deg = 77.0;
    plan.step_deg = 0.0;
    run.feed(build_packet(plan), host_of(n));
  }
  run.finish();
  CHECK(run.points() == 400U * 12 * 32);
  for (const auto& scan : run.done) {
    CHECK(scan->end_stamp_ns - scan->stamp_ns <= 262'140'000);
  }
}

}  // namespace isobar::test::test_decoder
