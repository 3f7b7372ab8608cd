// SPDX-License-Identifier: BSD-3-Clause
// Admission of sample datagrams: from bytes to samples on the robot clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time/base_station_stream.hpp"
#include "core/time/clock_anchor.hpp"
#include "core/time/stream_beginnings.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/udp/sender_lock.hpp"

namespace isobar {

/// Status of the admission: plain values, trivially copyable.
struct SampleInputStatus {
  datagram::Counters counters;
  std::uint64_t clock_steps = 0;  ///< times that a sender's clock was set, other than with the system clock
  /// Samples whose source is not `datagram`, by Kind.
  std::array<std::uint64_t, datagram::kKinds> refused{};
  std::uint64_t not_of_this_role = 0;  ///< IMU, wheel and base samples received by a base station
  std::uint64_t unsigned_base = 0;     ///< base samples while dds.keys_directory is set
  std::uint64_t not_allowed = 0;       ///< datagrams of senders that input.senders does not name
  std::uint32_t not_allowed_ipv4 = 0;  ///< the newest of these senders
  std::int64_t imu_began_ns = 0;       ///< last time that the IMU's stream began anew, robot clock; 0: never
  std::array<SenderStatus, datagram::kKinds> senders;  ///< by Kind; base stations: see `base`
  BaseStationStatus base;                              ///< of the base station that sends datagrams
};

/// Addresses of the text of input.senders, "192.168.1.50, 192.168.1.51".
[[nodiscard]] std::vector<std::uint32_t> addresses_of(const std::string& senders);

/// Takes datagrams of IMU, barometer, base station and wheels: one sender a stream, plausible lines in
/// sequence, stamps on the robot clock. No allocation after construction; one thread.
///
///     input.begin(datagram, system_clock);
///     while (input.next(sample)) { … }
class SampleInput {
 public:
  /// Kinds of samples that are used, those with the source `datagram`; others are refused and counted.
  struct Takes {
    bool imu = true;
    bool barometer = true;
    bool wheel = true;
    bool base_station_only = false;  ///< this machine is a base station: its own barometer, nothing else
    /// Base-station pressure, which in a datagram is not signed; false where dds.keys_directory is set.
    bool unsigned_base = true;
  };
  SampleInput(Takes takes, std::vector<std::uint32_t> allowed);

  /// @param system as of the datagram's receipt; read until the last next()
  void begin(const ReceivedDatagram& received, const SystemClockWatch& system) noexcept;
  /// The next admitted sample, its stamp on the robot clock; false at the end of the datagram.
  bool next(datagram::Sample& sample) noexcept;

  [[nodiscard]] SampleInputStatus status() const noexcept;

 private:
  /// A stream of samples other than a base station's, stamped with the clock of its sender.
  struct Stream {
    SenderLock sender;
    SenderClock clock;
    ClockAnchor anchor;
    bool anchored = false;
  };

  [[nodiscard]] datagram::Admission admission(const datagram::Sample& sample,
                                              datagram::LineStatus status) noexcept;
  [[nodiscard]] datagram::Admission base_admission() noexcept;
  [[nodiscard]] bool to_robot_clock(datagram::Sample& sample) noexcept;
  void to_robot_clock(Stream& stream, datagram::Sample& sample) noexcept;

  Takes takes_;
  std::vector<std::uint32_t> allowed_;
  datagram::DatagramParser parser_;
  std::array<Stream, datagram::kKinds> streams_;
  StreamBeginnings imu_beginnings_;
  BaseStationStream base_;
  std::uint64_t base_sender_ = 0;  ///< whose sequence numbers are followed
  SampleInputStatus status_;       ///< the counters of this class
  SenderAddress from_;
  std::int64_t receive_ns_ = 0;
  const SystemClockWatch* system_ = nullptr;
};

}  // namespace isobar
