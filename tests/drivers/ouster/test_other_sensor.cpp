// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/drivers/ouster/ouster_sensor.hpp"

namespace isobar::test::test_other_sensor {

TEST_CASE("Packets that the metadata does not fit are refused, and what they are is said") {
  const OusterPlan plan;
  PacketColumns columns;
  const auto refused = [&](const OusterPlan& other, const std::string& text) {
    const auto decoder = decoder_for(plan);
    CHECK(decoder->read(build_ouster_packet(other), columns) == DecodeStatus::kWrongModel);
    CHECK(decoder->mismatch() == text);
    CHECK(!decoder->is_data(build_ouster_packet(other)));
    CHECK(decoder->is_data(build_ouster_packet(plan)));
  };
  OusterPlan other = plan;
  other.profile = "RNG19_RFL8_SIG16_NIR16_DUAL";
  refused(
      other,
      "packets of 8448 bytes, but os.json says 6400 (32 beams, RNG19_RFL8_SIG16_NIR16); theirs: 32 beams in "
      "RNG19_RFL8_SIG16_NIR16_DUAL, or 64 beams in RNG15_RFL8_NIR8_DUAL/FUSA_RNG15_RFL8_NIR8_DUAL/"
      "RNG15_RFL8_NIR8_ZONE16, or 128 beams in RNG15_RFL8_NIR8/RNG15_RFL8_WIN8");
  other = plan;
  other.serial = 122'000'000'002;
  refused(other,
          "packets of the sensor with serial number 122000000002, but os.json is of 122000000001 (OS-1-32)");
  OusterPlan restarted = plan;
  restarted.init_id = 0x654321;
  CHECK(decoder_for(plan)->read(build_ouster_packet(restarted), columns) == DecodeStatus::kOk);
}

TEST_CASE("Without a serial number in the metadata the initialisation id must be the same") {
  OusterPlan plan;
  OusterPlan metadata = plan;
  metadata.serial = 0;
  PacketColumns columns;
  CHECK(decoder_for(metadata)->read(build_ouster_packet(plan), columns) == DecodeStatus::kOk);
  plan.init_id = 99;
  const auto decoder = decoder_for(metadata);
  CHECK(decoder->read(build_ouster_packet(plan), columns) == DecodeStatus::kWrongModel);
  CHECK(decoder->mismatch() ==
        "packets with initialisation id 99, but os.json has 1193046 and no serial number: read it again");
}

TEST_CASE("Another lidar_mode than the metadata's is found within a turn, whichever has more columns") {
  for (const int sent : {512, 2'048}) {
    for (const double hz : {10.0, 20.0}) {
      CAPTURE(sent);
      CAPTURE(hz);
      OusterPlan plan;
      plan.columns_per_turn = sent;
      plan.hz = hz;
      OusterSensor sensor(plan, OusterPlan{});
      sensor.run(6 * sent);
      const LidarCounters& counters = sensor.assembler->counters();
      CHECK(counters.packets <= static_cast<unsigned>(std::min(sent, 1'024) / 16));
      CHECK(counters.wrong_model + counters.packets == static_cast<unsigned>(6 * sent / 16));
      CHECK(sensor.assembler->decoder().mismatch() ==
            "packets of " + std::to_string(sent) +
                " columns a turn or more, but os.json says 1024 (lidar_mode)");
    }
  }
}

TEST_CASE("Lost, repeated and reordered packets are no other lidar_mode") {
  OusterPlan plan;
  OusterSensor sensor(plan);
  std::vector<std::vector<std::uint8_t>> packets;
  for (int column = 0; column < 4 * 1'024; column += 16) {
    plan.first_id = column % 1'024;
    plan.first_ns = 1'000'000'000 + static_cast<std::uint64_t>(std::llround(column * 97'656.25));
    packets.push_back(build_ouster_packet(plan));
  }
  std::swap(packets[70], packets[71]);
  std::swap(packets[127], packets[128]);
  packets.erase(packets.begin() + 180, packets.begin() + 200);
  packets.insert(packets.begin() + 30, packets[29]);
  for (const auto& packet : packets) {
    sensor.plan.first_ns += 1'562'500;
    sensor.send(packet);
  }
  const LidarCounters& counters = sensor.assembler->counters();
  CHECK(counters.wrong_model == 0);
  CHECK(counters.duplicated == 1);
  CHECK(counters.packets == 256 - 20);
  CHECK(counters.lost == 20);
}

TEST_CASE("Impossible fields are garbage; short and long packets are counted") {
  const OusterPlan plan;
  const auto good = build_ouster_packet(plan);
  const auto decoder = decoder_for(plan);
  PacketColumns columns;
  const auto status_with = [&](std::size_t at, std::uint8_t value) {
    auto bytes = good;
    bytes[at] = value;
    return decoder->read(bytes, columns);
  };
  CHECK(status_with(0, 9) == DecodeStatus::kGarbage);             // packet type
  CHECK(status_with(32 + 7, 0xFF) == DecodeStatus::kGarbage);     // timestamp of 2^63 ns
  CHECK(status_with(32 + 3, 0xFF) == DecodeStatus::kGarbage);     // first column after the second
  CHECK(status_with(32 + 9, 0x80) == DecodeStatus::kGarbage);     // measurement id
  CHECK(status_with(32 + 396 + 8, 0) == DecodeStatus::kGarbage);  // the same id twice
  auto bytes = good;
  bytes.pop_back();
  CHECK(decoder->read(bytes, columns) == DecodeStatus::kTruncated);
  bytes.resize(good.size() + 1);
  CHECK(decoder->read(bytes, columns) == DecodeStatus::kOversized);
  CHECK(decoder->read({}, columns) == DecodeStatus::kTruncated);
  CHECK(decoder->read(good, columns) == DecodeStatus::kOk);
}

}  // namespace isobar::test::test_other_sensor
