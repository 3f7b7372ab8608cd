// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// Watches the folder of a configuration file and conf.d beside it, by inotify(7). A change is told once it is
/// complete: the writer has closed its file, or renamed it into place, and nothing else has changed for
/// kQuiet. Main thread.
class ConfigWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// Rest after a change, so that files that are pushed together are read together.
  static constexpr std::chrono::milliseconds kQuiet{200};
  /// Longest wait for that rest.
  static constexpr std::chrono::milliseconds kLongest{2000};

  /// Without inotify (no descriptors left) nothing is ever told.
  explicit ConfigWatch(const std::filesystem::path& main);

  /// Whether the configuration may have changed since the last call that returned true. Never waits.
  [[nodiscard]] bool changed(Clock::time_point now);
  /// False where the kernel refuses to watch: only SIGHUP reloads then.
  [[nodiscard]] bool works() const { return main_watch_ >= 0; }

 private:
  void watch_folders();
  bool read_events();
  [[nodiscard]] bool note(int watch, std::uint32_t mask, const char* name);
  [[nodiscard]] bool matters(int watch, const char* name) const;

  std::filesystem::path main_;
  std::filesystem::path folder_;
  FileDescriptor inotify_;
  int main_watch_ = -1;
  int conf_d_watch_ = -1;
  Clock::time_point next_attempt_{};  // to watch a folder that is missing
  Clock::time_point first_{};         // change that is not told yet
  Clock::time_point last_{};
  bool pending_ = false;
};

}  // namespace isobar
