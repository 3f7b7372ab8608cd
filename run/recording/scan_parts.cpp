// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/scan_parts.hpp"

#include <cstring>

namespace isobar::recording {
namespace {

/// x, y, z [m]; time after the stamp [ns]; intensity; laser.
constexpr std::uint32_t kStep = 18;

void append_point(const ScanPoint& point, std::vector<std::uint8_t>& data) {
  const std::size_t at = data.size();
  data.resize(at + kStep);
  const auto time_ns = static_cast<std::uint32_t>(point.time_4us * kPointTimeUnitNs);
  std::memcpy(&data[at], &point.x_m, 3 * sizeof(float));
  std::memcpy(&data[at + 12], &time_ns, sizeof time_ns);
  data[at + 16] = point.intensity;
  data[at + 17] = point.ring;
}

}  // namespace

const CloudRecord* ScanParts::add(const LogEntry& entry) {
  const bool continues =
      is_open_ && entry.scan_first == points_ && entry.stamp_ns == cloud_.stamp_ns && entry.scan_first > 0;
  if (!continues) {
    lost_ += is_open_ || entry.scan_first > 0 ? 1 : 0;
    is_open_ = false;
    if (entry.scan_first > 0) return nullptr;
    cloud_ = {};
    cloud_.stamp_ns = entry.stamp_ns;
    cloud_.height = 1;
    cloud_.point_step = kStep;
    cloud_.fields = {{"x", 0, 7},  {"y", 4, 7},          {"z", 8, 7},
                     {"t", 12, 6}, {"intensity", 16, 2}, {"ring", 17, 2}};
    points_ = 0;
  }
  for (std::size_t at = 0; at + sizeof(ScanPoint) <= entry.packet.size();
       at += sizeof(ScanPoint), ++points_) {
    ScanPoint point;
    std::memcpy(&point, &entry.packet[at], sizeof point);
    append_point(point, cloud_.data);
  }
  is_open_ = points_ < entry.scan_points;
  if (is_open_) return nullptr;
  cloud_.width = points_;
  cloud_.row_step = points_ * kStep;
  return &cloud_;
}

}  // namespace isobar::recording
