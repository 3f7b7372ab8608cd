// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a stream of Mid-360 packets. Each starts with an option byte and the payload's length; the options
// set a length, a number of points and a checksum that pass the checks.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/livox/decoder.hpp"

namespace {

using isobar::livox::kHeaderBytes;

void put(std::vector<std::uint8_t>& packet, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) packet[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

void make_valid(std::vector<std::uint8_t>& packet, std::uint64_t& stamp_ns) {
  packet.resize(std::max(packet.size(), kHeaderBytes + 24));
  packet[10] %= 4;
  const std::size_t bytes = isobar::livox::sample_bytes(packet[10]);
  const std::size_t samples = std::min<std::size_t>((packet.size() - kHeaderBytes) / bytes, 96);
  packet.resize(kHeaderBytes + samples * bytes);
  packet[0] = 0;
  put(packet, 1, packet.size(), 2);
  put(packet, 5, samples, 2);
  put(packet, 28, stamp_ns, 8);
  put(packet, 24, isobar::livox::crc32(std::span(packet).subspan(28)), 4);
  stamp_ns += 480'000;
}

void check(const isobar::Scan& scan) {
  const bool is_sound = scan.point_count <= isobar::Scan::kMaxPoints && scan.end_stamp_ns >= scan.stamp_ns &&
                        scan.end_stamp_ns - scan.stamp_ns <= 600'000'000;
  if (!is_sound) std::abort();
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    if (!(std::abs(scan.points[i].x_m) <= 300.1F)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto scan = std::make_unique<isobar::Scan>();
  if (size < 1) return 0;
  isobar::LidarLimits limits;
  limits.mask_end_deg = data[0];
  isobar::ScanAssembler assembler(std::make_unique<isobar::livox::Decoder>(limits));
  std::int64_t host_ns = 1'700'000'000'000'000'000;
  std::uint64_t stamp_ns = 1'000'000'000;
  std::vector<std::uint8_t> packet;
  for (std::size_t at = 1; at + 4 <= size;) {
    const unsigned choices = data[at];
    const std::size_t length = std::min<std::size_t>(data[at + 1] | data[at + 2] << 8U, size - at - 4);
    packet.assign(data + at + 4, data + at + 4 + length);
    if ((choices & 6U) != 0) make_valid(packet, stamp_ns);
    if ((choices & 8U) != 0) stamp_ns += std::uint64_t{data[at + 3]} << (choices >> 4U) * 4;
    host_ns += 480'000;
    if (assembler.add_packet(packet, host_ns, *scan).scan_complete) check(*scan);
    for (isobar::ImuSample sample; assembler.take_imu(sample);) {
      if (!sample.accel_m_s2.allFinite() || !sample.gyro_rad_s.allFinite()) std::abort();
    }
    at += 4 + length;
  }
  if (assembler.flush(*scan)) check(*scan);
  return 0;
}
