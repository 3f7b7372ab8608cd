// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/recording/cloud_file.hpp"
#include "run/recording/manifest.hpp"
#include "run/recording/ports_seen.hpp"

namespace isobar::recording {

enum class EventKind : std::uint8_t { kLidarPacket, kImu, kPressure, kBasePressure, kWheel, kCloud };

/// One sample or packet. Only the member named by `kind` is valid.
struct Event {
  EventKind kind = EventKind::kImu;
  std::int64_t stamp_ns = 0;             ///< host time, robot clock; equals the sample's own stamp
  std::span<const std::uint8_t> packet;  ///< UDP payload, valid until the next call of next()
  std::uint32_t sender_ipv4 = 0;         ///< of a packet, host byte order
  std::uint16_t port = 0;                ///< of a packet: UDP destination, LidarEntry::port or info_port
  ImuSample imu;
  PressureSample pressure;  ///< of kPressure and kBasePressure, both on the robot clock
  WheelSample wheel;
  const CloudRecord* cloud = nullptr;  ///< of kCloud; valid until the next call of next()
};

/// Counter of the reader, for the status.
struct Count {
  std::string name;  ///< e.g. "imu: implausible rows"
  std::uint64_t count = 0;
  std::string first_message;  ///< "file:line: rule (value)" of the first one
};

/// Offset of the base station's clock.
struct BaseClock {
  std::int64_t offset_ns = 0;  ///< robot time = base-station time + offset
  std::string reason;          ///< a sentence for the status
};

/// The lidar's own clock in its packets, by which a step of the clock that stamped a recording is told from a pause.
struct LidarClock {
  std::int64_t period_ns = 0;  ///< after which it wraps; 0: never
  /// Time from one payload to a later one on that clock, 0 … period_ns; nothing where they do not tell it.
  std::function<std::optional<std::int64_t>(std::span<const std::uint8_t>, std::span<const std::uint8_t>)>
      elapsed_ns;
};

struct ReaderOptions {
  /// Largest step forward of a sensor's clock without confirmation by a second sample [ns].
  std::int64_t max_gap_ns = 2'000'000'000;
  /// Largest step backward of a sample that came late; a longer one, confirmed, is a step of the clock [ns].
  std::int64_t max_reorder_ns = 200'000'000;
};

/// Reader of a recording folder: events in order of host time, bounded memory, deterministic.
class RecordingReader {
 public:
  /// Opens all files of the manifest.
  /// @throws DataError when the folder, recording.toml, a file or a column is missing, or a file has the
  ///           wrong format
  explicit RecordingReader(const std::filesystem::path& folder, const ReaderOptions& options = {});
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  /// Before the first next(): tells steps of the clock from pauses (time_base.hpp).
  void use_lidar_clock(LidarClock clock);

  /// The next event in order of time; false at the end. Broken rows and packets are skipped and counted. Where the clock of
  /// the recording was set, time goes on without the step, on the clock before it.
  bool next(Event& event);

  [[nodiscard]] const Manifest& manifest() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;  ///< of the manifest
  [[nodiscard]] const BaseClock& base_clock() const;
  /// Counters that are not zero. Cheap enough for once a second.
  [[nodiscard]] std::vector<Count> counts() const;
  /// Packets of the lidar's capture for ports that the recording does not name.
  [[nodiscard]] const PortsSeen& other_ports() const;
  /// Fraction of the bytes read, 0 … 1, for a progress bar.
  [[nodiscard]] double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::recording
