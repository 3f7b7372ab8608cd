// SPDX-License-Identifier: BSD-3-Clause
// Payloads for recorders: the lidar's datagrams as they arrived, the description of the running isobard, and
// the orders to its black box and their answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace isobar::ipc {

/// UDP port of a lidar that a datagram came to.
enum class LidarPort : std::uint8_t {
  kData = 0,
  kInformation = 1,  ///< the second one: position, device information, IMU
};

/// One datagram of the lidar, unchanged; its bytes are in the group.
struct LidarPacket {
  std::int64_t stamp_ns;      ///< time of receipt, robot clock
  std::uint32_t sender_ipv4;  ///< address of the sender, host byte order
  std::uint32_t first_byte;   ///< in LidarPackets::bytes
  std::uint32_t byte_count;
  LidarPort port;
};

/// Consecutive datagrams of the lidar, of both ports in the order in which they were decoded. In groups, because one
/// message each would cost the lidar thread more and would fill a queue of 256 messages in 70 ms (a dual-return
/// HDL-32E sends 3600 packets per second). Their bytes lie end to end: packets are of 50 to 33'024 bytes, and slots
/// for the longest would hold nothing else.
struct LidarPackets {
  static constexpr std::uint32_t kMaxPackets = 64;
  /// Two of the longest packets (Ouster, 128 channels, dual return), and the longest datagram of UDP over IPv4.
  static constexpr std::uint32_t kMaxBytes = 2 * 33'024;

  /// Datagrams offered to this topic before the first of this group, since the start. The group before ended there,
  /// unless datagrams were lost: to a full queue, to the want of memory, or because they were too long.
  std::uint64_t first_number = 0;
  std::uint32_t count = 0;           ///< packets[0 … count-1] are valid
  std::uint32_t byte_count = 0;      ///< bytes[0 … byte_count-1] are valid
  LidarPacket packets[kMaxPackets];  // NOLINT(modernize-avoid-c-arrays): payload in shared memory
  std::uint8_t bytes[kMaxBytes];     // NOLINT(modernize-avoid-c-arrays)

  LidarPackets() {}  // NOLINT: user-provided, so that a loan does not zero 66 KiB

  [[nodiscard]] bool has_room(std::size_t payload_bytes) const noexcept {
    return count < kMaxPackets && payload_bytes <= kMaxBytes - byte_count;
  }
  /// Appends a datagram. Only where has_room() is true.
  void add(std::int64_t stamp_ns, std::uint32_t sender_ipv4, LidarPort port,
           std::span<const std::uint8_t> payload) noexcept {
    const auto size = static_cast<std::uint32_t>(payload.size());
    packets[count++] = {stamp_ns, sender_ipv4, byte_count, size, port};
    if (size > 0) std::memcpy(bytes + byte_count, payload.data(), size);
    byte_count += size;
  }
  /// Packets that may be read.
  [[nodiscard]] std::span<const LidarPacket> valid_packets() const noexcept {
    return {packets, count < kMaxPackets ? count : kMaxPackets};
  }
  /// Bytes of one of these packets; empty where its fields are out of range.
  [[nodiscard]] std::span<const std::uint8_t> payload(const LidarPacket& packet) const noexcept {
    const bool is_inside =
        packet.first_byte <= kMaxBytes && packet.byte_count <= kMaxBytes - packet.first_byte;
    return is_inside ? std::span<const std::uint8_t>(bytes + packet.first_byte, packet.byte_count)
                     : std::span<const std::uint8_t>{};
  }
};

/// The running isobard, for recorders, and for isobar-dds, which follows its settings. Published at the start
/// and after each change.
struct RunDescription {
  static constexpr std::size_t kMaxBytes = 60'000;
  static constexpr std::size_t kNameBytes = 512;

  std::int64_t robot_clock_offset_ns = 0;  ///< robot clock minus CLOCK_MONOTONIC
  std::uint32_t manifest_bytes = 0;        ///< recording.toml of a recording made now
  std::uint32_t settings_bytes = 0;        ///< all settings in force, TOML; 0: they do not fit
  /// Main file of the configuration; empty: isobard runs with defaults.
  char configuration[kNameBytes];  // NOLINT(modernize-avoid-c-arrays): null-terminated
  char text[kMaxBytes];            // NOLINT(modernize-avoid-c-arrays): first manifest, then settings

  RunDescription() {}  // NOLINT: user-provided, so that a loan does not zero 60 kB

  [[nodiscard]] std::string_view manifest() const noexcept { return {text, manifest_bytes}; }
  [[nodiscard]] std::string_view settings() const noexcept { return {text + manifest_bytes, settings_bytes}; }
};

/// Order to write the black box to the disk.
struct BlackBoxOrder {
  static constexpr std::size_t kReasonBytes = 48;
  std::uint64_t number = 0;        ///< chosen by the sender, repeated in the answer
  char reason[kReasonBytes] = {};  // NOLINT(modernize-avoid-c-arrays): part of the folder's name
};

/// State of the black box, published once a second and after each save.
struct BlackBoxState {
  std::int64_t held_ns = 0;  ///< time span of the held samples
  std::uint64_t held_bytes = 0;
  std::uint64_t limit_bytes = 0;  ///< most memory that it uses
  std::uint64_t dropped = 0;      ///< samples and packets lost to full queues or for want of memory
  std::uint64_t saved = 0;        ///< recordings written since the start
  std::uint64_t failed = 0;       ///< recordings that could not be written
  std::uint64_t answered = 0;     ///< BlackBoxOrder::number of the newest finished order; 0: none
  bool last_failed = false;
  char last[280] = {};  // NOLINT(modernize-avoid-c-arrays): newest folder, or why there is none
};

/// Copies a text into a field, cut to fit and null-terminated.
template <std::size_t Capacity>
void copy_to_field(std::string_view from,
                   char (&to)[Capacity]) noexcept {  // NOLINT(modernize-avoid-c-arrays)
  const std::size_t length = from.size() < Capacity - 1 ? from.size() : Capacity - 1;
  std::memcpy(to, from.data(), length);
  std::memset(to + length, 0, Capacity - length);
}

}  // namespace isobar::ipc
