// SPDX-License-Identifier: BSD-3-Clause
// A simulated Ouster and the decoder for it.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/ouster/decoder.hpp"
#include "tests/drivers/ouster/packet_builder.hpp"

namespace isobar::test {

inline constexpr std::int64_t kOusterHostNs = 1'700'000'000'000'000'000;

inline std::unique_ptr<ouster::Decoder> decoder_for(const OusterPlan& plan, const LidarLimits& limits = {},
                                                    bool nested = true) {
  return std::make_unique<ouster::Decoder>(
      "OS1", ouster::parse_metadata(build_ouster_metadata(plan, nested), "os.json", "OS1"), limits);
}

/// A sensor that sends turn after turn.
struct OusterSensor {
  OusterPlan plan;
  std::unique_ptr<ScanAssembler> assembler;
  std::vector<std::unique_ptr<Scan>> scans;
  std::unique_ptr<Scan> open = std::make_unique<Scan>();

  explicit OusterSensor(const OusterPlan& packets, const OusterPlan& metadata)
      : plan(packets), assembler(std::make_unique<ScanAssembler>(decoder_for(metadata))) {}
  explicit OusterSensor(const OusterPlan& packets) : OusterSensor(packets, packets) {}

  DecodeStatus send(const std::vector<std::uint8_t>& bytes) {
    const auto host_ns = kOusterHostNs + static_cast<std::int64_t>(plan.first_ns);
    const DecodeResult result = assembler->add_packet(bytes, host_ns, *open);
    if (result.scan_complete) turn_over();
    return result.status;
  }
  void turn_over() {
    scans.push_back(std::move(open));
    open = std::make_unique<Scan>();
  }
  /// Packets of so many columns; those without a valid column are not sent.
  void run(int columns) {
    const double column_ns = 1e9 / (plan.columns_per_turn * plan.hz);
    const std::uint64_t start_ns = plan.first_ns;
    for (int column = 0; column < columns; column += plan.columns_per_packet) {
      plan.first_id = column % plan.columns_per_turn;
      plan.first_ns = start_ns + static_cast<std::uint64_t>(std::llround(column * column_ns));
      bool any = false;
      for (int i = 0; i < plan.columns_per_packet; ++i) any = any || plan.is_valid(plan.first_id + i);
      if (any) send(build_ouster_packet(plan));
    }
    plan.first_ns = start_ns + static_cast<std::uint64_t>(std::llround(columns * column_ns));
  }
};

inline std::vector<ScanPoint> decode_packet(ouster::Decoder& decoder,
                                            const std::vector<std::uint8_t>& bytes) {
  PacketColumns columns;
  REQUIRE(decoder.read(bytes, columns) == DecodeStatus::kOk);
  std::vector<ScanPoint> points(static_cast<std::size_t>(columns.count) * decoder.points_per_column());
  points.resize(decoder.decode(bytes, columns, 0, columns.count, 0, points.data()));
  return points;
}

}  // namespace isobar::test
