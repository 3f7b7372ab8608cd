// SPDX-License-Identifier: BSD-3-Clause
// Input log: the inputs of isobard as one stream of bytes, for the black box and between the processes of
// `isobar record`. Not a file format for users: it becomes a recording folder.
//
// A record: head (magic, kind, length, checksum), then `length` bytes. Little-endian. A log that is cut
// anywhere is readable up to the cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/samples.hpp"

namespace isobar::recording {

enum class LogKind : std::uint8_t {
  kPacket = 1,  ///< datagram of the lidar, to its data port
  kImu,
  kPressure,
  kBasePressure,
  kWheel,
  kDescription,  ///< sensors and settings of the run that the following records belong to
  kLosses,       ///< number of inputs lost so far on the way into this log
  kInformation,  ///< datagram of the lidar to its second port: position, device information, IMU
  kScanPart,     ///< points of a scan of a lidar that gives clouds; the parts of a scan follow each other
};

/// One record. Only the members that `kind` names are valid; views refer to the log.
struct LogEntry {
  LogKind kind = LogKind::kLosses;
  /// Robot clock: of kPacket and kInformation the time of receipt, of kScanPart that of the scan's first point.
  std::int64_t stamp_ns = 0;
  std::uint32_t sender_ipv4 = 0;
  std::span<const std::uint8_t> packet;  ///< of kScanPart: its points, each as a ScanPoint lies in memory
  std::uint32_t scan_points = 0;         ///< of kScanPart: of the whole scan
  std::uint32_t scan_first = 0;          ///< of kScanPart: number of the part's first point in it
  ImuSample imu;
  PressureSample pressure;  ///< of kPressure and kBasePressure
  WheelSample wheel;
  std::int64_t robot_clock_offset_ns = 0;  ///< of kDescription: robot clock minus CLOCK_MONOTONIC
  std::string_view manifest;               ///< of kDescription: recording.toml
  std::string_view settings;               ///< of kDescription: settings.toml; may be empty
  std::uint64_t losses = 0;
};

/// Longest record that is written or read [bytes after the head].
inline constexpr std::size_t kMaxLogRecordBytes = 1U << 17U;

/// Appends records to a buffer, which keeps its memory when it is cleared.
class InputLog {
 public:
  /// A datagram longer than a record can be is left out.
  /// @return false when it was left out
  bool add_packet(std::int64_t stamp_ns, std::uint32_t sender_ipv4, std::span<const std::uint8_t> payload);
  /// The same of the lidar's second port.
  bool add_information(std::int64_t stamp_ns, std::uint32_t sender_ipv4,
                       std::span<const std::uint8_t> payload);
  void add_scan(const Scan& scan);
  void add(const ImuSample& sample);
  void add(const WheelSample& sample);
  void add_pressure(const PressureSample& sample);
  void add_base_pressure(const PressureSample& sample);
  /// @return false when both texts together are longer than a record can be: nothing is added
  bool add_description(std::int64_t robot_clock_offset_ns, std::string_view manifest,
                       std::string_view settings);
  void add_losses(std::uint64_t losses);

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  [[nodiscard]] std::size_t records() const { return records_; }
  void clear() {
    bytes_.clear();
    records_ = 0;
  }

 private:
  void begin(LogKind kind);
  bool add_datagram(LogKind kind, std::int64_t stamp_ns, std::uint32_t sender_ipv4,
                    std::span<const std::uint8_t> payload);
  void end();
  void add_pressure(LogKind kind, const PressureSample& sample);
  template <typename Value>
  void put(const Value& value);
  void put_bytes(const void* data, std::size_t count);

  std::vector<std::uint8_t> bytes_;
  std::size_t record_ = 0;   // where the record under construction begins
  std::size_t records_ = 0;  // in the buffer
};

/// Reads the records of a log from its first byte on.
class InputLogReader {
 public:
  explicit InputLogReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// The next record; false at the end of the log, at a cut and at a damaged record.
  bool next(LogEntry& entry);
  /// Bytes of the records read so far.
  [[nodiscard]] std::size_t consumed() const { return at_; }
  /// True when the rest of the log is no beginning of a record: it was damaged, not cut.
  [[nodiscard]] bool damaged() const { return damaged_; }

 private:
  bool parse(LogKind kind, std::span<const std::uint8_t> payload, LogEntry& entry);

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool damaged_ = false;
};

}  // namespace isobar::recording
