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
#include "run/recording/tally.hpp"
#include "run/recording/udp_extractor.hpp"

struct pcap;

namespace isobar::recording {

struct StampedPacket {
  std::int64_t stamp_ns = 0;
  std::uint32_t sender_ipv4 = 0;  ///< host byte order
  std::vector<std::uint8_t> payload;
};

/// Reader of the lidar's UDP payloads in a pcap file: both byte orders, micro- and nanoseconds, also pcapng.
/// A packet with an absurd stamp is kept with the last good stamp: its data carry the sensor's own time.
class PcapPackets {
 public:
  struct Tallies {
    Tally other_port;
    Tally other_protocol;
    Tally malformed;
    Tally cut;  ///< the capture holds only the beginning of the packet
    Tally absurd_stamp;
    Tally file_truncated;  ///< 1 when the file ends within a packet
  };

  /// @throws DataError when the file is missing, not a pcap, or of a link type without IP
  PcapPackets(const std::filesystem::path& file, const LidarPorts& ports, const StampGuardConfig& guard);
  ~PcapPackets();
  PcapPackets(const PcapPackets&) = delete;
  PcapPackets& operator=(const PcapPackets&) = delete;

  /// The next payload; false at the end. Reuses the memory of `packet`.
  bool next(StampedPacket& packet);

  [[nodiscard]] const Tallies& tallies() const { return tallies_; }
  [[nodiscard]] const StampGuard& guard() const { return guard_; }
  [[nodiscard]] const UdpExtractor& extractor() const { return extractor_; }
  [[nodiscard]] std::uint64_t bytes_read() const;

 private:
  bool read(StampedPacket& packet);
  [[nodiscard]] std::string place() const;

  std::string name_;
  std::vector<char> buffer_;  // file buffer of handle_
  pcap* handle_ = nullptr;
  LinkType link_ = LinkType::kEthernet;
  std::uint64_t frames_ = 0;
  bool ended_ = false;
  UdpExtractor extractor_;
  StampGuard guard_;
  Tallies tallies_;
  std::optional<StampedPacket> held_;       // its stamp jumped; the next verdict of guard_ decides
  std::optional<StampedPacket> following_;  // already read, returned by the next call of next()
};

}  // namespace isobar::recording
