// SPDX-License-Identifier: BSD-3-Clause
// Table of the topics in shared memory: name, payload type, queue depth, history. A full queue drops its
// oldest message and the subscriber counts the loss: a dead subscriber never blocks a publisher.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/estimates.hpp"
#include "core/samples.hpp"
#include "ipc/floors.hpp"
#include "ipc/inputs.hpp"
#include "ipc/pose_hint.hpp"
#include "ipc/status.hpp"

namespace isobar::ipc {

/// A piece of the local map. All pieces together, one after the other, are every point of it. About 1 MiB.
struct MapCloud {
  static constexpr std::uint32_t kMaxPoints = 65'536;

  std::int64_t stamp_ns = 0;       ///< stamp of the newest scan in the map, robot clock
  std::uint32_t sequence = 0;      ///< number of maps published before this one; equal in all its pieces
  std::uint32_t session = 1;       ///< number of the map frame, as in PoseEstimate
  std::uint32_t first_point = 0;   ///< points of the map in the pieces before this one
  std::uint32_t total_points = 0;  ///< of the map
  std::uint32_t point_count = 0;   ///< points[0 … point_count-1] are valid
  ScanPoint points[kMaxPoints];    // NOLINT(modernize-avoid-c-arrays): p_map; time and ring are 0

  MapCloud() {}  // NOLINT: user-provided, so that a loan does not zero 1 MiB
};

/// Level of a health entry, with the values of diagnostic_msgs/DiagnosticStatus.
enum class HealthLevel : std::uint8_t { kOk = 0, kWarning = 1, kError = 2, kStale = 3 };

/// Name of a level in texts for people and programs.
[[nodiscard]] constexpr const char* level_name(HealthLevel level) noexcept {
  return level == HealthLevel::kOk        ? "ok"
         : level == HealthLevel::kWarning ? "warning"
         : level == HealthLevel::kError   ? "error"
                                          : "stale";
}

/// Order of the levels, worst last: a fault that is known, data that does not come, a limit that is exceeded.
[[nodiscard]] constexpr int severity(HealthLevel level) noexcept {
  return level == HealthLevel::kOk        ? 0
         : level == HealthLevel::kWarning ? 1
         : level == HealthLevel::kStale   ? 2
                                          : 3;
}

/// One entry of the health report. The texts are null-terminated.
struct HealthEntry {
  static constexpr std::size_t kNameBytes = 40;
  static constexpr std::size_t kMessageBytes = 120;

  char name[kNameBytes];        // NOLINT(modernize-avoid-c-arrays): subject, such as "lidar/packets_lost"
  char message[kMessageBytes];  // NOLINT(modernize-avoid-c-arrays): one sentence; may be empty
  double value;                 ///< in the unit given by the name or the message
  HealthLevel level;
};

/// The health of isobard, published once a second.
struct HealthReport {
  /// Name of the first entry, which sums up all others.
  static constexpr std::string_view kSummaryName = "summary";
  /// Twice the entries of a robot with every sensor and every fault: a report that is full says less.
  static constexpr std::uint32_t kMaxEntries = 192;
  /// Name of the entry that counts the dropped entries; the last place is reserved for it.
  static constexpr std::string_view kDroppedName = "health/dropped";

  std::int64_t stamp_ns = 0;  ///< robot clock
  /// Robot clock minus CLOCK_MONOTONIC, constant while isobard runs. CLOCK_MONOTONIC is common to all
  /// processes of the machine, so a reader gets the current robot time by adding this offset to its own
  /// reading.
  std::int64_t robot_clock_offset_ns = 0;
  /// System clock (CLOCK_REALTIME) minus robot clock at this report: 0 until somebody sets the system clock.
  /// Added to a stamp it gives the time of day.
  std::int64_t system_clock_ahead_ns = 0;
  ServiceStatus status;
  std::uint32_t entry_count = 0;     ///< entries[0 … entry_count-1] are valid
  HealthEntry entries[kMaxEntries];  // NOLINT(modernize-avoid-c-arrays): payload in shared memory

  HealthReport() {}  // NOLINT: user-provided, so that a loan does not zero the entries

  /// Appends an entry; texts longer than their field are truncated.
  /// @return false when the report is full: the entry is dropped, and the last entry, a warning named
  ///         kDroppedName, counts the dropped entries
  [[nodiscard]] bool add(std::string_view name, HealthLevel level, std::string_view message,
                         double value) noexcept {
    constexpr std::uint32_t kLast = kMaxEntries - 1;
    if (entry_count < kLast) {
      write(entries[entry_count++], name, level, message, value);
      return true;
    }
    const double dropped = entry_count == kMaxEntries ? entries[kLast].value + 1.0 : 1.0;
    write(entries[kLast], kDroppedName, HealthLevel::kWarning, "entries dropped: this report is full",
          dropped);
    entry_count = kMaxEntries;
    return false;
  }

 private:
  static void write(HealthEntry& entry, std::string_view name, HealthLevel level, std::string_view message,
                    double value) noexcept {
    copy_text(name, entry.name, HealthEntry::kNameBytes);
    copy_text(message, entry.message, HealthEntry::kMessageBytes);
    entry.value = value;
    entry.level = level;
  }
};

/// What a person can ask of a running isobard.
enum class Command : std::uint8_t {
  kNewFrame = 1,  ///< begin a new map frame with an empty map; the old map and trajectory are kept
};

/// A command, published by the `isobar` program.
struct CommandMessage {
  Command command = Command::kNewFrame;
};

/// A topic: one row of the table below. Published by isobard, topics of samples also by isobar-dds. Any
/// number of subscribers.
template <class Payload>
struct Topic {
  static_assert(std::is_trivially_destructible_v<Payload>);
  const char* name;       ///< at most 100 characters
  std::uint32_t depth;    ///< length of a subscriber's queue [messages], 1 … 256
  std::uint32_t history;  ///< messages kept for late subscribers, 0 … 16
};

namespace topics {

inline constexpr Topic<Scan> kLidarScan{"lidar/scan", 4, 0};
inline constexpr Topic<ImuSample> kImu{"imu", 256, 0};
inline constexpr Topic<PressureSample> kBarometer{"barometer", 256, 0};
inline constexpr Topic<PressureSample> kBaseBarometer{"base_barometer", 256, 0};
inline constexpr Topic<WheelSample> kWheel{"wheel", 256, 0};
inline constexpr Topic<Prior> kPrior{"prior", 256, 0};
inline constexpr Topic<PoseEstimate> kPose{"pose", 64, 0};
inline constexpr Topic<RegisteredScan> kRegisteredScan{"registered_scan", 4, 0};
inline constexpr Topic<MapCloud> kMapCloud{"map_cloud", 4, 1};
inline constexpr Topic<FloorGrid> kFloorGrid{"floor_grid", 4, 1};
inline constexpr Topic<CurrentFloor> kFloor{"floor", 4, 1};
inline constexpr Topic<KnownFloors> kKnownFloors{"known_floors", 1, 1};
inline constexpr Topic<HealthReport> kHealth{"health", 4, 1};
inline constexpr Topic<LidarPackets> kLidarPackets{"lidar/packets", 80, 0};
inline constexpr Topic<RunDescription> kRunDescription{"run_description", 1, 1};
inline constexpr Topic<BlackBoxOrder> kBlackBoxOrder{"black_box/order", 4, 0};
inline constexpr Topic<BlackBoxState> kBlackBoxState{"black_box/state", 1, 1};
inline constexpr Topic<CommandMessage> kCommand{"command", 4, 0};
inline constexpr Topic<PoseHint> kPoseHint{"pose_hint", 4, 0};

}  // namespace topics

/// Pool of equal chunks in shared memory. A message takes a chunk of the smallest size that fits.
struct ChunkPool {
  std::uint32_t chunk_bytes;
  std::uint32_t chunk_count;
};

/// Sized for three subscribers per topic with full queues, including the messages they hold.
inline constexpr ChunkPool kChunkPools[] = {
    // NOLINT(modernize-avoid-c-arrays)
    {256, 4096},        // samples
    {1024, 1024},       // priors, poses
    {40 * 1024, 38},    // health, floors
    {60 * 1024, 4},     // description of the run
    {68 * 1024, 100},   // lidar packets: all queues hold the same newest 80 messages
    {1200 * 1024, 40},  // scans, registered scans, maps, grids
};

}  // namespace isobar::ipc
