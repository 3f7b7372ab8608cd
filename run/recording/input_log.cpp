// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/input_log.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace isobar::recording {

static_assert(std::endian::native == std::endian::little, "records are written as they are in memory");

namespace {

constexpr std::uint16_t kLogMagic = 0xB10C;

struct LogHead {
  std::uint16_t magic = kLogMagic;
  LogKind kind = LogKind::kLosses;
  std::uint8_t reserved = 0;
  std::uint32_t length = 0;    // bytes after the head
  std::uint32_t checksum = 0;  // CRC-32 of the fields above and of those bytes
};
static_assert(sizeof(LogHead) == 12);

/// CRC-32 of a record without its checksum field.
std::uint32_t checksum_of(const std::uint8_t* record, std::size_t length) {
  constexpr std::size_t kFields = offsetof(LogHead, checksum);
  const auto head = crc32_z(0, record, kFields);
  return static_cast<std::uint32_t>(crc32_z(head, record + sizeof(LogHead), length));
}

/// Takes values from the bytes of a record; too few bytes give zeros and ok() == false.
class Fields {
 public:
  explicit Fields(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <typename Value>
  Value take() {
    static_assert(std::is_arithmetic_v<Value>);
    Value value{};
    ok_ = ok_ && rest_.size() >= sizeof value;
    if (ok_) {
      std::memcpy(&value, rest_.data(), sizeof value);
      rest_ = rest_.subspan(sizeof value);
    }
    return value;
  }
  std::span<const std::uint8_t> take_bytes(std::size_t count) {
    ok_ = ok_ && rest_.size() >= count;
    const auto taken = ok_ ? rest_.first(count) : std::span<const std::uint8_t>{};
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void take(Fields& fields, ImuSample& sample) {
  sample.stamp_ns = fields.take<std::int64_t>();
  for (double& rate : sample.gyro_rad_s) rate = fields.take<double>();
  for (double& force : sample.accel_m_s2) force = fields.take<double>();
  for (double& part : sample.q_world_imu.coeffs()) part = fields.take<double>();
  sample.has_attitude = fields.take<std::uint8_t>() != 0;
}

void take(Fields& fields, PressureSample& sample) {
  sample.stamp_ns = fields.take<std::int64_t>();
  sample.pressure_pa = fields.take<double>();
  sample.temperature_c = fields.take<double>();
  sample.variance_pa2 = fields.take<double>();
  sample.station = fields.take<std::uint8_t>();
}

void take(Fields& fields, WheelSample& sample) {
  sample.stamp_ns = fields.take<std::int64_t>();
  sample.vx_m_s = fields.take<double>();
  sample.vy_m_s = fields.take<double>();
  sample.wz_rad_s = fields.take<double>();
  if (fields.left() == 0) return;  // kept over an upgrade, by a program that knew no variances
  sample.vx_variance_m2_s2 = fields.take<double>();
  sample.vy_variance_m2_s2 = fields.take<double>();
  sample.wz_variance_rad2_s2 = fields.take<double>();
}

void take_description(Fields& fields, LogEntry& entry) {
  entry.robot_clock_offset_ns = fields.take<std::int64_t>();
  const auto manifest_bytes = fields.take<std::uint32_t>();
  entry.manifest = text_of(fields.take_bytes(manifest_bytes));
  entry.settings = text_of(fields.take_bytes(fields.left()));
}

}  // namespace

void InputLog::put_bytes(const void* data, std::size_t count) {
  const auto* from = static_cast<const std::uint8_t*>(data);
  bytes_.insert(bytes_.end(), from, from + count);
}

template <typename Value>
void InputLog::put(const Value& value) {
  static_assert(std::is_arithmetic_v<Value>);
  put_bytes(&value, sizeof value);
}

void InputLog::begin(LogKind kind) {
  record_ = bytes_.size();
  LogHead head;
  head.kind = kind;
  put_bytes(&head, sizeof head);
}

void InputLog::end() {
  std::uint8_t* record = bytes_.data() + record_;
  LogHead head;
  std::memcpy(&head, record, sizeof head);
  head.length = static_cast<std::uint32_t>(bytes_.size() - record_ - sizeof head);
  std::memcpy(record, &head, sizeof head);
  head.checksum = checksum_of(record, head.length);
  std::memcpy(record, &head, sizeof head);
  ++records_;
}

bool InputLog::add_packet(std::int64_t stamp_ns, std::uint32_t sender_ipv4,
                          std::span<const std::uint8_t> payload) {
  return add_datagram(LogKind::kPacket, stamp_ns, sender_ipv4, payload);
}

bool InputLog::add_information(std::int64_t stamp_ns, std::uint32_t sender_ipv4,
                               std::span<const std::uint8_t> payload) {
  return add_datagram(LogKind::kInformation, stamp_ns, sender_ipv4, payload);
}

bool InputLog::add_datagram(LogKind kind, std::int64_t stamp_ns, std::uint32_t sender_ipv4,
                            std::span<const std::uint8_t> payload) {
  if (payload.size() + sizeof stamp_ns + sizeof sender_ipv4 > kMaxLogRecordBytes) return false;
  begin(kind);
  put(stamp_ns);
  put(sender_ipv4);
  put_bytes(payload.data(), payload.size());
  end();
  return true;
}

void InputLog::add_scan(const Scan& scan) {
  constexpr std::uint32_t kPointsOfPart = (kMaxLogRecordBytes - 16) / sizeof(ScanPoint);
  const std::uint32_t count = std::min(scan.point_count, Scan::kMaxPoints);
  for (std::uint32_t first = 0; first < count; first += kPointsOfPart) {
    begin(LogKind::kScanPart);
    put(scan.stamp_ns);
    put(count);
    put(first);
    put_bytes(scan.points + first, std::min(kPointsOfPart, count - first) * sizeof(ScanPoint));
    end();
  }
}

void InputLog::add(const ImuSample& sample) {
  begin(LogKind::kImu);
  put(sample.stamp_ns);
  for (const double rate : sample.gyro_rad_s) put(rate);
  for (const double force : sample.accel_m_s2) put(force);
  for (const double part : sample.q_world_imu.coeffs()) put(part);
  put(static_cast<std::uint8_t>(sample.has_attitude ? 1 : 0));
  end();
}

void InputLog::add(const WheelSample& sample) {
  begin(LogKind::kWheel);
  put(sample.stamp_ns);
  put(sample.vx_m_s);
  put(sample.vy_m_s);
  put(sample.wz_rad_s);
  put(sample.vx_variance_m2_s2);
  put(sample.vy_variance_m2_s2);
  put(sample.wz_variance_rad2_s2);
  end();
}

void InputLog::add_pressure(const PressureSample& sample) { add_pressure(LogKind::kPressure, sample); }
void InputLog::add_base_pressure(const PressureSample& sample) {
  add_pressure(LogKind::kBasePressure, sample);
}

void InputLog::add_pressure(LogKind kind, const PressureSample& sample) {
  begin(kind);
  put(sample.stamp_ns);
  put(sample.pressure_pa);
  put(sample.temperature_c);
  put(sample.variance_pa2);
  put(sample.station);
  end();
}

bool InputLog::add_description(std::int64_t robot_clock_offset_ns, std::string_view manifest,
                               std::string_view settings) {
  constexpr std::size_t kNumbers = sizeof(std::int64_t) + sizeof(std::uint32_t);
  if (manifest.size() + settings.size() + kNumbers > kMaxLogRecordBytes) return false;
  begin(LogKind::kDescription);
  put(robot_clock_offset_ns);
  put(static_cast<std::uint32_t>(manifest.size()));
  put_bytes(manifest.data(), manifest.size());
  put_bytes(settings.data(), settings.size());
  end();
  return true;
}

void InputLog::add_losses(std::uint64_t losses) {
  begin(LogKind::kLosses);
  put(losses);
  end();
}

bool InputLogReader::next(LogEntry& entry) {
  const auto rest = bytes_.subspan(at_);
  LogHead head;
  if (damaged_ || rest.size() < sizeof head) return false;
  std::memcpy(&head, rest.data(), sizeof head);
  if (head.magic != kLogMagic || head.length > kMaxLogRecordBytes) {
    damaged_ = true;
    return false;
  }
  if (rest.size() - sizeof head < head.length) return false;
  const bool intact = head.checksum == checksum_of(rest.data(), head.length) &&
                      parse(head.kind, rest.subspan(sizeof head, head.length), entry);
  damaged_ = !intact;
  if (intact) at_ += sizeof head + head.length;
  return intact;
}

bool InputLogReader::parse(LogKind kind, std::span<const std::uint8_t> payload, LogEntry& entry) {
  Fields fields(payload);
  entry.kind = kind;
  switch (kind) {
    case LogKind::kPacket:
    case LogKind::kInformation:
      entry.stamp_ns = fields.take<std::int64_t>();
      entry.sender_ipv4 = fields.take<std::uint32_t>();
      entry.packet = fields.take_bytes(fields.left());
      break;
    case LogKind::kScanPart:
      entry.stamp_ns = fields.take<std::int64_t>();
      entry.scan_points = fields.take<std::uint32_t>();
      entry.scan_first = fields.take<std::uint32_t>();
      entry.packet = fields.take_bytes(fields.left());
      // So that a damaged record cannot ask for memory.
      return fields.ok() && entry.scan_points <= Scan::kMaxPoints &&
             entry.packet.size() % sizeof(ScanPoint) == 0;
    case LogKind::kImu:
      take(fields, entry.imu);
      break;
    case LogKind::kPressure:
    case LogKind::kBasePressure:
      take(fields, entry.pressure);
      break;
    case LogKind::kWheel:
      take(fields, entry.wheel);
      break;
    case LogKind::kDescription:
      take_description(fields, entry);
      break;
    case LogKind::kLosses:
      entry.losses = fields.take<std::uint64_t>();
      break;
    default:
      return false;
  }
  return fields.ok() && fields.left() == 0;
}

}  // namespace isobar::recording
