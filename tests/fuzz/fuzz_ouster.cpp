// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a stream of packets. Each starts with an option byte and the payload's length; the options set the
// right size, header, ids and times, which pass the checks. The first byte chooses profile and beams.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/ouster/decoder.hpp"

namespace {

using isobar::ouster::kProfiles;
using isobar::ouster::Metadata;
using isobar::ouster::PacketLayout;

Metadata metadata_of(std::uint8_t choice) {
  Metadata metadata;
  metadata.file = "os.json";
  metadata.profile = &kProfiles[choice % kProfiles.size()];
  metadata.has_safety_header = metadata.profile->has_safety_header;
  if ((choice & 0x80U) != 0) metadata.imu_profile = isobar::ouster::ImuProfile::kAccel32Gyro32Nmea;
  metadata.pixels = (choice & 0x40U) != 0 ? 128 : 4;
  metadata.columns_per_packet = 16;
  metadata.columns_per_turn = 512;
  for (int row = 0; row < metadata.pixels; ++row) {
    metadata.altitude_deg.push_back(45.0 - row * 0.7);
    metadata.azimuth_deg.push_back(row % 4 * 3.0);
  }
  metadata.beam_origin_x_mm = 27.67;
  return metadata;
}

/// The bytes of the input become the pixels; id and time go on from packet to packet.
void make_valid(std::vector<std::uint8_t>& packet, const PacketLayout& layout, std::uint32_t& id) {
  packet.resize(layout.packet_bytes());
  if (layout.profile().has_header) {
    packet[0] = 1;
    packet[1] = 0;
  }
  for (std::size_t i = 0; i < layout.columns(); ++i, ++id) {
    auto* column = const_cast<std::uint8_t*>(layout.column(packet.data(), i));  // NOLINT: bytes of `packet`
    const std::uint64_t time_ns = std::uint64_t{id} * 195'312;
    for (std::size_t byte = 0; byte < 8; ++byte)
      column[byte] = static_cast<std::uint8_t>(time_ns >> 8 * byte);
    column[8] = static_cast<std::uint8_t>(id % 512);
    column[9] = static_cast<std::uint8_t>(id % 512 >> 8U);
    if (layout.profile().has_header) column[10] = static_cast<std::uint8_t>(column[10] | 1U);
    if (!layout.profile().has_header) std::fill_n(column + layout.column_bytes() - 4, 4, std::uint8_t{0xFF});
  }
}

/// Invariants that the next stage relies on.
void check(const isobar::Scan& scan) {
  const bool is_sound = scan.point_count <= isobar::Scan::kMaxPoints && scan.end_stamp_ns >= scan.stamp_ns &&
                        scan.end_stamp_ns - scan.stamp_ns <= 600'000'000;
  if (!is_sound) std::abort();
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    if (!(std::abs(scan.points[i].x_m) < 1'100.0F) || scan.points[i].ring > 127) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto scan = std::make_unique<isobar::Scan>();
  if (size < 1) return 0;
  const Metadata metadata = metadata_of(data[0]);
  const PacketLayout layout(*metadata.profile, metadata.pixels, 16, metadata.has_safety_header);
  isobar::LidarLimits limits;
  limits.mask_end_deg = data[0];
  auto decoder = std::make_unique<isobar::ouster::Decoder>("OS0", metadata, limits);
  isobar::ScanAssembler assembler(std::move(decoder));
  std::int64_t host_ns = 1'700'000'000'000'000'000;
  std::uint32_t id = 0;
  std::vector<std::uint8_t> packet;
  for (std::size_t at = 1; at + 4 <= size;) {
    const unsigned choices = data[at];
    const std::size_t length = std::min<std::size_t>(data[at + 1] | data[at + 2] << 8U, size - at - 4);
    packet.assign(data + at + 4, data + at + 4 + length);
    if ((choices & 6U) != 0) make_valid(packet, layout, id);
    if ((choices & 8U) != 0) id += data[at + 3];
    if ((choices & 16U) != 0) packet.resize(48);
    host_ns += 3'125'000;
    if (assembler.add_packet(packet, host_ns, *scan).scan_complete) check(*scan);
    for (isobar::ImuSample sample; assembler.take_imu(sample);) {
      if (!sample.accel_m_s2.allFinite() || !sample.gyro_rad_s.allFinite()) std::abort();
    }
    if (assembler.decoder().mismatch().empty()) std::abort();
    at += 4 + length;
  }
  if (assembler.flush(*scan)) check(*scan);
  return 0;
}
