// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/scan_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/plausibility.hpp"
#include "run/tile_store/tile_record.hpp"

namespace isobar {

namespace {

constexpr double kLargestM = 1e8;  // as LocalMap::update()

/// Point in base_link, in units of ScanHead::unit_m.
struct JournalPoint {
  std::array<std::int16_t, 3> p_base{};
  std::uint8_t intensity = 0;
  std::uint8_t reserved = 0;
};
static_assert(sizeof(JournalPoint) == 8);

/// Head of a record, in front of the points. Little-endian; all padding is explicit.
struct ScanHead {
  static constexpr std::uint32_t kMagic = 0x4E414353;  ///< "SCAN"
  std::uint32_t magic = kMagic;
  std::uint32_t point_count = 0;
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::uint32_t session = 1;
  std::array<double, 3> position_m{};
  std::array<double, 4> quaternion{};  ///< w x y z
  float unit_m = 0.0F;                 ///< of the points' coordinates
  float overlap = 0.0F;
  std::uint8_t mode = 0;
  std::array<std::uint8_t, 7> reserved{};
  std::uint32_t points_crc = 0;
  std::uint32_t head_crc = 0;  ///< of all fields above

  [[nodiscard]] std::uint32_t crc() const {
    return crc32_of(std::as_bytes(std::span(this, 1)).first(sizeof(ScanHead) - sizeof(head_crc)));
  }
  [[nodiscard]] Eigen::Quaterniond rotation() const {
    return {quaternion[0], quaternion[1], quaternion[2], quaternion[3]};
  }
  /// True if magic number, checksum and values are right.
  [[nodiscard]] bool is_valid() const {
    return magic == kMagic && head_crc == crc() && point_count <= kMostScanPoints &&
           mode <= static_cast<std::uint8_t>(PoseMode::kInitializing) && std::isfinite(unit_m) &&
           std::all_of(position_m.begin(), position_m.end(),
                       [](double value) { return std::abs(value) <= kLargestM; }) &&
           kPlausibleQuaternionNorm.holds(rotation().norm());
  }
};
static_assert(sizeof(ScanHead) == 104);

float largest_coordinate_m(const RegisteredScan& scan) {
  float largest = 0.0F;
  for (const ScanPoint& point : std::span(scan.points, scan.point_count)) {
    largest = std::max({largest, std::abs(point.x_m), std::abs(point.y_m), std::abs(point.z_m)});
  }
  return largest;
}

}  // namespace

void encode_scan(const RegisteredScan& scan, std::vector<std::byte>& record) {
  const std::uint32_t step = scan.point_count / (kMostScanPoints + 1) + 1;
  ScanHead head;
  head.stamp_ns = scan.pose.stamp_ns;
  head.sequence = scan.pose.sequence;
  head.session = scan.pose.session;
  const Eigen::Quaterniond q = Eigen::Quaterniond(scan.pose.T_map_base.linear()).normalized();
  head.quaternion = {q.w(), q.x(), q.y(), q.z()};
  Eigen::Vector3d::Map(head.position_m.data()) = scan.pose.T_map_base.translation();
  head.unit_m = std::max(largest_coordinate_m(scan), 1.0F) / 32'000.0F;
  head.overlap = static_cast<float>(scan.pose.overlap);
  head.mode = static_cast<std::uint8_t>(scan.pose.mode);
  record.resize(sizeof(ScanHead));
  const auto scaled = [&](float value_m) {
    return static_cast<std::int16_t>(std::lround(value_m / head.unit_m));
  };
  for (std::uint32_t i = 0; i < scan.point_count; i += step) {
    const ScanPoint& from = scan.points[i];
    const JournalPoint point{{scaled(from.x_m), scaled(from.y_m), scaled(from.z_m)}, from.intensity};
    const auto bytes = std::as_bytes(std::span(&point, 1));
    record.insert(record.end(), bytes.begin(), bytes.end());
    ++head.point_count;
  }
  head.points_crc = crc32_of(std::span(record).subspan(sizeof(ScanHead)));
  head.head_crc = head.crc();
  std::memcpy(record.data(), &head, sizeof(head));
}

bool decode_scan(std::span<const std::byte>& bytes, RegisteredScan& scan) {
  ScanHead head;
  if (bytes.size() < sizeof(head)) return false;
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (!head.is_valid()) return false;
  const std::size_t size = head.point_count * sizeof(JournalPoint);
  if (bytes.size() - sizeof(head) < size) return false;
  const auto points = bytes.subspan(sizeof(head), size);
  if (crc32_of(points) != head.points_crc) return false;
  bytes = bytes.subspan(sizeof(head) + size);
  scan.pose = PoseEstimate{};
  scan.pose.stamp_ns = head.stamp_ns;
  scan.pose.sequence = head.sequence;
  scan.pose.session = head.session;
  scan.pose.mode = static_cast<PoseMode>(head.mode);
  scan.pose.overlap = head.overlap;
  scan.pose.T_map_base.linear() = head.rotation().normalized().toRotationMatrix();
  scan.pose.T_map_base.translation() = Eigen::Vector3d(head.position_m.data());
  scan.point_count = head.point_count;
  for (std::uint32_t i = 0; i < head.point_count; ++i) {
    JournalPoint point;
    std::memcpy(&point, points.data() + i * sizeof(point), sizeof(point));
    const Eigen::Vector3f p =
        head.unit_m * Eigen::Vector3f(point.p_base[0], point.p_base[1], point.p_base[2]);
    scan.points[i] = {p.x(), p.y(), p.z(), 0, 0, point.intensity};
  }
  return true;
}

}  // namespace isobar
