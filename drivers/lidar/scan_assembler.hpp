// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "core/time/clock_anchor.hpp"
#include "core/time/clock_continuity.hpp"
#include "drivers/lidar/blind_sector.hpp"
#include "drivers/lidar/lidar_counters.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/lidar_time.hpp"

namespace isobar {

struct DecodeResult {
  DecodeStatus status = DecodeStatus::kOk;
  /// The scan passed to add_packet() is complete: publish it and pass another one to the next call.
  bool scan_complete = false;
};

/// Assembles the packets of any lidar model into scans of one turn. No I/O, no clock, no allocation after
/// construction.
///
/// The caller owns the scans and passes the one being filled to every call; the assembler resets it at the
/// start of a turn. Columns after the end of a turn are kept until the next call, which passes the next scan:
///
///     Scan* scan = loan();
///     for (each packet) {
///       if (assembler.add_packet(payload, stamp_ns, *scan).scan_complete) { publish(scan); scan = loan(); }
///     }
///     if (assembler.flush(*scan)) { publish(scan); }
///
/// Point times within a scan come from the sensor's clock; ClockAnchor ties Scan::stamp_ns to the host's, with
/// LidarTime::kSensor the seconds that both count. A
/// scan ends where the azimuth passes 0, with a reduced field of view at the end of the field, after a gap of
/// about a turn, at a step of the sensor's clock, and when it is full. No point is lost.
class ScanAssembler {
 public:
  explicit ScanAssembler(std::unique_ptr<LidarDecoder> decoder, LidarTime time = LidarTime::kReceive);

  /// Decodes a packet.
  /// @param payload UDP payload
  /// @param host_stamp_ns receive time, robot clock
  /// @param current scan being filled
  DecodeResult add_packet(std::span<const std::uint8_t> payload, std::int64_t host_stamp_ns, Scan& current);

  /// Changes ranges and masked sector. Allocates nothing.
  void set_limits(const LidarLimits& limits) { decoder_->set_limits(limits); }

  /// Ends the open turn; true when `current` holds a scan.
  bool flush(Scan& current);

  /// Takes a sample of the sensor's own IMU out of the last packet, its stamp on the robot clock.
  /// @return false: there is none
  bool take_imu(ImuSample& sample);

  /// Time of the first column of the last good packet, robot clock.
  [[nodiscard]] std::int64_t packet_stamp_ns() const {
    return anchor_.to_host_ns(anchor_.device_unwrapped_ns());
  }
  /// See ClockAnchor::device_ahead_ns().
  [[nodiscard]] std::int64_t clock_ahead_ns() const { return anchor_.device_ahead_ns(); }

  [[nodiscard]] const LidarCounters& counters() const { return counters_; }
  [[nodiscard]] const LidarDecoder& decoder() const { return *decoder_; }
  /// Host stamp of the packet that showed the last jump of the sensor's clock (ClockContinuity); 0: none yet.
  [[nodiscard]] std::int64_t clock_jumped_ns() const { return clock_jumped_ns_; }
  /// Whether the last scan was stamped by the sensor's clock.
  [[nodiscard]] bool sensor_stamps() const { return sensor_stamps_; }

 private:
  struct Packet {
    PacketColumns columns;
    std::int64_t device_ns = 0;  // unwrapped time of the first column
    std::int64_t delay_ns = 0;   // of the last column, by gaps within the packet
    std::span<const std::uint8_t> payload;
  };

  bool seen(const PacketColumns& columns);
  DecodeResult add_in_order(Packet& packet, bool stepped, std::int64_t offset_before_ns, Scan& current);
  DecodeResult add_reordered(const Packet& packet, Scan& current);
  [[nodiscard]] std::int64_t delay_after_gaps(PacketColumns& columns) const;
  /// From the packet before to this one, without the gaps within that packet [ns].
  [[nodiscard]] std::int64_t since_last_ns(const Packet& packet) const {
    return packet.device_ns - last_device_ns_;
  }
  std::uint32_t learn_sector(const Packet& packet, std::uint32_t lost);
  [[nodiscard]] std::uint32_t lost_before(const Packet& packet) const;
  [[nodiscard]] int first_column_of_next_scan(const Packet& packet, bool stepped, const Scan& current) const;
  [[nodiscard]] bool is_next_turn(std::uint32_t previous, std::uint32_t turn) const;
  [[nodiscard]] bool begins_field(const PacketColumns& columns) const;
  [[nodiscard]] bool ends_field(const PacketColumns& columns) const;
  [[nodiscard]] bool is_too_long_with(const Packet& packet) const;
  [[nodiscard]] bool is_full(const Scan& current, int columns) const;
  void remember(const Packet& packet);
  void open(std::int64_t device_ns, Scan& current);
  void append(const Packet& packet, int first, int end, Scan& current);
  void wait_for_next_scan(const Packet& packet, int first, std::uint32_t lost);
  void take_pending(Scan& current);
  void complete(std::int64_t offset_ns, Scan& current);
  [[nodiscard]] std::optional<std::int64_t> sensor_offset_ns(std::int64_t measured_ns) const;

  std::unique_ptr<LidarDecoder> decoder_;
  LidarTime time_;
  bool sensor_stamps_ = false;
  ClockAnchor anchor_;
  ClockContinuity continuity_;
  LidarCounters counters_;
  std::int64_t clock_jumped_ns_ = 0;
  std::array<std::uint64_t, 32> recent_{};  // identities of the newest packets
  std::size_t recent_count_ = 0;

  bool have_last_ = false;
  std::int64_t last_device_ns_ = 0;   // first column of the newest packet, delayed by the gaps within it
  std::int64_t shortest_gap_ns_ = 0;  // between consecutive packets, since construction
  std::uint32_t last_turn_ = 0;       // last column of the newest packet [0.01 deg]
  double turn_rate_ = 0.0;            // [0.01 deg / ns]
  BlindSector blind_;

  bool scan_open_ = false;
  bool field_ended_ = false;        // the open scan began with the rest of a field whose scan is complete
  std::int64_t scan_start_ns_ = 0;  // device time, unwrapped
  std::int64_t scan_end_ns_ = 0;
  std::uint32_t sequence_ = 0;

  // Columns after the end of a scan: they belong to the next one, which the caller has not passed yet.
  bool pending_ = false;
  Packet pending_packet_;
  std::vector<std::uint8_t> pending_bytes_;
  int pending_column_ = 0;
  std::uint32_t pending_lost_ = 0;
};

}  // namespace isobar
