// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/time/stamp_guard.hpp"
#include "run/recording/capture_file.hpp"
#include "run/recording/tally.hpp"
#include "run/recording/udp_extractor.hpp"

namespace isobar::recording {

struct StampedPacket {
  std::int64_t stamp_ns = 0;
  std::uint32_t sender_ipv4 = 0;  ///< host byte order
  std::uint16_t port = 0;         ///< UDP destination
  std::vector<std::uint8_t> payload;
};

/// Reader of the lidar's UDP payloads in a pcap or pcapng file, compressed with gzip or not: both byte orders, every
/// resolution of time, interfaces of different link types.
/// A packet with an absurd stamp is kept with the last good stamp: its data carry the sensor's own time.
class PcapPackets {
 public:
  struct Tallies {
    Tally other_port;  ///< which ports, tells ports_text()
    Tally other_link;  ///< of an interface of another link type, in pcapng
    Tally other_protocol;
    Tally malformed;
    Tally cut;  ///< the capture holds only the beginning of the packet
    Tally absurd_stamp;
    Tally file_truncated;  ///< 1 when the file ends within a packet or is damaged; the reason in its message
  };

  /// @throws DataError when the file is missing, no capture, or of a link type without IPv4
  PcapPackets(const std::filesystem::path& file, const LidarPorts& ports, const StampGuardConfig& guard);

  /// The next payload; false at the end. Reuses the memory of `packet`.
  bool next(StampedPacket& packet);

  [[nodiscard]] const Tallies& tallies() const { return tallies_; }
  [[nodiscard]] const StampGuard& guard() const { return guard_; }
  [[nodiscard]] const UdpExtractor& extractor() const { return extractor_; }
  [[nodiscard]] std::uint64_t bytes_read() const { return file_->bytes_read(); }
  /// Packets for ports that were not wanted: "FILE: 75 packets for port 2370, the recording says 2368"; empty
  /// without one.
  /// @param who says the wanted port: "the recording"
  [[nodiscard]] std::string ports_text(const std::string& who) const;

 private:
  bool read(StampedPacket& packet);
  bool take(const CaptureFrame& frame, StampedPacket& packet);
  void refuse_link() const;
  [[nodiscard]] std::string place() const;

  std::string name_;
  std::unique_ptr<CaptureFile> file_;
  std::uint64_t frames_ = 0;
  bool ended_ = false;
  UdpExtractor extractor_;
  StampGuard guard_;
  Tallies tallies_;
  std::optional<StampedPacket> held_;       // its stamp jumped; the next verdict of guard_ decides
  std::optional<StampedPacket> following_;  // already read, returned by the next call of next()
};

}  // namespace isobar::recording
