// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/ouster/decoder.hpp"
#include "tests/drivers/ouster/captures.hpp"
#include "tests/drivers/ouster/range_to_xyz.hpp"

namespace isobar::test::test_real_captures {
namespace {

using nlohmann::json;

const std::filesystem::path kFolder = std::filesystem::path(ISOBAR_SHARED_DATA) / "ouster";

struct Capture {
  const char* name;
  const char* model;
  FieldPlan plan;
  std::vector<PixelField> fields;  // range, reflectivity; of the second return
  const char* digest;
  double range_unit_m;  // of the field's values
};

const std::array<Capture, 4> kCaptures{
    Capture{"OS-0-128-U1_v2.3.0_1024x10",
            "OS0",
            {32, 12, 4, 0, 128},
            {{"RANGE", 0, 4, 0x7FFF, 3, 0, 4}, {"REFLECTIVITY", 2, 1, 0xFF, 0, 0, 1}},
            "OS-0-128-U1_v2.3.0_1024x10_digest.json",
            0.001},
    Capture{"OS-0-32-U1_v2.2.0_1024x10",
            "OS0",
            {32, 12, 16, 0, 32},
            {{"RANGE", 0, 4, 0x7FFFF, 0, 0, 4},
             {"REFLECTIVITY", 3, 1, 0xFF, 0, 0, 1},
             {"RANGE2", 4, 4, 0x7FFFF, 0, 0, 4},
             {"REFLECTIVITY2", 7, 1, 0xFF, 0, 0, 1}},
            "OS-0-32-U1_v2.2.0_1024x10_digest.json",
            0.001},
    Capture{"OS-1-32-G_v2.1.1_1024x10",
            "OS1",
            {0, 16, 12, 4, 32},
            {{"RANGE", 0, 4, 0xFFFFF, 0, 0, 4}, {"REFLECTIVITY", 4, 1, 0xFF, 0, 0, 1}},
            "OS-1-32-G_v2.1.1_1024x10_digest.json",
            0.001},
    Capture{"OS-1-128_767798045_1024x10_20230712_120049",
            "OS1",
            {32, 12, 8, 0, 128},
            {{"RANGE", 0, 4, 0x7FFF, 3, 0, 4},
             {"REFLECTIVITY", 2, 1, 0xFF, 0, 0, 1},
             {"RANGE2", 4, 4, 0x7FFF, 3, 0, 4},
             {"REFLECTIVITY2", 6, 1, 0xFF, 0, 0, 1}},
            nullptr,
            0.001},
};

bool is_missing() {
  if (std::filesystem::exists(kFolder)) return false;
  MESSAGE("skipped: " << kFolder.string() << " is not on this machine");
  return true;
}

std::filesystem::path file_of(const Capture& capture, const char* ending) {
  return kFolder / (std::string(capture.name) + ending);
}

json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return json::parse(in);
}

std::vector<CapturedPacket> packets_of(const Capture& capture, std::uint16_t port) {
  auto packets = read_capture(file_of(capture, ".pcap"));
  std::erase_if(packets, [port](const CapturedPacket& packet) { return packet.port != port; });
  return packets;
}

std::unique_ptr<ouster::Decoder> decoder_of(const Capture& capture, const LidarLimits& limits = {}) {
  return std::make_unique<ouster::Decoder>(
      capture.model, ouster::read_metadata(file_of(capture, ".json"), capture.model), limits);
}

std::string little_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

/// Bytes of a field of all packets, as Ouster's SDK hashes them: by packet, row, column.
std::string field_bytes(const Capture& capture, const PixelField& field,
                        const std::vector<CapturedPacket>& packets) {
  std::string text;
  for (const auto& packet : packets) {
    for (int row = 0; row < capture.plan.rows; ++row) {
      for (int column = 0; column < 16; ++column) {
        text += little_endian(pixel_value(capture.plan, field, packet.bytes, column, row), field.hash_bytes);
      }
    }
  }
  return text;
}

/// What a packet must give, in the decoder's order.
std::vector<ScanPoint> expected_points(const Capture& capture, const RangeToXyz& geometry,
                                       const std::vector<std::uint8_t>& bytes) {
  std::vector<ScanPoint> points;
  std::uint64_t first_ns = 0;
  for (int column = 0; column < 16; ++column) {
    if (!is_valid_column(capture.plan, bytes, column)) continue;
    const int at = column_at(capture.plan, column);
    const std::uint64_t time_ns = bytes_at(bytes, at, 8);
    first_ns = first_ns == 0 ? time_ns : first_ns;
    const int id = static_cast<int>(bytes_at(bytes, at + 8, 2));
    for (int row = 0; row < capture.plan.rows; ++row) {
      std::uint32_t before = 0;
      for (std::size_t f = 0; f < capture.fields.size(); f += 2) {
        const std::uint32_t range_mm = pixel_value(capture.plan, capture.fields[f], bytes, column, row);
        const std::uint32_t intensity = pixel_value(capture.plan, capture.fields[f + 1], bytes, column, row);
        if (range_mm != 0 && range_mm != before) {
          const Eigen::Vector3d p = geometry.point_m(range_mm, id, row, 1'024);
          points.push_back(
              {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
               static_cast<std::uint16_t>(std::llround(static_cast<double>(time_ns - first_ns) / 4e3)),
               static_cast<std::uint8_t>(capture.plan.rows - 1 - row), static_cast<std::uint8_t>(intensity)});
        }
        before = range_mm;
      }
    }
  }
  return points;
}

}  // namespace

TEST_CASE("The fields that the expected points are made from are those of Ouster's own digests") {
  if (is_missing()) return;
  for (const Capture& capture : kCaptures) {
    if (capture.digest == nullptr) continue;
    CAPTURE(std::string(capture.name));
    const json digest = read_json(kFolder / capture.digest)["packet_hash"];
    const auto packets = packets_of(capture, 7'502);
    REQUIRE(packets.size() == 64);
    std::string timestamps;
    std::string ids;
    std::string status;
    for (const auto& packet : packets) {
      for (int column = 0; column < 16; ++column) {
        const int at = column_at(capture.plan, column);
        timestamps += little_endian(bytes_at(packet.bytes, at, 8), 8);
        ids += little_endian(bytes_at(packet.bytes, at + 8, 2), 2);
        const bool legacy = capture.plan.column_footer > 0;
        status += little_endian(legacy ? bytes_at(packet.bytes, column_at(capture.plan, column + 1) - 4, 4)
                                       : bytes_at(packet.bytes, at + 10, 2),
                                4);
      }
    }
    CHECK(md5(timestamps) == digest["TIMESTAMP"]);
    CHECK(md5(ids) == digest["MEASUREMENT_ID"]);
    CHECK(md5(status) == digest["STATUS"]);
    for (const PixelField& field : capture.fields) {
      CAPTURE(std::string(field.name));
      CHECK(md5(field_bytes(capture, field, packets)) == digest[field.name]);
    }
  }
}

TEST_CASE("Every return of every packet of the captures is decoded: place, time, ring and reflectivity") {
  if (is_missing()) return;
  for (const Capture& capture : kCaptures) {
    CAPTURE(std::string(capture.name));
    const RangeToXyz geometry(read_json(file_of(capture, ".json")));
    LidarLimits limits;
    limits.min_range_m = 0.0;
    limits.max_range_m = 1'000.0;
    const auto decoder = decoder_of(capture, limits);
    std::vector<double> errors_m;
    for (const auto& packet : packets_of(capture, 7'502)) {
      PacketColumns columns;
      REQUIRE(decoder->read(packet.bytes, columns) == DecodeStatus::kOk);
      REQUIRE(decoder->is_data(packet.bytes));
      std::vector<ScanPoint> points(static_cast<std::size_t>(columns.count) * decoder->points_per_column());
      points.resize(decoder->decode(packet.bytes, columns, 0, columns.count, 0, points.data()));
      const auto expected = expected_points(capture, geometry, packet.bytes);
      REQUIRE(points.size() == expected.size());
      bool all_equal = true;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const ScanPoint& p = points[i];
        const ScanPoint& e = expected[i];
        all_equal = all_equal && p.ring == e.ring && p.intensity == e.intensity && p.time_4us == e.time_4us;
        errors_m.push_back(std::hypot(double{p.x_m} - e.x_m, double{p.y_m} - e.y_m, double{p.z_m} - e.z_m));
      }
      CHECK(all_equal);
    }
    std::sort(errors_m.begin(), errors_m.end());
    REQUIRE(errors_m.size() > 10'000);
    MESSAGE(std::string(capture.name)
            << ": " << errors_m.size() << " returns, median " << errors_m[errors_m.size() / 2] * 1e3
            << " mm, largest " << errors_m.back() * 1e3 << " mm");
    CHECK(errors_m[errors_m.size() / 2] <= 1e-5);
    CHECK(errors_m.back() <= 1e-4);  // floats: 3e-5 m at 500 m, in three terms
  }
}

TEST_CASE("A captured turn is one scan, or two that are full, without a lost packet") {
  if (is_missing()) return;
  for (const Capture& capture : kCaptures) {
    CAPTURE(std::string(capture.name));
    ScanAssembler assembler(decoder_of(capture));
    const auto scan = std::make_unique<Scan>();
    std::uint64_t points = 0;
    std::uint64_t samples = 0;
    for (const auto& packet : read_capture(file_of(capture, ".pcap"))) {
      const DecodeResult result = assembler.add_packet(packet.bytes, packet.stamp_ns, *scan);
      CHECK(result.status == (packet.port == 7'502 ? DecodeStatus::kOk : DecodeStatus::kNoPoints));
      if (result.scan_complete) points += scan->point_count;
      for (ImuSample sample; assembler.take_imu(sample);) {
        ++samples;
        CHECK(sample.accel_m_s2.norm() == doctest::Approx(9.81).epsilon(0.08));
        CHECK(sample.accel_m_s2.z() > 9.0);  // the sensors stood upright
        CHECK(sample.gyro_rad_s.norm() < 0.05);
        // One clock. Lidar packets come 7 ms (firmware 3.1) to 17 ms (2.3) later after their columns than IMU
        // packets after their samples; the offset of the clock to the host is by the lidar's.
        CHECK(std::abs(sample.stamp_ns - packet.stamp_ns) < 20'000'000);
      }
    }
    CHECK(assembler.flush(*scan));
    points += scan->point_count;
    const LidarCounters& counters = assembler.counters();
    CHECK(points == counters.returns);
    CHECK(counters.lost == 0);
    CHECK(counters.scans == (counters.returns > 70'000 ? 2 : 1));
    CHECK(samples == packets_of(capture, 7'503).size());
    CHECK(counters.no_points == samples);
  }
}

TEST_CASE(
    "A datagram whose identification is used again is decoded once, by the fragments of the later one") {
  if (is_missing()) return;
  const auto packets = read_capture(kFolder / "duplicate_id.pcap");
  REQUIRE(packets.size() == 1);
  CHECK(packets[0].port == 34'636);
  ScanAssembler assembler(std::make_unique<ouster::Decoder>(
      "OS2", ouster::read_metadata(kFolder / "duplicate_id.json", "OS2"), LidarLimits{}));
  const auto scan = std::make_unique<Scan>();
  CHECK(assembler.add_packet(packets[0].bytes, packets[0].stamp_ns, *scan).status == DecodeStatus::kOk);
  CHECK(assembler.add_packet(packets[0].bytes, packets[0].stamp_ns + 1'000, *scan).status ==
        DecodeStatus::kDuplicate);
  CHECK(assembler.counters().duplicated == 1);
  CHECK(assembler.flush(*scan));
  CHECK(scan->point_count > 100);
}

TEST_CASE("No capture is decoded with the metadata of another") {
  if (is_missing()) return;
  for (const Capture& packets : kCaptures) {
    const auto payload = packets_of(packets, 7'502).at(0).bytes;
    for (const Capture& metadata : kCaptures) {
      CAPTURE(std::string(packets.name));
      CAPTURE(std::string(metadata.name));
      const auto decoder = decoder_of(metadata);
      PacketColumns columns;
      const bool fits = &packets == &metadata;
      CHECK(decoder->read(payload, columns) == (fits ? DecodeStatus::kOk : DecodeStatus::kWrongModel));
      CHECK(decoder->is_data(payload) == fits);
      if (!fits) CHECK(decoder->mismatch().find(metadata.name) != std::string::npos);
    }
    CHECK_THROWS_AS(static_cast<void>(ouster::read_metadata(file_of(packets, ".json"), "OS2")), ConfigError);
  }
}

}  // namespace isobar::test::test_real_captures
