// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a stream of packets. Each starts with an option byte and the payload's length; the options set
// valid flags, azimuths, mode and model, which pass the checks.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/velodyne/decoder.hpp"

namespace {

using isobar::velodyne::Model;

void make_valid(std::vector<std::uint8_t>& packet, Model model, bool dual) {
  packet.resize(isobar::velodyne::kDataPacketBytes);
  for (std::size_t block = 0; block < 12; ++block) {
    packet[block * 100] = 0xFF;
    packet[block * 100 + 1] = 0xEE;
    packet[block * 100 + 3] %= 140;  // azimuth below 36000
  }
  packet[1204] = dual ? 0x39 : 0x37;
  packet[1205] = static_cast<std::uint8_t>(model);
}

/// Invariants that the next stage relies on.
void check(const isobar::Scan& scan) {
  if (scan.point_count > isobar::Scan::kMaxPoints || scan.end_stamp_ns < scan.stamp_ns ||
      scan.end_stamp_ns - scan.stamp_ns > 600'000'000) {
    std::abort();
  }
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    if (!(std::abs(scan.points[i].x_m) < 263.0F) || scan.points[i].ring > 31) {
      std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto scan = std::make_unique<isobar::Scan>();
  if (size < 1) {
    return 0;
  }
  constexpr auto& kModels = isobar::velodyne::kModels;
  const isobar::velodyne::ModelTraits& traits = *kModels[data[0] % kModels.size()];
  isobar::LidarLimits limits;
  limits.mask_end_deg = data[0];
  auto assembler =
      std::make_unique<isobar::ScanAssembler>(std::make_unique<isobar::velodyne::Decoder>(traits, limits));
  std::int64_t host_ns = 1'700'000'000'000'000'000;
  std::vector<std::uint8_t> packet;
  for (std::size_t at = 1; at + 5 <= size;) {
    const unsigned choices = data[at];
    const std::size_t length = std::min<std::size_t>(data[at + 1] | data[at + 2] << 8U, size - at - 5);
    const std::uint64_t step_ns =
        (choices & 1U) != 0 ? std::uint64_t{data[at + 3]} << (data[at + 4] % 56U) : 1'327'104;
    host_ns =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(host_ns) + step_ns);  // any stamp, wraps around
    packet.assign(data + at + 5, data + at + 5 + length);
    if ((choices & 6U) != 0) {
      make_valid(packet, traits.model, (choices & 4U) != 0);
    }
    if (assembler->add_packet(packet, host_ns, *scan).scan_complete) {
      check(*scan);
    }
    at += 5 + length;
  }
  if (assembler->flush(*scan)) {
    check(*scan);
  }
  return 0;
}
