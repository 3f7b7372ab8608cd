// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "run/recording/input_log.hpp"
#include "run/recording/manifest.hpp"
#include "run/recording/recording_writer.hpp"
#include "run/recording/scan_parts.hpp"

namespace isobar::recording {

/// Numbers of written inputs.
struct LiveCounts {
  std::uint64_t packets = 0;  ///< of both ports of the lidar
  std::uint64_t clouds = 0;   ///< of a lidar that gives clouds
  std::uint64_t imu = 0;
  std::uint64_t pressure = 0;
  std::uint64_t base_pressure = 0;
  std::uint64_t wheel = 0;
  std::uint64_t too_long = 0;  ///< datagrams longer than UDP allows, left out

  [[nodiscard]] std::uint64_t all() const {
    return packets + clouds + imu + pressure + base_pressure + wheel;
  }
};

/// Writes the records of an input log to a new recording folder as they come. The manifest names the sensors
/// that have delivered so far, so that the folder is a complete recording at every time after flush().
class LiveRecording {
 public:
  /// Creates the folder and its files; `settings` (may be empty) becomes settings.toml.
  /// @param manifest all sensors that may deliver
  /// @throws DataError when the folder exists and is not empty, or a file cannot be written
  LiveRecording(const std::filesystem::path& folder, const Manifest& manifest, std::string_view settings);

  /// Adds a packet or sample; records of other kinds, and sensors that the manifest lacks, are ignored.
  void add(const LogEntry& entry);
  /// Hands everything to the kernel; call it once a second.
  /// @throws DataError when any write failed
  void flush();
  /// Closes the files and removes those of sensors that delivered nothing.
  /// @param to_disk waits until the folder is on the disk
  /// @throws DataError when any write failed
  void close(bool to_disk);

  [[nodiscard]] const LiveCounts& counts() const { return counts_; }

 private:
  void add_datagram(const LogEntry& entry, std::uint16_t port);
  void add_scan_part(const LogEntry& entry);
  void note_seen();

  std::filesystem::path folder_;
  Manifest all_;   // the sensors that may deliver
  Manifest seen_;  // those that have
  bool manifest_is_old_ = true;
  LiveCounts counts_;
  ScanParts scan_parts_;
  std::unique_ptr<RecordingWriter> writer_;
};

/// Waits until a folder with its files is on the disk. Files that vanish meanwhile are skipped.
/// @throws DataError naming the file when the disk refuses
void sync_folder(const std::filesystem::path& folder);

}  // namespace isobar::recording
