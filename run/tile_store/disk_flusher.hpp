// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <atomic>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// Hands a file over to a thread that may wait for the disk: one thread posts, one flushes.
class DiskFlusher {
 public:
  DiskFlusher() = default;
  ~DiskFlusher() { const FileDescriptor last(posted_.exchange(-1)); }
  DiskFlusher(const DiskFlusher&) = delete;
  DiskFlusher& operator=(const DiskFlusher&) = delete;

  /// `file` takes the place of one that was not flushed yet; the caller makes sure that this is the same file.
  void post(FileDescriptor file) noexcept { const FileDescriptor old(posted_.exchange(file.release())); }
  /// Waits until the posted file is on the disk (fdatasync). True also without one.
  bool flush() noexcept { return wait_for(FileDescriptor(posted_.exchange(-1))); }
  /// Waits until the file is on the disk. True also without one.
  [[nodiscard]] static bool wait_for(const FileDescriptor& file) noexcept {
    return !file || ::fdatasync(file.get()) == 0;
  }

 private:
  std::atomic<int> posted_{-1};
};

}  // namespace isobar
