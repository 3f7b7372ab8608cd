// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run/recording/live_recording.hpp"

namespace isobar::recording {

/// Free space of the file system that holds `path` or its nearest existing parent [bytes].
/// @throws ServiceError when the system does not tell
[[nodiscard]] std::uint64_t free_bytes(const std::filesystem::path& path);

/// The recording folders of an input log, for `isobar record` and the black box: the first one as named, a further one ("NAME-2") after a
/// restart of isobard with other sensors or mounts, or with a robot clock that was set in between. A restart
/// with the same continues the folder.
class RecordSession {
 public:
  explicit RecordSession(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// A new attachment to isobard begins: its losses count from zero again.
  void begin_attachment() { lost_before_ += std::exchange(lost_, 0); }
  /// Adds a record of the input log.
  /// @throws DataError when a folder cannot be written, or isobard sends a manifest that is none
  void add(const LogEntry& entry);
  /// Hands everything to the kernel and waits until it is on the disk; call once a second.
  /// @throws DataError when the disk refuses
  void flush();
  /// @throws DataError when the disk refuses
  void close();

  /// Counters of all folders.
  [[nodiscard]] LiveCounts counts() const;
  [[nodiscard]] std::uint64_t lost() const { return lost_before_ + lost_; }
  [[nodiscard]] std::uint64_t bytes() const;  ///< size of all folders
  [[nodiscard]] bool started() const { return !folders_.empty(); }
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const { return folders_; }
  /// Sentences for the user since the last call.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  void describe(const LogEntry& entry);
  void open(const LogEntry& entry);

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> folders_;
  std::optional<LiveRecording> recording_;
  LiveCounts closed_;  // of the folders before the open one
  std::string manifest_;
  std::string settings_;
  std::int64_t clock_offset_ns_ = 0;
  std::uint64_t lost_ = 0;         // of this attachment to isobard
  std::uint64_t lost_before_ = 0;  // of earlier ones
  std::vector<std::string> notes_;
};

}  // namespace isobar::recording
