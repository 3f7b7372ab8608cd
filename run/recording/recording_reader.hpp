// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/recording/manifest.hpp"

namespace isobar::recording {

enum class EventKind : std::uint8_t { kLidarPacket, kImu, kPressure, kBasePressure, kWheel };

/// One thing that the robot sensed. Only the member that `kind` names is valid.
struct Event {
  EventKind kind = EventKind::kImu;
  std::int64_t stamp_ns = 0;             ///< host time, robot clock; equals the sample's own stamp
  std::span<const std::uint8_t> packet;  ///< UDP payload, valid until the next call of next()
  ImuSample imu;
  PressureSample pressure;  ///< kPressure and kBasePressure; the latter mapped to the robot clock
  WheelSample wheel;
};

/// Something that was met while reading, for the status.
struct Count {
  std::string name;  ///< e.g. "imu: implausible rows"
  std::uint64_t count = 0;
  std::string first_message;  ///< "file:line: rule (value)" of the first one
};

/// How the base station's clock was tied to the robot's.
struct BaseClock {
  std::int64_t offset_ns = 0;  ///< robot time = base-station time + offset
  std::string reason;          ///< a sentence for the status
};

struct ReaderOptions {
  /// The sensors' clocks may step forward by this much before a second sample must confirm it [ns].
  std::int64_t max_gap_ns = 2'000'000'000;
};

/// Reads a recording folder in order of host time with bounded memory. The same folder always gives the same
/// events.
class RecordingReader {
 public:
  /// Opens all files of the manifest. Throws DataError: no folder, no recording.toml, a file that is missing,
  /// a folder or not what its name says, a column that is missing.
  explicit RecordingReader(const std::filesystem::path& folder, const ReaderOptions& options = {});
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  /// The next event in order of time; false at the end. Broken rows and packets are skipped and counted.
  bool next(Event& event);

  [[nodiscard]] const Manifest& manifest() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;  ///< of the manifest
  [[nodiscard]] const BaseClock& base_clock() const;
  /// All counters that are not zero. May be called at any time; cheap enough for once a second.
  [[nodiscard]] std::vector<Count> counts() const;
  /// Fraction of the bytes read, 0 … 1, for a progress bar.
  [[nodiscard]] double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::recording
