// SPDX-License-Identifier: BSD-3-Clause
// LidarDecoder: what a lidar model brings, from the bytes of its packets to points. Scans are assembled by
// ScanAssembler, the same for all models.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/name_table.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Counts of a turn [0.01 deg].
inline constexpr std::uint32_t kFullTurn = 36'000;
/// Way from one position of the turn on to another [0.01 deg], below kFullTurn; both are below two turns.
[[nodiscard]] constexpr std::uint32_t turn_between(std::uint32_t from, std::uint32_t to) {
  return (to + 2 * kFullTurn - from) % kFullTurn;
}

enum class DecodeStatus : std::uint8_t {
  kOk,          ///< decoded
  kNoPoints,    ///< a valid packet of the sensor without points: position, device information, IMU
  kTruncated,   ///< shorter than a data packet
  kOversized,   ///< longer than a data packet
  kGarbage,     ///< right size, but a field has an impossible value
  kWrongModel,  ///< of another model or another packet format than configured: see LidarDecoder::mismatch()
  kDuplicate,   ///< received before
  kTooLate,     ///< reordered too late for the open scan
};

/// Returns that are dropped: by range, and in the sector in which the sensor sees the robot itself.
struct LidarLimits {
  /// Nearer returns are dropped [m], 0 … 10: they come from the sensor's housing and mount. 0 keeps all.
  double min_range_m = 0.3;
  /// Farther returns are dropped [m].
  double max_range_m = 300.0;
  /// Masked sector [deg], 0 … 360: from start clockwise (seen from above) to end, across 0 if end < start.
  /// Equal values mask nothing.
  double mask_start_deg = 0.0;
  double mask_end_deg = 0.0;
};

/// What ScanAssembler needs to know of a data packet. A column is the smallest part that is never divided
/// between two scans: the returns of one position of the turn (a block of Velodyne, a column of Ouster), or,
/// without a turn, a packet.
struct PacketColumns {
  static constexpr int kMost = 64;

  std::int64_t device_ns = 0;               ///< the sensor's time of the first column, 0 … period_ns() - 1
  std::int64_t duration_ns = 0;             ///< regular time from the first column to the next packet's
  std::int64_t column_ns = 0;               ///< from the first to the last firing of a column
  std::uint64_t identity = 0;               ///< differs between any two packets of some seconds
  int count = 0;                            ///< columns, 1 … kMost
  std::array<std::uint32_t, kMost> turn{};  ///< by column: position in the turn [0.01 deg], below kFullTurn
  std::array<std::int64_t, kMost> offset_ns{};  ///< by column: first firing after device_ns

  [[nodiscard]] std::uint32_t first_turn() const { return turn[0]; }
  [[nodiscard]] std::uint32_t last_turn() const { return turn[static_cast<std::size_t>(count) - 1]; }
  [[nodiscard]] std::int64_t last_offset_ns() const { return offset_ns[static_cast<std::size_t>(count) - 1]; }
};

/// State of the sensor's clock, as its packets tell it.
enum class LidarSync : std::uint8_t {
  kUnknown,  ///< not told
  kFree,     ///< counts from the sensor's start
  kLocking,  ///< a source is there, not locked
  kLocked,   ///< follows GPS, PPS or PTP
  kFault,    ///< the sensor reports an error of its source
};

inline constexpr NameTable<LidarSync, 5> kLidarSyncTexts{{{
    {LidarSync::kUnknown, "not told"},
    {LidarSync::kFree, "free: it counts from the sensor's start"},
    {LidarSync::kLocking, "a time source is there, not locked"},
    {LidarSync::kLocked, "locked to its time source"},
    {LidarSync::kFault, "its time source is faulty"},
}}};

/// A lidar model: layout and checks of its packets, geometry, firing times. No I/O, no clock; no allocation
/// after construction. Points are in the sensor's frame: x at azimuth 0, y left, z up.
///
///     switch (decoder.read(payload, packet)) { case DecodeStatus::kOk: … }
///     points = decoder.decode(payload, packet, 0, packet.count, 0, out);
class LidarDecoder {
 public:
  LidarDecoder() = default;
  virtual ~LidarDecoder() = default;
  LidarDecoder(const LidarDecoder&) = delete;
  LidarDecoder& operator=(const LidarDecoder&) = delete;

  /// Parses and validates a UDP payload.
  /// @param packet filled with kOk
  virtual DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) = 0;

  /// Whether a payload has the format of a data packet of this model, by its size and its fixed fields. Tells
  /// lidars apart before they are read.
  [[nodiscard]] virtual bool is_data(std::span<const std::uint8_t> payload) const = 0;

  /// Decodes the columns first … end - 1 of a packet that read() has accepted.
  /// @param payload the same bytes
  /// @param packet as filled by read(); its offset_ns may have been moved since
  /// @param since_start_ns time of the packet's first column after the scan's start; all columns decoded must
  ///        fire 0 … 262 ms after that start
  /// @param out room for points_per_column() points a column, dropped returns included
  /// @return points written
  virtual std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                               int end, std::int64_t since_start_ns, ScanPoint* out) const = 0;

  /// Changes ranges and masked sector. Allocates nothing.
  virtual void set_limits(const LidarLimits& limits) = 0;

  /// Name of the model, as in configurations and recordings.
  [[nodiscard]] virtual std::string_view model() const = 0;
  /// Most points of a column.
  [[nodiscard]] virtual std::uint32_t points_per_column() const = 0;
  /// Longest data packet [bytes].
  [[nodiscard]] virtual std::size_t longest_packet() const = 0;
  /// Period after which the sensor's time wraps to 0 [ns]; 0: never.
  [[nodiscard]] virtual std::int64_t period_ns() const { return 0; }
  /// What the last refused packets were, and what was expected: "packets of HDL-32E (product id 0x21), but VLP-16
  /// is configured".
  [[nodiscard]] virtual std::string mismatch() const = 0;
  /// What good packets say against each other, a sentence with its remedy; static, nullptr: nothing.
  [[nodiscard]] virtual const char* contradiction() const { return nullptr; }
  /// State of the sensor's clock.
  [[nodiscard]] virtual LidarSync sync() const { return LidarSync::kUnknown; }
  /// Takes a sample of the sensor's own IMU out of the last packet that read() took; its stamp is the
  /// sensor's time.
  /// @return false: there is none
  virtual bool take_imu(ImuSample& /*sample*/) { return false; }
};

/// Little-endian integers at `at`.
inline std::uint32_t le16(const std::uint8_t* at) { return at[0] | static_cast<std::uint32_t>(at[1]) << 8U; }
inline std::uint32_t le32(const std::uint8_t* at) { return le16(at) | le16(at + 2) << 16U; }
inline std::uint64_t le64(const std::uint8_t* at) {
  return le32(at) | static_cast<std::uint64_t>(le32(at + 4)) << 32U;
}
/// Big-endian integers at `at`.
inline std::uint32_t be16(const std::uint8_t* at) { return static_cast<std::uint32_t>(at[0]) << 8U | at[1]; }
inline std::uint32_t be32(const std::uint8_t* at) { return be16(at) << 16U | be16(at + 2); }

/// The firing time of a point in units of kPointTimeUnitNs, rounded.
inline std::uint16_t point_time(std::int64_t since_start_ns) {
  return static_cast<std::uint16_t>((since_start_ns + kPointTimeUnitNs / 2) / kPointTimeUnitNs);
}

}  // namespace isobar
