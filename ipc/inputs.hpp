// SPDX-License-Identifier: BSD-3-Clause
// Payloads for recorders: the lidar's datagrams as they arrived, the description of the running isobard, and
// the orders to its black box and their answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace isobar::ipc {

/// One datagram of the lidar, unchanged.
struct LidarPacket {
  static constexpr std::size_t kMaxBytes = 1'500;

  std::int64_t stamp_ns;          ///< time of receipt, robot clock
  std::uint32_t sender_ipv4;      ///< address of the sender, host byte order
  std::uint32_t byte_count;       ///< bytes[0 … byte_count-1] are valid
  std::uint8_t bytes[kMaxBytes];  // NOLINT(modernize-avoid-c-arrays): payload in shared memory
};

/// Consecutive datagrams of the lidar. In groups, because one message each would cost the lidar thread more
/// and would fill a queue of 256 messages in 70 ms (a dual-return HDL-32E sends 3600 packets per second).
struct LidarPackets {
  static constexpr std::uint32_t kMaxPackets = 12;

  std::uint64_t lost = 0;            ///< datagrams not published since the start: no free memory, or too long
  std::uint32_t count = 0;           ///< packets[0 … count-1] are valid
  LidarPacket packets[kMaxPackets];  // NOLINT(modernize-avoid-c-arrays)

  LidarPackets() {}  // NOLINT: user-provided, so that a loan does not zero 18 KiB
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
