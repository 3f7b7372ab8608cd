// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a stream of packets for any lidar model of the registry that needs no file. Each packet starts with
// an option byte and its length; the options overwrite its beginning and its block marks with those of a valid
// packet of the model, so that it passes the first checks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"

namespace {

using isobar::LidarModel;

void mark_blocks(std::vector<std::uint8_t>& packet, std::size_t first) {
  for (std::size_t block = 0; block < 12; ++block) {
    packet[first + block * 100] = 0xFF;
    packet[first + block * 100 + 1] = 0xEE;
    packet[first + block * 100 + 2] %= 140;  // azimuth below 36000, in either byte order
    packet[first + block * 100 + 3] %= 140;
  }
}

/// Makes the size and the fixed fields of a data packet, or of device information, of this maker.
void make_valid(std::vector<std::uint8_t>& packet, const LidarModel& model, bool other) {
  if (model.maker == "Hesai") {
    const std::uint8_t lasers = model.name == "XT16" ? 16 : 32;
    packet.resize(12U + 8U * (2U + 4U * lasers) + 28U);
    const std::array<std::uint8_t, 12> head{0xEE, 0xFF, 6, 1, 0, 0, lasers, 8, 1, 4, 1, 1};
    std::copy(head.begin(), head.end(), packet.begin());
    for (std::size_t block = 0; block < 8; ++block) packet[13 + block * (2U + 4U * lasers)] %= 140;
    std::uint8_t* tail = packet.data() + packet.size() - 28;
    tail[10] = other ? 0x39 : 0x37;
    const std::array<std::uint8_t, 6> date{124, 11, 29, 2, 42, 7};
    std::copy(date.begin(), date.end(), tail + 13);
    tail[21] %= 15;
    tail[22] = 0;
  } else if (model.maker == "RoboSense") {
    packet.resize(1248);
    constexpr std::array<std::uint8_t, 8> kDifop{0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
    constexpr std::array<std::uint8_t, 8> kRs16{0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0};
    constexpr std::array<std::uint8_t, 8> kHelios{0x55, 0xAA, 0x05, 0x5A, 0, 1, 0, 0};
    const auto& id = other ? kDifop : model.name == "RS-LiDAR-16" ? kRs16 : kHelios;
    std::copy(id.begin(), id.end(), packet.begin());
    if (other) return;
    const std::array<std::uint8_t, 10> date{24, 11, 29, 2, 42, 7, 0, packet[27], 0, packet[29]};
    const std::array<std::uint8_t, 10> epoch{0,    0, 0x67,       0x49,       0x28,
                                             0x7F, 0, packet[27], packet[28], packet[29]};
    std::copy_n((model.name == "RS-LiDAR-16" ? date : epoch).begin(), 10, packet.begin() + 20);
    mark_blocks(packet, 42);
  } else {
    packet.resize(1206);
    mark_blocks(packet, 0);
    packet[1204] = other ? 0x39 : 0x37;
    packet[1205] = model.name == "HDL-32E"         ? 0x21
                   : model.name == "VLP-16"        ? 0x22
                   : model.name == "VLP-16 Hi-Res" ? 0x24
                                                   : 0x28;
  }
}

/// Invariants that the next stage relies on.
void check(const isobar::Scan& scan) {
  if (scan.point_count > isobar::Scan::kMaxPoints || scan.end_stamp_ns < scan.stamp_ns ||
      scan.end_stamp_ns - scan.stamp_ns > 600'000'000) {
    std::abort();
  }
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    if (!(std::abs(scan.points[i].x_m) < 17'000.0F) || scan.points[i].ring > 127) std::abort();
  }
}

const LidarModel& choose(std::uint8_t number) {
  static const std::vector<LidarModel> models = [] {
    std::vector<LidarModel> without_file;
    for (const LidarModel& model : isobar::lidar_models()) {
      if (!model.needs_calibration) without_file.push_back(model);
    }
    return without_file;
  }();
  return models[number % models.size()];
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto scan = std::make_unique<isobar::Scan>();
  if (size < 1) return 0;
  const LidarModel& model = choose(data[0]);
  isobar::LidarConfig config;
  config.model = model.name;
  config.limits.mask_end_deg = data[0];
  isobar::ScanAssembler assembler(isobar::make_lidar_decoder(config));
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
    if ((choices & 6U) != 0) make_valid(packet, model, (choices & 4U) != 0);
    if (assembler.add_packet(packet, host_ns, *scan).scan_complete) check(*scan);
    at += 5 + length;
  }
  if (assembler.flush(*scan)) check(*scan);
  return 0;
}
