// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/samples.hpp"
#include "core/time/clock_anchor.hpp"
#include "core/time/clock_continuity.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/packet_format.hpp"
#include "drivers/velodyne/return_decoder.hpp"

namespace isobar::velodyne {

struct DecodeResult {
  DecodeStatus status = DecodeStatus::kOk;
  /// The scan passed to add_packet() is complete: publish it and pass another one to the next call.
  bool scan_complete = false;
};

/// Counters since construction; one writer.
struct VelodyneCounters {
  std::uint64_t packets = 0;  ///< data packets decoded
  std::uint64_t position = 0;
  std::uint64_t truncated = 0;
  std::uint64_t oversized = 0;
  std::uint64_t garbage = 0;
  std::uint64_t wrong_model = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;    ///< decoded into the open scan
  std::uint64_t too_late = 0;     ///< reordered too late for the open scan, not decoded
  std::uint64_t lost = 0;         ///< missing packets, from gaps in the sensor's time
  std::uint64_t clock_steps = 0;  ///< steps of the sensor's or the host's clock
  std::uint64_t returns = 0;      ///< points written
  std::uint64_t scans = 0;        ///< scans completed
};

/// Decoder of Velodyne data packets into scans of one revolution. No I/O, no clock, no allocation after
/// construction.
///
/// The caller owns the scans and passes the one being filled to every call; the decoder resets it at the
/// start of a revolution. Blocks after the end of a revolution are kept until the next call, which passes the
/// next scan:
///
///     Scan* scan = loan();
///     for (each packet) {
///       if (decoder.add_packet(payload, stamp_ns, *scan).scan_complete) { publish(scan); scan = loan(); }
///     }
///     if (decoder.flush(*scan)) { publish(scan); }
///
/// Points are in the sensor's frame (x at azimuth 0, y left, z up). Point times within a
/// scan come from the sensor's clock; ClockAnchor ties Scan::stamp_ns to the host's clock. A scan ends where
/// the azimuth passes 0, after a gap of about a turn, at a step of the sensor's clock, and when it is full.
/// No point is lost.
class VelodyneDecoder {
 public:
  explicit VelodyneDecoder(const VelodyneConfig& config);

  /// Decodes a packet.
  /// @param payload UDP payload
  /// @param host_stamp_ns receive time, robot clock
  /// @param current scan being filled
  DecodeResult add_packet(std::span<const std::uint8_t> payload, std::int64_t host_stamp_ns, Scan& current);

  /// Changes the range and the masked sector, not the model. Allocates nothing.
  void set_limits(const VelodyneConfig& config) { returns_.set_limits(config); }

  /// Ends the open revolution; true when `current` holds a scan.
  bool flush(Scan& current);

  [[nodiscard]] const VelodyneCounters& counters() const { return counters_; }
  /// Host stamp of the packet that showed the last jump of the sensor's clock (ClockContinuity); 0: none yet.
  [[nodiscard]] std::int64_t clock_jumped_ns() const { return clock_jumped_ns_; }
  /// Status text of a model mismatch: "packets of HDL-32E (product id 0x21), but VLP-16 is configured".
  [[nodiscard]] std::string wrong_model_message() const;

 private:
  struct Identity {
    std::uint32_t timestamp_us = 0;
    std::uint32_t azimuth = 0;
    bool used = false;
  };

  void count(DecodeStatus status, const DataPacket& packet);
  bool seen(const DataPacket& packet);
  DecodeResult add_in_order(const DataPacket& packet, bool stepped, std::int64_t offset_before_ns,
                            Scan& current);
  DecodeResult add_reordered(const DataPacket& packet, Scan& current);
  [[nodiscard]] std::uint32_t lost_before(const DataPacket& packet) const;
  [[nodiscard]] int first_block_of_next_scan(const DataPacket& packet, bool stepped,
                                             const Scan& current) const;
  void remember(const DataPacket& packet);
  void open(std::int64_t device_ns, Scan& current);
  void append(const DataPacket& packet, int first_block, int end_block, Scan& current);
  void wait_for_next_scan(const DataPacket& packet, int first_block, std::uint32_t lost);
  void take_pending(Scan& current);
  void complete(std::int64_t offset_ns, Scan& current);

  Model model_;
  const ModelTraits& traits_;
  ReturnDecoder returns_;

  ClockAnchor anchor_;
  VelodyneCounters counters_;
  ClockContinuity continuity_{kClockPeriodNs};
  std::int64_t clock_jumped_ns_ = 0;
  std::uint8_t wrong_product_id_ = 0;
  std::array<Identity, 32> recent_{};
  std::size_t recent_next_ = 0;

  bool have_last_ = false;
  std::int64_t last_device_ns_ = 0;   // first firing of the newest packet
  std::int64_t shortest_gap_ns_ = 0;  // between consecutive packets, since construction
  std::uint32_t last_azimuth_ = 0;    // last block of the newest packet [0.01 deg]
  double azimuth_rate_ = 0.0;         // [0.01 deg / ns]

  bool scan_open_ = false;
  std::int64_t scan_start_ns_ = 0;  // device time, unwrapped
  std::int64_t scan_end_ns_ = 0;
  std::uint32_t sequence_ = 0;

  // Blocks after the end of a scan: they belong to the next one, which the caller has not passed yet.
  bool pending_ = false;
  DataPacket pending_packet_;
  std::array<std::uint8_t, kDataPacketBytes> pending_bytes_{};
  int pending_block_ = 0;
  std::uint32_t pending_lost_ = 0;
};

}  // namespace isobar::velodyne
